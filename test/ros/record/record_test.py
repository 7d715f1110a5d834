#!/usr/bin/python3
"""Inputs of a free run are recorded and played again: same hashes, or the step that differs by name."""
import os
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest

import actionlib
import rosbag
import rospy
import rostest
from geometry_msgs.msg import Point, Pose, Twist, Vector3, Wrench
from sensor_msgs.msg import JointState, PointCloud2, PointField
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from blem_sim import msg, srv

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import sim_client
from sim_client import service, wait_until

CUBE = """<robot name="spawned"><link name="link"><inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/>
</inertial><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link></robot>"""


def run(program, *arguments):
    done = subprocess.run(["rosrun", "blem_sim", program] + list(arguments), stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
    return done.returncode, done.stdout + done.stderr


def trajectory(positions, times=(0.2, 0.5)):
    message = JointTrajectory(joint_names=["shoulder"])
    for position, moment in zip(positions, times):
        message.points.append(JointTrajectoryPoint(positions=[position], velocities=[0], time_from_start=rospy.Duration.from_sec(moment)))
    return message


def cloud():
    points = [(0.6 + 0.011 * i, 0.011 * j, 0.001) for i in range(-8, 9) for j in range(-8, 9)]
    message = PointCloud2(height=1, width=len(points), point_step=12, row_step=12 * len(points))
    message.header.frame_id = "world"
    message.fields = [PointField(name, 4 * i, PointField.FLOAT32, 1) for i, name in enumerate("xyz")]
    message.data = b"".join(struct.pack("<3f", *point) for point in points)
    return message


def done(service_name, kind, **request):
    answer = service(service_name, kind)(**request)
    assert answer.success, answer.status_message


def everything(topics, action):
    """Commands, calls and a cloud, while the simulation runs freely."""
    topics["command"].publish(trajectory((0.3, -0.2)))
    done("apply_body_wrench", srv.ApplyBodyWrench, body_name="cube::link", wrench=Wrench(force=Vector3(4, 1, 0)), duration=rospy.Duration(0.2))
    time.sleep(0.2)
    topics["points"].publish(cloud())
    topics["joint_trajectory"].publish(trajectory((0.1, 0.2)))
    done("spawn_urdf_model", srv.SpawnModel, model_name="spawned", model_xml=CUBE, initial_pose=Pose(position=Point(0.6, 0, 0.4)))
    time.sleep(0.2)
    topics["joint_command"].publish(JointState(name=["shoulder"], position=[0.15]))
    topics["set_model_state"].publish(msg.ModelState("cube", Pose(position=Point(0.7, 0.1, 0.3)), Twist(), "world"))
    done("apply_joint_effort", srv.ApplyJointEffort, joint_name="shoulder", effort=2.0, duration=rospy.Duration(0.1))
    goal = msg.FollowJointTrajectoryGoal(trajectory=trajectory((-0.1, 0.1)))
    action.send_goal_and_wait(goal, rospy.Duration(5))
    done("load_environment", srv.LoadEnvironment, name="second", uri="cube.off", pose=Pose(position=Point(2, 2, 0)))
    sim_client.reset_world()
    done("step_with_commands", srv.StepWithCommands, steps=20, commands=[msg.RobotCommand("", JointState(name=["shoulder"], velocity=[0.5]))])
    sim_client.unpause()
    time.sleep(0.2)


class RecordTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory(dir="/tmp")
        cls.folder = cls.temporary.name
        cls.bag = os.path.join(cls.folder, "run.bag")
        topics = {"command": ("/joint_trajectory_controller/command", JointTrajectory), "points": ("/points", PointCloud2),
                  "joint_trajectory": ("/joint_trajectory", JointTrajectory), "joint_command": ("/joint_command", JointState),
                  "set_model_state": ("/blem_sim/set_model_state", msg.ModelState)}
        publishers = {name: rospy.Publisher(topic, kind, queue_size=10) for name, (topic, kind) in topics.items()}
        action = actionlib.SimpleActionClient("/joint_trajectory_controller/follow_joint_trajectory", msg.FollowJointTrajectoryAction)
        action.wait_for_server()
        wait_until(lambda: all(p.get_num_connections() for p in publishers.values()), "the node to listen")
        recorder = subprocess.Popen(["rosrun", "blem_sim", "record", cls.bag], stdout=subprocess.PIPE, universal_newlines=True)
        assert "records into" in recorder.stdout.readline()
        try:
            everything(publishers, action)
        finally:
            recorder.send_signal(signal.SIGINT)
            cls.told = recorder.communicate()[0]

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def messages(self, topic):
        with rosbag.Bag(self.bag) as bag:
            return [message for _, message, _ in bag.read_messages(topic)]

    def altered(self, name, change):
        """Copy of the bag. @param change(topic, message) of every message; one that it answers with False for is left out"""
        copy = os.path.join(self.folder, name)
        with rosbag.Bag(self.bag) as bag, rosbag.Bag(copy, "w") as out:
            for topic, message, stamp in bag.read_messages():
                if change(topic, message) is not False:
                    out.write(topic, message, stamp)
        return copy

    def refused(self, bag, word):
        code, text = run("replay", bag)
        self.assertEqual(code, 2, text)
        self.assertIn(word, text)
        self.assertEqual(text.count("\n"), 1, text)

    def test_replayed_to_the_same_hash(self):
        code, text = run("replay", self.bag)
        self.assertEqual(code, 0, text)
        steps = sum(len(message.hashes) for message in self.messages("record/steps"))
        self.assertGreater(steps, 500)
        self.assertIn("the same in all %d steps" % steps, text)
        self.assertIn("%d steps" % steps, self.told)
        calls = {message.call for message in self.messages("record/input")}
        self.assertLessEqual({"commandTrajectory", "commandJoints", "applyLoad", "applyEffort", "spawn", "loadEnvironment", "moveModel",
                              "updateCloud", "resetWorld"}, calls)

    def test_one_altered_byte_is_named_by_its_step(self):
        step = []

        def change(topic, message):
            if topic == "record/input" and message.call == "applyLoad":
                numbers = list(message.numbers)
                bits = bytearray(struct.pack("<d", numbers[1]))
                bits[5] ^= 1
                numbers[1] = struct.unpack("<d", bits)[0]
                message.numbers = numbers
                step.append(message.step)

        code, text = run("replay", self.altered("byte.bag", change))
        self.assertEqual(code, 1, text)
        self.assertIn("step %d differs" % (step[0] + 1), text)
        self.assertIn("applyLoad", text)

    def test_bad_bags_are_refused_in_one_line(self):
        def format_2(topic, message):
            if topic == "record/start":
                message.format = 2

        def nan_index(topic, message):
            if topic == "record/input" and message.call == "applyLoad":
                message.numbers = [float("nan")] + list(message.numbers[1:])

        self.refused(self.altered("format.bag", format_2), "format 2")
        self.refused(self.altered("end.bag", lambda topic, message: not getattr(message, "last", False)), "cut short")
        self.refused(self.altered("start.bag", lambda topic, _: topic != "record/start"), "steps are missing")
        self.refused(self.altered("none.bag", lambda topic, _: False), "no record")
        self.refused(os.path.join(self.folder, "nowhere.bag"), "nowhere.bag")
        code, text = run("replay", self.altered("index.bag", nan_index))
        self.assertEqual(code, 1, text)
        self.assertIn("its input is refused: input 'applyLoad'", text)
        cut = os.path.join(self.folder, "cut.bag")
        shutil.copy(self.bag, cut)
        with open(cut, "r+b") as stream:
            stream.truncate(os.path.getsize(cut) // 2)
        self.refused(cut, "cut.bag")

    def test_changed_models_need_a_record_from_the_start(self):
        done("load_environment", srv.LoadEnvironment, name="third", uri="cube.off", pose=Pose(position=Point(4, 2, 0)))
        answer = service("start_record", srv.StartRecord)(os.path.join(self.folder, "late.bag"))
        self.assertFalse(answer.success)
        self.assertIn("have changed", answer.status_message)
        self.assertFalse(service("start_record", srv.StartRecord)("/var/tmp/elsewhere.bag").success)
        self.assertFalse(service("stop_record", srv.StopRecord)().success)

    def test_recorded_from_the_first_step(self):
        at = lambda name, kind: rospy.ServiceProxy("/from_start/" + name, kind)
        bag = os.path.join(os.environ["ROS_HOME"], "from_start.bag")
        rospy.wait_for_service("/from_start/stop_record")
        self.assertTrue(at("load_environment", srv.LoadEnvironment)(name="second", uri="cube.off", pose=Pose(position=Point(2, 2, 0))).success)
        end = at("step_with_commands", srv.StepWithCommands)(150, [msg.RobotCommand("", JointState(name=["shoulder"], position=[0.3]))])
        self.assertTrue(at("stop_record", srv.StopRecord)().success)
        code, text = run("replay", bag)
        self.assertEqual(code, 0, text)
        self.assertIn("%016x" % end.state_hash, text)


if __name__ == "__main__":
    rospy.init_node("record_test", disable_rostime=True)
    rostest.rosrun("blem_sim", "record", RecordTest)
