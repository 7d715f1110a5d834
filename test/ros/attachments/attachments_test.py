#!/usr/bin/python3
"""A cube that is attached hangs where it is, is told with its wrench, breaks loose beyond its limit, and falls when it is detached."""
import os
import sys
import unittest

import rospy
import rostest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import sim_client
from sim_client import Recorder, service, wait_until

from blem_sim.msg import AttachmentArray, ModelState
from blem_sim.srv import Attach, Detach, GetModelState, ResetModel, SetModelState

ARM, GROUND = "arm_on_base::base", "ground::link"
WEIGHT = 9.81  # [N] of the cube


class AttachmentsTest(unittest.TestCase):
    def setUp(self):
        sim_client.pause()
        sim_client.reset_world()
        self.attachments = Recorder("/blem_sim/attachments", AttachmentArray)
        wait_until(self.attachments.connected, "a connection to ~attachments")

    def tearDown(self):
        self.attachments.stop()

    def attach(self, max_force=0.0):
        answer = service("attach", Attach)("cube", GROUND, max_force, 0)
        self.assertTrue(answer.success, answer.status_message)

    def height(self):
        return service("get_model_state", GetModelState)("cube", "").pose.position.z

    def test_hangs_and_falls(self):
        raised = ModelState(model_name="cube")
        raised.pose.position.x, raised.pose.position.z = 0.6, 0.5
        self.assertTrue(service("set_model_state", SetModelState)(raised).success)
        self.attach()
        sim_client.step(300)
        last = self.attachments.wait_for(300)[-1].attachments[0]
        self.assertEqual((last.object_name, last.link_name, last.max_force), ("cube", GROUND, float("inf")))
        self.assertAlmostEqual(last.wrench.force.z, WEIGHT, delta=1e-9)
        self.assertAlmostEqual(self.height(), 0.5, delta=1e-12)
        self.assertTrue(service("detach", Detach)("cube").success)
        sim_client.step(600)
        self.assertAlmostEqual(self.height(), 0.1025, delta=1e-3)  # on the ground

    def test_breaks_beyond_its_limit(self):
        self.attach(0.5 * WEIGHT)
        sim_client.step(50)
        told = self.attachments.wait_for(1)
        self.assertEqual([list(message.broken) for message in told], [["cube"]])
        self.assertEqual(list(told[0].attachments), [])
        self.assertFalse(service("detach", Detach)("cube").success)

    def test_refuses_in_words(self):
        attach = service("attach", Attach)
        for names, words in ((("cub", ARM), "'cube'"), (("cube", "arm_on_base::bass"), "'arm_on_base::base'"), (("ground", ARM), "fixed")):
            answer = attach(names[0], names[1], 0, 0)
            self.assertFalse(answer.success)
            self.assertIn(words, answer.status_message)
        self.assertIn("max_force", attach("cube", ARM, -1, 0).status_message)
        self.attach()
        self.assertIn("already", attach("cube", ARM, 0, 0).status_message)
        self.assertTrue(service("reset_model", ResetModel)("cube").success)
        self.assertIn("not attached", service("detach", Detach)("cube").status_message)


if __name__ == "__main__":
    rospy.init_node("attachments_test", disable_rostime=True)
    rostest.rosrun("blem_sim", "attachments", AttachmentsTest)
