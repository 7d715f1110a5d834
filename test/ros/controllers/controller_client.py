"""Clients of controllers, as the rostests of controllers share them."""
import os
import sys
import unittest

import actionlib
import genpy.dynamic
import rospy
from actionlib_msgs.msg import GoalStatus
from rosgraph_msgs.msg import Log
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import sim_client
from blem_sim.msg import FollowJointTrajectoryAction, FollowJointTrajectoryGoal
from blem_sim.srv import QueryTrajectoryState
from sim_client import PATIENCE, Recorder, wait_until

JOINTS = ["swing", "spin"]


def trajectory(points, joints=None, stamp=None):
    """@param points [(time [s], positions)], at rest in each"""
    message = JointTrajectory(joint_names=joints or JOINTS)
    message.header.stamp = stamp or rospy.Time()
    for time, positions in points:
        message.points.append(
            JointTrajectoryPoint(positions=positions, velocities=[0] * len(positions), time_from_start=rospy.Duration.from_sec(time)))
    return message


def goal(points, **options):
    return FollowJointTrajectoryGoal(trajectory=trajectory(points, **options))


def foreign(message_type, package):
    """The type as another package has it that was built from the same layout: {name: class}, of it and of the types in it."""
    own, name = message_type._type.split("/")
    classes = genpy.dynamic.generate_dynamic(package + "/" + name, message_type._full_text.replace(own + "/", package + "/"))
    return {full.split("/")[-1]: made for full, made in classes.items() if full.startswith(package + "/")}


def action_client(name, action_type):
    client = actionlib.ActionClient(name, action_type)
    assert client.wait_for_server(), name
    return client


def ask(client, message, feedback_cb=None):
    """Sends a goal; returns its handle when the server has answered it."""
    handle = client.send_goal(message, feedback_cb=feedback_cb)
    wait_until(lambda: handle.get_goal_status() != GoalStatus.PENDING, "an answer to a goal")
    return handle


class Controller(object):
    """The client's side of a controller."""

    def __init__(self, name):
        self.name = name
        self.command = rospy.Publisher(name + "/command", JointTrajectory, queue_size=10)
        self.action = action_client(name + "/follow_joint_trajectory", FollowJointTrajectoryAction)
        self.feedback = []
        wait_until(lambda: self.command.get_num_connections() > 0, name + " to listen")

    def send(self, message):
        self.command.publish(message)
        rospy.rostime.wallsleep(0.3)

    def ask(self, message):
        """Sends a goal; returns its handle when the server has answered it."""
        return ask(self.action, message, lambda _, feedback: self.feedback.append(feedback))

    def query(self, stamp):
        service = self.name + "/query_state"
        rospy.wait_for_service(service, PATIENCE)
        return rospy.ServiceProxy(service, QueryTrajectoryState)(stamp)

    def desired(self):
        return self.query(sim_client.step(0).stamp)


def now():
    """[s] simulated."""
    return sim_client.step(0).stamp.to_sec()


class ControllerTestCase(unittest.TestCase):
    """Each test starts with the robots at rest where they started."""

    @classmethod
    def setUpClass(cls):
        cls.arm = Controller("/arm_controller")
        cls.log = Recorder("/rosout", Log)
        wait_until(cls.log.connected, "the log")

    def setUp(self):
        sim_client.reset_world()
        sim_client.step(1)

    def errors(self):
        return [m.msg for m in self.log.messages() if m.name == sim_client.NODE and m.level == Log.ERROR]

    def assert_ended(self, handle, status, code=None):
        wait_until(lambda: handle.get_terminal_state() is not None if handle.get_comm_state() == actionlib.CommState.DONE else False,
                   "the end of a goal")
        self.assertEqual(handle.get_terminal_state(), status, handle.get_goal_status_text())
        if code is not None:
            self.assertEqual(handle.get_result().error_code, code, handle.get_result().error_string)
            self.assertNotIn("\n", handle.get_result().error_string)

    def assert_active(self, handle):
        self.assertEqual(handle.get_goal_status(), GoalStatus.ACTIVE)

    def assert_at(self, swing, spin, delta=2e-3):
        desired = self.arm.desired()
        self.assertAlmostEqual(desired.position[0], swing, delta=delta)
        self.assertAlmostEqual(desired.position[1], spin, delta=delta)

    def assert_rejected(self, message, code, *words):
        handle = self.arm.ask(message)
        self.assert_ended(handle, GoalStatus.REJECTED, code)
        for word in words:
            self.assertIn(word, handle.get_result().error_string)
