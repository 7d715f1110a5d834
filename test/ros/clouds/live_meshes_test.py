#!/usr/bin/python3
"""Balls on a mesh, at the wall of a grid and on a joined cloud that topics bring: exchanged between steps, and refused where they lie."""
import os
import struct
import sys
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Point, TransformStamped
from nav_msgs.msg import OccupancyGrid
from sensor_msgs.msg import PointCloud2, PointField
from shape_msgs.msg import Mesh, MeshTriangle
from tf2_msgs.msg import TFMessage

from blem_sim.msg import LiveCloudUpdate
from blem_sim.srv import GetModelState, StepWithCommands

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import sim_client
from sim_client import Recorder, service

RADIUS = 0.05  # [m] of the balls
TABLE = 0.01  # [m] height of the mesh's frame
CELL, WALL = 0.5, 6.0  # [m] of the grid, and where its wall begins along x


def ground(height=0.0):
    corners = [Point(x, y, height) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    return Mesh(vertices=corners, triangles=[MeshTriangle([0, 1, 2]), MeshTriangle([0, 2, 3])])


def walls():
    """A wall of three cells across the way along x."""
    grid = OccupancyGrid()
    grid.header.frame_id = "world"
    grid.info.resolution = CELL
    grid.info.width, grid.info.height = 2, 3
    grid.info.origin.position.x, grid.info.origin.position.y, grid.info.origin.position.z = WALL - CELL, -0.5, -1
    grid.info.origin.orientation.w = 1
    grid.data = [0, 100, -1, 100, 49, 50]
    return grid


def seen():
    """A level grid of pixels about x = 10, one of which was not measured."""
    places = [0.02 * i for i in range(-5, 6)]
    points = [(10 + x, y, 0.0) for x in places for y in places]
    points[0] = (float("nan"),) * 3
    message = PointCloud2(height=11, width=11, point_step=12, row_step=12 * 11)
    message.header.frame_id = "world"
    message.fields = [PointField(name, 4 * i, PointField.FLOAT32, 1) for i, name in enumerate("xyz")]
    message.data = b"".join(struct.pack("<fff", *p) for p in points)
    return message


class LiveMeshesTest(unittest.TestCase):
    def setUp(self):
        self.topics = {"mesh": rospy.Publisher("/ground", Mesh, queue_size=10), "grid": rospy.Publisher("/map", OccupancyGrid, queue_size=10),
                       "seen": rospy.Publisher("/camera/points", PointCloud2, queue_size=10)}
        self.updates = Recorder(sim_client.NODE + "/live_cloud_updates", LiveCloudUpdate)
        self.diagnostics = Recorder("/diagnostics", DiagnosticArray)
        self.step = service("step_with_commands", StepWithCommands)
        sim_client.wait_until(lambda: all(topic.get_num_connections() > 0 for topic in self.topics.values()), "the node to listen")
        sim_client.wait_until(self.updates.connected, "updates")

    def tearDown(self):
        for recorder in (self.updates, self.diagnostics):
            recorder.stop()

    def counts(self):
        return sim_client.newest_status(self.diagnostics, "live clouds")

    def send(self, environment, message, counted="received"):
        """Publishes a message and returns when the node has received, or refused it."""
        key = "%s clouds %s" % (environment, counted)
        before = int(self.counts()[key])
        self.topics[environment].publish(message)
        sim_client.wait_until(lambda: int(self.counts()[key]) > before, key)

    def place(self, ball):
        return service("get_model_state", GetModelState)(ball, "").pose.position

    def test_1_balls_rest_and_stop(self):
        for environment, message in (("mesh", ground()), ("grid", walls()), ("seen", seen())):
            self.send(environment, message)
        self.assertTrue(self.step(1500, []).success)
        updates = {update.environment: update for update in self.updates.messages()}
        self.assertEqual(sorted(updates), ["grid", "mesh", "seen"])
        self.assertEqual((updates["mesh"].points_received, updates["mesh"].points, updates["mesh"].point_radius), (4, 4, 0))
        self.assertEqual((updates["seen"].points_received, updates["seen"].points), (120, 120))
        self.assertAlmostEqual(self.place("resting").z, TABLE + RADIUS, delta=1e-4)
        self.assertAlmostEqual(self.place("third").z, RADIUS, delta=1e-4)
        moving = self.place("moving")
        self.assertAlmostEqual(moving.x, WALL - RADIUS, delta=1e-3)
        self.assertAlmostEqual(moving.z, -1 + RADIUS, delta=1e-3)

    def test_2_a_mesh_that_rises_lifts_slowly(self):
        before = self.place("resting").z
        self.send("mesh", ground(0.001))
        self.assertTrue(self.step(1000, []).success)
        self.assertAlmostEqual(self.place("resting").z, before + 0.00025, delta=2e-5)
        self.assertTrue(self.step(4000, []).success)
        self.assertAlmostEqual(self.place("resting").z, before + 0.001, delta=2e-5)

    def test_3_lies_are_refused_and_counted(self):
        height = self.place("resting").z
        out_of_range, without, not_finite = ground(), ground(), ground()
        out_of_range.triangles[0].vertex_indices = [0, 1, 4]
        without.triangles = []
        not_finite.vertices[2].z = float("nan")
        for lie, why in ((out_of_range, "out of range"), (without, "none"), (not_finite, "finite")):
            self.send("mesh", lie, "refused")
            self.assertIn(why, self.counts()["mesh last refusal"])
        larger, without_cells, nowhere = walls(), walls(), walls()
        larger.info.width = larger.info.height = 2 ** 31
        without_cells.info.resolution = 0
        nowhere.header.frame_id = "nowhere"
        for lie, why in ((larger, "info.width"), (without_cells, "info.resolution"), (nowhere, "nowhere")):
            self.send("grid", lie, "refused")
            self.assertIn(why, self.counts()["grid last refusal"])
        self.assertTrue(self.step(50, []).success)
        self.assertAlmostEqual(self.place("resting").z, height, delta=1e-4)

    def test_4_a_grid_without_walls_takes_them_away(self):
        empty = walls()
        empty.data = [0] * len(empty.data)
        self.send("grid", empty)
        self.assertTrue(self.step(1, []).success)
        self.assertEqual([update.points for update in self.updates.wait_for(1) if update.environment == "grid"][-1], 0)


if __name__ == "__main__":
    rospy.init_node("live_meshes_test")
    transforms = rospy.Publisher("/tf_static", TFMessage, queue_size=1, latch=True)
    table = TransformStamped(child_frame_id="table")
    table.header.frame_id = "world"
    table.transform.translation.z = TABLE
    table.transform.rotation.w = 1.0
    transforms.publish(TFMessage([table]))
    rostest.rosrun("blem_sim", "live_meshes", LiveMeshesTest, sys.argv)
