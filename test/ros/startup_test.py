#!/usr/bin/python3
"""Bad parameters are refused with one line and exit code 2; a good node starts, and stops when it is told to."""
import array
import math
import os
import random
import re
import resource
import signal
import subprocess
import tempfile
import time
import unittest

import rosbag
import rosgraph
import rosnode
import rospkg
import rospy
import rostest
import yaml
from roscpp.srv import GetLoggers
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import PointCloud2, PointField

from blem_sim.srv import LoadEnvironment, RestoreState, SaveState, StartRecord, StopRecord
from sim_client import Recorder, temporary_folder, wait_until

NAME = "/starting_blem_sim"
DATA = os.path.join(rospkg.RosPack().get_path("blem_sim"), "test", "data", "ros")
WORLD = os.path.join(DATA, "world.yaml")
LARGEST = 65536  # [bytes] of a file, where the disk is to be full
STEPS_OF_16_KB = 2048  # of a record, at 8 bytes at least


def on_sphere(rng):
    point = [rng.gauss(0, 1) for _ in "xyz"]
    length = math.sqrt(sum(x * x for x in point))
    return [x / length for x in point]


def fill_disk():
    """In a child: files are as on a full disk beyond a size."""
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (LARGEST, LARGEST))


class StartupTest(unittest.TestCase):
    def setUp(self):
        if rospy.has_param(NAME):
            rospy.delete_param(NAME)
        with open(WORLD) as stream:
            self.parameters = yaml.safe_load(stream)
        self.parameters["config_file"] = WORLD

    def start(self, parameters, **options):
        rospy.set_param(NAME, parameters)
        self.output = tempfile.TemporaryFile(mode="w+")
        command = ["rosrun", "blem_sim", "blem_sim_node", "__name:=" + NAME.strip("/")]
        process = subprocess.Popen(command, stdout=self.output, stderr=subprocess.STDOUT, **options)
        self.addCleanup(lambda: process.poll() is None and process.kill())
        return process

    def assert_refused(self, parameters, *words):
        process = self.start(parameters)
        self.assertEqual(process.wait(timeout=60), 2)
        self.output.seek(0)
        lines = [line for line in self.output.read().splitlines() if "FATAL" in line]
        self.assertEqual(len(lines), 1, lines)
        for word in words:
            self.assertIn(word, lines[0])

    def wait_until_ready(self, process):
        clock = Recorder("/clock", Clock)
        clock.wait_for(1)
        clock.stop()
        self.assertIsNone(process.poll())

    def test_unknown_parameter_names_the_nearest(self):
        self.parameters["time_stp"] = 0.001
        self.assert_refused(self.parameters, "time_stp", "time_step")

    def test_unknown_parameter_of_a_robot(self):
        self.parameters["robots"][0]["fixed_bas"] = True
        self.assert_refused(self.parameters, "fixed_bas", "fixed_base")

    def test_wrong_type(self):
        self.parameters["time_step"] = "fast"
        self.assert_refused(self.parameters, "time_step")

    def test_environment_beside_what_is_no_list(self):
        for value in (5, "", {"a": 1}):
            self.parameters.update(environments=value, environment="cube.off")
            self.assert_refused(self.parameters, NAME, "environments", "must be a list")

    def test_parameters_that_are_no_map(self):
        for value in (5, [1, 2]):
            self.assert_refused(value, NAME, "must be a map of keys")

    def test_robot_description_that_is_no_text(self):
        self.addCleanup(rospy.delete_param, "/robot_description")
        del self.parameters["robots"]
        for value in (5, {"a": 1}, ""):
            rospy.set_param("/robot_description", value)
            self.assert_refused(self.parameters, "description_param", "/robot_description", "set it")

    def test_node_name_that_is_none(self):
        command = ["rosrun", "blem_sim", "blem_sim_node", "__name:=two words"]
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        self.assertEqual(done.returncode, 2, done.stdout)
        self.assertIn("FATAL", done.stdout)
        self.assertIn("two words", done.stdout)

    def test_missing_mesh(self):
        self.parameters["environments"][0]["uri"] = "no_such_mesh.off"
        self.assert_refused(self.parameters, "no_such_mesh.off")

    def test_missing_description_parameter(self):
        del self.parameters["robots"][0]["urdf"]
        self.parameters["robots"][0]["description_param"] = "no_such_parameter"
        self.assert_refused(self.parameters, "no_such_parameter")

    def test_description_that_is_not_xml(self):
        rospy.set_param("/broken_description", "this is no URDF")
        del self.parameters["robots"][0]["urdf"]
        self.parameters["robots"][0]["description_param"] = "/broken_description"
        self.assert_refused(self.parameters, "broken_description")

    def test_two_sensors_on_one_topic(self):
        self.parameters["robots"][0]["sensors"][1]["topic"] = "tilt"
        self.assert_refused(self.parameters, "tilt")

    def test_names_that_are_none(self):
        for name in ("~own", "two words"):
            self.setUp()
            self.parameters["robots"][0]["namespace"] = name
            self.assert_refused(self.parameters, "robots[0].namespace", name, "use letters")
            self.setUp()
            self.parameters["robots"][0]["odom"] = {"topic": name}
            self.assert_refused(self.parameters, "odom.topic", name, "use letters")
            self.setUp()
            self.parameters["environments"].append({"name": "live", "topic": name})
            self.assert_refused(self.parameters, "environments[1].topic", name, "use letters")

    def test_topics_of_the_node_itself(self):
        for topic in ("/clock", "joint_states", "odom"):
            self.setUp()
            self.parameters["robots"][0]["sensors"][1]["topic"] = topic
            self.assert_refused(self.parameters, "/" + topic.strip("/"), "another")

    def end(self, process, told):
        process.send_signal(told)
        self.assertEqual(process.wait(timeout=20), 0)

    def test_interrupt_ends_it_cleanly(self):
        for paused in (False, True):
            for told in (signal.SIGINT, signal.SIGTERM):
                self.parameters["paused"] = paused
                process = self.start(self.parameters)
                self.wait_until_ready(process)
                self.end(process, told)

    def test_record_is_whole_after_a_termination(self):
        record = os.path.join(temporary_folder(self), "inputs.bag")
        self.parameters["record"] = record
        process = self.start(self.parameters)
        self.wait_until_ready(process)
        self.end(process, signal.SIGTERM)
        with rosbag.Bag(record) as bag:
            self.assertGreater(bag.get_message_count(), 0)

    def test_records_begin_after_one_that_its_disk_did_not_take(self):
        folder = temporary_folder(self)
        self.parameters.update(file_roots=[folder], real_time_factor=0)
        process = self.start(self.parameters, preexec_fn=fill_disk)
        self.wait_until_ready(process)
        full, whole = (os.path.join(folder, name) for name in ("full.bag", "whole.bag"))
        begin, end = rospy.ServiceProxy(NAME + "/start_record", StartRecord), rospy.ServiceProxy(NAME + "/stop_record", StopRecord)
        self.assertTrue(begin(full).success)
        wait_until(lambda: os.path.getsize(full) == LARGEST, "a full disk")
        time.sleep(1)
        told = end()
        self.assertFalse(told.success)
        told_step = int(re.search("full.bag ends at step ([0-9]+) or up to 16 kB before", told.status_message).group(1))
        self.assertIn("(File too large)", told.status_message, "the system's reason")
        wait_until(lambda: begin(whole).success, "the next record")
        self.assertTrue(end().success)
        self.assertEqual(subprocess.call(["rosrun", "blem_sim", "replay", whole]), 0)
        self.assertTrue(told_step - STEPS_OF_16_KB < self.replayed_steps(full) <= told_step)
        self.end(process, signal.SIGINT)

    def replayed_steps(self, record):
        """Steps of a record that was cut short."""
        replay = lambda: subprocess.run(["rosrun", "blem_sim", "replay", record], stderr=subprocess.PIPE, universal_newlines=True).stderr
        self.assertIn("its disk was full; rosbag reindex", replay())
        subprocess.check_call(["rosbag", "reindex", "-q", record])
        return int(re.search("no end after step ([0-9]+), and is the same up to there", replay()).group(1))

    def test_record_of_a_node_that_was_killed_is_whole_up_to_its_end(self):
        record = os.path.join(temporary_folder(self), "inputs.bag")
        self.parameters["record"] = record
        process = self.start(self.parameters)
        self.wait_until_ready(process)
        time.sleep(1)
        process.kill()
        process.wait()
        subprocess.check_call(["rosbag", "reindex", "-q", record])
        with rosbag.Bag(record) as bag:
            self.assertEqual(bag.get_message_count("record/start"), 1)
        done = subprocess.run(["rosrun", "blem_sim", "replay", record], stderr=subprocess.PIPE, universal_newlines=True)
        self.assertIn("cut short", done.stderr)

    def test_record_ends_with_its_terminal(self):
        folder = temporary_folder(self)
        self.parameters["file_roots"] = [folder]
        process = self.start(self.parameters)
        self.wait_until_ready(process)
        command = ["rosrun", "blem_sim", "record", "--node", NAME, os.path.join(folder, "run.bag")]
        recorder = subprocess.Popen(command, stdout=subprocess.PIPE, universal_newlines=True)
        self.assertIn("records into", recorder.stdout.readline())
        recorder.send_signal(signal.SIGHUP)
        self.assertIn("steps", recorder.communicate(timeout=20)[0])
        self.assertEqual(recorder.returncode, 0)
        self.end(process, signal.SIGINT)

    def test_checkpoint_stays_after_a_termination(self):
        self.parameters["checkpoint_period"] = 0.05
        self.parameters["checkpoint_file"] = os.path.join(temporary_folder(self), "kept.state")
        for told, stays in ((signal.SIGTERM, True), (signal.SIGINT, False)):
            process = self.start(self.parameters)
            self.wait_until_ready(process)
            wait_until(lambda: os.path.exists(self.parameters["checkpoint_file"]), "a checkpoint")
            process.send_signal(told)
            self.assertEqual(process.wait(timeout=20), 0)
            self.assertEqual(os.path.exists(self.parameters["checkpoint_file"]), stays)

    def test_ends_while_a_cloud_is_made_into_a_surface(self):
        outliers = {"statistical_outliers": {"neighbours": 30, "factor": 2}}
        self.parameters["environments"].append({"name": "live", "topic": "/large", "cloud": {"as": "mesh", "mesher": "poisson", "cell": 0.004, "filters": [outliers]}})
        process = self.start(self.parameters)
        self.wait_until_ready(process)
        clouds = rospy.Publisher("/large", PointCloud2, queue_size=1)
        wait_until(clouds.get_num_connections, "the node to listen")
        count = 400000
        message = PointCloud2(height=1, width=count, point_step=12, row_step=12 * count)
        message.header.frame_id = "world"
        message.fields = [PointField(axis, 4 * i, PointField.FLOAT32, 1) for i, axis in enumerate("xyz")]
        rng = random.Random(1)
        places = array.array("f", (x for _ in range(count) for x in on_sphere(rng)))
        message.data = places.tobytes()
        clouds.publish(message)
        time.sleep(1.5)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=8), 0)

    def test_rosnode_kill_ends_it(self):
        process = self.start(self.parameters)
        self.wait_until_ready(process)
        rosnode.kill_nodes([NAME])
        self.assertEqual(process.wait(timeout=20), 0)

    def test_loggers_are_listed_and_logging_goes_on(self):
        process = self.start(self.parameters)
        self.wait_until_ready(process)
        for _ in range(3):
            loggers = rospy.ServiceProxy(NAME + "/get_loggers", GetLoggers)().loggers
            self.assertIn(("ros.blem_sim", "info"), [(logger.name, logger.level) for logger in loggers])
            self.assertFalse(rospy.ServiceProxy(NAME + "/load_environment", LoadEnvironment)(name="a", uri="nowhere").success)
        self.end(process, signal.SIGINT)

    def test_services_use_no_files_if_they_are_not_allowed_to(self):
        self.parameters["allow_file_services"] = False
        self.parameters["paused"] = True
        process = self.start(self.parameters)
        self.wait_until_ready(process)
        for name, kind, request in (("save_state", SaveState, {"file": "a.state"}), ("restore_state", RestoreState, {"file": "a.state"}),
                                    ("load_environment", LoadEnvironment, {"name": "a", "uri": "package://blem_sim/test/data/ros/cube.off"})):
            answer = rospy.ServiceProxy(NAME + "/" + name, kind)(**request)
            self.assertFalse(answer.success)
            self.assertIn("allow_file_services", answer.status_message)
        self.end(process, signal.SIGINT)

    def test_another_clock_is_told(self):
        clock = rospy.Publisher("/clock", Clock, queue_size=1)
        self.addCleanup(clock.unregister)
        process = self.start(self.parameters)
        self.wait_until_ready(process)
        self.end(process, signal.SIGINT)
        self.output.seek(0)
        self.assertIn("/clock: is published by %s too" % rospy.get_name(), self.output.read())

    def test_sim_time_is_set_if_it_was_not(self):
        master = rosgraph.Master("/startup_test")
        if master.hasParam("/use_sim_time"):
            master.deleteParam("/use_sim_time")
        process = self.start(self.parameters)
        self.wait_until_ready(process)
        self.assertIs(master.getParam("/use_sim_time"), True)
        self.end(process, signal.SIGINT)

    def test_robot_from_the_parameter_robot_description(self):
        with open(os.path.join(DATA, "arm_on_base.urdf")) as stream:
            rospy.set_param("/robot_description", stream.read())
        del self.parameters["robots"]
        process = self.start(self.parameters)
        self.wait_until_ready(process)
        deadline = time.time() + 20
        while "/joint_states" not in dict(rospy.get_published_topics()) and time.time() < deadline:
            time.sleep(0.05)
        self.assertIn("/joint_states", dict(rospy.get_published_topics()))
        self.end(process, signal.SIGINT)
        rospy.delete_param("/robot_description")


if __name__ == "__main__":
    rospy.init_node("startup_test")
    rostest.rosrun("blem_sim", "startup", StartupTest)
