"""URDF of the links of a model that hang together by joints."""
import copy
import math
from xml.dom import minidom
from xml.etree import ElementTree

import numpy as np

from sdf.elements import InputError, number, text, truth
from sdf.model import WORLD
from sdf.poses import angles, inverse, is_identity, pose, tidy
from sdf.shapes import parts_of, shape_of, urdf_shape

ANY = 1e6      # [rad, m, N m, N, rad/s, m/s] that blem_sim takes for no limit
NO_LIMIT = 1e15  # where Gazebo's default limits are
KINDS = ("revolute", "continuous", "prismatic", "fixed")  # of joints, as in URDF
SURFACE = {"mu1": "surface/friction/ode/mu", "mu2": "surface/friction/ode/mu2", "kp": "surface/contact/ode/kp", "kd": "surface/contact/ode/kd"}
GAZEBO_FRICTION = 1.0


def origin(X):
    element = ElementTree.Element("origin")
    element.set("xyz", "%.9g %.9g %.9g" % tuple(tidy(X[:3, 3])))
    element.set("rpy", "%.9g %.9g %.9g" % tuple(tidy(angles(X))))
    return element


def add(parent, tag, content=None, **attributes):
    element = ElementTree.SubElement(parent, tag, {key: value if isinstance(value, str) else "%.9g" % value for key, value in attributes.items()})
    element.text = content
    return element


