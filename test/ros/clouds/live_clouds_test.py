#!/usr/bin/python3
"""A cube on a floor that a camera streams: clouds are turned by tf, exchanged between steps, and refused where they lie."""
import math
import os
import random
import struct
import sys
import time
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import TransformStamped
from sensor_msgs.msg import PointCloud2, PointField
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import MarkerArray

from blem_sim.msg import LiveCloudUpdate
from blem_sim.srv import GetModelState, StepWithCommands

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import sim_client
from sim_client import Recorder, service

CAMERA_HEIGHT = 1.0  # [m]; it looks straight down: its z is the world's -z
HALF, LAYER = 0.1, 0.0025  # [m] of the cube
SPACING, NOISE = 0.01, 0.0005  # [m] of the floor's points
RADIUS = 0.3 * SPACING


def floor(rng, noise=NOISE, height=0.0):
    """Points of a floor as the camera sees them."""
    places = [SPACING * i for i in range(-20, 21)]
    return [(x, -y, CAMERA_HEIGHT - height - rng.gauss(0, noise)) for x in places for y in places]


def cloud(points, frame="camera", stamp=None):
    message = PointCloud2(height=1, width=len(points), point_step=12, row_step=12 * len(points), is_dense=True)
    message.header.frame_id = frame
    message.header.stamp = rospy.get_rostime() if stamp is None else stamp
    message.fields = [PointField(name, 4 * i, PointField.FLOAT32, 1) for i, name in enumerate("xyz")]
    message.data = b"".join(struct.pack("<fff", *p) for p in points)
    return message


