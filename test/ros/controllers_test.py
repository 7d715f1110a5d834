#!/usr/bin/python3
"""Trajectory controllers behave as joint_trajectory_controller does, to an actionlib client, to topics and to a spawner."""
import math
import unittest

import actionlib
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

import sim_client
from blem_sim.msg import FollowJointTrajectoryAction, FollowJointTrajectoryGoal, FollowJointTrajectoryResult
from blem_sim.msg import GripperCommandAction, GripperCommandGoal, JointTolerance, JointTrajectoryControllerState
from blem_sim.srv import ListControllers, LoadController, QueryTrajectoryState, SwitchController, UnloadController
from sim_client import PATIENCE, Recorder, wait_until

JOINTS = ["swing", "spin"]
STRICT, BEST_EFFORT = 2, 1


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


def manage(name, service_type, *request, **options):
    service = options.get("robot", "") + "/controller_manager/" + name
    rospy.wait_for_service(service, PATIENCE)
    return rospy.ServiceProxy(service, service_type)(*request)


def states(**options):
    return {c.name: c.state for c in manage("list_controllers", ListControllers, **options).controller}


def switch(start, stop, strictness=STRICT, **options):
    return manage("switch_controller", SwitchController, start, stop, strictness, False, 0.0, **options).ok


class ControllersTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.arm, cls.weak = Controller("/arm_controller"), Controller("/weak_controller")
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

    def test_state_and_query_agree(self):
        recorder = Recorder("/arm_controller/state", JointTrajectoryControllerState)
        wait_until(recorder.connected, "the state")
        self.arm.send(trajectory([(0.5, [0.4, -0.3])]))
        answer = sim_client.step(200)
        wait_until(lambda: any(m.header.stamp == answer.stamp for m in recorder.messages()), "the last state")
        self.assertEqual(len([m for m in recorder.messages() if m.header.stamp > answer.stamp - rospy.Duration(0.1995)]), 200)
        for message in recorder.messages()[-200::50] + recorder.messages()[-1:]:
            self.assertEqual(message.joint_names, JOINTS)
            if message.header.stamp < answer.stamp - rospy.Duration(0.1975):
                continue
            queried = self.arm.query(message.header.stamp)
            self.assertEqual(list(queried.name), JOINTS)
            for i in range(2):
                self.assertAlmostEqual(queried.position[i], message.desired.positions[i], delta=1e-9)
                self.assertAlmostEqual(queried.velocity[i], message.desired.velocities[i], delta=1e-9)
                self.assertAlmostEqual(queried.acceleration[i], message.desired.accelerations[i], delta=1e-7)
                self.assertAlmostEqual(message.desired.positions[i] - message.actual.positions[i], message.error.positions[i], delta=1e-12)
        recorder.stop()
        self.assertRaises(rospy.ServiceException, self.arm.query, rospy.Time())

    def test_topic_follows_a_trajectory_of_joints_in_any_order(self):
        self.arm.send(trajectory([(0.25, [0.1, -0.1]), (0.5, [0.5, -0.3])]))
        sim_client.step(600)
        self.assert_at(0.5, -0.3)
        self.arm.send(trajectory([(0.5, [0.2, 0.1])], joints=["spin", "swing"]))
        sim_client.step(600)
        self.assert_at(0.1, 0.2)

    def test_goal_succeeds_with_feedback(self):
        self.arm.feedback = []
        handle = self.arm.ask(goal([(0.5, [0.5, -0.3])]))
        self.assert_active(handle)
        sim_client.step(450)
        self.assert_active(handle)
        sim_client.step(100)
        self.assert_ended(handle, GoalStatus.SUCCEEDED, FollowJointTrajectoryResult.SUCCESSFUL)
        self.assert_at(0.5, -0.3)
        self.assertTrue(45 <= len(self.arm.feedback) <= 52, len(self.arm.feedback))
        self.assertEqual(self.arm.feedback[-1].joint_names, JOINTS)

    def test_invalid_goals_are_rejected(self):
        self.assert_rejected(goal([(1, [0.1])], joints=["swing"]), -2, "'spin'", "allow_partial_joints_goal")
        self.assert_rejected(goal([(1, [0.1, 0.1])], joints=["swing", "bad"]), -2, "'bad'")
        self.assert_rejected(goal([(1, [0.1, 0.1])], joints=["swing", "swing"]), -2)
        self.assert_rejected(FollowJointTrajectoryGoal(), -2)
        self.assert_rejected(goal([(1, [0.1, 0.1]), (0.5, [0.2, 0.2])]), -1, "points[1].time_from_start")
        self.assert_rejected(goal([(1, [0.1])]), -1, "points[0].positions")
        self.assert_rejected(goal([(1, [math.nan, 0])]), -1, "'swing'")
        sim_client.step(100)
        self.assert_at(0, 0)

    def test_invalid_topics_are_refused_and_the_goal_goes_on(self):
        handle = self.arm.ask(goal([(0.3, [0.3, 0.3])]))
        before = len(self.errors())
        for message in (trajectory([(1, [0.1])], joints=["swing"]), trajectory([(1, [0.1, 0.1]), (1, [0.2, 0.2])]),
                        trajectory([(1, [0.1, math.inf])])):
            self.arm.send(message)
        wait_until(lambda: len(self.errors()) >= before + 3, "three error lines")
        sim_client.step(400)
        self.assert_ended(handle, GoalStatus.SUCCEEDED)

    def test_old_points(self):
        sim_client.step(500)
        stamp = rospy.Time.from_sec(now() - 0.3)
        self.assert_rejected(goal([(0.1, [1, 1]), (0.2, [1, 1])], stamp=stamp), -1, "before the next step")
        self.assert_rejected(goal([(0.1, [1, 1])], stamp=stamp), -1)
        self.arm.send(trajectory([(0.1, [1, 1]), (0.3, [1, 1])], stamp=stamp))
        sim_client.step(100)
        self.assert_at(0, 0)
        handle = self.arm.ask(goal([(0.1, [2, 2]), (0.8, [0.2, 0.1])], stamp=stamp))
        self.assert_active(handle)
        sim_client.step(450)
        self.assert_ended(handle, GoalStatus.SUCCEEDED)
        self.assert_at(0.2, 0.1)

    def test_goals_and_topics_replace_each_other(self):
        first = self.arm.ask(goal([(1, [1, 1])]))
        sim_client.step(100)
        second = self.arm.ask(goal([(1, [-1, -1])]))
        self.assert_ended(first, GoalStatus.PREEMPTED)
        sim_client.step(100)
        self.assert_active(second)
        self.arm.send(trajectory([(0.2, [0.1, 0.2])]))
        self.assert_ended(second, GoalStatus.PREEMPTED)
        sim_client.step(100)
        third = self.arm.ask(goal([(0.2, [0.4, 0.5])]))
        sim_client.step(300)
        self.assert_ended(third, GoalStatus.SUCCEEDED)
        self.assert_at(0.4, 0.5)
        fourth = self.arm.ask(goal([(1, [1, 1])]))
        plain = rospy.Publisher("/joint_trajectory", JointTrajectory, queue_size=1)
        wait_until(lambda: plain.get_num_connections() > 0, "the plain topic")
        plain.publish(trajectory([(0.2, [0.1])], joints=["swing"]))
        rospy.rostime.wallsleep(0.3)
        sim_client.step(1)
        self.assert_ended(fourth, GoalStatus.PREEMPTED)

    def test_a_goal_ahead_preempts_and_waits(self):
        first = self.arm.ask(goal([(0.6, [0.6, 0.6])]))
        ahead = self.arm.ask(goal([(0.3, [0, 0])], stamp=rospy.Time.from_sec(now() + 1)))
        self.assert_ended(first, GoalStatus.PREEMPTED)
        sim_client.step(900)
        self.assert_active(ahead)
        self.assert_at(0.6, 0.6)
        sim_client.step(500)
        self.assert_ended(ahead, GoalStatus.SUCCEEDED)
        self.assert_at(0, 0)

    def test_cancel_and_empty_trajectories_stop(self):
        handle = self.arm.ask(goal([(1, [1, 1])]))
        sim_client.step(400)
        handle.cancel()
        self.assert_ended(handle, GoalStatus.PREEMPTED)
        held = self.arm.desired().position
        sim_client.step(300)
        self.assert_at(held[0], held[1])
        self.assertTrue(0.1 < held[0] < 0.6, held)
        self.arm.send(trajectory([(1, [1, 1])]))
        sim_client.step(300)
        self.arm.send(JointTrajectory())
        self.assertEqual(self.arm.desired().velocity[0], 0)
        empty = self.arm.ask(FollowJointTrajectoryGoal(trajectory=JointTrajectory(joint_names=JOINTS)))
        sim_client.step(2)
        self.assert_ended(empty, GoalStatus.SUCCEEDED)

    def test_reset_ends_a_goal(self):
        handle = self.arm.ask(goal([(1, [1, 1])]))
        sim_client.step(100)
        sim_client.reset_world()
        sim_client.step(1)
        self.assert_ended(handle, GoalStatus.PREEMPTED)

    def test_path_tolerance_of_all_and_of_one_joint(self):
        for tolerances in ([JointTolerance(name=name, position=1e-6) for name in JOINTS], [JointTolerance(name="spin", position=1e-6)]):
            sim_client.reset_world()
            message = goal([(0.2, [0.5, 0.5])])
            message.path_tolerance = tolerances
            handle = self.arm.ask(message)
            sim_client.step(100)
            self.assert_ended(handle, GoalStatus.ABORTED, FollowJointTrajectoryResult.PATH_TOLERANCE_VIOLATED)
            sim_client.step(200)
            self.assert_at(0.5, 0.5)

    def test_goal_tolerances(self):
        reach = goal([(0.1, [1])], joints=["weak"])
        handle = self.weak.ask(reach)
        sim_client.step(150)
        self.assert_ended(handle, GoalStatus.ABORTED, FollowJointTrajectoryResult.GOAL_TOLERANCE_VIOLATED)
        self.assertIn("'weak'", handle.get_result().error_string)
        sim_client.reset_world()
        reach.goal_time_tolerance = rospy.Duration(10)
        handle = self.weak.ask(reach)
        sim_client.step(150)
        self.assert_active(handle)
        sim_client.step(5000)
        self.assert_ended(handle, GoalStatus.SUCCEEDED)
        sim_client.reset_world()
        reach.goal_time_tolerance = rospy.Duration(0)
        reach.goal_tolerance = [JointTolerance(name="weak", position=-1, velocity=-1)]
        handle = self.weak.ask(reach)
        sim_client.step(150)
        self.assert_ended(handle, GoalStatus.SUCCEEDED)

    def test_wrap_around_and_half_a_turn(self):
        for target, expected in ((-math.pi / 2, -math.pi / 2), (math.pi / 2, math.pi / 2), (-math.pi / 2 - 0.02, 1.5 * math.pi - 0.02),
                                 (2 * math.pi, 2 * math.pi)):
            handle = self.arm.ask(goal([(0.4, [0, target])]))
            sim_client.step(500)
            self.assert_ended(handle, GoalStatus.SUCCEEDED)
            self.assert_at(0, expected)

    def test_controllers_are_listed_loaded_and_switched(self):
        self.assertEqual(states(), {"arm_controller": "running", "weak_controller": "running", "rival_controller": "initialized"})
        listed = {c.name: c for c in manage("list_controllers", ListControllers).controller}
        self.assertEqual(listed["arm_controller"].type, "effort_controllers/JointTrajectoryController")
        self.assertEqual(list(listed["arm_controller"].claimed_resources[0].resources), JOINTS)
        for name, ok in (("arm_controller", True), ("late_controller", True), ("joint_state_controller", True), ("odd_controller", False),
                         ("no_controller", False)):
            self.assertEqual(manage("load_controller", LoadController, name).ok, ok, name)
        wait_until(lambda: any("DiffDriveController" in e for e in self.errors()), "a line about the type")

        self.assertTrue(switch(["arm_controller", "joint_state_controller"], []), "what runs may be started")
        self.assertFalse(switch(["rival_controller"], []))
        self.assertFalse(switch(["rival_controller"], ["arm_controller", "weak_controller", "none"]))
        self.assertEqual(states()["arm_controller"], "running", "a strict change is whole or not at all")
        handle = self.arm.ask(goal([(1, [1, 1])]))
        sim_client.step(100)
        self.assertTrue(switch(["rival_controller"], ["arm_controller", "weak_controller"]))
        self.assert_ended(handle, GoalStatus.PREEMPTED)
        self.assert_rejected(goal([(1, [1, 1])]), -1, "stopped")
        self.assertFalse(manage("unload_controller", UnloadController, "rival_controller").ok)
        self.assertTrue(switch(["arm_controller", "late_controller"], ["rival_controller", "none"], BEST_EFFORT))
        self.assertEqual(states()["late_controller"], "running")
        self.assertTrue(switch(["weak_controller"], ["late_controller"]))
        self.assertTrue(manage("unload_controller", UnloadController, "late_controller").ok)
        self.assertNotIn("late_controller", states())

    def test_a_gripper_in_a_namespace_of_its_own(self):
        self.assertEqual(states(robot="/left"), {"joint_trajectory_controller": "running"})
        default = Controller("/left/joint_trajectory_controller")
        self.assertEqual(default.desired().name, ["swing", "spin", "weak"])
        default.send(trajectory([(0.2, [0.3, 0.3, 0.3])], joints=["swing", "spin", "weak"]))
        sim_client.step(300)
        self.assertAlmostEqual(default.desired().position[0], 0.3, delta=1e-9)
        self.assert_at(0, 0)

        self.assertTrue(manage("load_controller", LoadController, "gripper_controller", robot="/left").ok)
        self.assertTrue(switch(["gripper_controller"], [], robot="/left"), "the controller of all joints gives way")
        self.assertEqual(states(robot="/left"), {"joint_trajectory_controller": "stopped", "gripper_controller": "running"})
        client = action_client("/left/gripper_controller/gripper_cmd", GripperCommandAction)
        command = GripperCommandGoal()
        command.command.position = 0.6
        handle = ask(client, command)
        sim_client.step(1000)
        self.assert_ended(handle, GoalStatus.SUCCEEDED)
        self.assertTrue(handle.get_result().reached_goal)
        self.assertAlmostEqual(handle.get_result().position, 0.6, delta=0.011)
        command.command.position = 3.1
        handle = ask(client, command)
        sim_client.step(5000)
        self.assert_ended(handle, GoalStatus.ABORTED)
        self.assertTrue(handle.get_result().stalled)
        self.assertAlmostEqual(handle.get_result().position, 3, delta=1e-3)
        command.command.position = math.nan
        self.assert_ended(ask(client, command), GoalStatus.REJECTED)

    def test_two_robots_of_one_namespace_do_not_share_controllers(self):
        recorder = Recorder("/joint_states", JointState)
        wait_until(recorder.connected, "the joint states")
        self.arm.send(trajectory([(0.2, [0.5, 0.5])]))
        answer = sim_client.step(300)

        def last():
            return sorted(m.position[m.name.index("swing")] for m in recorder.messages() if m.header.stamp == answer.stamp)
        wait_until(lambda: len(last()) == 2, "the last joint states of both robots")
        recorder.stop()
        self.assertAlmostEqual(last()[0], 0, delta=1e-9)
        self.assertAlmostEqual(last()[1], 0.5, delta=1e-3)

    def test_lock_step_gives_the_same_motion(self):
        def run():
            sim_client.reset_simulation()
            recorder = Recorder("/arm_controller/state", JointTrajectoryControllerState)
            wait_until(recorder.connected, "the state")
            sim_client.step(1)
            self.arm.ask(goal([(0.2, [0.5, -0.5]), (0.4, [0.1, 0.1])]))
            sim_client.step(100)
            handle = self.arm.ask(goal([(0.3, [-0.5, 0.5])]))
            sim_client.step(100)
            handle.cancel()
            self.assert_ended(handle, GoalStatus.PREEMPTED)
            sim_client.step(50)
            wait_until(lambda: recorder.messages()[-1].header.stamp.to_sec() > 0.2505, "the last state")
            recorder.stop()
            return [(m.header.stamp, m.desired, m.actual) for m in recorder.messages() if m.header.stamp.to_sec() > 0.0015]

        first, second = run(), run()
        self.assertEqual(len(first), 250)
        self.assertTrue(first == second, "the same bits")


if __name__ == "__main__":
    rospy.init_node("controllers_test")
    rostest.rosrun("blem_sim", "controllers", ControllersTest)
