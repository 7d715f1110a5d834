#!/usr/bin/python3
"""Trajectories and joint commands move the joints; bad ones are refused and the node lives on."""
import math
import os
import subprocess
import time
import unittest

import rospkg
import rospy
import rostest
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import JointState
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

import sim_client
from sim_client import Recorder, temporary_folder, wait_until

SCRIPT = os.path.join(rospkg.RosPack().get_path("blem_sim"), "scripts", "ros", "play_trajectory")


def trajectory(joints, points):
    """@param points [(time [s], positions)]"""
    message = JointTrajectory(joint_names=joints)
    for seconds, positions in points:
        message.points.append(JointTrajectoryPoint(positions=positions, time_from_start=rospy.Duration.from_sec(seconds)))
    return message


class CommandsTest(unittest.TestCase):
    def setUp(self):
        sim_client.reset_world()
        self.joint_states = Recorder("/joint_states", JointState)
        self.log = Recorder("/rosout", Log)
        wait_until(lambda: self.joint_states.connected() and self.log.connected(), "connections")

    def tearDown(self):
        self.joint_states.stop()
        self.log.stop()

    def publisher(self, topic, message_type):
        publisher = rospy.Publisher(topic, message_type, queue_size=10)
        wait_until(lambda: publisher.get_num_connections() > 0, "the node to listen on " + topic)
        return publisher

    def position_after(self, steps):
        answer = sim_client.step(steps)
        wait_until(lambda: any(m.header.stamp == answer.stamp for m in self.joint_states.messages()), "the joint state of the last step")
        return self.joint_states.messages()[-1].position[0]

    def send(self, publisher, message):
        """Messages and services go different ways: a message has arrived once the node has had time to serve it."""
        publisher.publish(message)
        rospy.rostime.wallsleep(0.5)

    def errors(self):
        return [m.msg for m in self.log.messages() if m.name == sim_client.NODE and m.level == Log.ERROR]

    def assert_refused(self, publisher, message, *words):
        before = len(self.errors())
        self.send(publisher, message)
        wait_until(lambda: len(self.errors()) > before, "an error line")
        for word in words:
            self.assertIn(word, self.errors()[-1])
        self.assertNotIn("\n", self.errors()[-1].strip())
        self.assertAlmostEqual(self.position_after(100), 0, delta=0.02)

    def test_trajectory_moves_the_joint(self):
        for topic in ("/joint_trajectory_controller/command", "/joint_trajectory"):
            sim_client.reset_world()
            self.send(self.publisher(topic, JointTrajectory), trajectory(["shoulder"], [(0.5, [0.3]), (1.0, [0.6])]))
            self.assertAlmostEqual(self.position_after(500), 0.3, delta=0.06)
            self.assertAlmostEqual(self.position_after(1500), 0.6, delta=0.03)

    def test_stamp_in_the_future_waits(self):
        message = trajectory(["shoulder"], [(0.5, [0.5])])
        message.header.stamp = sim_client.step(1).stamp + rospy.Duration(1)
        self.send(self.publisher("/joint_trajectory", JointTrajectory), message)
        self.assertAlmostEqual(self.position_after(900), 0, delta=0.02)
        self.assertAlmostEqual(self.position_after(1600), 0.5, delta=0.03)

    def test_empty_trajectory_holds(self):
        publisher = self.publisher("/joint_trajectory", JointTrajectory)
        self.send(publisher, trajectory(["shoulder"], [(2.0, [1.0])]))
        sim_client.step(500)
        self.send(publisher, JointTrajectory())
        held = self.position_after(1000)
        self.assertGreater(held, 0.1)
        self.assertLess(held, 0.4)

    def test_joint_command(self):
        publisher = self.publisher("/joint_command", JointState)
        self.send(publisher, JointState(name=["shoulder"], position=[-0.4]))
        self.assertAlmostEqual(self.position_after(2000), -0.4, delta=0.03)

    def test_bad_trajectories_are_refused(self):
        publisher = self.publisher("/joint_trajectory", JointTrajectory)
        self.assert_refused(publisher, trajectory(["elbow"], [(1, [1])]), "elbow")
        self.assert_refused(publisher, trajectory(["shoulder"], [(1, [math.nan])]), "shoulder")
        self.assert_refused(publisher, trajectory(["shoulder"], [(1, [math.inf])]))
        self.assert_refused(publisher, trajectory(["shoulder"], [(1, [1, 2])]))
        self.assert_refused(publisher, trajectory(["shoulder"], [(1, [])]))
        self.assert_refused(publisher, trajectory(["shoulder", "shoulder"], [(1, [1, 1])]), "shoulder")
        self.assert_refused(publisher, trajectory(["shoulder"], [(1, [1]), (0.5, [0])]))
        self.assert_refused(publisher, trajectory([], [(1, [])]))

    def test_bad_joint_commands_are_refused(self):
        publisher = self.publisher("/joint_command", JointState)
        self.assert_refused(publisher, JointState(name=["elbow"], position=[1]), "elbow")
        self.assert_refused(publisher, JointState(name=["shoulder"], position=[math.nan]), "shoulder")
        self.assert_refused(publisher, JointState(name=["shoulder"], position=[1, 2]))

    def play(self, content, *flags):
        """Exit code and errors of play_trajectory, while steps are made."""
        file = os.path.join(temporary_folder(self), "motion.csv")
        with open(file, "wb") as stream:
            stream.write(content)
        command = [SCRIPT, file] + list(flags)
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, universal_newlines=True)
        self.addCleanup(lambda: process.poll() is None and process.kill())
        wait_until(lambda: sim_client.step(50) and process.poll() is not None, "the script's end")
        return process.returncode, process.stderr.read()

    def test_script_plays_a_file_with_a_byte_order_mark_and_other_columns(self):
        code, text = self.play(b"\xef\xbb\xbftime,shoulder,remark\n0,0,begins\n\n0.2,-0.4,ends\n", "--approach", "0.1")
        self.assertEqual(code, 0, text)
        self.assertAlmostEqual(self.position_after(1000), -0.4, delta=0.03)

    def test_script_that_loops_goes_on_after_a_reset(self):
        file = os.path.join(temporary_folder(self), "motion.csv")
        with open(file, "w") as stream:
            stream.write("time,shoulder\n0,0\n5,0.3\n")
        process = subprocess.Popen([SCRIPT, file, "--loop"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        self.addCleanup(lambda: process.poll() is None and process.kill())
        sent = lambda: len([m for m in self.log.messages() if m.msg.startswith("sent 2 points")])
        wait_until(lambda: sim_client.step(50) and sent() == 1, "the first motion")
        sim_client.step(500)
        sim_client.reset_simulation()
        time.sleep(1)  # rospy looks at the clock three times a second
        wait_until(lambda: sim_client.step(50) and sent() == 2, "the next motion")
        self.assertIsNone(process.poll())

    def test_rosrun_finds_one_script(self):
        done = subprocess.run(["rosrun", "blem_sim", "play_trajectory", "--help"], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.assertEqual(done.returncode, 0, done.stdout)

    def test_script_refuses_bad_files_in_one_line(self):
        for content, words in ((b"time,shoulder\n0,abc\n", "motion.csv:2: 'abc'"), (b"time,shoulder\n0,0\n0.3\n", "motion.csv:3: has 1 cells"),
                               (b"time,shoulder\n0,0,1\n", "motion.csv:2: has 3 cells"), (b"time,shoulder\n0,nan\n", "'nan'"),
                               (b"time,shoulder\n0,0\ninf,0\n", "'inf'"), (b"time,shoulder\n0,0\n1e12,0\n", "'1e12'"),
                               (b"time,shoulder,shoulder\n0,0,0\n", "twice"), (b"\xff\xfe\x00", "motion.csv: is no CSV file")):
            code, text = self.play(content)
            self.assertEqual(code, 2, text)
            self.assertIn(words, text)
            self.assertEqual(text.count("\n"), 1, text)
        code, text = self.play(b"time,shoulder\n0,0\n", "--approach", "inf")
        self.assertEqual(code, 2, text)
        self.assertIn("'inf'", text)
        for topic in ("", "no topic", "7th"):
            code, text = self.play(b"time,shoulder\n0,0\n", "--topic", topic)
            self.assertEqual(code, 2, text)
            self.assertIn("'%s' is no ROS topic" % topic, text)


if __name__ == "__main__":
    rospy.init_node("commands_test")
    rostest.rosrun("blem_sim", "commands", CommandsTest)
