#!/usr/bin/python3
"""figure.launch: a figure without data and one with data start, answer services, and publish the joints of their robot."""
import pathlib
import signal
import subprocess
import sys
import unittest

import rospy
import rostest
from sensor_msgs.msg import JointState

from blem_sim.srv import GetWorldProperties

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from shared_data import shared_data  # noqa: E402

PATIENCE = 60  # [s]


class Started:
    """A figure's launch, on this master, while it is asked."""

    def __init__(self, *arguments):
        self.process = subprocess.Popen(["roslaunch", "blem_sim", "figure.launch", *arguments])

    def __enter__(self):
        rospy.wait_for_service("/blem_sim/get_world_properties", PATIENCE)
        return rospy.ServiceProxy("/blem_sim/get_world_properties", GetWorldProperties)()

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGINT)
        self.process.wait(PATIENCE)


class FigureLaunchTest(unittest.TestCase):
    def test_stack_of_cubes_without_data(self):
        with Started("figure:=1", "data:=/nowhere", "real_time_factor:=3") as world:
            self.assertTrue(world.success)
            self.assertEqual(set(world.model_names), {"ground", "cube_1", "cube_2", "cube_3"})
            self.assertEqual(rospy.get_param("/blem_sim/real_time_factor"), 3)

    def test_robot_with_data(self):
        if shared_data("worlds/hubo_plane.yaml") is None:
            self.skipTest("the shared data are not here (BLEM_SIM_SHARED_DATA)")
        with Started("figure:=9", "data:=%s" % shared_data()) as world:
            self.assertIn("jaemiHubo", world.model_names)
            joints = rospy.wait_for_message("/joint_states", JointState, PATIENCE)
            self.assertEqual(len(joints.name), 57)
            self.assertTrue(self.moves(joints), "the figure's motion is not played")

    @staticmethod
    def moves(first):
        """Whether a joint comes to be 0.05 rad from where it was."""
        for _ in range(20 * PATIENCE):
            now = rospy.wait_for_message("/joint_states", JointState, PATIENCE)
            if max(abs(a - b) for a, b in zip(now.position, first.position)) > 0.05:
                return True
        return False

    def test_missing_data_are_said_in_a_line(self):
        done = subprocess.run(["roslaunch", "blem_sim", "figure.launch", "figure:=9", "data:=/nowhere"],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True, timeout=PATIENCE)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("figure 9: it needs robots/klampt/huboplus, worlds/hubo_plane.yaml", done.stdout)


if __name__ == "__main__":
    rospy.init_node("figure_launch_test")
    rostest.rosrun("blem_sim", "figure_launch", FigureLaunchTest)
