#!/usr/bin/env python3
"""Writes urdf/blem_humanoid.urdf, urdf/demo_gripper.urdf and urdf/demo_watcher.urdf; inertias are those of the link meshes at uniform density.

Usage: scripts/support/make_demo_robots.py [OUT_DIR]     default: urdf/ of this package
"""
import os
import struct
import sys

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")

COLOURS = {
    "white": "0.92 0.93 0.95 1",
    "graphite": "0.22 0.24 0.28 1",
    "blue": "0.16 0.42 0.75 1",
    "rubber": "0.10 0.10 0.11 1",
}

# link mesh: mass [kg], colour
PARTS = {
    "pelvis": (4.0, "graphite"),
    "torso": (8.5, "white"),
    "head": (1.6, "blue"),
    "upper_arm": (1.3, "white"),
    "forearm": (1.0, "blue"),
    "hip_yaw": (0.7, "graphite"),
    "hip_roll": (0.9, "graphite"),
    "thigh": (2.6, "white"),
    "shin": (1.9, "white"),
    "ankle_pitch": (0.5, "graphite"),
    "foot": (0.9, "rubber"),
}

# joint: child link's mesh, parent, origin [m] (y for the left side), axis, lower, upper [rad], effort [N m], velocity [rad/s]
LEG = [
    ("hip_yaw", "hip_yaw", "pelvis", (0, 0.085, -0.05), (0, 0, 1), (-0.8, 0.8), 60, 8),
    ("hip_roll", "hip_roll", "hip_yaw", (0, 0, 0), (1, 0, 0), (-0.5, 0.7), 90, 8),
    ("hip_pitch", "thigh", "hip_roll", (0, 0, 0), (0, 1, 0), (-1.6, 0.9), 90, 8),
    ("knee", "shin", "thigh", (0, 0, -0.26), (0, 1, 0), (-0.05, 2.3), 110, 8),
    ("ankle_pitch", "ankle_pitch", "shin", (0, 0, -0.26), (0, 1, 0), (-1.1, 0.9), 70, 8),
    ("ankle_roll", "foot", "ankle_pitch", (0, 0, 0), (1, 0, 0), (-0.6, 0.6), 50, 8),
]
ARM = [
    ("shoulder", "upper_arm", "torso", (0, 0.170, 0.25), (0, 1, 0), (-3.0, 1.2), 30, 8),
    ("elbow", "forearm", "upper_arm", (0, 0, -0.20), (0, 1, 0), (-2.3, 0.05), 20, 8),
]


def read_stl(path):
    """Triangles of a binary STL, each three points."""
    with open(path, "rb") as file:
        data = file.read()
    count = struct.unpack_from("<I", data, 80)[0]
    triangles = []
    for i in range(count):
        numbers = struct.unpack_from("<12f", data, 84 + 50 * i)
        triangles.append([numbers[3:6], numbers[6:9], numbers[9:12]])
    return triangles


