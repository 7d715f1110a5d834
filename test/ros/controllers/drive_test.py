#!/usr/bin/python3
"""Robots on wheels: cmd_vel in, odometry and /tf out, from a URDF's diff_drive plugin and from the configuration."""
import math
import os
import sys
import unittest

import rospkg
import rospy
import rostest
from geometry_msgs.msg import Point, Pose, Twist
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log
from tf2_msgs.msg import TFMessage

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import sim_client
from blem_sim.srv import DeleteModel, ListControllers, LoadController, SpawnModel, SwitchController, UnloadController
from sim_client import PATIENCE, Recorder, wait_until

NAME = "differential_drive_controller"
ROBOTS = os.path.join(rospkg.RosPack().get_path("blem_sim"), "test", "data", "ros")
ROVER, TRICYCLE = os.path.join(ROBOTS, "rover.urdf"), os.path.join(ROBOTS, "tricycle.urdf")
SPEED, TURN = 0.5, 0.5  # [m/s], [rad/s]
SLEDGE = """<robot name="sledge"><link name="base_link"><inertial><mass value="5"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>
  <collision><geometry><box size="0.4 0.4 0.2"/></geometry></collision></link>
  <gazebo><plugin name="push" filename="libgazebo_ros_planar_move.so"><robotBaseFrame>base_link</robotBaseFrame></plugin></gazebo></robot>"""


def heading(pose):
    return 2 * math.atan2(pose.orientation.z, pose.orientation.w)


def listed(name_space=""):
    service = name_space + "/controller_manager/list_controllers"
    rospy.wait_for_service(service, PATIENCE)
    return {c.name: c for c in rospy.ServiceProxy(service, ListControllers)().controller}


def after_arc(pose, seconds):
    """x, y and heading of a pose after an arc."""
    start, radius = heading(pose), SPEED / TURN
    end = start + TURN * seconds
    return (pose.position.x + radius * (math.sin(end) - math.sin(start)), pose.position.y - radius * (math.cos(end) - math.cos(start)), end)


