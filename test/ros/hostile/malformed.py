"""Messages and requests that are wrong, by kind. All numbers of a kind come from one random.Random."""
import copy
import io
import math
import struct

import rospy
from geometry_msgs.msg import Point, Pose, Quaternion, Twist, Vector3, Wrench
from sensor_msgs.msg import JointState, PointCloud2, PointField
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from blem_sim import msg, srv

NO_NUMBERS = (math.nan, math.inf, -math.inf)
TOO_LARGE = (1e300, -1e300, 1e18)
NAMES = ("", "nobody", "nobody::link", "::", "arm_on_base::", "x" * 100000, "a\nb\x07", "../..", "arm_on_base::nothing", "\u00e9\u4e2d")
COUNTS = (0x7fffffff, 0x20000001, 0x10000000, 0xffffffff, 1000000)  # entries that lists claim to have
HEAD = '<robot name="r"><link name="a"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
BALL = HEAD + "</robot>"
TWIN = HEAD + """<link name="b"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="shoulder" type="continuous"><parent link="a"/><child link="b"/></joint></robot>"""  # has a joint of the robot that is there


def bad(random):
    return random.choice(NO_NUMBERS + TOO_LARGE)


def name(random):
    return random.choice(NAMES)


def spoil(message, random, values=None):
    """One of the message's floats, at any depth, becomes a number that is none, or too large."""
    places = list(floats(message))
    owner, key = random.choice(places)
    value = random.choice(values or NO_NUMBERS + TOO_LARGE)
    if isinstance(owner, list):
        owner[key] = value
    else:
        setattr(owner, key, value)
    return message


def floats(message):
    for slot in message.__slots__:
        value = getattr(message, slot)
        if isinstance(value, float):
            yield message, slot
        elif isinstance(value, list) and value and isinstance(value[0], float):
            for i in range(len(value)):
                yield value, i
        elif hasattr(value, "__slots__") and not isinstance(value, (rospy.Time, rospy.Duration)):
            for place in floats(value):
                yield place


def raw_type(kind):
    """A message type whose bytes are given."""
    class Raw(kind):
        raw = b""

        def serialize(self, buff):
            buff.write(self.raw)

    Raw.__name__ = kind.__name__
    return Raw


def lengths(data):
    """Places of the lengths of texts and lists: what stands behind them tells that they are none of a number's bytes."""
    def is_text(place):
        count = struct.unpack_from("<I", data, place)[0] if place + 4 <= len(data) else 0
        return 0 < count < 64 and data[place + 4:place + 4 + count].decode("ascii", "replace").replace("_", "").replace(":", "").isalpha()

    for place in range(len(data) - 4):
        count = struct.unpack_from("<I", data, place)[0]
        numbers = data[place + 4:].startswith((struct.pack("<d", 0.1), struct.pack("<f", 0.1)))
        if is_text(place) or (0 < count < 4 and is_text(place + 4)) or (0 < count < 2000 and numbers):
            yield place


def lying(message, random):
    """Bytes of a message whose lists, texts or end are not where they say."""
    buff = io.BytesIO()
    message.serialize(buff)
    data = bytearray(buff.getvalue())
    if random.random() < 0.3:
        return bytes(data[:random.randrange(4, max(5, len(data) - 8))])
    struct.pack_into("<I", data, random.choice(list(lengths(data))), random.choice(COUNTS))
    return bytes(data)


# Topics.

def joint_command(random):
    return random.choice((
        lambda: JointState(name=["shoulder"], position=[bad(random)]),
        lambda: JointState(name=["shoulder"], velocity=[bad(random)]),
        lambda: JointState(name=["shoulder"], position=[0.1], effort=[bad(random)]),
        lambda: JointState(name=["shoulder"], position=[0.5, 0.5]),
        lambda: JointState(name=["shoulder"], position=[0.5] * 100000),
        lambda: JointState(name=[], position=[0.5]),
        lambda: JointState(name=["shoulder", "shoulder"], position=[0.1, 0.2]),
        lambda: JointState(name=[name(random)], position=[0.5]),
        lambda: JointState(name=["shoulder"] + ["more"] * 10000, position=[0.5] * 10001)))()


def point(seconds, positions, **more):
    return JointTrajectoryPoint(positions=positions, time_from_start=rospy.Duration.from_sec(seconds), **more)


