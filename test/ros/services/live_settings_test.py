#!/usr/bin/python3
"""Settings by a client of dynamic_reconfigure: taken between steps, refused with the old values, recorded and replayed."""
import math
import os
import subprocess
import sys
import tempfile
import unittest

import rospy
import rostest
from dynamic_reconfigure.client import Client
from geometry_msgs.msg import Pose, Vector3
from rosgraph_msgs.msg import Log

from blem_sim import msg, srv

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import sim_client
from sim_client import Recorder, service, wait_until

BALL = """<robot name="ball"><link name="ball"><inertial><mass value="1"/>
<inertia ixx="0.004" iyy="0.004" izz="0.004" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><sphere radius="0.1"/></geometry></collision></link></robot>"""


def observe(steps=0):
    answer = service("step_with_commands", srv.StepWithCommands)(steps, [])
    assert answer.success, answer.status_message
    return answer


def place(model):
    return service("get_model_state", srv.GetModelState)(model, "").pose.position


class LiveSettingsTest(unittest.TestCase):
    def setUp(self):
        self.client = Client("/blem_sim", timeout=sim_client.PATIENCE)
        self.addCleanup(self.client.close)
        self.before = self.client.get_configuration(timeout=sim_client.PATIENCE)
        self.addCleanup(self.put_back)

    def put_back(self):
        self.client.update_configuration({name: value for name, value in self.before.items() if isinstance(value, float) and "ball" not in name})
        sim_client.reset_world()

    def test_all_settings_are_there(self):
        self.assertEqual(self.before["gravity_z"], -9.81)
        self.assertEqual(self.before["time_step"], 0.001)
        self.assertEqual(self.before["real_time_factor"], 1.0)
        self.assertEqual(self.before["cube::friction"], 0.5)
        self.assertEqual(self.before["arm_on_base::friction"], 1.0)
        self.assertEqual([self.before["arm_on_base::shoulder::" + gain] for gain in "pid"], [100, 0, 5])
        self.assertIn("ground::friction", self.before)

    def test_gravity_time_step_and_pace(self):
        answer = self.client.update_configuration({"gravity_z": -1.5, "time_step": 0.002, "real_time_factor": 0.5})
        self.assertEqual((answer["gravity_z"], answer["time_step"], answer["real_time_factor"]), (-1.5, 0.002, 0.5))
        physics = service("get_physics_properties", srv.GetPhysicsProperties)()
        self.assertEqual((physics.gravity.z, physics.time_step, physics.max_update_rate), (-1.5, 0.002, 250))
        service("set_model_state", srv.SetModelState)(msg.ModelState("cube", Pose(position=Vector3(3, 3, 2)), msg.ModelState().twist, ""))
        before, start = observe().stamp, place("cube").z
        seconds = (observe(100).stamp - before).to_sec()
        self.assertAlmostEqual(seconds, 0.2)
        self.assertAlmostEqual(start - place("cube").z, 0.5 * 1.5 * seconds ** 2, delta=1e-3)

    def test_friction_lets_slide(self):
        def slid(friction):
            sim_client.reset_world()
            self.client.update_configuration({"cube::friction": friction, "gravity_x": 3.0})
            start = place("cube").x
            sim_client.step(300)
            return place("cube").x - start

        self.assertLess(slid(0.5), 1e-3)
        self.assertAlmostEqual(slid(0.0), 0.5 * 3.0 * 0.3 ** 2, delta=0.01)

    def test_gains_hold_or_give(self):
        def error(p):
            sim_client.reset_world()
            self.client.update_configuration({"arm_on_base::shoulder::p": p})
            service("set_model_configuration", srv.SetModelConfiguration)("arm_on_base", "", ["shoulder"], [0.5])
            sim_client.step(500)
            return abs(service("get_joint_properties", srv.GetJointProperties)("shoulder").position[0] - 0.5)

        stiff, soft = error(1000.0), error(5.0)
        self.assertLess(stiff, 0.01)
        self.assertGreater(soft, 10 * stiff)

    def test_refused_values_are_put_back_in_words(self):
        log = Recorder("/rosout", Log)
        self.addCleanup(log.stop)
        wait_until(log.connected, "the log")
        before = observe()
        for name, value in (("gravity_z", math.nan), ("gravity_x", 1e9), ("time_step", 0.0), ("real_time_factor", -1.0), ("real_time_factor", math.inf),
                            ("cube::friction", -0.1), ("arm_on_base::shoulder::p", -5.0), ("arm_on_base::shoulder::d", math.nan)):
            log.clear()
            answer = self.client.update_configuration({name: value, "gravity_y": 1.0})
            self.assertEqual((answer[name], answer["gravity_y"]), (self.before[name], 0.0), name)
            wait_until(lambda: [m for m in log.messages() if m.msg.startswith("set_parameters: " + name)], "a line on " + name)
        self.assertEqual(observe().state_hash, before.state_hash)

    def test_models_bring_their_settings(self):
        descriptions = lambda: {row["name"] for row in self.client.get_parameter_descriptions(timeout=sim_client.PATIENCE)}
        self.assertTrue(service("spawn_urdf_model", srv.SpawnModel)("ball", BALL, "", Pose(position=Vector3(-2, 0, 1)), "").success)
        self.addCleanup(lambda: service("delete_model", srv.DeleteModel)("ball"))
        wait_until(lambda: "ball::friction" in descriptions(), "the ball's friction")
        self.assertEqual(self.client.update_configuration({"ball::friction": 0.125})["ball::friction"], 0.125)
        self.assertTrue(service("delete_model", srv.DeleteModel)("ball").success)
        wait_until(lambda: "ball::friction" not in descriptions(), "the ball's friction to go")

    def test_other_ways_of_setting_are_told(self):
        set_physics = service("set_physics_properties", srv.SetPhysicsProperties)
        self.assertTrue(set_physics(0.001, 1000, Vector3(0, 0, -4), msg.ODEPhysics()).success)
        wait_until(lambda: self.client.get_configuration(timeout=sim_client.PATIENCE)["gravity_z"] == -4, "the other gravity")

    def test_recorded_and_replayed(self):
        with tempfile.TemporaryDirectory(dir="/tmp") as folder:
            bag = os.path.join(folder, "settings.bag")
            self.assertTrue(service("start_record", srv.StartRecord)(bag).success)
            self.client.update_configuration({"gravity_x": 2.0})
            sim_client.step(50)
            self.client.update_configuration({"cube::friction": 0.1, "arm_on_base::shoulder::p": 30.0, "arm_on_base::shoulder::i": 3.0})
            end = observe(50)
            self.assertTrue(service("stop_record", srv.StopRecord)().success)
            done = subprocess.run(["rosrun", "blem_sim", "replay", bag], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertIn("4 inputs", done.stdout)
        self.assertIn("%016x" % end.state_hash, done.stdout)


if __name__ == "__main__":
    rospy.init_node("live_settings_test", disable_rostime=True)
    rostest.rosrun("blem_sim", "live_settings", LiveSettingsTest)