class UrdfWriter:
    """Writes one robot. root: name of the link that others hang on; joints: those of the links, in any order."""

    def __init__(self, model, folders, report):
        self.model, self.folders, self.report = model, folders, report

    def write(self, name, root, joints, path):
        """Writes links, joints, sensors and plugins of the component to a file. Raises InputError."""
        robot = ElementTree.Element("robot", {"name": name})
        if root == WORLD:
            add(robot, "link", name=WORLD)
        for link in [root] + [joint.child for joint in joints]:
            if link != WORLD:
                self._add_link(robot, self.model.links[link])
        for joint in joints:
            self._add_joint(robot, joint)
        for plugin in self.model.plugins:
            add(robot, "gazebo").append(copy.deepcopy(plugin))
        if truth(self.model.element, "self_collide"):
            add(add(robot, "gazebo"), "self_collide", "true")
        path.write_text('<?xml version="1.0"?>\n%s\n' % indented(robot), encoding="utf-8")

    def _where(self, element, link=None):
        return "model '%s', %s" % (self.model.name, ("link '%s', " % link if link else "") + "%s '%s'" % (element.tag, element.get("name")))

    def _add_link(self, robot, link):
        """A link has one surface, so each other surface of a link in SDF has a link of its own, which is fixed to it."""
        element = add(robot, "link", name=link.name)
        self._add_inertial(element, link)
        for visual in link.element.findall("visual"):
            self._add_shapes(element, "visual", visual, link)
        surfaces = surfaces_of(link)
        for surface, collisions in surfaces[1:]:
            name = "%s__%s" % (link.name, collisions[0].get("name"))
            self._add_collisions(robot, add(robot, "link", name=name), name, surface, collisions, link)
            add_fixed(robot, name + "__joint", link.name, name, np.eye(4))
        surface, collisions = surfaces[0] if surfaces else ({}, [])
        block = self._add_collisions(robot, element, link.name, surface, collisions, link)
        if not truth(link.element, "gravity", True):
            add(block, "turnGravityOff", "true")
        if truth(link.element, "self_collide"):
            add(block, "selfCollide", "true")
        if truth(link.element, "kinematic"):
            self.report.note("%s: <kinematic> is not read; the link obeys forces" % self._where(link.element))
        block.extend(copy.deepcopy(sensor) for sensor in link.element.findall("sensor"))

    def _add_collisions(self, robot, element, name, surface, collisions, link):
        """Adds collisions to an element of URDF, and returns the <gazebo> block of it."""
        for collision in collisions:
            self._add_shapes(element, "collision", collision, link)
        block = add(robot, "gazebo", reference=name)
        for key, value in surface.items():
            add(block, key, "%.9g" % value)
        return block

    def _add_inertial(self, element, link):
        where = self._where(link.element) + ": <inertial>"
        given = link.element.find("inertial")
        inertial = add(element, "inertial")
        inertial.append(origin(pose(given, where)))
        add(inertial, "mass", value=number(given, "mass", 1.0, where))
        values = {key: number(given, "inertia/" + key, 1.0 if key[1] == key[2] else 0.0, where) for key in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")}
        add(inertial, "inertia", **values)

    def _add_shapes(self, element, tag, part, link):
        where = self._where(part, link.name)
        try:
            shape = shape_of(part.find("geometry"), where)
            X = pose(part, where)
            if shape.tag == "mesh":
                add_geometry(element, tag, X).append(self._mesh(shape, link.folder, where))
                return
            for name, sizes, height in parts_of(shape, where):
                add_geometry(element, tag, X @ shifted(height)).append(urdf_shape(name, sizes))
        except InputError as error:
            if tag == "collision":
                self.report.leave_out(str(error))

    def _mesh(self, shape, folder, where):
        mesh = ElementTree.Element("mesh", {"filename": self.folders.file_of(mesh_uri(shape, where), folder, where)})
        if text(shape, "scale"):
            mesh.set("scale", text(shape, "scale"))
        if shape.find("submesh") is not None:
            self.report.note("%s: <submesh> is not read; the whole mesh is taken" % where)
        return mesh

    def _add_joint(self, robot, joint):
        parent = self.model.links[joint.parent].X_ML if joint.parent != WORLD else None
        X_PJ = joint.X_MJ if parent is None else inverse(parent) @ joint.X_MJ
        X_JC = inverse(joint.X_MJ) @ self.model.links[joint.child].X_ML
        child = joint.child
        if not is_identity(X_JC):  # URDF has a link where its joint is, so the joint moves a frame that holds the link
            child = joint.name + "__frame"
            add(robot, "link", name=child)
            add_fixed(robot, joint.name + "__offset", child, joint.child, X_JC)
        where = self._where(joint.element)
        kind, limits = limits_of(joint, where)
        element = add(robot, "joint", name=joint.name, type=kind)
        element.append(origin(X_PJ))
        add(element, "parent", link=joint.parent)
        add(element, "child", link=child)
        if kind != "fixed":
            add(element, "axis", xyz="%.9g %.9g %.9g" % tuple(tidy(joint.axis)))
            add(element, "limit", **limits)
            dynamics = {name: number(joint.element, "axis/dynamics/" + name, 0.0, where) for name in ("damping", "friction")}
            if any(dynamics.values()):
                add(element, "dynamics", **dynamics)
            if number(joint.element, "axis/dynamics/spring_stiffness", 0.0, where):
                self.report.note("%s: <spring_stiffness> is not read; give the joint gains" % where)
        sensors = joint.element.findall("sensor")
        if sensors:
            add(robot, "gazebo", reference=joint.name).extend(copy.deepcopy(sensors))


def mesh_uri(shape, where):
    uri = text(shape, "uri") or text(shape, "filename")
    if not uri:
        raise InputError("%s: <mesh> has no <uri>; name a file" % where)
    return uri


def surface_of(collision, where):
    values = {name: number(collision, path, None, where) for name, path in SURFACE.items()}
    if values["mu1"] is None:
        values["mu1"] = GAZEBO_FRICTION
    return {name: min(value, 1e12) for name, value in values.items() if value is not None}


def surfaces_of(link):
    """The surfaces of a link's collisions in their order, each with those that have it."""
    surfaces = []
    for collision in link.element.findall("collision"):
        surface = surface_of(collision, "link '%s', collision '%s'" % (link.name, collision.get("name")))
        known = next((collisions for other, collisions in surfaces if other == surface), None)
        if known is None:
            surfaces.append((surface, [collision]))
        else:
            known.append(collision)
    return surfaces


def restitution_of(collision, where):
    return min(max(number(collision, "surface/bounce/restitution_coefficient", 0.0, where), 0.0), 1.0)


def limits_of(joint, where):
    """URDF's type and limits of a joint of one of KINDS."""
    lower, upper = (number(joint.element, "axis/limit/" + end, value, where) for end, value in (("lower", -math.inf), ("upper", math.inf)))
    effort, speed = (number(joint.element, "axis/limit/" + name, -1.0, where) for name in ("effort", "velocity"))
    limits = {"effort": effort if 0 <= effort < NO_LIMIT else ANY, "velocity": speed if 0 <= speed < NO_LIMIT else ANY}
    kind = joint.kind
    if kind == "revolute" and lower < -NO_LIMIT and upper > NO_LIMIT:
        kind = "continuous"
    if kind in ("revolute", "prismatic"):
        limits.update(lower=max(lower, -ANY), upper=min(upper, ANY))
    return kind, limits


def shifted(height):
    X = pose(None, "")
    X[2, 3] = height
    return X


def add_geometry(element, tag, X):
    part = add(element, tag)
    part.append(origin(X))
    return add(part, "geometry")


def add_fixed(robot, name, parent, child, X):
    joint = add(robot, "joint", name=name, type="fixed")
    joint.append(origin(X))
    add(joint, "parent", link=parent)
    add(joint, "child", link=child)


def indented(element):
    lines = minidom.parseString(ElementTree.tostring(element)).documentElement.toprettyxml(indent="  ").splitlines()
    return "\n".join(line for line in lines if line.strip())
