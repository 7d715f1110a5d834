#!/usr/bin/python3
"""Pause, step, reset and environments do what they say."""
import os
import tempfile
import time
import unittest

import rospy
import rostest
from geometry_msgs.msg import Pose, Vector3
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from visualization_msgs.msg import Marker, MarkerArray

from blem_sim.srv import Step, StepWithCommands

import sim_client
from sim_client import Recorder, wait_until

CUBE = "package://blem_sim/test/data/ros/cube.off"


class ServicesTest(unittest.TestCase):
    def setUp(self):
        sim_client.pause()
        sim_client.reset_world()
        self.clock = Recorder("/clock", Clock)
        self.odom = Recorder("/odom", Odometry)
        self.clock.wait_for(1)
        self.odom.wait_for(1)

    def tearDown(self):
        self.clock.stop()
        self.odom.stop()

    def height_after(self, steps):
        answer = sim_client.step(steps)
        wait_until(lambda: self.odom.messages()[-1].header.stamp.to_sec() > answer.stamp.to_sec() - 0.021, "the last odometry")
        return self.odom.messages()[-1].pose.pose.position.z

    def test_step_makes_exactly_that_many(self):
        for count in (1, 7, 500):
            self.clock.clear()
            first = sim_client.step(0).step
            answer = sim_client.step(count)
            self.assertEqual(answer.step, first + count)
            self.clock.wait_for(count)
            time.sleep(0.2)
            self.assertEqual(len(self.clock.messages()), count)
            self.assertEqual(self.clock.messages()[-1].clock, answer.stamp)

    def test_too_many_steps_are_refused(self):
        first = sim_client.step(0).step
        for name, kind in (("step", Step), ("step_with_commands", StepWithCommands)):
            answer = sim_client.service(name, kind)(steps=4000000000)
            self.assertFalse(answer.success)
            self.assertIn("too many for one call", answer.status_message)
        self.assertEqual(sim_client.step(0).step, first)

    def test_step_pauses_a_running_simulation(self):
        sim_client.unpause()
        self.clock.wait_for(50)
        stamp = sim_client.step(10).stamp
        time.sleep(0.3)
        self.assertEqual(self.clock.messages()[-1].clock, stamp)

    def test_pause_and_unpause(self):
        self.clock.clear()
        time.sleep(0.3)
        self.assertEqual(len(self.clock.messages()), 0)
        sim_client.unpause()
        self.clock.wait_for(100)
        sim_client.pause()
        time.sleep(0.2)
        count = len(self.clock.messages())
        time.sleep(0.3)
        self.assertEqual(len(self.clock.messages()), count)

    def test_reset_world_keeps_the_time(self):
        start = sim_client.step(0).stamp
        command = rospy.Publisher("/joint_command", JointState, queue_size=1)
        wait_until(lambda: command.get_num_connections() > 0, "the node to listen")
        command.publish(JointState(name=["shoulder"], position=[0.5]))
        time.sleep(0.5)
        sim_client.step(1000)
        sim_client.reset_world()
        after = sim_client.step(100).stamp
        self.assertAlmostEqual((after - start).to_sec(), 1.1, delta=1e-6)
        joints = Recorder("/joint_states", JointState)
        self.assertAlmostEqual(joints.wait_for(1)[-1].position[0], 0, delta=0.01)
        joints.stop()

    def test_reset_simulation_starts_time_again(self):
        stamp = sim_client.step(20).stamp
        wait_until(lambda: self.clock.messages()[-1].clock == stamp, "the stamp of the last step")
        self.clock.clear()
        sim_client.reset_simulation()
        self.assertEqual(self.clock.wait_for(1)[0].clock.to_nsec(), 0)
        answer = sim_client.step(5)
        self.assertEqual((answer.step, answer.stamp.to_nsec()), (5, 5000000))
        self.clock.wait_for(6)
        self.assertEqual([message.clock.to_nsec() for message in self.clock.messages()], [0, 1000000, 2000000, 3000000, 4000000, 5000000])

    def test_environment_is_loaded_and_unloaded(self):
        markers = Recorder("/blem_sim/environment_markers", MarkerArray)
        names = lambda: {m.ns.split("::")[0] for m in markers.messages()[-1].markers if m.action == Marker.ADD}
        markers.wait_for(1)
        self.assertEqual(names(), {"ground"})
        # A platform appears in free air beside the robot, and takes the name only once.
        pose = Pose()
        pose.position.x = -0.6
        pose.position.z = 0.3
        answer = sim_client.load_environment(name="platform", uri=CUBE, pose=pose, scale=Vector3(1, 1, 0.5), friction=0.7)
        self.assertTrue(answer.success, answer.status_message)
        markers.wait_for(2)
        self.assertEqual(names(), {"ground", "platform"})
        again = sim_client.load_environment(name="platform", uri=CUBE)
        self.assertFalse(again.success)
        self.assertIn("platform", again.status_message)
        answer = sim_client.unload_environment("platform")
        self.assertTrue(answer.success, answer.status_message)
        markers.wait_for(3)
        self.assertEqual(names(), {"ground"})
        markers.stop()

    def test_unloaded_ground_lets_the_robot_fall(self):
        self.assertAlmostEqual(self.height_after(300), 0.05, delta=0.006)
        self.assertTrue(sim_client.unload_environment("ground").success)
        self.assertLess(self.height_after(300), -0.1)
        answer = sim_client.load_environment(name="ground", uri="package://blem_sim/test/data/ros/ground.off")
        self.assertTrue(answer.success, answer.status_message)
        sim_client.reset_world()
        self.assertAlmostEqual(self.height_after(300), 0.05, delta=0.006)

    def test_bad_environments_are_refused(self):
        with tempfile.NamedTemporaryFile(suffix=".stl") as file:
            file.write(b"this is no mesh")
            file.flush()
            self.assert_refused("nonsense.stl", os.path.basename(file.name), uri=file.name)
        self.assert_refused("missing file", "nowhere.stl", uri="/nowhere.stl")
        self.assert_refused("missing package", "no_such_package", uri="package://no_such_package/a.stl")
        self.assert_refused("unknown key", "frixion", uri=CUBE, settings="{frixion: 1}")
        self.assert_refused("no YAML", "settings", uri=CUBE, settings="{a: [")
        self.assert_refused("no map", "settings", uri=CUBE, settings="7")
        self.assert_refused("negative friction", "friction", uri=CUBE, friction=-1)
        self.assert_refused("NaN pose", "pose", uri=CUBE, pose=self.pose_with_nan())
        self.assert_refused("no uri", "uri")
        answer = sim_client.unload_environment("no_such_thing")
        self.assertFalse(answer.success)
        self.assertIn("no_such_thing", answer.status_message)
        self.assertFalse(sim_client.unload_environment("cube").success)
        sim_client.step(10)

    def pose_with_nan(self):
        pose = Pose()
        pose.position.x = float("nan")
        return pose

    def assert_refused(self, case, word, **request):
        answer = sim_client.load_environment(name="bad", **request)
        self.assertFalse(answer.success, case)
        self.assertIn(word, answer.status_message, case)
        self.assertNotIn("\n", answer.status_message.strip(), case)


if __name__ == "__main__":
    # rospy's own sim time would share the /clock connection and keep only the newest stamp.
    rospy.init_node("services_test", disable_rostime=True)
    rostest.rosrun("blem_sim", "services", ServicesTest)
