#!/usr/bin/python3
"""Topics and goals that take over from each other, stop each other, come too late, or carry feed-forward: a test for each case that
joint_trajectory_controller has one for and controllers_test has not."""
import os
import sys

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import sim_client
from blem_sim.msg import FollowJointTrajectoryGoal, JointTrajectoryControllerState
from controller_client import JOINTS, Controller, ControllerTestCase, goal, now, trajectory
from sim_client import Recorder, wait_until

TOPIC, ACTION = "topic", "action"


class ReplacementsTest(ControllerTestCase):
    def start(self, way, points):
        """Sends a trajectory; returns the goal's handle, None for a topic."""
        if way == TOPIC:
            self.arm.send(trajectory(points))
            return None
        handle = self.arm.ask(goal(points))
        self.assert_active(handle)
        return handle

    def assert_preempted(self, handle):
        if handle:
            self.assert_ended(handle, GoalStatus.PREEMPTED)

    def assert_succeeded(self, handle):
        if handle:
            self.assert_ended(handle, GoalStatus.SUCCEEDED)

    def assert_replaces(self, second_way, first_way):
        first = self.start(first_way, [(1, [1, 1])])
        sim_client.step(400)
        before = self.arm.desired()
        second = self.start(second_way, [(0.5, [-0.4, -0.2])])
        sim_client.step(1)
        self.assert_preempted(first)
        for i in range(2):
            self.assertAlmostEqual(self.arm.desired().position[i], before.position[i], delta=2e-3 * before.velocity[i])
        sim_client.step(550)
        self.assert_succeeded(second)
        self.assert_at(-0.4, -0.2)

    def test_topic_replaces_topic(self):
        self.assert_replaces(TOPIC, TOPIC)

    def test_topic_replaces_action(self):
        self.assert_replaces(TOPIC, ACTION)

    def test_action_replaces_topic(self):
        self.assert_replaces(ACTION, TOPIC)

    def test_action_replaces_action(self):
        self.assert_replaces(ACTION, ACTION)

    def assert_stops(self, empty_way, moving_way):
        moving = self.start(moving_way, [(1, [1, 0.5])])
        sim_client.step(400)
        self.assertGreater(self.arm.desired().velocity[0], 0.5)
        empty = None
        if empty_way == TOPIC:
            self.arm.send(JointTrajectory())
        else:
            empty = self.arm.ask(FollowJointTrajectoryGoal(trajectory=JointTrajectory(joint_names=JOINTS)))
        sim_client.step(2)
        self.assert_preempted(moving)
        self.assert_succeeded(empty)
        held = self.arm.desired()
        self.assertEqual(list(held.velocity), [0, 0])
        self.assertTrue(0.2 < held.position[0] < 0.6, held)
        sim_client.step(700)
        self.assert_at(held.position[0], held.position[1], delta=1e-12)

    def test_empty_topic_stops_topic(self):
        self.assert_stops(TOPIC, TOPIC)

    def test_empty_topic_stops_action(self):
        self.assert_stops(TOPIC, ACTION)

    def test_empty_action_stops_topic(self):
        self.assert_stops(ACTION, TOPIC)

    def test_empty_action_stops_action(self):
        self.assert_stops(ACTION, ACTION)

    def start_then_wait(self, way):
        """A trajectory to 0.5 in half a second, of which 0.3 s are over. Returns its handle and a stamp at its start."""
        handle, stamp = self.start(way, [(0.5, [0.5, 0.5])]), rospy.Time.from_sec(now())
        sim_client.step(300)
        return handle, stamp

    def assert_old_is_ignored(self, way, points):
        handle, stamp = self.start_then_wait(way)
        self.arm.send(trajectory(points, stamp=stamp))
        sim_client.step(300)
        self.assert_succeeded(handle)
        self.assert_at(0.5, 0.5)

    def test_old_topic_is_ignored(self):
        self.assert_old_is_ignored(TOPIC, [(0.1, [1, 1]), (0.25, [2, 2])])

    def test_single_old_topic_is_ignored(self):
        self.assert_old_is_ignored(TOPIC, [(0.2, [1, 1])])

    def test_old_topic_leaves_a_goal_alone(self):
        self.assert_old_is_ignored(ACTION, [(0.1, [1, 1]), (0.25, [2, 2])])

    def test_old_points_of_a_topic_are_dropped(self):
        handle, stamp = self.start_then_wait(ACTION)
        self.arm.send(trajectory([(0.1, [3, 3]), (0.9, [0.1, 0.2])], stamp=stamp))
        sim_client.step(1)
        self.assert_preempted(handle)
        self.assertLess(self.arm.desired().position[0], 0.5)
        sim_client.step(650)
        self.assert_at(0.1, 0.2)

    def test_old_goal_is_rejected_and_the_motion_goes_on(self):
        for way in (TOPIC, ACTION):
            sim_client.reset_world()
            handle, stamp = self.start_then_wait(way)
            self.assert_rejected(goal([(0.1, [1, 1]), (0.25, [2, 2])], stamp=stamp), -1)
            sim_client.step(300)
            self.assert_succeeded(handle)
            self.assert_at(0.5, 0.5)

    def test_partly_old_goal_is_done_from_now_on(self):
        handle, stamp = self.start_then_wait(TOPIC)
        handle = self.arm.ask(goal([(0.1, [3, 3]), (0.9, [0.1, 0.2])], stamp=stamp))
        sim_client.step(650)
        self.assert_succeeded(handle)
        self.assert_at(0.1, 0.2)

    # The weak joint has 2 N m/rad and 1 N m s/rad, and nothing holds it back.
    def weak_state_after(self, point, steps):
        """State of the weak controller after so many steps towards a point."""
        weak = Controller("/weak_controller")
        states = Recorder("/weak_controller/state", JointTrajectoryControllerState)
        wait_until(states.connected, "the state")
        message = JointTrajectory(joint_names=["weak"], points=[point])
        weak.send(message)
        answer = sim_client.step(steps)
        wait_until(lambda: any(m.header.stamp >= answer.stamp - rospy.Duration(0.03) for m in states.messages()), "the last state")
        states.stop()
        return states.messages()[-1]

    def test_velocity_feed_forward(self):
        # Without it the joint would be late by d v / p = 0.1 rad.
        state = self.weak_state_after(JointTrajectoryPoint(positions=[1.2], velocities=[0.2], time_from_start=rospy.Duration(6)), 5000)
        self.assertGreater(state.desired.velocities[0], 0.1)
        self.assertAlmostEqual(state.error.positions[0], 0, delta=0.02)

    def test_effort_feed_forward(self):
        point = JointTrajectoryPoint(positions=[0], velocities=[0], effort=[0.2], time_from_start=rospy.Duration(6))
        state = self.weak_state_after(point, 6000)
        self.assertAlmostEqual(state.actual.positions[0], 0.2 / 2, delta=0.02)


if __name__ == "__main__":
    rospy.init_node("replacements_test")
    rostest.rosrun("blem_sim", "replacements", ReplacementsTest)
