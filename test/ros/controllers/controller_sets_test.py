#!/usr/bin/python3
"""Several controllers: listed, loaded and switched as a spawner does it, in namespaces, grippers, in lock-step, asked by clients of other packages."""
import math
import os
import sys

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from sensor_msgs.msg import JointState

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import sim_client
from blem_sim.msg import FollowJointTrajectoryAction, GripperCommandAction, GripperCommandGoal, JointTrajectoryControllerState
from blem_sim.srv import ListControllers, LoadController, SwitchController, UnloadController
from controller_client import JOINTS, Controller, ControllerTestCase, action_client, ask, foreign, goal, trajectory
from sim_client import PATIENCE, Recorder, wait_until

STRICT, BEST_EFFORT = 2, 1


def manage(name, service_type, *request, **options):
    service = options.get("robot", "") + "/controller_manager/" + name
    rospy.wait_for_service(service, PATIENCE)
    return rospy.ServiceProxy(service, service_type)(*request)


def states(**options):
    return {c.name: c.state for c in manage("list_controllers", ListControllers, **options).controller}


def switch(start, stop, strictness=STRICT, **options):
    return manage("switch_controller", SwitchController, start, stop, strictness, False, 0.0, **options).ok


class ControllerSetsTest(ControllerTestCase):
    def test_controllers_are_listed_loaded_and_switched(self):
        self.assertEqual(states(), {"arm_controller": "running", "weak_controller": "running", "rival_controller": "initialized"})
        listed = {c.name: c for c in manage("list_controllers", ListControllers).controller}
        self.assertEqual(listed["arm_controller"].type, "effort_controllers/JointTrajectoryController")
        self.assertEqual(list(listed["arm_controller"].claimed_resources[0].resources), JOINTS)
        for name, ok in (("arm_controller", True), ("late_controller", True), ("joint_state_controller", True), ("odd_controller", False),
                         ("no_controller", False), ("bad_controller", False)):
            self.assertEqual(manage("load_controller", LoadController, name).ok, ok, name)
        wait_until(lambda: any("FourWheelSteeringController" in e for e in self.errors()), "a line about the type")

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

    def test_clients_built_against_control_msgs_connect(self):
        types = foreign(FollowJointTrajectoryAction, "control_msgs")
        self.assertEqual(types["FollowJointTrajectoryAction"]._type, "control_msgs/FollowJointTrajectoryAction")
        client = action_client("/arm_controller/follow_joint_trajectory", types["FollowJointTrajectoryAction"])
        message = types["FollowJointTrajectoryGoal"]()
        message.trajectory = trajectory([(0.2, [0.4, -0.4])])
        message.path_tolerance = [types["JointTolerance"](name="swing", position=0.5)]
        handle = ask(client, message)
        sim_client.step(300)
        self.assert_ended(handle, GoalStatus.SUCCEEDED, 0)
        state = foreign(JointTrajectoryControllerState, "control_msgs")["JointTrajectoryControllerState"]
        recorder = Recorder("/arm_controller/state", state)
        wait_until(recorder.connected, "the state")
        sim_client.step(1)
        self.assertAlmostEqual(recorder.wait_for(1)[0].actual.positions[0], 0.4, delta=1e-3)
        recorder.stop()

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

    def test_two_robots_of_one_namespace_do_not_take_each_others_commands(self):
        command = rospy.Publisher("/joint_command", JointState, queue_size=1)
        recorder = Recorder("/joint_states", JointState)
        wait_until(lambda: recorder.connected() and command.get_num_connections(), "the node to listen")
        command.publish(JointState(name=["weak"], position=[0.4]))
        rospy.rostime.wallsleep(sim_client.SETTLE)
        answer = sim_client.step(3000)

        def last():
            return [m.position[m.name.index("weak")] for m in recorder.messages() if m.header.stamp == answer.stamp]
        wait_until(lambda: len(last()) == 2, "the last joint states of both robots")
        recorder.stop()
        command.unregister()
        self.assertAlmostEqual(min(last()), 0, delta=1e-9)
        self.assertGreater(max(last()), 0.1)

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
    rospy.init_node("controller_sets_test")
    rostest.rosrun("blem_sim", "controller_sets", ControllerSetsTest)