class LiveCloudsTest(unittest.TestCase):
    def setUp(self):
        self.rng = random.Random(5)
        self.points = rospy.Publisher("/camera/points", PointCloud2, queue_size=10)
        self.far_points = rospy.Publisher("/camera/far_points", PointCloud2, queue_size=10)
        self.updates = Recorder(sim_client.NODE + "/live_cloud_updates", LiveCloudUpdate)
        self.diagnostics = Recorder("/diagnostics", DiagnosticArray)
        self.step = service("step_with_commands", StepWithCommands)
        sim_client.wait_until(lambda: self.points.get_num_connections() > 0 and self.far_points.get_num_connections() > 0, "the node to listen")
        sim_client.wait_until(self.updates.connected, "updates")

    def tearDown(self):
        for recorder in (self.updates, self.diagnostics):
            recorder.stop()

    def counts(self):
        return sim_client.newest_status(self.diagnostics, "live clouds")

    def wait_for_count(self, key, least):
        sim_client.wait_until(lambda: int(self.counts()[key]) >= least, "%s of %d" % (key, least))

    def send(self, message, publisher=None, environment="live"):
        """Publishes a cloud and returns when the node has it."""
        before = int(self.counts()[environment + " clouds received"])
        (publisher or self.points).publish(message)
        self.wait_for_count(environment + " clouds received", before + 1)

    def cube(self):
        return service("get_model_state", GetModelState)("cube", "").pose.position

    def test_1_a_cube_stands_on_a_streamed_floor(self):
        self.send(cloud(floor(self.rng, 0)))
        answer = self.step(300, [])
        self.assertTrue(answer.success, answer.status_message)
        update = self.updates.wait_for(1)[-1]
        self.assertEqual((update.environment, update.step, update.points, update.accepted), ("live", 0, 41 * 41, 1))
        self.assertAlmostEqual(update.point_radius, RADIUS, delta=1e-5)
        self.assertAlmostEqual(self.cube().z, HALF + LAYER + RADIUS, delta=1e-4)
        # 10 Hz of simulated time while it runs.
        self.updates.clear()
        sim_client.unpause()
        rate = rospy.Rate(10)
        for _ in range(20):
            self.points.publish(cloud(floor(self.rng)))
            rate.sleep()
        sim_client.pause()
        updates = self.updates.messages()
        self.assertGreater(len(updates), 5)
        self.assertEqual([u.step for u in updates], sorted(u.step for u in updates))
        self.assertEqual(updates[-1].refused, 0)
        at = self.cube()
        self.assertGreater(at.z, HALF + LAYER + RADIUS - 5 * NOISE)
        self.assertLess(at.z, HALF + LAYER + RADIUS + 5 * NOISE)
        self.assertLess(math.hypot(at.x, at.y), 0.001)

    def test_2_lies_are_refused_and_counted(self):
        self.send(cloud(floor(self.rng, 0)))
        self.step(10, [])
        before, height = self.counts(), self.cube().z
        lies = []
        for field, value in (("point_step", 0), ("width", 0), ("width", 100000000), ("row_step", 1), ("is_bigendian", True), ("data", b"1"),
                             ("fields", [])):
            lies.append(cloud(floor(self.rng, 0)))
            setattr(lies[-1], field, value)
        lies.append(cloud(floor(self.rng, 0)))
        lies[-1].width = lies[-1].height = 65536
        lies.append(cloud(floor(self.rng, 0), frame="nowhere"))
        lies.append(cloud(floor(self.rng, 0), frame=""))
        lies.append(cloud(floor(self.rng, 0), stamp=rospy.get_rostime() + rospy.Duration(100)))
        lies.append(cloud([(float("nan"), 0, 0)]))
        refused = int(before["live clouds refused"])
        for lie in lies:
            self.points.publish(lie)
            refused += 1
            self.wait_for_count("live clouds refused", refused)
        after = self.counts()
        self.assertEqual(int(after["live clouds refused"]), refused)
        self.assertEqual(after["live clouds accepted"], before["live clouds accepted"])
        self.assertIn("finite", after["live last refusal"])
        self.assertTrue(self.step(50, []).success)
        self.assertAlmostEqual(self.cube().z, height, delta=1e-4)

    def test_3_a_call_takes_what_was_sent_before_it(self):
        def run():
            """State hashes of steps on a floor that rises and sinks by less than its layer."""
            service("reset_simulation", sim_client.Empty)()
            rng, hashes = random.Random(9), []
            for i in range(5):
                self.send(cloud(floor(rng), stamp=rospy.Time(0)))
                self.updates.clear()
                hashes.append(self.step(50, []).state_hash)
                self.assertEqual(self.updates.wait_for(1)[0].step, 50 * i)
            return hashes

        first = run()
        self.assertEqual(run(), first)

    def test_4_a_map_needs_hits_and_is_seen(self):
        markers = Recorder(sim_client.NODE + "/environment_markers", MarkerArray)
        sim_client.wait_until(markers.connected, "markers")
        self.send(cloud(floor(self.rng, 0)), self.far_points, "map")
        self.wait_for_count("map clouds refused", 1)
        time.sleep(1.1)  # markers come once a second
        self.send(cloud(floor(self.rng, 0)), self.far_points, "map")
        self.step(10, [])
        self.assertEqual(self.counts()["map clouds accepted"], "1")
        sim_client.wait_until(lambda: any(marker.ns == "map" for message in markers.messages() for marker in message.markers), "the map's markers")
        markers.stop()

    def test_5_a_cloud_that_is_unloaded_carries_nothing(self):
        self.send(cloud(floor(self.rng, 0)))
        self.step(10, [])
        for name in ("live", "map"):
            self.assertTrue(sim_client.unload_environment(name).success)
        height = self.cube().z
        self.assertTrue(self.step(100, []).success)
        self.assertAlmostEqual(self.cube().z, height - 0.5 * 9.81 * 0.1 ** 2, delta=0.002)
        refused = int(self.counts()["live clouds refused"])
        self.send(cloud(floor(self.rng, 0)))
        self.assertTrue(self.step(1, []).success)
        self.wait_for_count("live clouds refused", refused + 1)


if __name__ == "__main__":
    rospy.init_node("live_clouds_test")
    transforms = rospy.Publisher("/tf_static", TFMessage, queue_size=1, latch=True)
    camera = TransformStamped(child_frame_id="camera")
    camera.header.frame_id = "world"
    camera.transform.translation.z = CAMERA_HEIGHT
    camera.transform.rotation.x = 1.0
    transforms.publish(TFMessage([camera]))
    rostest.rosrun("blem_sim", "live_clouds", LiveCloudsTest, sys.argv)
