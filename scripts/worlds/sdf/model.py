"""A model of SDF as links and joints with poses in the model's frame; nested and included models are part of it."""
from dataclasses import dataclass, field
from typing import Any, Dict, List

import numpy as np

from sdf.elements import InputError, numbers, text, truth, version_of
from sdf.files import included
from sdf.poses import SAME, pose, relative_to

MODEL, WORLD = "__model__", "world"
AXES_IN_JOINT = (1, 5)  # version of SDF since when axes are told in the joint's frame


@dataclass
class Link:
    name: str
    X_ML: Any
    element: Any
    folder: Any  # that files are named from


@dataclass
class Joint:
    name: str
    kind: str
    parent: str
    child: str
    X_MJ: Any
    axis: Any  # in the joint's frame
    element: Any


@dataclass
class Model:
    name: str
    static: bool
    element: Any
    X_WM: Any = None
    links: Dict[str, Link] = field(default_factory=dict)
    joints: List[Joint] = field(default_factory=list)
    plugins: List[Any] = field(default_factory=list)


def flat(name):
    """nested::link as a name that URDF may have."""
    return name.replace("::", "__")


class Frames:
    """Frames of a model by name, each in another; poses are made where they are asked for."""

    def __init__(self, where):
        self.where, self.known = where, {}

    def add(self, name, X, other):
        self.known[name] = (X, other)

    def pose(self, name, on_the_way=()):
        """Pose of a frame in the model's. Raises InputError."""
        if name in ("", MODEL):
            return np.eye(4)
        if name not in self.known:
            raise InputError("%s: there is no frame '%s'; name a link, joint or frame of the model" % (self.where, name))
        if name in on_the_way:
            raise InputError("%s: frame '%s' is told relative to itself; break that circle" % (self.where, name))
        X, other = self.known[name]
        return self.pose(other, (*on_the_way, name)) @ X


class Scope:
    """Where names of a model are looked up: its own frame (empty: the outermost model's) and the frames of all."""

    def __init__(self, frames, own=""):
        self.frames, self.own = frames, own

    def full(self, name):
        """Name of a link, joint or frame of this model among those of the outermost one."""
        if name in ("", MODEL):
            return self.own
        return self.own + "__" + flat(name) if self.own else flat(name)

    def pose(self, name):
        return self.frames.pose(self.full(name))


class Reader:
    """Reads models with all that is nested in them."""

    def __init__(self, folders):
        self.folders = folders

    def read(self, element, version, folder, name=None):
        """The model of a <model>; its place in the world is left to the caller. Raises InputError.

        folder: that files are named from; name: of an <include>."""
        name = name or element.get("name") or "model"
        model = Model(name, truth(element, "static"), element)
        scope = Scope(Frames("model '%s'" % name))
        self._read_into(model, element, version, folder, scope)
        for link in model.links.values():
            link.X_ML = scope.pose(link.name)
        for joint in model.joints:
            joint.X_MJ = scope.pose(joint_frame(joint.name))
            joint.axis = joint.axis(joint.X_MJ)
        return model

    def _read_into(self, model, element, version, folder, scope):
        where = scope.frames.where + (", model '%s'" % scope.own if scope.own else "")
        for nested in element.findall("model"):
            self._nest(model, nested, version, folder, nested, nested.get("name") or "model", scope)
        for include in element.findall("include"):
            root, nested, place = included(include, self.folders, folder)
            if nested is not None:
                placed = include if include.find("pose") is not None else nested
                self._nest(model, nested, version_of(root), place, placed, text(include, "name") or nested.get("name") or "model", scope)
        for frame in element.findall("frame"):
            self._add_frame(scope, scope.full(frame.get("name", "frame")), frame, frame.get("attached_to", ""), where)
        for link in element.findall("link"):
            name = scope.full(link.get("name", "link"))
            self._add_frame(scope, name, link, "", where)
            model.links[name] = Link(name, None, link, folder)
        for joint in element.findall("joint"):
            model.joints.append(self._joint(joint, version, scope, where))
        model.plugins += element.findall("plugin")

    def _nest(self, model, element, version, folder, placed, name, scope):
        """placed: the element whose <pose> tells where the nested model is."""
        self._add_frame(scope, scope.full(name), placed, "", scope.frames.where)
        self._read_into(model, element, version, folder, Scope(scope.frames, scope.full(name)))

    def _add_frame(self, scope, name, element, otherwise, where):
        other = relative_to(element) or otherwise
        scope.frames.add(name, pose(element, "%s, %s '%s'" % (where, element.tag, element.get("name"))), scope.full(other))

    def _joint(self, joint, version, scope, where):
        name = joint.get("name", "joint")
        where = "%s, joint '%s'" % (where, name)
        ends = [text(joint, end) for end in ("parent", "child")]
        if None in ends:
            raise InputError("%s: has no <parent> or no <child>; name both links" % where)
        parent, child = (end if end == WORLD else scope.full(end) for end in ends)
        self._add_frame(scope, joint_frame(scope.full(name)), joint, ends[1] if ends[1] != WORLD else "", where)
        return Joint(scope.full(name), joint.get("type", ""), parent, child, None, self._axis(joint, version, scope, where), joint)

    def _axis(self, joint, version, scope, where):
        """The axis in the joint's frame, as a function of the joint's pose in the model."""
        found = joint.find("axis/xyz")
        axis = np.array(numbers(found.text, 3, where + ": <xyz>")) if found is not None and found.text else np.array([0.0, 0.0, 1.0])
        length = np.linalg.norm(axis)
        if length < SAME:
            raise InputError("%s: <xyz> 0 0 0 is no axis; write 0 0 1" % where)
        axis /= length
        frame = found.get("expressed_in", "") if found is not None else ""
        if frame:
            return lambda X_MJ: X_MJ[:3, :3].T @ scope.pose(frame)[:3, :3] @ axis
        if truth(joint, "axis/use_parent_model_frame") or version < AXES_IN_JOINT:
            return lambda X_MJ: X_MJ[:3, :3].T @ scope.pose(MODEL)[:3, :3] @ axis
        return lambda X_MJ: axis


def joint_frame(name):
    """Joints may be called as a link of their model is."""
    return "joint " + name
