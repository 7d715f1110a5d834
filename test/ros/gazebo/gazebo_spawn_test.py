#!/usr/bin/python3
"""Models come and go by Gazebo's services, in a node named gazebo that empty_world.launch starts; the types have Gazebo's md5."""
import os
import shutil
import signal
import subprocess
import sys
import threading
import unittest

import rospkg
import rospy
import rostest
import yaml
from geometry_msgs.msg import Point, Pose
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import Imu, JointState
from tf2_msgs.msg import TFMessage
from trajectory_msgs.msg import JointTrajectoryPoint
from visualization_msgs.msg import MarkerArray

from blem_sim import msg, srv
from blem_sim.msg import LinkStates

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import sim_client
from sim_client import Recorder, service, temporary_folder, wait_until

sim_client.NODE = "/gazebo"
ACTION = "/joint_trajectory_controller/follow_joint_trajectory"
DATA = os.path.join(rospkg.RosPack().get_path("blem_sim"), "test", "data", "ros")
ARM = os.path.join(DATA, "arm_on_base.urdf")
# Sums of gazebo_msgs, as its generated code has them.
SUMS = {
    "ModelState": "9330fd35f2fcd82d457e54bd54e10593", "LinkState": "0818ebbf28ce3a08d48ab1eaa7309ebe",
    "ModelStates": "48c080191eb15c41858319b4d8a609c2", "LinkStates": "48c080191eb15c41858319b4d8a609c2",
    "ODEPhysics": "667d56ddbd547918c32d1934503dc335", "ODEJointProperties": "1b744c32a920af979f53afe2f9c3511f",
    "ContactState": "48c0ffb054b8c444f870cecea1ee50d9", "ContactsState": "acbcb1601a8e525bf72509f18e6f668d",
    "ApplyBodyWrench": "585b9f9618aa0581b207e2f2d90866bc", "ApplyJointEffort": "c0039811b8cc919490b3cff748cdf46b",
    "BodyRequest": "5eade9afe7f232d78005bd0cafeab755", "JointRequest": "0be1351618e1dc030eb7959d9a4902de",
    "DeleteModel": "9ce56b4e9e54616de25d796dc972a262", "SpawnModel": "9ed9c82c96abe1a00c3e8cdaeee24413",
    "GetJointProperties": "7b30be900f50aa21efec4a0ec92d91c9", "SetJointProperties": "15a76e921b1410c698d82782ea5fa370",
    "GetLinkProperties": "0e06a70386d0ee3fb880c02f23fcd821", "SetLinkProperties": "d534ce1b36ee99de0ffa806c3a6348f0",
    "GetLinkState": "09d6c98cce97b35f7ab9bd70300657ab", "SetLinkState": "8a5146eb66ae4d26b0860b08f3f271be",
    "GetModelState": "4c515e936d3319c9610c559c60bfc3d4", "SetModelState": "5b3ab0281d4f5445def017e3a2e4a07b",
    "GetModelProperties": "5717f7bd34ed990fa80e28b3015027a3", "SetModelConfiguration": "10e3139d3b669c40afc057d38956fff7",
    "GetPhysicsProperties": "575a5e74786981b7df2e3afc567693a6", "SetPhysicsProperties": "97e2057080558ce4730434b5fae75c91",
    "GetWorldProperties": "36bb0f2eccf4d8be971410c22818ba3f", "GetLightProperties": "df2cef87e13e2e6990e81e8aaa454c19",
    "SetLightProperties": "e6f13430c57278bb364aca53a1bf5ebf",
}
BALL = """<robot name="ball"><link name="ball"><inertial><mass value="1"/>
<inertia ixx="0.004" iyy="0.004" izz="0.004" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><sphere radius="0.1"/></geometry></collision></link></robot>"""
POST = """<robot name="post"><link name="world"/><link name="bar"><inertial><origin xyz="0.5 0 0"/><mass value="2"/>
<inertia ixx="0.01" iyy="0.02" izz="0.03" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="swing" type="continuous"><parent link="world"/><child link="bar"/><axis xyz="0 1 0"/></joint></robot>"""


def spawn(name, xml, name_space="", x=0.0, y=0.0, z=1.0, frame=""):
    return service("spawn_urdf_model", srv.SpawnModel)(name, xml, name_space, Pose(position=Point(x, y, z)), frame)


def delete(name):
    return service("delete_model", srv.DeleteModel)(name)


def place(model, frame=""):
    answer = service("get_model_state", srv.GetModelState)(model, frame)
    assert answer.success, answer.status_message
    return answer.pose.position


