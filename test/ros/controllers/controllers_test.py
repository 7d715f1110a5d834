#!/usr/bin/python3
"""Trajectory controllers behave as joint_trajectory_controller does, to an actionlib client and to topics."""
import math
import os
import sys

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from trajectory_msgs.msg import JointTrajectory

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import sim_client
from blem_sim.msg import FollowJointTrajectoryGoal, FollowJointTrajectoryResult, JointTolerance, JointTrajectoryControllerState
from controller_client import JOINTS, Controller, ControllerTestCase, goal, now, trajectory
from sim_client import Recorder, wait_until


class ControllersTest(ControllerTestCase):
    @classmethod
    def setUpClass(cls):
        super(ControllersTest, cls).setUpClass()
        cls.weak = Controller("/weak_controller")

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
        # A client drops feedback that comes after the result, and results have a connection of their own.
        wait_until(lambda: len(self.arm.feedback) >= 45, "feedback of 0.45 s")
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


if __name__ == "__main__":
    rospy.init_node("controllers_test")
    rostest.rosrun("blem_sim", "controllers", ControllersTest)
