#!/usr/bin/python3
"""Sensors with errors publish what they read, and the truth beside it."""
import os
import sys
import unittest

import rospy
import rostest
from geometry_msgs.msg import PointStamped, WrenchStamped
from sensor_msgs.msg import Imu
from std_msgs.msg import Bool
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from sim_client import Recorder, record

G = 9.81
HAND_WEIGHT = 0.2 * G


class SensorErrorsTest(unittest.TestCase):
    def test_wrench_of_limited_range_and_resolution(self):
        self.assertAlmostEqual(record("/arm/wrist/wrench", WrenchStamped, 20)[-1].wrench.force.z, 1.2, delta=1e-9)
        truth = record("/arm/wrist/wrench/ground_truth", WrenchStamped, 20)[-1]
        self.assertAlmostEqual(truth.wrench.force.z, HAND_WEIGHT, delta=0.01)
        self.assertEqual(truth.header.frame_id, "hand")

    def test_imu_with_noise(self):
        noisy, truth = record("/arm/imu", Imu, 20), record("/arm/imu/ground_truth", Imu, 20)
        self.assertGreater(max(abs(message.linear_acceleration.z - G) for message in noisy), 0.05)
        for message in truth:
            self.assertAlmostEqual(message.linear_acceleration.z, G, delta=1e-6)
        self.assertAlmostEqual(noisy[-1].linear_acceleration_covariance[0], 0.25, delta=1e-9)
        self.assertEqual(truth[-1].linear_acceleration_covariance[0], 0)

    def test_tilt_with_noise(self):
        noisy, truth = record("/arm/noisy_tilt", Imu, 20), record("/arm/noisy_tilt/ground_truth", Imu, 20)
        self.assertGreater(max(abs(message.orientation.x) for message in noisy), 0.01)
        self.assertAlmostEqual(noisy[-1].orientation_covariance[0], 0.01, delta=1e-9)
        self.assertEqual(truth[-1].orientation_covariance[0], 0)
        self.assertAlmostEqual(truth[-1].orientation.w, 1, delta=1e-3)

    def test_tare(self):
        self.assertAlmostEqual(record("/arm/wrist/free", WrenchStamped, 20)[-1].wrench.force.z, HAND_WEIGHT, delta=0.01)
        tare = rospy.ServiceProxy("/arm/wrist/free/tare", Trigger)
        tare.wait_for_service(60)
        answer = tare()
        self.assertTrue(answer.success, answer.message)
        for message in record("/arm/wrist/free", WrenchStamped, 20)[5:]:
            self.assertAlmostEqual(message.wrench.force.z, 0, delta=1e-3)
        self.assertAlmostEqual(record("/arm/joint_wrench", WrenchStamped, 20)[-1].wrench.force.z, HAND_WEIGHT, delta=0.01, msg="others stay")

    def test_wrench_in_the_joints_frame(self):
        self.assertEqual(record("/arm/joint_wrench", WrenchStamped, 20)[-1].header.frame_id, "joint_wrench_frame")
        frames = {transform.child_frame_id: transform for message in record("/tf_static", TFMessage, 1) for transform in message.transforms}
        self.assertNotEqual(frames["joint_wrench_frame"].header.frame_id, "hand")

    def test_switches_and_soles(self):
        self.assertEqual({message.data for message in record("/block/switch", Bool, 20)}, {True})
        self.assertEqual({message.data for message in record("/arm/switch", Bool, 20)}, {False})
        sole = record("/block/sole", PointStamped, 20)[-1]
        self.assertEqual(sole.header.frame_id, "sole_frame")
        for value, expected in ((sole.point.x, 0.02), (sole.point.y, 0.01), (sole.point.z, 0)):
            self.assertAlmostEqual(value, expected, delta=1e-5)
        in_air = Recorder("/arm/sole", PointStamped)
        record("/arm/tilt", Imu, 100)
        self.assertTrue(in_air.connected())
        self.assertFalse(in_air.messages(), "what nothing presses on has no centre of pressure")

    def test_a_sensor_without_errors_has_no_truth_beside_it(self):
        record("/arm/tilt", Imu, 1)
        topics = [name for name, _ in rospy.get_published_topics("/arm")]
        self.assertIn("/arm/tilt", topics)
        self.assertNotIn("/arm/tilt/ground_truth", topics)


if __name__ == "__main__":
    rospy.init_node("sensor_errors_test")
    rostest.rosrun("blem_sim", "sensor_errors", SensorErrorsTest)
