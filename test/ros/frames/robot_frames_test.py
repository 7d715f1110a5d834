#!/usr/bin/python3
"""Three robots of one URDF: frames of their own, odometry as it was asked for, and topics that are off."""
import math
import os
import sys
import unittest

import rospy
import rostest
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Imu, JointState
from tf2_msgs.msg import TFMessage

from blem_sim.msg import LinkStates

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from sim_client import Recorder, record


class RobotFramesTest(unittest.TestCase):
    def assert_at(self, transform, parent, x, y, z):
        self.assertEqual(transform.header.frame_id, parent)
        at = transform.transform.translation
        for value, expected in ((at.x, x), (at.y, y), (at.z, z)):
            self.assertAlmostEqual(value, expected, delta=1e-3)

    def test_tf_has_every_frame_once(self):
        transforms = record("/tf", TFMessage, 5)[-1].transforms
        frames = {transform.child_frame_id: transform for transform in transforms}
        self.assertEqual(len(frames), len(transforms))
        self.assertEqual(set(frames), {"cart", "odom", "sled", "drone", "second/cart", "second/sled", "second/drone"})
        self.assert_at(frames["cart"], "world", 1, 0, 0)
        self.assert_at(frames["odom"], "world", 1, 0, 0)
        self.assert_at(frames["sled"], "cart", 0.3, 0, 0.2)
        self.assert_at(frames["drone"], "cart", 0, 0, 1)
        self.assert_at(frames["second/cart"], "world", 0, 2, 0)
        self.assert_at(frames["second/drone"], "second/cart", 0, 0, 1)

    def test_odometry_is_told_in_its_frame(self):
        truth = record("/first/truth", Odometry, 5)[-1]
        self.assertEqual((truth.header.frame_id, truth.child_frame_id), ("odom", "cart"))
        at, turn = truth.pose.pose.position, truth.pose.pose.orientation
        self.assertAlmostEqual(math.hypot(at.x, at.y), 0, delta=1e-3)
        self.assertAlmostEqual(2 * math.atan2(turn.z, turn.w), -math.pi / 2, delta=1e-3)
        second = record("/second/odom", Odometry, 5)[-1]
        self.assertEqual((second.header.frame_id, second.child_frame_id), ("world", "second/cart"))
        hidden = record("/hidden/odom", Odometry, 5)[-1]
        self.assertEqual((hidden.header.frame_id, hidden.child_frame_id), ("world", "masked/cart"))
        self.assertAlmostEqual(hidden.pose.pose.position.y, 4, delta=1e-3)

    def test_sensors_have_their_robots_prefix(self):
        for topic, frame in (("imu", "second/sled"), ("askew", "second/askew_frame"), ("named", "second/eye"), ("absolute", "nose")):
            self.assertEqual(record("/second/" + topic, Imu, 5)[-1].header.frame_id, frame)
        self.assertEqual(record("/first/told", Imu, 5)[-1].header.frame_id, "map")
        self.assertEqual(record("/second/state", Odometry, 5)[-1].child_frame_id, "second/drone")
        fixed = {transform.child_frame_id: transform for message in record("/tf_static", TFMessage, 1) for transform in message.transforms}
        self.assert_at(fixed["second/askew_frame"], "second/sled", 0, 0, 1)
        self.assert_at(fixed["nose"], "second/sled", 0, 0, 0)

    def test_what_is_off_is_silent(self):
        silent = [Recorder("/first/joint_states", JointState), Recorder("/first/silent", Imu), Recorder("/blem_sim/link_states", LinkStates)]
        record("/clock", Clock, 500)
        for recorder in silent:
            self.assertTrue(recorder.connected(), recorder.topic)
            self.assertFalse(recorder.messages(), recorder.topic)


if __name__ == "__main__":
    rospy.init_node("robot_frames_test", disable_rostime=True)
    rostest.rosrun("blem_sim", "robot_frames", RobotFramesTest)
