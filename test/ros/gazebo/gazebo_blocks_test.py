#!/usr/bin/python3
"""Spawned robots have the sensors and surfaces of their URDF's <gazebo> blocks, in their namespace, and lose them when they are deleted."""
import os
import sys
import unittest

import rospkg
import rospy
import rostest
from geometry_msgs.msg import Point, Pose, WrenchStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import CameraInfo, Image, Imu, LaserScan, PointCloud2
from tf2_msgs.msg import TFMessage

from blem_sim import srv
from blem_sim.msg import ContactsState, LoadReport

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import sim_client
from sim_client import Recorder, service, wait_until

sim_client.NODE = "/gazebo"
ROBOT = os.path.join(rospkg.RosPack().get_path("blem_sim"), "test", "data", "ros", "gazebo_robot.urdf")
G = 9.81  # [m/s^2]
HEIGHT = 0.1225  # [m] of the base's origin over a ground its paw stands on, layer included
# Topics of the robot's blocks, their types, their rates [Hz] and frames.
TOPICS = {
    "ankle/wrench": (WrenchStamped, 100, "paw"), "ground_truth/state": (Odometry, 50, "world"), "paw_bumper": (ContactsState, 50, "world"),
    "imu/data": (Imu, 100, "imu_link"), "laser/scan": (LaserScan, 20, "hokuyo_link"),
    "camera/depth/image_rect": (Image, 10, "camera_depth_optical_frame"), "camera/depth/info": (CameraInfo, 10, "camera_depth_optical_frame"),
    "camera/cloud": (PointCloud2, 10, "camera_depth_optical_frame"),
}
BOX = """<robot name="box"><link name="box"><inertial><mass value="1"/>
<inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
<gazebo reference="box"><mu1>0.02</mu1><mu2>0.02</mu2>%s</gazebo></robot>"""
IMU = """<sensor name="box_imu" type="imu"><plugin name="p" filename="libgazebo_ros_imu_sensor.so"><robotNamespace>/boxes</robotNamespace>
<topicName>imu</topicName><frameName>extra_frame</frameName></plugin></sensor>"""


def spawn(name, xml, name_space="", x=0.0, y=0.7, z=HEIGHT):
    return service("spawn_urdf_model", srv.SpawnModel)(name, xml, name_space, Pose(position=Point(x, y, z)), "")


def delete(name):
    return service("delete_model", srv.DeleteModel)(name)


def published():
    return set(topic for topic, _ in rospy.get_published_topics())