def trajectory(random, joints=("shoulder",)):
    joints = list(joints)
    return random.choice((
        lambda: JointTrajectory(joint_names=joints, points=[point(1, [bad(random)])]),
        lambda: JointTrajectory(joint_names=joints, points=[point(1, [0.1], velocities=[bad(random)])]),
        lambda: JointTrajectory(joint_names=joints, points=[point(1, [0.3]), point(1, [0.4])]),
        lambda: JointTrajectory(joint_names=joints, points=[point(2, [0.3]), point(1, [0.4])]),
        lambda: JointTrajectory(joint_names=joints, points=[point(1, [])]),
        lambda: JointTrajectory(joint_names=joints, points=[point(1, [0.1, 0.2])]),
        lambda: JointTrajectory(joint_names=joints, points=[point(1, [0.1], velocities=[1.0, 2.0])]),
        lambda: JointTrajectory(joint_names=joints, points=[point(1, [0.1], accelerations=[1.0])]),
        lambda: JointTrajectory(joint_names=joints + joints, points=[point(1, [0.1, 0.2])]),
        lambda: JointTrajectory(joint_names=joints + ["nobody"], points=[point(1, [0.1, 0.2])]),
        lambda: JointTrajectory(joint_names=[name(random)], points=[point(1, [0.1])])))()


def controller_trajectory(random):
    if random.random() < 0.2:
        old = JointTrajectory(joint_names=["shoulder"], points=[point(0.01 * i, [0.3]) for i in range(10)])
        old.header.stamp = rospy.Time(0, 1)
        return old
    if random.random() < 0.2:
        return JointTrajectory(points=[point(1, [0.3])])
    if random.random() < 0.2:
        return JointTrajectory(joint_names=["shoulder"], points=[point(-2, [0.3]), point(-1, [0.3])])
    return trajectory(random)


def pose():
    return Pose(Point(0.1, 0.2, 0.3), Quaternion(0.0, 0.0, 0.0, 1.0))


def model_state(random):
    state = msg.ModelState("cube", pose(), Twist(Vector3(0.0, 0.0, 0.0), Vector3(0.0, 0.0, 0.0)), "")
    choice = random.randrange(4)
    if choice == 0:
        return spoil(state, random, NO_NUMBERS)
    if choice == 1:
        state.pose.position.x = random.choice(TOO_LARGE)
    elif choice == 2:
        state.reference_frame = random.choice(NAMES[1:])
    else:
        state.model_name = random.choice(NAMES + ("ground",))
    return state


def link_state(random):
    state = model_state(random)
    link = {"cube": "cube::link", "ground": "ground::link"}.get(state.model_name, state.model_name)
    return msg.LinkState(link, state.pose, state.twist, state.reference_frame)


def cloud(count=100):
    message = PointCloud2(height=1, width=count, point_step=12, row_step=12 * count)
    message.header.frame_id = "world"
    message.fields = [PointField(axis, 4 * i, PointField.FLOAT32, 1) for i, axis in enumerate("xyz")]
    message.data = struct.pack("<3f", 0.1, 0.2, 0.001) * count
    return message


def spoiled_cloud(random):
    message = cloud()
    random.choice((
        lambda: setattr(message.fields[random.randrange(3)], "offset", random.choice((9, 12, 0xffffffff, 0x7ffffffc))),
        lambda: setattr(message.fields[random.randrange(3)], "datatype", random.choice((0, 1, 6, 9, 255))),
        lambda: setattr(message.fields[random.randrange(3)], "count", 0xffffffff),
        lambda: setattr(message.fields[random.randrange(3)], "name", name(random)),
        lambda: setattr(message, "fields", []),
        lambda: setattr(message, "width", random.choice((0, 101, 0xffffffff))),
        lambda: setattr(message, "height", random.choice((0, 2, 0xffffffff))),
        lambda: setattr(message, "point_step", random.choice((0, 8, 13, 0xffffffff))),
        lambda: setattr(message, "row_step", random.choice((0, 1199))),
        lambda: setattr(message, "is_bigendian", True),
        lambda: setattr(message, "data", message.data[:random.randrange(1200)]),
        lambda: setattr(message, "data", struct.pack("<f", math.nan) * 300)))()
    return message


# Requests.