def models():
    return service("get_world_properties", srv.GetWorldProperties)().model_names


def published():
    return set(topic for topic, _ in rospy.get_published_topics())


class GazeboSpawnTest(unittest.TestCase):
    def setUp(self):
        with open(ARM) as stream:
            self.arm = stream.read()
        self.assertEqual(models(), ["ground", "arm_on_base", "cube"])
        self.addCleanup(lambda: [delete(name) for name in models() if name not in ("ground", "arm_on_base", "cube")])

    def test_types_have_gazebos_sums(self):
        for name, md5 in SUMS.items():
            self.assertEqual((getattr(msg, name, None) or getattr(srv, name))._md5sum, md5, name)

    def test_robot_gets_all_that_a_configured_one_has(self):
        answer = spawn("second", self.arm, "second", x=2)
        self.assertTrue(answer.success, answer.status_message)
        self.assertIn("free", answer.status_message)
        joints, links, frames = Recorder("/second/joint_states", JointState), Recorder("/gazebo/link_states", LinkStates), Recorder("/tf", TFMessage)
        self.addCleanup(lambda: [recorder.stop() for recorder in (joints, links, frames)])
        command = rospy.Publisher("/second/joint_command", JointState, queue_size=1)
        wait_until(lambda: command.get_num_connections() and links.connected(), "the node to listen")
        command.publish(JointState(name=["shoulder"], effort=[4.0]))
        rospy.rostime.wallsleep(0.3)
        sim_client.step(200)
        wait_until(lambda: joints.messages() and links.messages() and frames.messages(), "messages")
        self.assertEqual(joints.messages()[-1].name, ["shoulder"])
        self.assertGreater(joints.messages()[-1].position[0], 0.05)
        self.assertIn("second::hand", links.messages()[-1].name)
        self.assertIn(2, [round(transform.transform.translation.x) for transform in frames.messages()[-1].transforms])
        self.assertTrue({"/second/odom", "/second/joint_states"} <= published())
        self.assertAlmostEqual(place("second", "cube").x, 1.4, delta=0.2)
        self.assertTrue(delete("second").success)
        self.assertFalse([topic for topic in published() if topic.startswith("/second/odom")])
        self.assertEqual(models(), ["ground", "arm_on_base", "cube"])
        sim_client.step(10)
        self.assertFalse(service("get_model_state", srv.GetModelState)("second", "").success)

    def test_robots_of_one_namespace_take_the_commands_of_their_own_joints(self):
        log = Recorder("/rosout", Log)
        self.addCleanup(log.stop)
        wait_until(log.connected, "the log")
        self.assertTrue(spawn("post", POST, z=4).success)
        command = rospy.Publisher("/joint_command", JointState, queue_size=1)
        wait_until(lambda: command.get_num_connections() > 0, "the node to listen")
        for joint, effort in (("swing", -100.0), ("shoulder", 4.0)):
            command.publish(JointState(name=[joint], effort=[effort]))
            rospy.rostime.wallsleep(sim_client.SETTLE)
            sim_client.step(20)
            self.assertGreater(service("get_joint_properties", srv.GetJointProperties)(joint).rate[0] * effort, 0, joint)
        self.assertFalse([m.msg for m in log.messages() if "command refused" in m.msg])
        command.publish(JointState(name=["swong"], effort=[1.0]))
        wait_until(lambda: [m.msg for m in log.messages() if "command refused" in m.msg and "swong" in m.msg], "a line about a joint of neither")

    def test_a_link_without_gravity_is_told_as_one(self):
        weightless = BALL.replace("</robot>", '<gazebo reference="ball"><turnGravityOff>true</turnGravityOff></gazebo></robot>')
        for xml, acts in ((BALL, True), (weightless, False)):
            self.assertTrue(spawn("floater", xml, x=3).success)
            found = service("get_link_properties", srv.GetLinkProperties)("floater::ball")
            self.assertEqual(found.gravity_mode, acts)
            request = dict(link_name="floater::ball", com=found.com, mass=2, **{name: getattr(found, name) for name in ("ixx", "iyy", "izz")})
            put = service("set_link_properties", srv.SetLinkProperties)
            self.assertTrue(put(gravity_mode=acts, **request).success, "what get_link_properties told is taken")
            self.assertTrue(delete("floater").success)

    def test_joints_with_a_transmission_hold(self):
        transmission = """<transmission name="drive"><type>transmission_interface/SimpleTransmission</type>
          <joint name="shoulder"/><actuator name="motor"><mechanicalReduction>1</mechanicalReduction></actuator></transmission>"""
        base = """<link name="world"/><joint name="foot" type="fixed"><parent link="world"/><child link="base"/></joint>"""
        for added, holds in ((base, False), (base + transmission, True)):
            answer = spawn("second", self.arm.replace("</robot>", added + "</robot>"), "second", x=2)
            self.assertTrue(answer.success, answer.status_message)
            self.assertIn("computed gains" if holds else "move freely", answer.status_message)
            configured = service("set_model_configuration", srv.SetModelConfiguration)("second", "", ["shoulder"], [0.5])
            self.assertTrue(configured.success, configured.status_message)
            sim_client.step(200)
            sunk = abs(service("get_joint_properties", srv.GetJointProperties)("second::shoulder").position[0] - 0.5)
            self.assertEqual(sunk < 2e-3, holds, sunk)
            self.assertTrue(delete("second").success)

    def test_clashes_and_nonsense_are_refused(self):
        before = models()
        for word, answer in (("taken", spawn("cube", BALL)), ("robot_namespace", spawn("second", self.arm)), ("model_xml", spawn("a", "")),
                             ("model_name", spawn("", BALL)), ("::", spawn("a::b", BALL)), ("a", spawn("a", "<robot")),
                             ("robot_namespace", spawn("a", self.arm, "no name!")), ("robot_namespace", spawn("a", self.arm, "~a")), ("initial_pose", spawn("a", BALL, x=float("nan"))),
                             ("reference_frame", spawn("a", BALL, frame="nowhere")), ("nobody", delete("nobody"))):
            self.assertFalse(answer.success, word)
            self.assertIn(word, answer.status_message)
            self.assertNotIn("\n", answer.status_message)
        long_name = service("get_model_properties", srv.GetModelProperties)("x" * 1000000 + "\n")
        self.assertFalse(long_name.success)
        self.assertLess(len(long_name.status_message), 1000)
        self.assertEqual(models(), before)
        sim_client.step(10)

    def test_topic_of_the_node_is_refused_and_leaves_nothing(self):
        before = models()
        block = """<gazebo reference="hand"><sensor name="eye" type="imu"><plugin name="p" filename="libgazebo_ros_imu_sensor.so">
          <topicName>%s</topicName></plugin></sensor></gazebo></robot>"""
        answer = spawn("second", self.arm.replace("</robot>", block % "/clock"), "second", x=2)
        self.assertFalse(answer.success)
        self.assertIn("/clock", answer.status_message)
        self.assertEqual(models(), before)
        self.assertFalse({"/second/odom", "/second/joint_states"} & published())
        joints = Recorder("/joint_states", JointState)
        self.addCleanup(joints.stop)
        wait_until(joints.connected, "the configured robot's joint states")
        sim_client.step(100)
        joints.wait_for(5)

    def test_frames_of_sensors_go_with_their_robot(self):
        block = """<gazebo reference="hand"><sensor name="eye" type="imu"><pose>0 0 0.1 0 0 0</pose>
          <plugin name="p" filename="libgazebo_ros_imu_sensor.so"/></sensor></gazebo></robot>"""
        answer = spawn("second", self.arm.replace("</robot>", block), "second", x=2)
        self.assertTrue(answer.success, answer.status_message)
        frames = Recorder("/tf_static", TFMessage)
        self.assertIn("eye_frame", [transform.child_frame_id.split("/")[-1] for transform in frames.wait_for(1)[0].transforms])
        frames.stop()
        self.assertTrue(delete("second").success)
        late = Recorder("/tf_static", TFMessage)
        self.addCleanup(late.stop)
        rospy.rostime.wallsleep(sim_client.SETTLE)
        self.assertEqual(late.messages(), [])

    def test_the_root_and_no_namespace_are_one(self):
        answer = spawn("post", POST, "/", x=-2, z=2)
        self.assertTrue(answer.success, answer.status_message)
        goals = rospy.Publisher(ACTION + "/goal", msg.FollowJointTrajectoryActionGoal, queue_size=1)
        results = Recorder(ACTION + "/result", msg.FollowJointTrajectoryActionResult)
        self.addCleanup(results.stop)
        wait_until(lambda: goals.get_num_connections() and results.connected(), "the action")
        goal = msg.FollowJointTrajectoryActionGoal()
        goal.goal.trajectory.joint_names = ["shoulder"]
        goal.goal.trajectory.points = [JointTrajectoryPoint(positions=[0.1], time_from_start=rospy.Duration(0.1))]
        goals.publish(goal)
        rospy.rostime.wallsleep(sim_client.SETTLE)
        self.assertEqual([result.result.error_string for result in results.messages()], [])  # no second robot's controller refuses it

    def test_one_body_is_an_object(self):
        markers = Recorder("/gazebo/object_markers", MarkerArray)
        self.addCleanup(markers.stop)
        arrows = Recorder("/gazebo/contact_markers", MarkerArray)
        self.addCleanup(arrows.stop)
        wait_until(arrows.connected, "contact markers")
        self.assertTrue(spawn("ball", BALL, x=0.1, z=0.5, frame="cube").success)
        self.assertAlmostEqual(place("ball").x, 0.7, delta=1e-3)
        wait_until(lambda: markers.messages() and "ball" in {marker.ns.split("::")[0] for marker in markers.messages()[-1].markers}, "its marker")
        service("set_model_state", srv.SetModelState)(msg.ModelState("ball", Pose(position=Point(-0.5, 0.5, 0.4)), msg.ModelState().twist, ""))
        sim_client.step(2000)
        self.assertAlmostEqual(place("ball").z, 0.1, delta=0.01)
        self.assertIn("forces", {marker.ns for message in arrows.messages() for marker in message.markers})
        sim_client.reset_world()
        self.assertAlmostEqual(place("ball", "cube").z, 0.5, delta=1e-3)

    def test_root_link_world_is_fixed(self):
        self.assertTrue(spawn("post", POST, "post", x=-2, z=2).success)
        sim_client.step(200)
        joint = service("get_joint_properties", srv.GetJointProperties)("post::swing")
        self.assertEqual(joint.type, 1)
        self.assertGreater(joint.position[0], 0.1)
        self.assertAlmostEqual(place("post").z, 2)
        moved = service("set_model_state", srv.SetModelState)(msg.ModelState("post", Pose(), msg.ModelState().twist, ""))
        self.assertIn("fixed", moved.status_message)

    def test_slots_are_used_again(self):
        sim_client.step(1)
        for _ in range(10):
            self.assertTrue(spawn("ball", BALL, x=-1).success)
            self.assertTrue(spawn("second", self.arm, "second", x=2).success)
            self.assertTrue(delete("ball").success)
            loaded = sim_client.load_environment(name="platform", uri="package://blem_sim/test/data/ros/cube.off", pose=Pose(position=Point(5, 6, 7)))
            self.assertTrue(loaded.success, loaded.status_message)
            sim_client.step(3)
            self.assertEqual((place("platform").x, place("platform").z), (5, 7))
            self.assertTrue(delete("second").success)
            self.assertTrue(delete("platform").success)
            sim_client.step(3)
        self.assertAlmostEqual(place("cube").x, 0.6, delta=1e-3)
        self.assertEqual(models(), ["ground", "arm_on_base", "cube"])

    def test_what_is_not_supported_says_so(self):
        sdf = service("spawn_sdf_model", srv.SpawnModel)("a", "<sdf/>", "", Pose(), "")
        self.assertFalse(sdf.success)
        self.assertIn("URDF", sdf.status_message)
        for name, kind in (("get_light_properties", srv.GetLightProperties), ("set_light_properties", srv.SetLightProperties)):
            answer = service(name, kind)(light_name="sun")
            self.assertFalse(answer.success)
            self.assertIn("light", answer.status_message)

    def test_script_spawns(self):
        flags = ["-urdf", "-file", ARM, "-model", "scripted", "-x", "3", "-z", "0.5", "-Y", "0.3", "-robot_namespace", "scripted", "-J", "shoulder", "0.25"]
        subprocess.check_call(["rosrun", "blem_sim", "spawn_model"] + flags)
        self.assertAlmostEqual(place("scripted").x, 3, delta=1e-6)
        self.assertAlmostEqual(service("get_joint_properties", srv.GetJointProperties)("scripted::shoulder").position[0], 0.25, delta=1e-6)
        rospy.set_param("/ball_description", BALL)
        subprocess.check_call(["rosrun", "blem_sim", "spawn_model", "-urdf", "-param", "ball_description", "-model", "ball", "-z", "2"])
        self.assertAlmostEqual(place("ball").z, 2)
        again = ["rosrun", "blem_sim", "spawn_model", "-urdf", "-param", "ball_description", "-model", "ball"]
        self.assertNotEqual(subprocess.call(again), 0)
        odd = ["-urdf", "-file", ARM, "-model", "odd", "-J", "shoulder", "half"]
        refused = subprocess.run(["rosrun", "blem_sim", "spawn_model"] + odd, stderr=subprocess.PIPE, universal_newlines=True)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("position of shoulder: 'half' is no number", refused.stderr)
        self.assertNotIn("odd", models())

    def test_launch_file_takes_yaml_by_any_of_its_endings(self):
        folder = temporary_folder(self)
        for ending in ("yaml", "yml", "YAML"):
            world = os.path.join(folder, "world." + ending)
            shutil.copy(os.path.join(DATA, "world.yaml"), world)
            command = ["roslaunch", "--dump-params", "blem_sim", "empty_world.launch", "world_name:=" + world]
            parameters = yaml.safe_load(subprocess.check_output(command))
            self.assertEqual(parameters["/gazebo/config_file"], world)
            self.assertIn("/gazebo/objects", parameters)

    def script(self, *flags, **options):
        return subprocess.run(["rosrun", "blem_sim", "spawn_model"] + list(flags), stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)

    def test_script_takes_negative_numbers_with_exponents(self):
        done = self.script("-urdf", "-file", ARM, "-model", "scripted", "-robot_namespace", "scripted", "-x", "-2.5e-1", "-J", "shoulder", "-2e-1")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertAlmostEqual(place("scripted").x, -0.25, delta=1e-6)
        self.assertAlmostEqual(service("get_joint_properties", srv.GetJointProperties)("scripted::shoulder").position[0], -0.2, delta=1e-6)

    def test_script_refuses_in_words(self):
        rospy.set_param("/number", 5)
        rospy.set_param("/map", {"a": 1})
        for flags, word in ((("-param", "number"), "/number is no text"), (("-param", "map"), "/map is no text"), (("-param", ""), "is no text"),
                            (("-stdin",), "standard input"), (("-file", ARM, "-R", "inf"), "'inf'"), (("-file", ARM, "-J", "shoulder", "nan"), "'nan'")):
            done = self.script("-model", "odd", *flags, input=b"\xff\xfe")
            self.assertNotEqual(done.returncode, 0)
            self.assertIn(word, done.stderr.decode())
            self.assertNotIn("Traceback", done.stderr.decode())
        self.assertNotIn("odd", models())

    def test_script_ends_though_its_node_is_gone(self):
        services = [rospy.Service("/fleeting/" + name, kind, lambda request: (True, ""))
                    for name, kind in (("spawn_urdf_model", srv.SpawnModel), ("delete_model", srv.DeleteModel))]
        command = ["rosrun", "blem_sim", "spawn_model", "-urdf", "-file", ARM, "-model", "odd", "-gazebo_namespace", "/fleeting", "-b"]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, universal_newlines=True)
        self.addCleanup(lambda: process.poll() is None and process.kill())
        self.assertIn("spawn_model:", process.stdout.readline())
        for offered in services:
            offered.shutdown()
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=20), 0)

    def test_script_takes_a_model_back_whose_joints_are_refused(self):
        done = self.script("-urdf", "-file", ARM, "-model", "odd", "-robot_namespace", "odd", "-J", "elbow", "1")
        self.assertEqual(done.returncode, 1)
        self.assertIn("'elbow'", done.stderr.decode())
        self.assertNotIn("odd", models())

    def test_script_says_what_it_waits_for(self):
        for flags, word in ((("-gazebo_namespace", "/nowhere"), "/nowhere"), (("-wait", "nobody"), "nobody")):
            command = ["rosrun", "blem_sim", "spawn_model", "-urdf", "-file", ARM, "-model", "odd"] + list(flags)
            process = subprocess.Popen(command, stderr=subprocess.PIPE, universal_newlines=True)
            self.addCleanup(lambda: process.poll() is None and process.kill())
            stopped = threading.Timer(20, process.kill)
            stopped.start()
            line = process.stderr.readline()
            self.assertTrue("waits for" in line and word in line, line)
            process.kill()
            stopped.cancel()

    def test_z_configured_robot_goes_with_its_sensors(self):
        imu = Recorder("/imu", Imu)
        self.addCleanup(imu.stop)
        wait_until(imu.connected, "the IMU's topic")
        self.assertTrue(spawn("second", self.arm, "second", x=2).success)
        sim_client.step(20)
        imu.wait_for(4)
        self.assertTrue(delete("arm_on_base").success)
        sim_client.step(20)
        self.assertEqual(models(), ["ground", "cube", "second"])
        self.assertFalse({"/imu", "/joint_states", "/motors"} & published())
        self.assertTrue(spawn("arm_on_base", self.arm, "").success)
        sim_client.step(20)
        self.assertIn("/joint_states", published())


if __name__ == "__main__":
    rospy.init_node("gazebo_spawn_test", disable_rostime=True)
    rostest.rosrun("blem_sim", "gazebo_spawn", GazeboSpawnTest)