class DriveTest(unittest.TestCase):
    def setUp(self):
        sim_client.reset_world()
        sim_client.step(1)
        self.log = self.listen("/rosout", Log)

    def listen(self, topic, message_type):
        recorder = Recorder(topic, message_type)
        self.addCleanup(recorder.stop)
        wait_until(recorder.connected, topic)
        return recorder

    def drive(self, topic, linear, angular, lateral=0):
        publisher = rospy.Publisher(topic, Twist, queue_size=1)
        self.addCleanup(publisher.unregister)
        wait_until(lambda: publisher.get_num_connections() > 0, topic)
        twist = Twist()
        twist.linear.x, twist.linear.y, twist.angular.z = linear, lateral, angular
        publisher.publish(twist)
        rospy.rostime.wallsleep(0.3)

    def run_to(self, recorder, steps):
        """The last message, of the last step."""
        recorder.clear()
        stamp = sim_client.step(steps).stamp
        wait_until(lambda: any(m.header.stamp >= stamp - rospy.Duration(0.0199) for m in recorder.messages()), "odometry")
        return recorder.messages()[-1]

    def of_same_time(self, recorder, message):
        """What another topic of the same rate tells."""
        found = lambda: [m for m in recorder.messages() if m.header.stamp == message.header.stamp]
        wait_until(found, recorder.topic)
        return found()[0]

    def assert_arc(self, first, last, delta):
        x, y, turned = after_arc(first.pose.pose, (last.header.stamp - first.header.stamp).to_sec())
        self.assertAlmostEqual(last.pose.pose.position.x, x, delta=delta)
        self.assertAlmostEqual(last.pose.pose.position.y, y, delta=delta)
        self.assertAlmostEqual(math.remainder(heading(last.pose.pose) - turned, 2 * math.pi), 0, delta=delta)

    def test_a_plugin_drives_a_circle_and_tells_of_it(self):
        odometry, truth, tf = self.listen("/odom", Odometry), self.listen("/ground_truth/odom", Odometry), self.listen("/tf", TFMessage)
        self.drive("/cmd_vel", SPEED, TURN)
        first = self.run_to(odometry, 1000)
        tf.clear()
        last = self.run_to(odometry, 3000)
        true_first, true_last = self.of_same_time(truth, first), self.of_same_time(truth, last)
        self.assertEqual((last.header.frame_id, last.child_frame_id), ("odom", "base_link"))
        self.assertEqual(last.pose.covariance[0], 1e-5)
        self.assertAlmostEqual(last.twist.twist.linear.x, SPEED, delta=1e-4)
        self.assertAlmostEqual(last.twist.twist.angular.z, TURN, delta=1e-4)
        self.assert_arc(first, last, 1e-4)
        self.assertAlmostEqual(math.hypot(true_last.pose.pose.position.x - last.pose.pose.position.x,
                                          true_last.pose.pose.position.y - last.pose.pose.position.y), 0, delta=0.02)
        self.assert_arc(true_first, true_last, 0.02)
        parents = {t.child_frame_id: t.header.frame_id for m in tf.messages() for t in m.transforms}
        self.assertEqual(parents.get("base_link"), "odom")
        self.assertEqual([t.header.frame_id for m in tf.messages() for t in m.transforms if t.child_frame_id == "base_link"].count("world"), 0)

    def test_controllers_are_listed(self):
        controllers = listed()
        self.assertEqual(controllers[NAME].type, "diff_drive_controller/DiffDriveController")
        self.assertEqual(controllers[NAME].state, "running")
        self.assertEqual(list(controllers[NAME].claimed_resources[0].resources), ["left_axle", "right_axle"])
        others = controllers["joint_trajectory_controller"]
        self.assertEqual((others.state, list(others.claimed_resources[0].resources)), ("running", ["pan"]))
        self.assertEqual(set(listed("/second")), {NAME})

    def test_a_spawned_robot_is_driven_in_its_namespace_and_goes(self):
        with open(ROVER) as stream:
            spawned = sim_client.service("spawn_urdf_model", SpawnModel)("third", stream.read(), "third", Pose(position=Point(0, -5, 0.1)), "")
        self.assertTrue(spawned.success, spawned.status_message)
        self.assertIn("%s (on /third/cmd_vel)" % NAME, spawned.status_message)
        odometry = self.listen("/third/odom", Odometry)
        self.drive("/third/cmd_vel", SPEED, 0)
        self.assertAlmostEqual(self.run_to(odometry, 1000).pose.pose.position.x, SPEED * (1 - SPEED / 2), delta=0.01)
        self.assertTrue(sim_client.service("delete_model", DeleteModel)("third").success)
        wait_until(lambda: "/third/odom" not in dict(rospy.get_published_topics()), "the end of its topics")
        sim_client.step(1)

    def test_a_spawned_tricycle_steers(self):
        angle, wheelbase = 0.5, 0.5
        with open(TRICYCLE) as stream:
            spawned = sim_client.service("spawn_urdf_model", SpawnModel)("trike", stream.read(), "trike", Pose(position=Point(0, -5, 0.1)), "")
        self.assertTrue(spawned.success, spawned.status_message)
        self.assertIn("tricycle_drive_controller (on /trike/cmd_vel)", spawned.status_message)
        drive = listed("/trike")["tricycle_drive_controller"]
        self.assertEqual((drive.type, drive.state), ("ackermann_steering_controller/AckermannSteeringController", "running"))
        self.assertEqual(list(drive.claimed_resources[0].resources), ["left_axle", "right_axle", "front_steer", "front_axle"])
        manager = "/trike/controller_manager/"
        self.assertTrue(rospy.ServiceProxy(manager + "load_controller", LoadController)("ackermann").ok)
        for stopping, name_space, side in ((None, "", 1), ("tricycle_drive_controller", "/ackermann", -1)):
            if stopping:
                self.assertTrue(rospy.ServiceProxy(manager + "switch_controller", SwitchController)(["ackermann"], [stopping], 2, False, 0).ok)
            odometry = self.listen("/trike" + name_space + "/odom", Odometry)
            self.drive("/trike" + name_space + "/cmd_vel", SPEED, side * angle)
            twist = self.run_to(odometry, 2000).twist.twist
            self.assertAlmostEqual(twist.linear.x, SPEED * math.cos(angle), delta=0.01 * SPEED)
            self.assertAlmostEqual(twist.angular.z, side * SPEED * math.sin(angle) / wheelbase, delta=0.01)
        self.assertTrue(sim_client.service("delete_model", DeleteModel)("trike").success)
        sim_client.step(1)

    def test_a_spawned_box_is_pushed_as_by_planar_move(self):
        spawned = sim_client.service("spawn_urdf_model", SpawnModel)("sledge", SLEDGE, "sledge", Pose(position=Point(0, 9, 0.1026)), "")
        self.assertTrue(spawned.success, spawned.status_message)
        self.assertIn("push (on /sledge/cmd_vel)", spawned.status_message)
        controllers = listed("/sledge")
        self.assertEqual({name: (c.type, c.state) for name, c in controllers.items()}, {"push": ("blem_sim/PlanarDrive", "running")})
        odometry = self.listen("/sledge/odom", Odometry)
        self.drive("/sledge/cmd_vel", 0.3, 0, 0.2)
        first, last = self.run_to(odometry, 500), self.run_to(odometry, 1000)
        seconds = (last.header.stamp - first.header.stamp).to_sec()
        self.assertAlmostEqual(last.pose.pose.position.x - first.pose.pose.position.x, 0.3 * seconds, delta=1e-5)
        self.assertAlmostEqual(last.pose.pose.position.y - first.pose.pose.position.y, 0.2 * seconds, delta=1e-5)
        self.assertAlmostEqual(last.twist.twist.linear.y, 0.2, delta=1e-4)
        self.assertTrue(sim_client.service("delete_model", DeleteModel)("sledge").success)
        sim_client.step(1)

    def test_odometry_and_frames_are_told_during_a_pause(self):
        late, tf = self.listen("/odom", Odometry), self.listen("/tf", TFMessage)
        late.wait_for(1)
        wait_until(lambda: any(t.child_frame_id == "base_link" for m in tf.messages() for t in m.transforms), "the frame of the base")

    def parents_of(self, frame, tf):
        """Parents that a frame has in steps to come."""
        tf.clear()
        sim_client.step(100)
        wait_until(lambda: any(t.child_frame_id == frame for m in tf.messages() for t in m.transforms), frame)
        rospy.rostime.wallsleep(sim_client.SETTLE)
        return {t.header.frame_id for m in tf.messages() for t in m.transforms if t.child_frame_id == frame}

    def test_a_frame_has_one_parent_whatever_drive_runs(self):
        tf, manager = self.listen("/tf", TFMessage), "/second/controller_manager/"
        switch = rospy.ServiceProxy(manager + "switch_controller", SwitchController)
        self.assertEqual(self.parents_of("second/base_link", tf), {"world"})
        self.assertTrue(rospy.ServiceProxy(manager + "load_controller", LoadController)("loaded").ok)
        self.assertTrue(switch(["loaded"], [NAME], 2, False, 0).ok)
        self.assertEqual(self.parents_of("second/base_link", tf), {"second/odom"})
        self.assertTrue(switch([NAME], ["loaded"], 2, False, 0).ok)
        self.assertEqual(self.parents_of("second/base_link", tf), {"world"})
        self.assertTrue(rospy.ServiceProxy(manager + "unload_controller", UnloadController)("loaded").ok)

    def test_limits_of_the_parameter_server_hold(self):
        manager = "/second/controller_manager/"
        switch = rospy.ServiceProxy(manager + "switch_controller", SwitchController)
        self.assertTrue(rospy.ServiceProxy(manager + "load_controller", LoadController)("limited").ok)
        self.assertTrue(switch(["limited"], [NAME], 2, False, 0).ok)
        odometry = self.listen("/second/limited/odom", Odometry)
        self.drive("/second/limited/cmd_vel", SPEED, 0)
        self.assertAlmostEqual(self.run_to(odometry, 400).twist.twist.linear.x, 0.2, delta=0.011)
        self.assertAlmostEqual(self.run_to(odometry, 400).twist.twist.linear.x, 0.3, delta=1e-3)
        self.assertTrue(switch([NAME], ["limited"], 2, False, 0).ok)
        self.assertTrue(rospy.ServiceProxy(manager + "unload_controller", UnloadController)("limited").ok)

    def test_no_stamp_comes_twice_after_resets_at_the_beginning(self):
        tf = self.listen("/tf", TFMessage)
        sim_client.reset_simulation()
        sim_client.step(0)
        rospy.rostime.wallsleep(sim_client.SETTLE)
        tf.clear()
        for _ in range(2):
            sim_client.reset_simulation()
        sim_client.step(50)
        wait_until(lambda: any(t.header.stamp.to_sec() > 0 for m in tf.messages() for t in m.transforms), "a step's frames")
        self.assertEqual([t for m in tf.messages() for t in m.transforms if t.header.stamp.to_sec() == 0], [])

    def test_a_faulty_twist_changes_nothing_and_is_told(self):
        odometry = self.listen("/odom", Odometry)
        self.drive("/cmd_vel", SPEED, 0)
        self.drive("/cmd_vel", math.nan, 0)
        last = self.run_to(odometry, 1000)
        self.assertAlmostEqual(last.twist.twist.linear.x, SPEED, delta=1e-4)
        wait_until(lambda: any("/cmd_vel" in m.msg and "linear.x" in m.msg for m in self.log.messages()), "a line about the twist")

    def test_the_configurations_drive_stops_when_commands_end(self):
        odometry = self.listen("/second/%s/odom" % NAME, Odometry)
        self.drive("/second/%s/cmd_vel" % NAME, SPEED, 0)
        moving = self.run_to(odometry, 500)
        self.assertAlmostEqual(moving.pose.pose.position.y, 5, delta=1e-3)
        self.assertAlmostEqual(moving.twist.twist.linear.x, SPEED, delta=0.02)
        still = self.run_to(odometry, 1000)
        self.assertAlmostEqual(still.twist.twist.linear.x, 0, delta=1e-4)
        self.assertAlmostEqual(still.pose.pose.position.x, SPEED ** 2, delta=0.02)


if __name__ == "__main__":
    rospy.init_node("drive_test")
    rostest.rosrun("blem_sim", "drive_test", DriveTest)
