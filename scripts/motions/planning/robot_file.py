"""The robot that a motion is for: from the configuration that blem_sim_run takes, or from a URDF."""
import collections
import math
import pathlib
import xml.etree.ElementTree as ElementTree

import numpy as np
from kinematics import Tree, from_rpy
from sweeping.checked_yaml import Field, InputError, nearest, read_yaml
from sweeping.input_files import resolved

from planning.robot_model import Posture, RobotModel

ROOT = pathlib.Path(__file__).resolve().parents[3]
FARTHEST = 1e5  # [m] that a motion may be from the origin
TYPES = ("fixed", "revolute", "continuous", "prismatic")

# A robot as it starts: name in the configuration (None of a bare URDF), its place in the list, gravity [m/s^2] along -z.
Robot = collections.namedtuple("Robot", "file name number model posture gravity")


def with_own(packages):
    """Folders of packages by name, blem_sim's own among them unless another one is given."""
    return dict({"blem_sim": str(ROOT)}, **packages)


def read_robot(file, name, packages):
    """The robot of a name, or the only one. @param packages {name: folder} Raises InputError in one line."""
    if str(file).endswith((".urdf", ".xml")):
        return placed_robot(Field(str(file), "", {"urdf": str(pathlib.Path(file).resolve())}), None, packages, 9.81)
    root = Field(str(file), "", read_yaml(file))
    root.map()
    if not root.value.get("robots"):
        root.refuse("'robots' is missing or empty; name a configuration with the robot that moves")
    robots = root.below("robots").items()
    names = [robot.map().get("name") for robot in robots]
    if name is None and len(robots) > 1:
        root.below("robots").refuse("there are %d; write robot: NAME in the motion; known: %s" % (len(robots), ", ".join(map(str, names))))
    if name is not None and name not in names:
        root.below("robots").refuse("there is no '%s'; %s" % (name, nearest(name, names)))
    number = 0 if name is None else names.index(name)
    return placed_robot(robots[number], number, packages, gravity_of(root))


def gravity_of(root):
    if "gravity" not in root.value:
        return 9.81
    vector = [item.number() for item in root.below("gravity").items()]
    if len(vector) != 3 or vector[0] or vector[1] or vector[2] >= 0:
        root.below("gravity").refuse("a motion is planned for gravity along -z; write [0, 0, -9.81]")
    return -vector[2]


def placed_robot(field, number, packages, gravity):
    if "urdf" not in field.value:
        field.refuse("'urdf' is missing; name the robot's file")
    tree = read_tree(field.below("urdf"), packages)
    fixed = field.below("fixed_base").flag() if "fixed_base" in field.value else tree.root == "world"
    model = RobotModel(tree, fixed, numbers_by_joint(field, "effort_limits"), numbers_by_joint(field, "velocity_limits"))
    numbers = np.concatenate([each.ravel() for each in (model.origins, model.origin_rotations, model.axes, model.masses, model.centres)])
    if not (np.abs(numbers) <= FARTHEST).all() or (model.masses < 0).any() or not (fixed or model.mass > 0):
        field.below("urdf").refuse("%s has an origin, axis or mass that is no such number, or weighs nothing; check it with check_urdf"
                                   % field.below("urdf").shown())
    rotation, position = pose_of(field)
    starts = numbers_by_joint(field, "initial_positions")
    joints = np.clip([starts.get(name, 0.0) for name in model.joint_names], model.lower, model.upper)
    return Robot(field.file, field.value.get("name"), number, model, Posture(rotation, position, joints), gravity)


def numbers_by_joint(field, key):
    """{joint: number}; infinite ones are left out, they bound nothing."""
    if not field.value.get(key):
        return {}
    below = field.below(key)
    return {name: below.below(name).number() for name, value in below.map().items() if value != math.inf}


def pose_of(field):
    parts = {"xyz": [0.0] * 3, "rpy": [0.0] * 3}
    if field.value.get("pose"):
        pose = field.below("pose")
        for key in pose.map(parts):
            pose.below(key).list(3)
            parts[key] = [item.number() for item in pose.below(key).items()]
            if max(map(abs, parts[key])) > FARTHEST:
                pose.below(key).refuse("%s is beyond %g; write m and rad" % (pose.below(key).shown(), FARTHEST))
    return from_rpy(parts["rpy"]), parts["xyz"]


def read_tree(field, packages):
    """The tree of a URDF that a field names."""
    path = resolved(field.text(), str(pathlib.Path(field.file).resolve().parent), with_own(packages))
    if path is None or not pathlib.Path(path).is_file():
        field.refuse("%s is no file; name one, and its package's folder by --package NAME=DIR" % field.shown())
    try:
        check_urdf(path)
        return Tree(path)
    except (ElementTree.ParseError, UnicodeDecodeError) as error:
        raise InputError("%s: is no URDF that can be read: %s; correct it" % (path, error))
    except (AttributeError, TypeError, ValueError, StopIteration):
        raise InputError("%s: an element lacks what it needs, or holds no number; check it with check_urdf" % path)


def check_urdf(path):
    """Raises InputError for what a tree cannot hold: other joints, two parents, mimics of mimics."""
    joints = ElementTree.parse(path).getroot().findall("joint")
    movable = [joint.get("name") for joint in joints if joint.get("type") != "fixed"]
    mimics = {joint.get("name"): joint.find("mimic").get("joint") for joint in joints if joint.find("mimic") is not None}
    names, children = [joint.get("name") for joint in joints], set()
    for joint in joints:
        name, kind, child = joint.get("name"), joint.get("type"), joint.find("child").get("link")
        if kind not in TYPES:
            raise InputError("%s: joint '%s' is of type '%s'; a motion can have: %s" % (path, name, kind, ", ".join(TYPES)))
        if child in children or names.count(name) > 1:
            raise InputError("%s: joint '%s' or its child link is there twice; name each once" % (path, name))
        if name in mimics and (mimics[name] not in movable or mimics[name] in mimics):
            raise InputError("%s: joint '%s' mimics '%s', which is no joint with a motor; correct it" % (path, name, mimics[name]))
        children.add(child)