def volume_properties(triangles):
    """Volume, centre and second moments [xx, yy, zz, xy, xz, yz] about the centre of a closed mesh, by tetrahedra from the origin."""
    volume, first, second = 0.0, [0.0] * 3, [[0.0] * 3 for _ in range(3)]
    for a, b, c in triangles:
        v = (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6.0
        volume += v
        s = [a[i] + b[i] + c[i] for i in range(3)]
        for i in range(3):
            first[i] += v * s[i] / 4.0
            for j in range(3):
                second[i][j] += v * (a[i] * a[j] + b[i] * b[j] + c[i] * c[j] + s[i] * s[j]) / 20.0
    centre = [f / volume for f in first]
    return volume, centre, [[second[i][j] - volume * centre[i] * centre[j] for j in range(3)] for i in range(3)]


def inertial(parts):
    """<inertial> of meshes welded together. parts: (mesh name, mass)."""
    total = sum(mass for _, mass in parts)
    bodies = []
    for mesh, mass in parts:
        volume, centre, second = volume_properties(read_stl(os.path.join(ROOT, "meshes", mesh + ".stl")))
        bodies.append((mass, centre, [[mass / volume * m for m in row] for row in second]))
    com = [sum(mass * centre[i] for mass, centre, _ in bodies) / total for i in range(3)]
    moments = [[0.0] * 3 for _ in range(3)]
    for mass, centre, second in bodies:
        for i in range(3):
            for j in range(3):
                moments[i][j] += second[i][j] + mass * (centre[i] - com[i]) * (centre[j] - com[j])
    trace = sum(moments[i][i] for i in range(3))
    values = {}
    for i, j, name in ((0, 0, "ixx"), (0, 1, "ixy"), (0, 2, "ixz"), (1, 1, "iyy"), (1, 2, "iyz"), (2, 2, "izz")):
        value = (trace if i == j else 0.0) - moments[i][j]
        values[name] = 0.0 if i != j and abs(value) < 1e-9 else value
    com = [0.0 if abs(c) < 1e-7 else c for c in com]
    return ('    <inertial>\n      <origin xyz="%s"/>\n      <mass value="%g"/>\n      <inertia %s/>\n    </inertial>\n'
            % (" ".join("%.6g" % c for c in com), total, " ".join('%s="%.6g"' % item for item in values.items())))


def shape(tag, mesh, colour):
    material = '\n      <material name="%s"/>' % colour if tag == "visual" else ""
    return ('    <%s>\n      <geometry><mesh filename="package://blem_sim/meshes/%s.stl"/></geometry>%s\n    </%s>\n'
            % (tag, mesh, material, tag))


def link(name, parts):
    """parts: (mesh name, mass, colour)."""
    text = '  <link name="%s">\n' % name + inertial([(mesh, mass) for mesh, mass, _ in parts])
    for mesh, _, colour in parts:
        text += shape("visual", mesh, colour)
    for mesh, _, _ in parts:
        text += shape("collision", mesh, None)
    return text + "  </link>\n"


def joint(name, kind, parent, child, xyz, axis, limits, effort, velocity, rpy=(0, 0, 0)):
    numbers = lambda values: " ".join("%g" % v for v in values)
    text = '  <joint name="%s" type="%s">\n    <parent link="%s"/>\n    <child link="%s"/>\n' % (name, kind, parent, child)
    text += '    <origin xyz="%s" rpy="%s"/>\n' % (numbers(xyz), numbers(rpy))
    if kind != "fixed":
        text += '    <axis xyz="%s"/>\n' % numbers(axis)
        text += '    <limit lower="%g" upper="%g" effort="%g" velocity="%g"/>\n' % (limits[0], limits[1], effort, velocity)
    return text + "  </joint>\n"


def head_of(robot):
    text = '<?xml version="1.0"?>\n<!-- Made by scripts/support/make_demo_robots.py; inertias from the link meshes. -->\n<robot name="%s">\n' % robot
    for name, rgba in COLOURS.items():
        text += '  <material name="%s"><color rgba="%s"/></material>\n' % (name, rgba)
    return text


def humanoid_part(name, mesh):
    mass, colour = PARTS[mesh]
    return link(name, [("humanoid_" + mesh, mass, colour)])


def limb(side, joints, body_links):
    """Mirrored in y for the right side: y of origins, limits of joints about x and z."""
    sign = 1 if side == "left" else -1
    text = ""
    for name, mesh, parent, xyz, axis, limits, effort, velocity in joints:
        parent_name = parent if parent in body_links else "%s_%s" % (side, parent)
        mirrored = limits if sign > 0 or axis[1] else (-limits[1], -limits[0])
        text += humanoid_part("%s_%s" % (side, mesh), mesh)
        text += joint("%s_%s" % (side, name), "revolute", parent_name, "%s_%s" % (side, mesh), (xyz[0], sign * xyz[1], xyz[2]), axis,
                      mirrored, effort, velocity)
    return text


def humanoid():
    body_links = ("pelvis", "torso")
    text = head_of("blem_humanoid") + humanoid_part("pelvis", "pelvis") + humanoid_part("torso", "torso")
    text += joint("waist", "revolute", "pelvis", "torso", (0, 0, 0.055), (0, 0, 1), (-1.2, 1.2), 60, 8)
    text += humanoid_part("head", "head") + joint("neck", "fixed", "torso", "head", (0, 0, 0.325), None, None, 0, 0)
    for side in ("left", "right"):
        text += limb(side, LEG, body_links) + limb(side, ARM, body_links)
    return text + "</robot>\n"


def gripper():
    text = head_of("demo_gripper") + '  <link name="world"/>\n'
    text += link("carriage", [("gripper_carriage", 1.5, "graphite")])
    text += joint("lift", "prismatic", "world", "carriage", (0, 0, 0.06), (0, 0, 1), (-0.02, 0.4), 300, 1)
    text += link("palm", [("gripper_palm", 0.8, "white")])
    text += joint("shake", "prismatic", "carriage", "palm", (0, 0, 0), (1, 0, 0), (-0.2, 0.2), 200, 2)
    for side, y, yaw in (("left", 0.06, 0), ("right", -0.06, 3.141592653589793)):
        text += link(side + "_finger", [("gripper_finger", 0.15, "blue"), ("finger_pad", 0.03, "rubber")])
        text += joint(side + "_grip", "prismatic", "palm", side + "_finger", (0, y, 0), (0, -1, 0), (0, 0.055), 60, 0.5, (0, 0, yaw))
    return text + "</robot>\n"


def watcher():
    """A mast that stands on its foot; a camera on top pans and tilts."""
    text = head_of("demo_watcher")
    text += link("foot", [("watcher_foot", 9.0, "graphite"), ("watcher_mast", 1.5, "white")])
    text += link("neck", [("watcher_neck", 0.2, "graphite")])
    text += joint("pan", "revolute", "foot", "neck", (0, 0, 0.585), (0, 0, 1), (-1.6, 1.6), 10, 3)
    text += link("head", [("watcher_head", 0.5, "blue")])
    text += joint("tilt", "revolute", "neck", "head", (0, 0, 0.075), (0, 1, 0), (-0.6, 1.0), 10, 3)
    return text + "</robot>\n"


def main():
    out = sys.argv[1] if len(sys.argv) > 1 else os.path.join(ROOT, "urdf")
    for name, text in (("blem_humanoid", humanoid()), ("demo_gripper", gripper()), ("demo_watcher", watcher())):
        with open(os.path.join(out, name + ".urdf"), "w") as file:
            file.write(text)


if __name__ == "__main__":
    main()
