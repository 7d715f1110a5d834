#!/usr/bin/python3
"""Gazebo's services that read and set the state: models, links, joints, forces, physics, saved states."""
import math
import os
import sys
import unittest

import rospy
import rostest
from geometry_msgs.msg import Point, Pose, Quaternion, Twist, Vector3, Wrench

from blem_sim import srv
from blem_sim.msg import LinkState, ModelState, ODEJointProperties

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import sim_client
from sim_client import service, temporary_folder, wait_until

NAN = float("nan")
GRAVITY = Vector3(0, 0, -9.81)


def ask(name, **request):
    """Answer of a service, whose type has the service's name in capitals."""
    types = {"clear_body_wrenches": srv.BodyRequest, "clear_joint_forces": srv.JointRequest}
    return service(name, types.get(name) or getattr(srv, name.title().replace("_", "")))(**request)


def xyz(v):
    return (v.x, v.y, v.z)


class GazeboServicesTest(unittest.TestCase):
    def setUp(self):
        sim_client.service("pause_physics", sim_client.Empty)()
        self.done("set_physics_properties", time_step=0.001, max_update_rate=1000, gravity=GRAVITY)
        sim_client.reset_world()

    def done(self, name, **request):
        answer = ask(name, **request)
        self.assertTrue(answer.success, answer.status_message)
        return answer

    def refused(self, word, name, **request):
        answer = ask(name, **request)
        self.assertFalse(answer.success, name)
        self.assertIn(word, answer.status_message)
        self.assertNotIn("\n", answer.status_message)

    def float_freely(self):
        self.done("set_physics_properties", time_step=0.001, max_update_rate=1000, gravity=Vector3())

    def cube(self, frame=""):
        return self.done("get_model_state", model_name="cube", relative_entity_name=frame)

    def put_cube(self, x=0.0, y=2.0, z=1.0, orientation=Quaternion(), twist=None, frame="world"):
        self.done("set_model_state", model_state=ModelState("cube", Pose(Point(x, y, z), orientation), twist or Twist(), frame))

    def shoulder(self):
        return self.done("get_joint_properties", joint_name="shoulder").position[0]

    def near(self, seen, expected, delta=1e-9):
        for a, b in zip(seen, expected):
            self.assertAlmostEqual(a, b, delta=delta)

    def test_world_and_models(self):
        world = self.done("get_world_properties")
        self.assertEqual(world.model_names, ["ground", "arm_on_base", "cube"])
        self.assertFalse(world.rendering_enabled)
        self.assertAlmostEqual(world.sim_time, sim_client.step(0).stamp.to_sec(), delta=1e-9)
        robot = self.done("get_model_properties", model_name="arm_on_base")
        self.assertEqual((robot.body_names, robot.joint_names), (["base", "arm", "hand"], ["shoulder"]))
        self.assertEqual((robot.canonical_body_name, robot.is_static), ("base", False))
        self.assertTrue(self.done("get_model_properties", model_name="ground").is_static)
        self.refused("arm_on_base", "get_model_properties", model_name="arm_on_bse")

    def test_states_in_frames(self):
        self.near(xyz(self.cube().pose.position), (0.6, 0, 0.103), 1e-6)
        self.assertEqual(self.cube().header.frame_id, "world")
        self.near(xyz(self.cube("arm_on_base").pose.position), (0.6, 0, 0.0505), 1e-6)
        hand = self.done("get_link_state", link_name="hand").link_state
        scoped = self.done("get_link_state", link_name="arm_on_base::hand", reference_frame="map").link_state
        self.assertEqual(hand.pose, scoped.pose)
        self.near(xyz(hand.pose.position), (0, 0, 0.0525 + 0.36), 1e-6)
        own = self.done("get_link_state", link_name="hand", reference_frame="arm_on_base::hand").link_state
        self.near(xyz(own.pose.position), (0, 0, 0))
        self.refused("hand", "get_link_state", link_name="arm_on_base::hnd")
        self.refused("cube", "get_model_state", model_name="cube", relative_entity_name="cub")

    def test_model_is_put_and_falls(self):
        turn = Quaternion(0, 0, math.sin(math.pi / 4), math.cos(math.pi / 4))
        self.put_cube(orientation=turn)
        self.put_cube(x=1, y=0, z=0, twist=Twist(linear=Vector3(2, 0, 0)), frame="cube")
        state = self.cube()
        self.near(xyz(state.pose.position), (0, 3, 1))
        self.near(xyz(state.twist.linear), (0, 2, 0))
        sim_client.step(100)
        state = self.cube()
        self.near(xyz(state.pose.position), (0, 3.2, 1 - 9.81 * 0.001 ** 2 * 100 * 101 / 2), 1e-4)

    def test_links_take_their_model_along(self):
        self.done("set_model_configuration", model_name="arm_on_base", joint_names=["arm_on_base::shoulder"], joint_positions=[0.4])
        self.assertAlmostEqual(self.shoulder(), 0.4, delta=1e-9)
        before = self.done("get_link_state", link_name="hand", reference_frame="base").link_state.pose.position
        self.done("set_link_state", link_state=LinkState("hand", Pose(Point(1, 2, 3), Quaternion()), Twist(angular=Vector3(0, 0, 1)), ""))
        self.near(xyz(self.done("get_link_state", link_name="hand").link_state.pose.position), (1, 2, 3))
        after = self.done("get_link_state", link_name="hand", reference_frame="base").link_state.pose.position
        self.near(xyz(before), xyz(after))
        joint = self.done("get_joint_properties", joint_name="arm_on_base::shoulder")
        self.near((joint.position[0], joint.rate[0]), (0.4, 0))
        sim_client.step(1)
        self.assertAlmostEqual(self.shoulder(), 0.4, delta=1e-3)

    def test_configuration_is_held_within_limits(self):
        set_joints = lambda names, positions: ask("set_model_configuration", model_name="arm_on_base", joint_names=names, joint_positions=positions)
        self.assertTrue(set_joints(["shoulder"], [9]).success)
        self.assertAlmostEqual(self.shoulder(), 1.5, delta=1e-9)
        self.assertTrue(set_joints(["shoulder"], [0.5]).success)
        sim_client.step(1000)
        self.assertAlmostEqual(self.shoulder(), 0.5, delta=0.02)
        for names, positions in ((["shoulder"], []), (["shoulder"], [NAN]), (["elbow"], [0]), (["shoulder", "shoulder"], [0, 0])):
            self.assertFalse(set_joints(names, positions).success, names)
        self.refused("no joints", "set_model_configuration", model_name="cube", joint_names=["a"], joint_positions=[0])
        sim_client.reset_world()
        self.assertAlmostEqual(self.shoulder(), 0, delta=1e-9)

    def test_topics_set_states(self):
        models = rospy.Publisher("/blem_sim/set_model_state", ModelState, queue_size=1)
        links = rospy.Publisher("/blem_sim/set_link_state", LinkState, queue_size=1)
        wait_until(lambda: models.get_num_connections() and links.get_num_connections(), "the node to listen")
        models.publish(ModelState("nobody", Pose(), Twist(), ""))
        models.publish(ModelState("cube", Pose(position=Point(3, 0, 1)), Twist(), ""))
        wait_until(lambda: abs(self.cube().pose.position.x - 3) < 1e-9, "the cube at x = 3")
        links.publish(LinkState("cube::link", Pose(position=Point(4, 0, 1)), Twist(), "world"))
        wait_until(lambda: abs(self.cube().pose.position.x - 4) < 1e-9, "the cube at x = 4")

    def test_hostile_states_change_nothing(self):
        before = self.cube().pose
        for pose in (Pose(position=Point(NAN, 0, 0)), Pose(position=Point(1e300, 0, 0)), Pose(orientation=Quaternion(NAN, 0, 0, 1))):
            self.assertFalse(ask("set_model_state", model_state=ModelState("cube", pose, Twist(), "")).success)
        self.refused("twist", "set_model_state", model_state=ModelState("cube", before, Twist(linear=Vector3(NAN, 0, 0)), ""))
        self.refused("ground", "set_model_state", model_state=ModelState("ground", Pose(position=Point(0, 0, 1)), Twist(), ""))
        self.refused("nowhere", "set_model_state", model_state=ModelState("cube", before, Twist(), "nowhere"))
        self.refused("finite", "apply_body_wrench", body_name="cube::link", wrench=Wrench(force=Vector3(NAN, 0, 0)), duration=rospy.Duration(1))
        self.refused("effort", "apply_joint_effort", joint_name="shoulder", effort=float("inf"), duration=rospy.Duration(1))
        self.assertEqual(self.cube().pose, before)

    def push(self, force, duration=0.1, **request):
        request.setdefault("body_name", "cube::link")
        self.done("apply_body_wrench", wrench=Wrench(force=Vector3(*force)), duration=rospy.Duration(duration), **request)

    def test_wrench_acts_for_its_time(self):
        self.float_freely()
        self.put_cube()
        self.push((2, 0, 0))
        sim_client.step(300)
        self.near(xyz(self.cube().twist.linear), (0.2, 0, 0))
        self.near(xyz(self.cube().twist.angular), (0, 0, 0))
        self.push((2, 0, 0), start_time=rospy.Time.from_sec(self.done("get_world_properties").sim_time + 0.05))
        sim_client.step(50)
        self.near(xyz(self.cube().twist.linear), (0.2, 0, 0))
        sim_client.step(1)
        self.near(xyz(self.cube().twist.linear), (0.202, 0, 0))
        ask("clear_body_wrenches", body_name="cube::link")
        sim_client.step(10)
        self.near(xyz(self.cube().twist.linear), (0.202, 0, 0))

    def test_wrench_for_ever_ends_when_it_is_cleared_or_reset(self):
        self.float_freely()
        for end in (lambda: ask("clear_body_wrenches", body_name="link"), lambda: self.done("reset_model", model_name="cube")):
            self.put_cube()
            self.push((0, 1, 0), duration=-1)
            sim_client.step(500)
            self.near(xyz(self.cube().twist.linear), (0, 0.5, 0), 1e-9)
            end()
            speed = self.cube().twist.linear.y
            sim_client.step(10)
            self.assertAlmostEqual(self.cube().twist.linear.y, speed, delta=1e-9)

    def test_wrench_in_axes_and_at_a_point(self):
        self.float_freely()
        self.put_cube(orientation=Quaternion(0, 0, math.sin(math.pi / 4), math.cos(math.pi / 4)))
        self.push((2, 0, 0), reference_frame="cube")
        sim_client.step(100)
        self.near(xyz(self.cube().twist.linear), (0, 0.2, 0))
        self.put_cube()
        self.push((1, 0, 0), duration=0.001, reference_frame="cube", reference_point=Point(0, 0.1, 0))
        sim_client.step(1)
        inertia = self.done("get_link_properties", link_name="cube::link").izz
        self.near(xyz(self.cube().twist.angular), (0, 0, -0.1 * 0.001 / inertia), 1e-9)

    def test_effort_acts_beside_the_motor(self):
        self.done("apply_joint_effort", joint_name="shoulder", effort=5.0, duration=rospy.Duration(-1))
        sim_client.step(1500)
        self.assertAlmostEqual(self.shoulder(), 0.051, delta=0.004)
        ask("clear_joint_forces", joint_name="shoulder")
        sim_client.step(1500)
        self.assertAlmostEqual(self.shoulder(), 0, delta=0.004)

    def test_physics_are_set(self):
        start = sim_client.step(7).stamp
        answer = self.done("set_physics_properties", time_step=0.002, max_update_rate=250, gravity=Vector3(0, 0, -1.6))
        physics = self.done("get_physics_properties")
        self.assertEqual((physics.time_step, physics.max_update_rate, physics.gravity.z, physics.pause), (0.002, 250, -1.6, True))
        self.put_cube()
        self.assertAlmostEqual((sim_client.step(50).stamp - start).to_sec(), 0.1, delta=1e-9)
        self.assertAlmostEqual(self.cube().twist.linear.z, -0.16, delta=1e-9)
        physics.ode_config.sor_pgs_w = 1.3
        answer = ask("set_physics_properties", time_step=0.001, max_update_rate=1000, gravity=GRAVITY, ode_config=physics.ode_config)
        self.assertTrue(answer.success)
        self.assertIn("sor_pgs_w", answer.status_message)
        for step, gravity in ((0, GRAVITY), (NAN, GRAVITY), (1e9, GRAVITY), (0.001, Vector3(NAN, 0, 0))):
            self.assertFalse(ask("set_physics_properties", time_step=step, max_update_rate=0, gravity=gravity).success)
        self.assertEqual(self.done("get_physics_properties").time_step, 0.001)

    def test_link_properties_are_set(self):
        self.float_freely()
        for link, mass in (("cube::link", 1.0), ("arm_on_base::base", 5.0)):
            found = self.done("get_link_properties", link_name=link)
            self.assertAlmostEqual(found.mass, mass)
            names = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
            request = dict(link_name=link, com=found.com, gravity_mode=True, **{name: getattr(found, name) for name in names})
            self.done("set_link_properties", mass=2 * mass, **request)
            self.assertAlmostEqual(self.done("get_link_properties", link_name=link).mass, 2 * mass)
            if link == "cube::link":
                self.put_cube()
                self.push((2, 0, 0))
                sim_client.step(100)
                self.near(xyz(self.cube().twist.linear), (0.1, 0, 0))
            self.refused("mass", "set_link_properties", mass=-1, **request)
            self.done("set_link_properties", mass=mass, **request)

    def test_gravity_of_a_link_is_switched(self):
        names = ("mass", "ixx", "ixy", "ixz", "iyy", "iyz", "izz")
        found = self.done("get_link_properties", link_name="cube::link")
        request = dict(link_name="cube::link", com=found.com, **{name: getattr(found, name) for name in names})
        fall = 9.81 * 0.1
        for acts, speed in ((False, 0), (True, -fall)):
            self.put_cube()
            self.done("set_link_properties", gravity_mode=acts, **request)
            self.assertEqual(self.done("get_link_properties", link_name="cube::link").gravity_mode, acts)
            sim_client.step(100)
            self.near(xyz(self.cube().twist.linear), (0, 0, speed))

    def test_centre_of_mass_is_moved(self):
        """A link of a chain gets another centre of mass where it stands, and joints keep their places."""
        found = self.done("get_link_properties", link_name="arm")
        names = ("mass", "ixx", "ixy", "ixz", "iyy", "iyz", "izz")
        request = dict(link_name="arm", gravity_mode=True, **{name: getattr(found, name) for name in names})
        before = self.done("get_link_state", link_name="arm").link_state.pose.position
        self.done("set_link_properties", com=Pose(position=Point(0.02, 0, 0.1)), **request)
        self.near(xyz(before), xyz(self.done("get_link_state", link_name="arm").link_state.pose.position))
        self.near(xyz(self.done("get_link_properties", link_name="arm").com.position), (0.02, 0, 0.1))
        sim_client.step(1000)
        self.assertAlmostEqual(self.shoulder(), 0.001, delta=0.004)
        self.done("set_link_properties", com=found.com, **request)

    def test_joint_properties_are_set(self):
        joint = self.done("get_joint_properties", joint_name="shoulder")
        self.assertEqual((joint.type, list(joint.damping)), (0, [0.0]))
        self.done("set_joint_properties", joint_name="shoulder", ode_joint_config=ODEJointProperties(damping=[0.3], loStop=[-0.1], hiStop=[0.1]))
        self.assertEqual(list(self.done("get_joint_properties", joint_name="shoulder").damping), [0.3])
        self.done("apply_joint_effort", joint_name="shoulder", effort=25.0, duration=rospy.Duration(-1))
        sim_client.step(1000)
        self.assertAlmostEqual(self.shoulder(), 0.1, delta=0.002)
        self.done("reset_model", model_name="arm_on_base")
        refuse = lambda word, **config: self.refused(word, "set_joint_properties", joint_name="shoulder", ode_joint_config=ODEJointProperties(**config))
        refuse("loStop", loStop=[1], hiStop=[-1])
        refuse("stands at", loStop=[0.5], hiStop=[1])
        refuse("damping", damping=[-1])
        refuse("2 values", damping=[1, 2])
        answer = self.done("set_joint_properties", joint_name="shoulder", ode_joint_config=ODEJointProperties(damping=[0], loStop=[-1.5], hiStop=[1.5], fmax=[1]))
        self.assertIn("fmax", answer.status_message)

    def test_saved_state_goes_on_with_the_same_bits(self):
        folder = temporary_folder(self)
        file = os.path.join(folder, "a.state")
        hash_now = lambda: self.done("save_state", file=os.path.join(folder, "now.state")).state_hash
        sim_client.step(100)
        self.push((3, 1, 0), duration=0.15)
        self.done("apply_joint_effort", joint_name="shoulder", effort=5.0, duration=rospy.Duration(-1))
        saved = self.done("save_state", file=file)
        sim_client.step(300)
        end = hash_now()
        self.assertNotEqual(end, saved.state_hash)
        restored = self.done("restore_state", file=file)
        self.assertEqual((restored.state_hash, restored.step), (saved.state_hash, saved.step))
        sim_client.step(300)
        self.assertEqual(hash_now(), end)
        self.refused("file_roots", "save_state", file="/var/tmp/a.state")
        self.refused("file_roots", "restore_state", file=folder + "/../../etc/passwd")
        with open(file, "r+b") as stream:
            stream.truncate(1000)
        self.refused("a.state", "restore_state", file=file)
        self.assertEqual(hash_now(), end)

    def test_one_model_is_reset(self):
        self.put_cube()
        self.done("set_model_configuration", model_name="arm_on_base", joint_names=["shoulder"], joint_positions=[0.5])
        self.done("reset_model", model_name="cube")
        self.near(xyz(self.cube().pose.position), (0.6, 0, 0.103), 1e-6)
        self.assertAlmostEqual(self.shoulder(), 0.5, delta=1e-9)
        self.done("reset_model", model_name="arm_on_base")
        self.assertAlmostEqual(self.shoulder(), 0, delta=1e-9)
        self.refused("nobody", "reset_model", model_name="nobody")


if __name__ == "__main__":
    rospy.init_node("gazebo_services_test", disable_rostime=True)
    rostest.rosrun("blem_sim", "gazebo_services", GazeboServicesTest)
