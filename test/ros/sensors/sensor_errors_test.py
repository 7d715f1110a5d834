#!/usr/bin/python3
"""Sensors with errors publish what they read, and the truth beside it."""
import os
import sys
import unittest

import rospy
import rostest
from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import Imu

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from sim_client import Recorder

G = 9.81
HAND_WEIGHT = 0.2 * G


def record(topic, message_type, count=20):
    recorder = Recorder(topic, message_type)
    messages = recorder.wait_for(count)
    recorder.stop()
    return messages


class SensorErrorsTest(unittest.TestCase):
    def test_wrench_of_limited_range_and_resolution(self):
        self.assertAlmostEqual(record("/arm/wrist/wrench", WrenchStamped)[-1].wrench.force.z, 1.2, delta=1e-9)
        truth = record("/arm/wrist/wrench/ground_truth", WrenchStamped)[-1]
        self.assertAlmostEqual(truth.wrench.force.z, HAND_WEIGHT, delta=0.01)
        self.assertEqual(truth.header.frame_id, "hand")

    def test_imu_with_noise(self):
        noisy, truth = record("/arm/imu", Imu), record("/arm/imu/ground_truth", Imu)
        self.assertGreater(max(abs(message.linear_acceleration.z - G) for message in noisy), 0.05)
        for message in truth:
            self.assertAlmostEqual(message.linear_acceleration.z, G, delta=1e-6)
        self.assertAlmostEqual(noisy[-1].linear_acceleration_covariance[0], 0.25, delta=1e-9)
        self.assertEqual(truth[-1].linear_acceleration_covariance[0], 0)

    def test_a_sensor_without_errors_has_no_truth_beside_it(self):
        topics = [name for name, _ in rospy.get_published_topics("/arm")]
        self.assertIn("/arm/tilt", topics)
        self.assertNotIn("/arm/tilt/ground_truth", topics)


if __name__ == "__main__":
    rospy.init_node("sensor_errors_test")
    rostest.rosrun("blem_sim", "sensor_errors", SensorErrorsTest)
