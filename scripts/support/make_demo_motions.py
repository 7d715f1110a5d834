#!/usr/bin/python3
"""Writes the demos' trajectories, config/demo_*.csv, and tells the humanoid's start pose on the scanned floor.

Usage: scripts/support/make_demo_motions.py [OUT_DIR]     default: config/ of this package
       scripts/support/make_demo_motions.py --pose        prints root height and joint positions for the YAML files
"""
import math
import os
import struct
import sys
import xml.etree.ElementTree as xml

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from trajectory_file import smooth  # noqa: E402

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")

THIGH, SHIN, ANKLE_HEIGHT = 0.26, 0.26, 0.06  # [m] between the joints, and from the ankle down to the sole
HIP = (0.0, 0.085, -0.05)                     # [m] of the left hip in the pelvis
FEET_APART = 0.19                             # [m] between the ankles
ANKLE_X = -0.03                               # [m] of the ankles in the world: the soles' middles come over the origin
HIP_ABOVE_ANKLE = 0.495                       # [m]; straight legs would have 0.52
PELVIS_X = -0.0055                            # [m] in the world: puts the centre of mass over the soles' middles
SWAY = 0.04                                   # [m] of the hips to either side
ARMS = {"shoulder": 0.25, "elbow": -0.55}     # [rad]
LOOKING_DOWN = 0.60                           # [rad] of the watcher's camera
SOLE = (-0.080, 0.140, 0.055)                 # [m] heel, toe, half width about the ankle


def leg_angles(side, pelvis):
    """Joint angles of one leg for an upright pelvis at `pelvis` [m] and its sole flat on the ground z = 0."""
    sign = 1 if side == "left" else -1
    dx = ANKLE_X - pelvis[0] - HIP[0]
    dy = sign * 0.5 * FEET_APART - pelvis[1] - sign * HIP[1]
    dz = ANKLE_HEIGHT - pelvis[2] - HIP[2]
    roll = math.atan2(dy, -dz)
    down = math.hypot(dy, dz)
    reach2 = dx * dx + down * down
    knee = math.acos((reach2 - THIGH**2 - SHIN**2) / (2 * THIGH * SHIN))
    pitch = math.atan2(-dx, down) - math.atan2(SHIN * math.sin(knee), THIGH + SHIN * math.cos(knee))
    return {side + "_hip_yaw": 0.0, side + "_hip_roll": roll, side + "_hip_pitch": pitch, side + "_knee": knee,
            side + "_ankle_pitch": -pitch - knee, side + "_ankle_roll": -roll}


def pelvis_position(sway=0.0):
    return (PELVIS_X, sway, ANKLE_HEIGHT + HIP_ABOVE_ANKLE - HIP[2])


def posture(sway=0.0):
    """All joint positions with the hips moved sideways by `sway` [m]."""
    joints = {"waist": 0.0}
    for side in ("left", "right"):
        joints.update(leg_angles(side, pelvis_position(sway)))
        joints.update({side + "_" + name: angle for name, angle in ARMS.items()})
    return joints


def sway_at(t):
    """Rest, left, right, left, rest, over 10 s. [m]"""
    stops = [(1.0, 0.0), (2.5, SWAY), (3.0, SWAY), (5.0, -SWAY), (5.5, -SWAY), (7.5, SWAY), (8.0, SWAY), (9.5, 0.0)]
    value = 0.0
    for (t0, v0), (t1, v1) in zip(stops, stops[1:]):
        value += (v1 - v0) * smooth(t, t0, t1)
    return value


def gripper_at(t):
    """Close, lift 10 cm, shake +-5 cm at 1 Hz, put back, open."""
    grip = 0.030 * (smooth(t, 0.5, 1.5) - smooth(t, 9.0, 9.8))
    lift = 0.10 * (smooth(t, 2.0, 3.5) - smooth(t, 7.0, 8.5))
    strength = smooth(t, 3.5, 4.0) - smooth(t, 6.0, 6.5)
    shake = 0.05 * strength * math.sin(2 * math.pi * (t - 3.5))
    return {"lift": lift, "shake": shake, "left_grip": grip, "right_grip": grip}


def look_at(t):
    """Left, right and back, with a nod on each side."""
    pan = 0.7 * (smooth(t, 0.5, 2.0) - 2 * smooth(t, 3.5, 6.0) + smooth(t, 7.5, 9.0))
    nod = smooth(t, 2.0, 2.7) - smooth(t, 2.8, 3.5) + smooth(t, 6.0, 6.7) - smooth(t, 6.8, 7.5)
    return {"pan": pan, "tilt": LOOKING_DOWN - 0.25 * nod}


def write_csv(path, duration, step, at):
    names = sorted(at(0.0))
    with open(path, "w") as file:
        file.write(",".join(["time"] + names) + "\n")
        for i in range(int(round(duration / step)) + 1):
            values = at(i * step)
            numbers = ["%.6f" % values[name] for name in names]
            file.write(",".join(["%.3f" % (i * step)] + ["0.000000" if n == "-0.000000" else n for n in numbers]) + "\n")


