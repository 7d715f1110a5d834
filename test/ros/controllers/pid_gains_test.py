#!/usr/bin/python3
"""Gains come from gazebo_ros_control/pid_gains; without them the arm would fall, or sag by a fiftieth of what they let it."""
import math
import os
import sys
import unittest

import rospy
import rostest
from sensor_msgs.msg import JointState

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import sim_client
from sim_client import Recorder, wait_until

WEIGHT = 9.81 * (0.5 * 0.15 + 0.2 * 0.33)  # [N m] of the arm lying


class PidGainsTest(unittest.TestCase):
    def test_arm_sags_as_the_gains_say(self):
        states = Recorder("/joint_states", JointState)
        wait_until(states.connected, "connections")
        answer = sim_client.step(3000)
        wait_until(lambda: any(m.header.stamp == answer.stamp for m in states.messages()), "the joint state of the last step")
        position = states.messages()[-1].position[0]
        self.assertAlmostEqual(50 * (position - 1), WEIGHT * math.sin(position), delta=1e-3)


if __name__ == "__main__":
    rospy.init_node("pid_gains_test")
    rostest.rosrun("blem_sim", "pid_gains", PidGainsTest)
