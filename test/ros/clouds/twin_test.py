#!/usr/bin/python3
"""A mast walks its view over a floor; in a second simulator its twin stands on the streamed cloud, as high as on the floor itself."""
import os
import signal
import subprocess
import sys
import unittest

import rospy
import rostest
from geometry_msgs.msg import Pose
from sensor_msgs.msg import JointState, PointCloud2
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from blem_sim.msg import LiveCloudUpdate, ModelState, StepReport
from blem_sim.srv import GetModelState, LoadEnvironment, SetModelState, Step, UnloadEnvironment

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from sim_client import PATIENCE, Recorder, wait_until

SEER, TWIN = "/blem_sim", "/twin/blem_sim"
FLOOR = "package://blem_sim/meshes/scanned_floor.ply"
STARTS = (0.8, -0.15, 0.035)  # [m] of the twin's foot
DISTANCE = 0.98               # [m] from the camera to there, along its axis
NOISE = 2.85e-3 * DISTANCE ** 2  # [m] a step of the camera's disparity there
TURN, SECONDS, STEPS = 0.6, 4.0, 100  # [rad], [s], of a turn: a cloud each
PAN_TILT = [(1.0, TURN, 0.6), (2.0, -TURN, 0.5), (3.0, 0.0, 0.7), (3.8, 0.2, 0.6)]  # time [s], [rad]


def call(node, name, service, *request):
    rospy.wait_for_service(node + "/" + name, PATIENCE)
    answer = rospy.ServiceProxy(node + "/" + name, service)(*request)
    assert answer.success, answer.status_message
    return answer


def steps(node, count=STEPS):
    return call(node, "step", Step, count).stamp.to_sec()


def steps_made(node):
    """Simulated time [s], without stepping."""
    return call(node, "step", Step, 0).stamp.to_sec()


def twin_pose():
    return call(TWIN, "get_model_state", GetModelState, "watcher", "").pose


def look_around(publisher):
    trajectory = JointTrajectory(joint_names=["pan", "tilt"])
    for time, pan, tilt in PAN_TILT:
        trajectory.points.append(JointTrajectoryPoint(positions=[pan, tilt], velocities=[0, 0], time_from_start=rospy.Duration.from_sec(time)))
    publisher.publish(trajectory)


class TwinTest(unittest.TestCase):
    def setUp(self):
        self.look = rospy.Publisher("/joint_trajectory", JointTrajectory, queue_size=1)
        self.clouds = Recorder("/camera/depth/points", PointCloud2)
        self.joints = Recorder("/joint_states", JointState)
        self.updates = Recorder(TWIN + "/live_cloud_updates", LiveCloudUpdate)
        self.reports = Recorder(TWIN + "/step_report", StepReport)
        wait_until(lambda: self.look.get_num_connections() > 0 and self.clouds.connected() and self.joints.connected(), "the first simulator")

    def walk_the_view(self):
        """Both simulators in turns, the seeing one first, from its first cloud on."""
        wait_until(lambda: self.updates.connected() and self.reports.connected(), "the second simulator")
        while not self.clouds.messages():
            steps(SEER)
        look_around(self.look)
        time, sent = 0, len(self.clouds.messages())
        while time < SECONDS:
            time, sent = steps(SEER), sent + 1
            wait_until(lambda: len(self.clouds.messages()) >= sent, "the cloud of this turn")
            steps(TWIN)

    def height_on_the_floor_itself(self):
        call(TWIN, "unload_environment", UnloadEnvironment, "seen")
        state = ModelState(model_name="watcher", pose=Pose(), reference_frame="world")
        state.pose.position.x, state.pose.position.y, state.pose.position.z = STARTS
        state.pose.orientation.w = 1
        call(TWIN, "set_model_state", SetModelState, state)
        request = LoadEnvironment._request_class(name="floor", uri=FLOOR, friction=0.8)
        call(TWIN, "load_environment", LoadEnvironment, request)
        steps(TWIN, 1500)
        return twin_pose().position.z

    def test_1_twin_stands_as_high_as_on_the_floor_that_was_seen(self):
        self.walk_the_view()
        pans = [message.position[message.name.index("pan")] for message in self.joints.messages()]
        self.assertGreater(max(pans), 0.9 * TURN)
        self.assertLess(min(pans), -0.9 * TURN)
        self.assertTrue(self.updates.messages(), "no cloud came to the twin")
        update = self.updates.messages()[-1]
        self.assertEqual(update.refused, 0)
        self.assertGreater(update.accepted, 0.5 * 10 * SECONDS)
        crossed = [report.step for report in self.reports.messages() if report.status & StepReport.CONTACT_UNRELIABLE]
        self.assertEqual(crossed, [], "contacts outside the layers")
        pose = twin_pose()
        self.assertGreater(pose.orientation.w, 0.999)
        self.assertLess(max(abs(pose.position.x - STARTS[0]), abs(pose.position.y - STARTS[1])), 0.01)
        height = self.height_on_the_floor_itself()
        rospy.loginfo("the twin stands at %.2f mm, on the floor itself at %.2f mm; the camera's noise is %.2f mm", 1e3 * pose.position.z,
                      1e3 * height, 1e3 * NOISE)
        self.assertAlmostEqual(pose.position.z, height, delta=NOISE)

    def test_2_simulators_that_step_together_keep_together(self):
        before = [steps(node, 1) for node in (SEER, TWIN)]
        turns = 20
        stepping = subprocess.Popen(["rosrun", "blem_sim", "step_together", SEER, TWIN, "--steps", str(turns), "--rate", "0"],
                                    stderr=subprocess.PIPE, universal_newlines=True)
        wait_until(lambda: steps_made(SEER) > before[0] + 0.5, "half a second in turns")
        stepping.send_signal(signal.SIGINT)
        self.assertEqual((stepping.communicate(timeout=PATIENCE)[1], stepping.returncode), ("", 0))
        made = [steps_made(node) - time for node, time in zip((SEER, TWIN), before)]
        self.assertGreater(min(made), 0.4)
        self.assertLess(abs(made[0] - made[1]), 1.5e-3 * turns)

    def test_3_who_steps_nobody_says_so_in_one_line(self):
        stepping = subprocess.run(["rosrun", "blem_sim", "step_together", "/nobody", "--patience", "0.5"], stderr=subprocess.PIPE,
                                  universal_newlines=True, timeout=PATIENCE)
        self.assertEqual(stepping.returncode, 1)
        self.assertRegex(stepping.stderr, "^step_together: .*/nobody/step.*\n$")


if __name__ == "__main__":
    rospy.init_node("twin_test", disable_rostime=True)
    rostest.rosrun("blem_sim", "twin", TwinTest, sys.argv)