def urdf(random):
    laughs = '<?xml version="1.0"?><!DOCTYPE r [<!ENTITY a "ha">' + "".join(
        '<!ENTITY %s "%s">' % (chr(98 + i), ("&%s;" % chr(97 + i)) * 10) for i in range(12)) + "]>"
    child = '<joint name="j" type="revolute"><parent link="%s"/><child link="%s"/><axis xyz="%s"/><limit lower="-1" upper="1" effort="%s" velocity="1"/></joint>'
    link = '<link name="b"><inertial><mass value="%s"/><inertia ixx="%s" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>%s</link>'
    mesh = '<collision><geometry><mesh filename="%s"/></geometry></collision>'
    return random.choice((
        "", "<", "robot", "<robot", "<sdf/>", HEAD, "<robot name='r'/>", "\x00\xff" * 10, "<robot>" * 3000,
        laughs + "<robot name='&m;'><link name='&m;'/></robot>",
        HEAD + link % ("1", "1", "") + "</robot>",  # two roots
        HEAD + child % ("a", "a", "1 0 0", "1") + "</robot>",
        HEAD + link % ("1", "1", "") + child % ("a", "b", "1 0 0", "1") + child.replace('"j"', '"k"') % ("b", "a", "1 0 0", "1") + "</robot>",
        HEAD + link % ("1", "1", "") + child % ("a", "nobody", "1 0 0", "1") + "</robot>",
        HEAD + link % (random.choice(("nan", "-1", "inf", "x", "1e999")), "1", "") + child % ("a", "b", "1 0 0", "1") + "</robot>",
        HEAD + link % ("1", random.choice(("nan", "-1", "0", "1e99999")), "") + child % ("a", "b", "1 0 0", "1") + "</robot>",
        HEAD + link % ("1", "1", "") + child % ("a", "b", random.choice(("nan 0 0", "1 2", "a b c")), "1") + "</robot>",
        HEAD + link % ("1", "1", "") + child % ("a", "b", "1 0 0", random.choice(("nan", "-1", "x"))) + "</robot>",
        HEAD + link % ("1", "1", mesh % random.choice(OUTSIDE)) + child % ("a", "b", "1 0 0", "1") + "</robot>"))


OUTSIDE = ("/etc/passwd", "file:///etc/shadow", "../../../../../../../etc/passwd", "/tmp/../etc/passwd", "package://nowhere/a.stl", "/dev/zero",
           "/proc/self/environ", "http://example.org/a.stl", "/var/tmp/a.stl", "package://blem_sim/../../../../../../etc/passwd")


def spawn(random):
    request = srv.SpawnModelRequest("new", BALL, "", pose(), "")
    choice = random.randrange(5)
    if choice < 2:
        request.model_xml = urdf(random)
    elif choice == 2:
        request.model_name = random.choice(("", "cube", "ground", "arm_on_base", "a::b"))
    elif choice == 3:
        request.reference_frame = random.choice(NAMES[1:])
    else:
        spoil(request.initial_pose, random, NO_NUMBERS)
    return request


def spawn_names(random):
    if random.random() < 0.5:
        return srv.SpawnModelRequest("new", TWIN, "", pose(), "")
    return srv.SpawnModelRequest("new", BALL, random.choice(("no name!", "a b", "\n", "1a", "a//\x00")), pose(), "")


def load_environment(random):
    request = srv.LoadEnvironmentRequest(name="new", uri="cube.off", pose=pose(), scale=Vector3(1.0, 1.0, 1.0))
    choice = random.randrange(6)
    if choice == 0:
        request.uri = random.choice(OUTSIDE + ("", "nowhere.stl", "world.yaml"))
    elif choice == 1:
        request.name = random.choice(("", "cube", "ground", "live", "a::b"))
    elif choice == 2:
        spoil(request.pose, random, NO_NUMBERS)
    elif choice == 3:
        request.scale = Vector3(random.choice(NO_NUMBERS), 1.0, 1.0)
    elif choice == 4:
        setattr(request, random.choice(("friction", "boundary_width")), random.choice(NO_NUMBERS + (-1.0,)))
    else:
        request.settings = random.choice(("{frixion: 1}", "{a: [", "7", "- 1", "{friction: nan}", "&a [*a]", "{friction: [1]}", "[" * 20000, "{plane: [0, 0, 1, 0]}"))
    return request


def wrench(random):
    request = srv.ApplyBodyWrenchRequest("cube::link", "", Point(0.0, 0.0, 0.0), Wrench(Vector3(1.0, 0.0, 0.0), Vector3(0.0, 0.0, 0.0)), rospy.Time(), rospy.Duration(1))
    choice = random.randrange(4)
    if choice == 0:
        request.body_name = random.choice(NAMES + ("ground::link",))
    elif choice == 1:
        request.reference_frame = random.choice(NAMES[1:])
    else:
        spoil(request, random)
    return request


def effort(random):
    if random.random() < 0.5:
        return srv.ApplyJointEffortRequest(name(random), 1.0, rospy.Time(), rospy.Duration(1))
    return srv.ApplyJointEffortRequest("shoulder", bad(random), rospy.Time(), rospy.Duration(-1))


