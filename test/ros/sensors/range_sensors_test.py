#!/usr/bin/python3
"""Every topic of a depth camera and of lidars arrives, with what it should hold for a wall 2 m ahead."""
import math
import os
import struct
import sys
import unittest

import rospy
import rostest
import sensor_msgs.point_cloud2 as point_cloud2
from sensor_msgs.msg import CameraInfo, Image, LaserScan, PointCloud2
from tf2_msgs.msg import TFMessage

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from sim_client import Recorder, pause, record, stamps, step, unpause

WIDTH, HEIGHT, HFOV = 64, 48, 0.6
WALL = 2.0


class RangeSensorsTest(unittest.TestCase):
    def assert_of_camera(self, message):
        self.assertEqual(message.header.frame_id, "camera_optical_frame")
        self.assertEqual([message.width, message.height], [WIDTH, HEIGHT])

    def test_image_in_metres(self):
        messages = record("/camera/depth/image_raw", Image, 10)
        image = messages[-1]
        self.assert_of_camera(image)
        self.assertEqual([image.encoding, image.step, image.is_bigendian], ["32FC1", 4 * WIDTH, 0])
        for depth in struct.unpack("<%df" % (WIDTH * HEIGHT), image.data):
            self.assertAlmostEqual(depth, WALL, delta=1e-6)
        # 30 Hz on average, at steps of 2 ms.
        times = stamps(messages)
        self.assertAlmostEqual((times[-1] - times[0]) / (len(times) - 1), 1 / 30.0, delta=0.002)

    def test_image_in_millimetres(self):
        image = record("/camera/depth/image", Image)[0]
        self.assert_of_camera(image)
        self.assertEqual([image.encoding, image.step], ["16UC1", 2 * WIDTH])
        self.assertEqual(set(struct.unpack("<%dH" % (WIDTH * HEIGHT), image.data)), {2000})

    def test_camera_info(self):
        info = record("/camera/depth/camera_info", CameraInfo)[0]
        self.assert_of_camera(info)
        focal_length = WIDTH / 2.0 / math.tan(HFOV / 2)
        for value, expected in zip(info.K, [focal_length, 0, 31.5, 0, focal_length, 23.5, 0, 0, 1]):
            self.assertAlmostEqual(value, expected, places=9)
        self.assertEqual([info.P[0], info.P[2], info.P[6], info.P[10]], [info.K[0], info.K[2], info.K[5], 1])
        self.assertEqual(list(info.R), [1, 0, 0, 0, 1, 0, 0, 0, 1])

    def test_points(self):
        cloud = record("/camera/depth/points", PointCloud2)[0]
        self.assert_of_camera(cloud)
        points = list(point_cloud2.read_points(cloud, ("x", "y", "z")))
        self.assertEqual(len(points), WIDTH * HEIGHT)
        half = WALL * math.tan(HFOV / 2) * (WIDTH - 1) / WIDTH
        for value, expected in zip(points[0], [-half, -half * (HEIGHT - 1) / (WIDTH - 1), WALL]):
            self.assertAlmostEqual(value, expected, delta=1e-6)
        self.assertAlmostEqual(points[-1][0], half, delta=1e-6)

    def test_optical_frame(self):
        transforms = {t.child_frame_id: t for m in record("/tf_static", TFMessage) for t in m.transforms}
        optical = transforms["camera_optical_frame"]
        self.assertEqual(optical.header.frame_id, "base")
        self.assertAlmostEqual(optical.transform.translation.z, 1)
        q = optical.transform.rotation
        for value, expected in zip([q.x, q.y, q.z, q.w], [-0.5, 0.5, -0.5, 0.5]):
            self.assertAlmostEqual(abs(value), abs(expected), places=12)
        self.assertGreater(q.y * q.w, 0)
        self.assertLess(q.x * q.w, 0)
        self.assertLess(q.z * q.w, 0)
        self.assertEqual(transforms["scan_frame"].header.frame_id, "base")

    def test_scan(self):
        scan = record("/scan", LaserScan)[0]
        self.assertEqual(scan.header.frame_id, "scan_frame")
        self.assertEqual(len(scan.ranges), 181)
        self.assertAlmostEqual(scan.angle_min + 180 * scan.angle_increment, scan.angle_max, places=5)
        self.assertAlmostEqual(scan.ranges[90], WALL, delta=1e-6)
        self.assertAlmostEqual(scan.ranges[135], WALL * math.sqrt(2), delta=1e-5)
        self.assertEqual(scan.ranges[0], float("inf"))
        self.assertAlmostEqual(scan.scan_time, 1 / 40.0, places=6)

    def test_truth_beside_noise(self):
        noisy, truth = record("/noisy_scan", LaserScan)[0], record("/noisy_scan/ground_truth", LaserScan)[0]
        self.assertEqual((truth.header.frame_id, len(truth.ranges)), (noisy.header.frame_id, len(noisy.ranges)))
        self.assertAlmostEqual(truth.ranges[90], WALL, delta=1e-6)
        self.assertGreater(max(abs(a - WALL) for a in noisy.ranges[85:96]), 0.01)
        depth = record("/kinect/ground_truth/depth/points", PointCloud2)[0]
        for _, _, z in point_cloud2.read_points(depth, ("x", "y", "z")):
            self.assertAlmostEqual(z, WALL, delta=1e-6)
        topics = [name for name, _ in rospy.get_published_topics()]
        self.assertIn("/cloud", topics)
        self.assertNotIn("/scan/ground_truth", topics)

    def test_a_step_answers_when_its_images_are_out(self):
        recorder = Recorder("/camera/depth/image_raw", Image)
        recorder.wait_for(1)
        pause()
        recorder.clear()
        last = step(50).stamp.to_sec()
        # 100 ms at 30 Hz; what was sent before the answer may take a moment to be read.
        times = stamps(recorder.wait_for(3))
        self.assertTrue(all(last - 0.1 < time <= last + 1e-9 for time in times), "%s until %g" % (times, last))
        recorder.stop()
        unpause()

    def test_layers(self):
        cloud = record("/layers", PointCloud2)[0]
        self.assertEqual([cloud.width, cloud.height, cloud.header.frame_id], [90, 4, "layers_frame"])
        for x, _, _ in point_cloud2.read_points(cloud, ("x", "y", "z")):
            self.assertAlmostEqual(x, WALL, delta=1e-5)


if __name__ == "__main__":
    rospy.init_node("range_sensors_test")
    rostest.rosrun("blem_sim", "range_sensors", RangeSensorsTest)