def read_vertices(path):
    """Vertices of our own binary PLY or PCD files."""
    with open(path, "rb") as file:
        data = file.read()
    end = b"end_header\n" if path.endswith(".ply") else b"DATA binary\n"
    start = data.index(end) + len(end)
    header = data[:start].decode().split("\n")
    key = "element vertex " if path.endswith(".ply") else "POINTS "
    count = int(next(line for line in header if line.startswith(key))[len(key):])
    return list(struct.iter_unpack("<3f", data[start:start + 12 * count]))


def ground_heights(path, side, rim=0.012):
    """Heights [m] of the vertices under a sole and `rim` [m] around it: a triangle that begins outside may reach in."""
    y0 = (0.5 if side == "left" else -0.5) * FEET_APART
    heel, toe, half_width = SOLE
    return [z for x, y, z in read_vertices(path) if heel - rim <= x - ANKLE_X <= toe + rim and abs(y - y0) <= half_width + rim]


def rotation(axis, angle):
    """Matrix of a turn about a unit axis."""
    c, s, (x, y, z) = math.cos(angle), math.sin(angle), axis
    return [[c + x * x * (1 - c), x * y * (1 - c) - z * s, x * z * (1 - c) + y * s],
            [y * x * (1 - c) + z * s, c + y * y * (1 - c), y * z * (1 - c) - x * s],
            [z * x * (1 - c) - y * s, z * y * (1 - c) + x * s, c + z * z * (1 - c)]]


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def turned(r, v):
    return [sum(r[i][k] * v[k] for k in range(3)) for i in range(3)]


def numbers(text):
    return [float(number) for number in text.split()]


def link_poses(urdf, joints, root_xyz):
    """Link -> (rotation, position), joint -> (position, world axis), by the URDF's own numbers."""
    joint_of, poses, axes = {}, {}, {}
    children = set()
    for joint in urdf.findall("joint"):
        joint_of.setdefault(joint.find("parent").get("link"), []).append(joint)
        children.add(joint.find("child").get("link"))
    root = next(link.get("name") for link in urdf.findall("link") if link.get("name") not in children)
    poses[root] = ([[1, 0, 0], [0, 1, 0], [0, 0, 1]], list(root_xyz))
    queue = [root]
    while queue:
        parent = queue.pop(0)
        r, p = poses[parent]
        for joint in joint_of.get(parent, []):
            offset = turned(r, numbers(joint.find("origin").get("xyz")))
            position = [p[i] + offset[i] for i in range(3)]
            axis = joint.find("axis")
            turn = r
            if axis is not None:
                axes[joint.get("name")] = (position, turned(r, numbers(axis.get("xyz"))))
                turn = product(r, rotation(numbers(axis.get("xyz")), joints.get(joint.get("name"), 0.0)))
            child = joint.find("child").get("link")
            poses[child] = (turn, position)
            queue.append(child)
    return poses, axes


def masses(urdf, poses):
    """(link, mass, centre of mass in the world) of every link that has mass."""
    found = []
    for link in urdf.findall("link"):
        inertial = link.find("inertial")
        if inertial is None:
            continue
        r, p = poses[link.get("name")]
        c = turned(r, numbers(inertial.find("origin").get("xyz")))
        found.append((link.get("name"), float(inertial.find("mass").get("value")), [p[i] + c[i] for i in range(3)]))
    return found


def centre_of_mass(bodies):
    total = sum(mass for _, mass, _ in bodies)
    return total, [sum(mass * c[i] for _, mass, c in bodies) / total for i in range(3)]


def humanoid_urdf():
    return xml.parse(os.path.join(ROOT, "urdf", "blem_humanoid.urdf")).getroot()


def print_pose():
    urdf = humanoid_urdf()
    poses, _ = link_poses(urdf, posture(), pelvis_position())
    total, com = centre_of_mass(masses(urdf, poses))
    print("mass %.3f kg, centre of mass %.4f %.4f %.4f above soles at z = 0 whose middle is x = %.4f"
          % (total, com[0], com[1], com[2], ANKLE_X + 0.5 * (SOLE[0] + SOLE[1])))
    for file, layer in (("scanned_floor.ply", 0.0025), ("scanned_floor.pcd", 0.0065)):
        heights = [ground_heights(os.path.join(ROOT, "meshes", file), side) for side in ("left", "right")]
        for side, h in zip(("left", "right"), heights):
            print("%s %s: %d points, %.4f .. %.4f" % (file, side, len(h), min(h), max(h)))
        top = max(max(h) for h in heights)
        print("%s: root xyz [%.4f, 0, %.4f] with layers of %.4f just touching" % (file, PELVIS_X, pelvis_position()[2] + top + layer, layer))
    print("{" + ", ".join("%s: %.4f" % item for item in sorted(posture().items())) + "}")


def main():
    if sys.argv[1:] == ["--pose"]:
        return print_pose()
    out = sys.argv[1] if len(sys.argv) > 1 else os.path.join(ROOT, "config")
    write_csv(os.path.join(out, "demo_humanoid_sway.csv"), 10.0, 0.02, lambda t: posture(sway_at(t)))
    write_csv(os.path.join(out, "demo_gripper_mug.csv"), 10.0, 0.02, gripper_at)
    write_csv(os.path.join(out, "demo_robot_with_eyes.csv"), 10.0, 0.02, look_at)


if __name__ == "__main__":
    main()