def configuration(random):
    return random.choice((
        lambda: srv.SetModelConfigurationRequest(name(random), "", ["shoulder"], [0.1]),
        lambda: srv.SetModelConfigurationRequest("cube", "", ["shoulder"], [0.1]),
        lambda: srv.SetModelConfigurationRequest("arm_on_base", "", ["shoulder"], [bad(random)]),
        lambda: srv.SetModelConfigurationRequest("arm_on_base", "", ["shoulder"], []),
        lambda: srv.SetModelConfigurationRequest("arm_on_base", "", ["shoulder"] * 2, [0.1, 0.2]),
        lambda: srv.SetModelConfigurationRequest("arm_on_base", "", [name(random)], [0.1])))()


def physics(random):
    request = srv.SetPhysicsPropertiesRequest(0.001, 1000.0, Vector3(0.0, 0.0, -9.81), msg.ODEPhysics())
    choice = random.randrange(3)
    if choice == 0:
        request.time_step = random.choice(NO_NUMBERS + (0.0, -0.001, 1e-9, 5.0))
    elif choice == 1:
        request.max_update_rate = random.choice(NO_NUMBERS + (-1.0,))
    else:
        spoil(request.gravity, random)
    return request


def link_properties(random):
    request = srv.SetLinkPropertiesRequest("cube::link", pose(), True, 1.0, 0.01, 0.0, 0.0, 0.01, 0.0, 0.01)
    choice = random.randrange(4)
    if choice == 0:
        request.link_name = random.choice(NAMES + ("ground::link",))
    elif choice == 1:
        request.iyy = random.choice(NO_NUMBERS + (-1.0,))
    elif choice == 2:
        request.mass = random.choice(NO_NUMBERS + (0.0, -1.0))
    else:
        request.ixx = random.choice(NO_NUMBERS + (-1.0, 0.0))
    return request


def joint_properties(random):
    request = srv.SetJointPropertiesRequest("shoulder", msg.ODEJointProperties(damping=[0.1]))
    choice = random.randrange(4)
    if choice == 0:
        request.joint_name = name(random)
    elif choice == 1:
        request.ode_joint_config.damping = [random.choice(NO_NUMBERS + (-1.0,))]
    elif choice == 2:
        request.ode_joint_config.damping = [0.1] * 50
    else:
        request.ode_joint_config = msg.ODEJointProperties(loStop=[random.choice((1.0, math.nan, math.inf))], hiStop=[1.2])
    return request


def step_with_commands(random):
    robot = random.choice(("arm_on_base", "", "arm_on_base", "nobody"))
    good = msg.RobotCommand("arm_on_base", JointState(name=["shoulder"], position=[0.7]))
    return srv.StepWithCommandsRequest(random.choice((1, 10, 0xffffffff)), [good, msg.RobotCommand(robot, joint_command(random))])


def switch(random):
    names = [random.choice(("nobody", "", "x" * 1000, "../a"))]
    return srv.SwitchControllerRequest(names, [], 2, False, 0.0) if random.random() < 0.5 else srv.SwitchControllerRequest([], names, 2, False, 0.0)


def goal(random):
    follow = msg.FollowJointTrajectoryGoal(trajectory=controller_trajectory(random))
    if random.random() < 0.3:
        follow.trajectory = JointTrajectory(joint_names=["shoulder"], points=[point(1, [0.3])])
        tolerance = msg.JointTolerance("shoulder", random.choice(NO_NUMBERS), 0.1, 0.1)
        setattr(follow, random.choice(("path_tolerance", "goal_tolerance")), [tolerance])
    return follow


def spoiled_state(data, random):
    """Bytes of a saved state with a word changed, cut short or made longer."""
    data = bytearray(data)
    choice = random.randrange(4)
    if choice == 0:
        return bytes(data[:random.randrange(len(data))])
    if choice == 1:
        return bytes(data) + bytes(8)
    place = random.randrange(len(data) // 8) * 8
    word = struct.pack("<d", bad(random)) if choice == 2 else bytes(255 - b for b in data[place:place + 8])
    data[place:place + 8] = word if word != data[place:place + 8] else bytes(8)
    return bytes(data)


def valid_messages():
    """One of each type that lists or texts can lie in."""
    return {
        "joint_command": JointState(name=["shoulder"], position=[0.1]),
        "joint_trajectory": JointTrajectory(joint_names=["shoulder"], points=[point(1, [0.1])]),
        "command": JointTrajectory(joint_names=["shoulder"], points=[point(1, [0.1])]),
        "set_model_state": msg.ModelState("cube", pose(), Twist(), ""),
        "set_link_state": msg.LinkState("cube::link", pose(), Twist(), ""),
        "points": cloud(10),
    }
