#!/usr/bin/python3
"""Commands that are stamped to a step act in it, whenever they come: same stamps, same hash."""
import os
import sys
import time
import unittest

import rospy
import rostest
from geometry_msgs.msg import Vector3, Wrench
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import JointState
from std_msgs.msg import Header
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from blem_sim.msg import RobotCommand
from blem_sim.srv import ApplyBodyWrench, ApplyJointEffort, StepWithCommands

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import sim_client
from sim_client import Recorder, service, wait_until

MS = 1000000  # [ns]
END = 400  # steps of a run


def stamp(milliseconds):
    return Header(stamp=rospy.Time(0, milliseconds * MS))


def target(milliseconds, **targets):
    return JointState(header=stamp(milliseconds), name=["shoulder"], **{field: [value] for field, value in targets.items()})


def path(milliseconds, positions):
    points = [JointTrajectoryPoint(positions=[position], time_from_start=rospy.Duration(0, 100 * MS * (i + 1))) for i, position in enumerate(positions)]
    return JointTrajectory(header=stamp(milliseconds), joint_names=["shoulder"], points=points)


class StampedCommandsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        kinds = {"/joint_command": JointState, "/joint_trajectory": JointTrajectory, "/joint_trajectory_controller/command": JointTrajectory}
        cls.publishers = {topic: rospy.Publisher(topic, kind, queue_size=10) for topic, kind in kinds.items()}
        wait_until(lambda: all(p.get_num_connections() for p in cls.publishers.values()), "the node to listen")
        cls.call = service("step_with_commands", StepWithCommands)
        cls.log = Recorder("/rosout", Log)
        wait_until(cls.log.connected, "the log")

    def setUp(self):
        service("reset_simulation", sim_client.Empty)()

    def send(self, topic, message):
        self.publishers[topic].publish(message)
        time.sleep(0.2)  # it has come, between two steps

    def run_with(self, sends):
        """Hashes of a run after each 50 steps. @param sends by number of the step before which it is sent"""
        service("reset_simulation", sim_client.Empty)()
        hashes = []
        for step in range(0, END, 50):
            for send in sends.get(step, ()):
                send()
            hashes.append(self.call(50, []).state_hash)
        return hashes

    def shoulder(self):
        return self.call(0, []).robots[0].joints.position[0]

    def test_a_command_acts_in_its_step(self):
        still = [self.call(1, []).state_hash for _ in range(40)]
        service("reset_simulation", sim_client.Empty)()
        self.send("/joint_command", target(25, position=0.3))
        hashes = [self.call(1, []).state_hash for _ in range(40)]
        # 25 steps end at the stamp, and the one that starts there is another.
        self.assertEqual(hashes[:25], still[:25])
        self.assertTrue(all(a != b for a, b in zip(hashes[25:], still[25:])))
        service("reset_simulation", sim_client.Empty)()
        self.call(25, [])
        self.send("/joint_command", target(0, position=0.3))
        self.assertEqual([self.call(1, []).state_hash for _ in range(15)], hashes[25:])

    def test_it_does_not_matter_when_commands_come(self):
        kinds = {
            "positions": lambda: self.send("/joint_command", target(210, position=0.3)),
            "velocities": lambda: self.send("/joint_command", target(210, velocity=0.5)),
            "efforts": lambda: self.send("/joint_command", target(210, effort=1.5)),
            "step_with_commands": lambda: self.call(0, [RobotCommand("arm_on_base", target(210, position=0.3))]),
            "wrench": lambda: service("apply_body_wrench", ApplyBodyWrench)(
                body_name="cube::link", wrench=Wrench(force=Vector3(8, 0, 0)), start_time=rospy.Time(0, 210 * MS), duration=rospy.Duration(0, 20 * MS)),
            "effort": lambda: service("apply_joint_effort", ApplyJointEffort)("shoulder", 2.0, rospy.Time(0, 210 * MS), rospy.Duration(0, 20 * MS)),
        }
        still = self.run_with({})
        for kind, send in kinds.items():
            early, late = self.run_with({0: [send]}), self.run_with({200: [send]})
            self.assertEqual((kind, early[4:]), (kind, late[4:]))
            self.assertNotEqual(late[4:], still[4:], kind)

    def test_trajectories_give_the_same_motion(self):
        """The hash holds since when a path is known, too."""
        def motion(topic, step):
            service("reset_simulation", sim_client.Empty)()
            self.call(step, [])
            self.send(topic, path(210, [0.2, -0.1]))
            return [(seen.robots[0].joints, seen.models) for seen in (self.call(20, []) for _ in range(step, END, 20))][(200 - step) // 20:]

        for topic in ("/joint_trajectory", "/joint_trajectory_controller/command"):
            self.assertEqual(motion(topic, 0), motion(topic, 200), topic)

    def test_in_the_order_of_stamps(self):
        first, second = (lambda: self.send("/joint_command", target(110, position=0.3))), (lambda: self.send("/joint_command", target(120, velocity=0.2)))
        self.assertEqual(self.run_with({0: [first, second]})[3:], self.run_with({0: [second], 50: [first]})[3:])

    def test_stamps_of_the_past_mean_now(self):
        self.call(100, [])
        self.send("/joint_command", target(50, position=0.3))
        self.call(300, [])
        self.assertAlmostEqual(self.shoulder(), 0.3, delta=0.1)

    def test_a_reset_forgets_what_waits(self):
        still = self.run_with({})
        self.send("/joint_command", target(1000, position=0.5))
        self.send("/joint_command", target(500, position=0.5))
        self.assertEqual(self.run_with({}), still)

    def test_stamps_of_another_clock_are_refused(self):
        self.log.clear()
        message = target(0, position=0.3)
        message.header.stamp = rospy.Time(int(time.time()))
        self.send("/joint_command", message)
        wait_until(lambda: [m for m in self.log.messages() if "/joint_command: command refused: header.stamp: lies" in m.msg], "a line on the stamp")
        answer = self.call(10, [RobotCommand("arm_on_base", message)])
        self.assertFalse(answer.success)
        self.assertIn("header.stamp", answer.status_message)

    def test_faulty_ones_are_refused_when_they_come(self):
        self.log.clear()
        self.send("/joint_command", target(200, position=float("nan")))
        wait_until(lambda: [m for m in self.log.messages() if "command refused" in m.msg], "a line")


if __name__ == "__main__":
    rospy.init_node("stamped_commands_test", disable_rostime=True)
    rostest.rosrun("blem_sim", "stamped_commands", StampedCommandsTest)
