#!/usr/bin/python3
"""Every topic arrives, at its rate in simulated time, with what it should hold for a box that stands on a mesh."""
import math
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import WrenchStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu, JointState
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker, MarkerArray

from blem_sim.msg import ContactArray, ContactsState, LinkStates, LoadReport, ModelStates, MotorCurrents, StepReport
from sim_client import Recorder, stamps, wait_until

G = 9.81
ROBOT_MASS = 5.7
HAND_MASS = 0.2
CUBE_HALF, LAYER = 0.1, 0.0025  # [m]


class TopicsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        # By then the box has come to rest.
        wait_until(lambda: rospy.get_time() > 1.5, "the clock to reach 1.5 s")

    def record(self, topic, message_type, count):
        recorder = Recorder(topic, message_type)
        messages = recorder.wait_for(count)
        recorder.stop()
        return messages

    def assert_rate(self, times, rate):
        # The first message may be a latched one.
        times = times[1:]
        self.assertTrue(all(a < b for a, b in zip(times, times[1:])), "stamps go back or repeat")
        self.assertAlmostEqual((len(times) - 1) / (times[-1] - times[0]), rate, delta=0.02 * rate)

    def test_joint_states(self):
        messages = self.record("/joint_states", JointState, 100)
        self.assert_rate(stamps(messages), 100)
        self.assertEqual(messages[-1].name, ["shoulder"])
        self.assertEqual([len(messages[-1].position), len(messages[-1].velocity), len(messages[-1].effort)], [1, 1, 1])
        self.assertAlmostEqual(messages[-1].position[0], 0, delta=0.01)

    def test_wrench_of_the_wrist(self):
        messages = self.record("/wrist_wrench", WrenchStamped, 500)
        self.assert_rate(stamps(messages), 1000)
        self.assertEqual(messages[-1].header.frame_id, "hand")
        # The arm holds the hand up: its weight, along z of the upright hand, whose mass sits above the joint.
        mean = sum(message.wrench.force.z for message in messages) / len(messages)
        self.assertAlmostEqual(mean, HAND_MASS * G, delta=0.01 * HAND_MASS * G)

    def test_imu(self):
        messages = self.record("/imu", Imu, 200)
        self.assert_rate(stamps(messages), 200)
        self.assertEqual(messages[-1].header.frame_id, "base")
        mean = sum(message.linear_acceleration.z for message in messages) / len(messages)
        self.assertAlmostEqual(mean, G, delta=0.01)
        self.assertAlmostEqual(messages[-1].orientation.w, 1, delta=1e-3)
        self.assertAlmostEqual(messages[-1].linear_acceleration_covariance[4], 1e-4, delta=1e-9)
        self.assertAlmostEqual(messages[-1].angular_velocity_covariance[8], 4e-6, delta=1e-12)

    def test_sensors_are_published_while_somebody_listens(self):
        last = self.record("/imu", Imu, 20)[-1]
        later = rospy.get_time() + 1
        wait_until(lambda: rospy.get_time() > later, "a second to pass")
        again = self.record("/imu", Imu, 20)
        # Every publication counts one on, also one that nobody hears: 200 in that second.
        self.assertLess(again[0].header.seq - last.header.seq, 100)
        self.assertEqual(again[-1].header.seq - again[0].header.seq, len(again) - 1)

    def test_contact_sensor(self):
        messages = self.record("/base_contact", ContactsState, 50)
        self.assert_rate(stamps(messages), 50)
        states = messages[-1].states
        self.assertEqual(len(states), 1)
        self.assertEqual(states[0].collision1_name, "arm_on_base::base")
        self.assertTrue(states[0].collision2_name.startswith("ground"))
        self.assertEqual(len(states[0].wrenches), len(states[0].depths))
        self.assertEqual(len(states[0].contact_positions), len(states[0].contact_normals))
        self.assertAlmostEqual(states[0].total_wrench.force.z, ROBOT_MASS * G, delta=0.01 * ROBOT_MASS * G)
        for normal in states[0].contact_normals:
            self.assertAlmostEqual(normal.z, 1, delta=1e-3)

    def test_tilt_and_motor_currents(self):
        tilt = self.record("/tilt", Imu, 20)
        self.assert_rate(stamps(tilt), 20)
        self.assertAlmostEqual(tilt[-1].orientation.w, 1, delta=1e-3)
        currents = self.record("/motors", MotorCurrents, 20)
        self.assert_rate(stamps(currents), 20)
        self.assertEqual(currents[-1].name, ["shoulder"])
        self.assertAlmostEqual(currents[-1].current[0], currents[-1].effort[0] / 2, delta=1e-9)

    def test_odometry(self):
        messages = self.record("/odom", Odometry, 50)
        self.assert_rate(stamps(messages), 50)
        self.assertEqual((messages[-1].header.frame_id, messages[-1].child_frame_id), ("world", "base"))
        self.assertAlmostEqual(messages[-1].pose.pose.position.z, 0.05, delta=0.006)

    def test_transforms(self):
        messages = self.record("/tf", TFMessage, 50)
        frames = {transform.child_frame_id for message in messages for transform in message.transforms}
        self.assertEqual(frames, {"base", "cube"})
        self.assert_rate([message.transforms[0].header.stamp.to_sec() for message in messages], 50)

    def test_contacts(self):
        messages = self.record("/blem_sim/contacts", ContactArray, 30)
        self.assert_rate(stamps(messages), 30)
        contacts = messages[-1].contacts
        self.assertTrue(contacts)
        self.assertTrue(all(contact.within_layer for contact in contacts))
        up = sum(abs(contact.force.z) for contact in contacts)
        self.assertAlmostEqual(up, (ROBOT_MASS + 1.0) * G, delta=0.02 * up)

    def test_contact_markers(self):
        messages = self.record("/blem_sim/contact_markers", MarkerArray, 15)
        markers = messages[-1].markers
        points = [marker for marker in markers if marker.type == Marker.SPHERE_LIST]
        self.assertEqual(len(points), 1)
        self.assertEqual(len(points[0].points), len(points[0].colors))
        self.assertGreaterEqual(len(points[0].points), 8)
        arrows = [marker for marker in markers if marker.type == Marker.ARROW and marker.action == Marker.ADD]
        self.assertTrue(arrows)
        self.assertTrue(all(arrow.points[1].z > arrow.points[0].z for arrow in arrows))

    def test_geometry_markers(self):
        environment = self.record("/blem_sim/environment_markers", MarkerArray, 1)[0].markers
        triangles = [marker for marker in environment if marker.type == Marker.TRIANGLE_LIST and marker.action == Marker.ADD]
        self.assertEqual(sum(len(marker.points) for marker in triangles), 3 * 32)
        self.assertEqual({marker.header.frame_id for marker in triangles}, {"world"})
        objects = self.record("/blem_sim/object_markers", MarkerArray, 1)[0].markers
        self.assertEqual({marker.header.frame_id for marker in objects if marker.action == Marker.ADD}, {"cube"})

    def test_layer_markers(self):
        layers = [marker for marker in self.record("/blem_sim/layer_markers", MarkerArray, 1)[0].markers if marker.action == Marker.ADD]
        self.assertEqual({marker.header.frame_id for marker in layers}, {"base", "arm", "cube"})
        self.assertTrue(all(marker.type == Marker.TRIANGLE_LIST and 0 < marker.color.a < 1 for marker in layers))
        cube = [point for marker in layers if marker.ns.startswith("cube") for point in marker.points]
        self.assertAlmostEqual(max(point.z for point in cube), CUBE_HALF + LAYER, delta=1e-6)

    def test_gazebo_layouts(self):
        """Clients built against gazebo_msgs connect if the sums of the layouts are gazebo_msgs' own."""
        self.assertEqual(ContactsState._md5sum, "acbcb1601a8e525bf72509f18e6f668d")
        self.assertEqual(LinkStates._md5sum, "48c080191eb15c41858319b4d8a609c2")
        self.assertEqual(ModelStates._md5sum, "48c080191eb15c41858319b4d8a609c2")

    def test_states(self):
        links = self.record("/blem_sim/link_states", LinkStates, 2)[-1]
        self.assertTrue({"arm_on_base::base", "arm_on_base::arm", "arm_on_base::hand"} <= set(links.name))
        self.assertEqual((len(links.pose), len(links.twist)), (len(links.name), len(links.name)))
        hand = links.pose[links.name.index("arm_on_base::hand")]
        self.assertAlmostEqual(hand.position.z, 0.05 + 0.06 + 0.3, delta=0.006)
        models = self.record("/blem_sim/model_states", ModelStates, 2)[-1]
        self.assertEqual(set(models.name), {"ground", "arm_on_base", "cube"})
        self.assertAlmostEqual(models.pose[models.name.index("cube")].position.x, 0.6, delta=1e-3)

    def test_step_report(self):
        messages = self.record("/blem_sim/step_report", StepReport, 10)
        self.assert_rate(stamps(messages), 10)
        last = messages[-1]
        self.assertEqual(last.steps, 100)
        self.assertEqual(last.status & StepReport.CONTACT_UNRELIABLE, 0)
        self.assertEqual(len(last.status_names), bin(last.status).count("1"))
        self.assertEqual(len(last.stages), len(last.stage_seconds))
        self.assertGreater(last.reduced_contacts, 0)
        self.assertGreater(last.real_time_factor, 0)
        self.assertTrue(math.isfinite(last.energy))

    def test_load_report(self):
        report = self.record("/blem_sim/load_report", LoadReport, 1)[0]
        ground = [mesh for mesh in report.meshes if mesh.name.startswith("ground")]
        self.assertEqual([mesh.triangles for mesh in ground], [32])
        self.assertEqual([mesh.closed for mesh in ground], [False])

    def test_diagnostics(self):
        messages = self.record("/diagnostics", DiagnosticArray, 3)
        names = {status.name for message in messages for status in message.status}
        self.assertTrue(any(name.endswith("simulation speed") for name in names), names)
        self.assertTrue(any(name.endswith("contacts") for name in names), names)
        keys = {value.key for message in messages for status in message.status for value in status.values}
        self.assertTrue({"real_time_factor", "contacts outside the boundary layers", "energy [J]"} <= keys, keys)


if __name__ == "__main__":
    rospy.init_node("topics_test")
    rostest.rosrun("blem_sim", "topics", TopicsTest)
