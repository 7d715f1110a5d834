#!/usr/bin/python3
"""One call per decision: joint commands go in, steps are made, and what is then known comes back."""
import os
import sys
import unittest

import rospy
import rostest
from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import Imu, JointState

from blem_sim.msg import RobotCommand, StepReport
from blem_sim.srv import DeleteModel, StepWithCommands

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import sim_client
from sim_client import Recorder, service

SENSORS = {"wrist_wrench": 6, "imu": 10, "base_contact": 7, "tilt": 9, "motors": 2}


def command(robot="", **positions):
    return RobotCommand(robot, JointState(name=sorted(positions), position=[positions[name] for name in sorted(positions)]))


class StepWithCommandsTest(unittest.TestCase):
    def setUp(self):
        self.call = service("step_with_commands", StepWithCommands)
        sim_client.pause()
        service("reset_simulation", sim_client.Empty)()

    def test_observation(self):
        answer = self.call(500, [command(shoulder=0.3)])
        self.assertTrue(answer.success, answer.status_message)
        self.assertEqual(answer.step, 500)
        self.assertEqual(answer.stamp, rospy.Time(0, 500000000))
        self.assertNotEqual(answer.state_hash, 0)
        self.assertEqual(len(answer.status_names), bin(answer.status).count("1"))
        robot = answer.robots[0]
        self.assertEqual((robot.robot, robot.joints.name, robot.joints.header.stamp), ("arm_on_base", ["shoulder"], answer.stamp))
        self.assertAlmostEqual(robot.joints.position[0], 0.3, delta=0.1)
        self.assertEqual({sensor.sensor: len(sensor.values) for sensor in robot.sensors}, SENSORS)
        for sensor in robot.sensors:
            self.assertEqual(len(sensor.fields), len(sensor.values), sensor.sensor)
            self.assertGreater(sensor.stamp, rospy.Time(0, 440000000), sensor.sensor)
        self.assertEqual(set(answer.models.name), {"ground", "arm_on_base", "cube"})
        self.assertAlmostEqual(answer.models.pose[answer.models.name.index("cube")].position.x, 0.6, delta=1e-3)

    def test_status_of_the_steps(self):
        self.assertNotIn("JOINT_LIMIT_HIT", self.call(10, []).status_names)
        answer = self.call(1500, [command(shoulder=1.6)])
        self.assertIn("JOINT_LIMIT_HIT", answer.status_names)
        self.assertTrue(answer.status & StepReport.JOINT_LIMIT_HIT)

    def test_a_reading_stays_until_the_next_one(self):
        before = {sensor.sensor: sensor for sensor in self.call(100, []).robots[0].sensors}
        after = {sensor.sensor: sensor for sensor in self.call(1, []).robots[0].sensors}
        self.assertEqual(after["tilt"], before["tilt"])
        self.assertGreater(after["wrist_wrench"].stamp, before["wrist_wrench"].stamp)

    def test_equal_commands_give_equal_hashes(self):
        def run():
            service("reset_simulation", sim_client.Empty)()
            return [self.call(20, [command("arm_on_base", shoulder=0.02 * i)]).state_hash for i in range(20)]

        first = run()
        self.assertEqual(len(set(first)), 20)
        self.assertEqual(run(), first)
        # The same in every run of this test, on busy machines too.
        print("state hash of 400 steps: %016x" % first[-1])

    def test_every_report_has_the_hash(self):
        reports = Recorder("/blem_sim/step_report", StepReport)
        sim_client.wait_until(reports.connected, "the report's publisher")
        answers = [self.call(10, []) for _ in range(5)]
        sim_client.wait_until(lambda: reports.messages() and reports.messages()[-1].step == answers[-1].step, "the last report")
        hashes = {report.step: report.state_hash for report in reports.messages()}
        for answer in answers:
            self.assertEqual(hashes[answer.step], answer.state_hash)
        reports.stop()

    def test_messages_of_the_steps_are_out(self):
        imu, wrench = Recorder("/imu", Imu), Recorder("/wrist_wrench", WrenchStamped)
        sim_client.wait_until(lambda: imu.connected() and wrench.connected(), "publishers")
        self.call(100, [])
        self.assertEqual(imu.wait_for(20)[-1].header.stamp, rospy.Time(0, 100000000))
        self.assertEqual(wrench.wait_for(100)[-1].header.stamp, rospy.Time(0, 100000000))
        imu.stop()
        wrench.stop()

    def test_faulty_commands_change_nothing(self):
        before = self.call(0, [])
        for faulty in (command("nobody", shoulder=1), command("", elbow=1), command("", shoulder=float("nan")),
                       RobotCommand("", JointState(name=["shoulder"], position=[1, 2]))):
            answer = self.call(10, [command(shoulder=1), faulty])
            self.assertFalse(answer.success)
            self.assertGreater(len(answer.status_message), 20)
            self.assertNotIn("\n", answer.status_message)
        after = self.call(0, [])
        self.assertEqual((after.step, after.state_hash), (before.step, before.state_hash))
        self.assertIn("arm_on_base", self.call(1, [command("nobody", shoulder=1)]).status_message)

    def test_zz_a_deleted_robot_is_not_observed(self):
        self.assertTrue(service("delete_model", DeleteModel)("arm_on_base").success)
        answer = self.call(10, [])
        self.assertTrue(answer.success, answer.status_message)
        self.assertEqual(answer.robots, [])
        self.assertEqual(set(answer.models.name), {"ground", "cube"})


if __name__ == "__main__":
    rospy.init_node("step_with_commands_test")
    rostest.rosrun("blem_sim", "step_with_commands", StepWithCommandsTest)