class GazeboBlocksTest(unittest.TestCase):
    def setUp(self):
        with open(ROBOT) as stream:
            self.robot = stream.read()
        others = ("ground", "arm_on_base", "cube")
        self.addCleanup(lambda: [delete(name) for name in service("get_world_properties", srv.GetWorldProperties)().model_names if name not in others])

    def listen(self, name_space):
        recorders = {topic: Recorder("/%s/%s" % (name_space, topic), kind) for topic, (kind, _, _) in TOPICS.items()}
        self.addCleanup(lambda: [recorder.stop() for recorder in recorders.values()])
        wait_until(lambda: all(recorder.connected() for recorder in recorders.values()), "topics of " + name_space)
        return recorders

    def test_two_robots_have_sensors_of_their_own(self):
        answer = spawn("first", self.robot, "first", x=-0.6, y=0.6)
        self.assertTrue(answer.success, answer.status_message)
        for words in ("imu_sensor (imu of 'imu_link' on /first/imu/data)", "not read: plugin 'lamp'", "'paw' <glitter>", "<mu2> other than <mu1>",
                      "without effect here: controlPeriod"):
            self.assertEqual(answer.status_message.count(words), 1, words + " in " + answer.status_message)
        report = Recorder("/gazebo/load_report", LoadReport)
        self.addCleanup(report.stop)
        for words in ("not read: plugin 'lamp'", "<mu2> other than <mu1>", "without effect here: controlPeriod"):
            wait_until(lambda: report.messages() and sum(words in note for note in report.messages()[-1].notes) == 1, words + " in ~load_report")
        first = self.listen("first")
        frames = Recorder("/tf_static", TFMessage)
        self.addCleanup(frames.stop)
        sim_client.step(1000)
        for topic, (_, rate, frame) in TOPICS.items():
            messages = first[topic].wait_for(rate)
            self.assertEqual(len(messages), rate, topic)
            self.assertEqual(messages[-1].header.frame_id, frame, topic)
        told = [transform.child_frame_id for message in frames.messages() for transform in message.transforms]
        self.assertFalse(set(told) & {frame for _, _, frame in TOPICS.values()}, "links are on /tf")
        self.check_values({topic: recorder.messages()[-1] for topic, recorder in first.items()})
        self.assertTrue(spawn("second", self.robot, "second", x=-0.6, y=-0.6).success)
        second = self.listen("second")
        self.assertTrue(delete("first").success)
        self.assertFalse([topic for topic in published() if topic.startswith("/first/") and topic[len("/first/"):] in TOPICS])
        for recorder in first.values():
            recorder.clear()
        sim_client.step(1000)
        for topic, (_, rate, frame) in TOPICS.items():
            self.assertEqual(len(second[topic].wait_for(rate)), rate, topic)
            expected = frame if frame == "world" else "second/" + frame
            self.assertEqual(second[topic].messages()[-1].header.frame_id, expected, "a robot of the same links has a prefix")
            self.assertFalse(first[topic].messages(), topic)
        self.assertAlmostEqual(second["ground_truth/state"].messages()[-1].pose.pose.position.y, -0.6, delta=1e-3)

    def check_values(self, last):
        # The paw lifts the base and the mast; the joint's parent feels that.
        self.assertAlmostEqual(last["ankle/wrench"].wrench.force.z, 4.5 * G, delta=0.01)
        self.assertAlmostEqual(sum(state.total_wrench.force.z for state in last["paw_bumper"].states), 5 * G, delta=0.01)
        self.assertAlmostEqual(last["imu/data"].linear_acceleration.z, G, delta=0.01)
        self.assertAlmostEqual(last["imu/data"].angular_velocity_covariance[0], 1e-6)
        truth = last["ground_truth/state"]
        self.assertEqual(truth.child_frame_id, "mast")
        self.assertAlmostEqual(truth.pose.pose.position.x, -0.6, delta=1e-3)
        # Four springs of 1e5 N/m carry it.
        self.assertAlmostEqual(truth.pose.pose.position.z, HEIGHT + 0.05 - 5 * G / 4e5, delta=1e-5)
        self.assertEqual((len(last["laser/scan"].ranges), last["laser/scan"].angle_min), (11, -1))
        self.assertEqual((last["camera/depth/image_rect"].width, last["camera/cloud"].height), (32, 24))

    def test_surface_of_a_single_body(self):
        for name, surface in (("slippery", BOX % ""), ("rough", (BOX % "").replace("0.02", "0.5"))):
            self.assertTrue(spawn(name, surface, x=0.5, z=0.1025).success)
            sim_client.step(20)
            answer = service("set_model_state", srv.SetModelState)
            state = srv.SetModelStateRequest().model_state
            state.model_name, state.pose.position, state.twist.linear.x = name, Point(0.5, 0.7, 0.1025), 0.5
            self.assertTrue(answer(state).success)
            sim_client.step(200)
            moved = service("get_model_state", srv.GetModelState)(name, "").pose.position.x - 0.5
            # v t - mu g t^2 / 2 on ice; v^2 / (2 mu g) where it stops.
            self.assertAlmostEqual(moved, 0.5 * 0.2 - 0.02 * G * 0.02 if name == "slippery" else 0.25 / G, delta=1e-3)
            self.assertTrue(delete(name).success)

    def test_single_body_with_a_sensor_is_a_robot(self):
        answer = spawn("boxed", BOX % IMU, x=0.5, z=0.1025)
        self.assertTrue(answer.success, answer.status_message)
        imu = Recorder("/boxes/imu", Imu)
        self.addCleanup(imu.stop)
        wait_until(imu.connected, "the IMU's topic")
        sim_client.step(10)
        self.assertAlmostEqual(imu.wait_for(10)[-1].linear_acceleration.z, G, delta=0.01)
        self.assertEqual(imu.messages()[-1].header.frame_id, "extra_frame")
        frames = Recorder("/tf_static", TFMessage)
        self.addCleanup(frames.stop)
        mounting = frames.wait_for(1)[0].transforms[-1]
        self.assertEqual((mounting.header.frame_id, mounting.child_frame_id), ("box", "extra_frame"))
        self.assertTrue(delete("boxed").success)
        self.assertNotIn("/boxes/imu", published())

    def test_two_of_one_absolute_topic_are_refused(self):
        self.assertTrue(spawn("boxed", BOX % IMU, x=0.5).success)
        answer = spawn("again", BOX % IMU, x=-0.5)
        self.assertFalse(answer.success)
        self.assertIn("/boxes/imu", answer.status_message)
        self.assertTrue(spawn("again", BOX % IMU, "again", x=-0.5).success, "a name space of its own helps")
        self.assertIn("/again/imu", published())


if __name__ == "__main__":
    rospy.init_node("gazebo_blocks_test", disable_rostime=True)
    rostest.rosrun("blem_sim", "gazebo_blocks", GazeboBlocksTest)
