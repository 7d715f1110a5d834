"""Kinematics and weights of a robot in numpy: where its links are, and how they, its centre of mass and its efforts answer to its joints.

Coordinates of a robot are the six of its root (velocity of the root link's origin and angular velocity, in the world) and then its joints
without those that mimic others. Units are m, rad, kg; poses are in the world.
"""
import math

import numpy as np

ROOT_COORDINATES = 6


class Posture:
    """Where the root link is, and the positions of the joints (RobotModel.joint_names)."""

    def __init__(self, rotation, position, joints):
        self.rotation, self.position, self.joints = np.asarray(rotation, float), np.asarray(position, float), np.asarray(joints, float)

    def moved(self, step):
        """The posture after a small step of the coordinates."""
        return Posture(turn(step[3:6]) @ self.rotation, self.position + step[:3], self.joints + step[ROOT_COORDINATES:])


def skew(v):
    """Matrix of the cross product with a vector."""
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def cross_products(a, b):
    """Of the rows of two arrays; numpy's own takes five times as long for so few."""
    return a[:, [1, 2, 0]] * b[:, [2, 0, 1]] - a[:, [2, 0, 1]] * b[:, [1, 2, 0]]


def turns(axes, angles):
    """Matrices of turns about unit axes."""
    crosses = np.zeros((len(axes), 3, 3))
    crosses[:, 0, 1], crosses[:, 0, 2], crosses[:, 1, 2] = -axes[:, 2], axes[:, 1], -axes[:, 0]
    crosses -= crosses.transpose(0, 2, 1)
    sines, versines = np.sin(angles)[:, None, None], (1 - np.cos(angles))[:, None, None]
    return np.eye(3) + sines * crosses + versines * (crosses @ crosses)


def turn(rotation_vector):
    """Matrix of a rotation vector [rad]."""
    angle = float(np.linalg.norm(rotation_vector))
    if angle < 1e-15:
        return np.eye(3)
    return turns(np.array([rotation_vector]) / angle, np.array([angle]))[0]


def rotation_vector(matrix):
    """Rotation vector [rad] of a matrix that turns by less than half a turn."""
    v = 0.5 * np.array([matrix[2, 1] - matrix[1, 2], matrix[0, 2] - matrix[2, 0], matrix[1, 0] - matrix[0, 1]])
    sine, cosine = float(np.linalg.norm(v)), 0.5 * (np.trace(matrix) - 1)
    return v if sine < 1e-12 else v * (np.arctan2(sine, cosine) / sine)


def quaternion(rotation):
    """x, y, z, w of a rotation matrix, w not negative."""
    m = np.asarray(rotation)
    w = 0.5 * math.sqrt(max(0.0, 1 + m[0, 0] + m[1, 1] + m[2, 2]))
    parts = [0.5 * math.sqrt(max(0.0, 1 + 2 * m[k, k] - np.trace(m))) for k in range(3)]
    if w > 1e-3:
        signs = (m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1])
        return [math.copysign(part, sign) for part, sign in zip(parts, signs)] + [w]
    largest = int(np.argmax(parts))
    return [math.copysign(part, m[largest, k] if k != largest else 1.0) for k, part in enumerate(parts)] + [w]


class RobotModel:
    """A kinematics.Tree as arrays. fixed: the root link stays where it is."""

    def __init__(self, tree, fixed, effort_limits, velocity_limits):
        self.tree, self.fixed = tree, fixed
        self.links = [tree.root] + [joint.child for joint in tree.joints]
        parent_of = {joint.child: joint.parent for joint in tree.joints}
        self.parents = [self.links.index(joint.parent) for joint in tree.joints]
        self.origin_rotations = np.array([joint.origin[0] for joint in tree.joints]).reshape(-1, 3, 3)
        self.origins = np.array([joint.origin[1] for joint in tree.joints]).reshape(-1, 3)
        self.axes = np.array([np.array(joint.axis) / max(np.linalg.norm(joint.axis), 1e-12) for joint in tree.joints]).reshape(-1, 3)
        self.slides = np.array([joint.type == "prismatic" for joint in tree.joints], bool)
        self.masses = np.array([tree.masses.get(link, (0.0, None))[0] for link in self.links])
        self.centres = np.array([tree.masses.get(link, (0.0, (0.0, 0.0, 0.0)))[1] for link in self.links])
        self.mass = float(self.masses.sum())
        self.moves = np.zeros((len(tree.joints), len(self.links)), bool)  # whether a joint moves a link
        for column, link in enumerate(self.links):
            while link in parent_of:
                self.moves[self.links.index(link) - 1, column] = True
                link = parent_of[link]
        self.read_joints()
        for limits, given in ((self.effort, effort_limits), (self.velocity, velocity_limits)):
            for name, limit in given.items():
                if name in self.joint_names:
                    limits[self.joint_names.index(name)] = limit
        for limits in (self.effort, self.velocity):
            limits[limits <= 0] = np.inf  # as the simulator takes them: none

    def read_joints(self):
        """Names, limits and couplings of the joints that mimic no other."""
        joints = self.tree.joints
        self.joint_names = [joint.name for joint in joints if joint.type != "fixed" and not joint.mimics]
        self.coupling, self.offsets = np.zeros((len(joints), len(self.joint_names))), np.zeros(len(joints))
        count = len(self.joint_names)
        self.lower, self.upper, self.velocity, self.effort = np.full(count, -np.inf), np.full(count, np.inf), np.full(count, np.inf), np.full(count, np.inf)
        for row, joint in enumerate(joints):
            if joint.type == "fixed":
                continue
            leader, factor, offset = joint.mimics or (joint.name, 1.0, 0.0)
            column = self.joint_names.index(leader)
            self.coupling[row, column], self.offsets[row] = factor, offset
            self.bound(column, joint, factor, offset)

    def bound(self, column, joint, factor, offset):
        """Takes a joint's limits over to the one that leads it, which may be itself; those that leave the leader no way are not kept."""
        if not joint.mimics:
            self.effort[column] = joint.effort
        if factor == 0.0:
            return
        if joint.velocity > 0:
            self.velocity[column] = min(self.velocity[column], joint.velocity / abs(factor))
        if joint.type == "continuous":
            return
        lower, upper = joint.lower, joint.upper
        if joint.soft_lower < joint.soft_upper:
            lower, upper = max(lower, joint.soft_lower), min(upper, joint.soft_upper)
        low, high = sorted(((lower - offset) / factor, (upper - offset) / factor))
        low, high = max(low, self.lower[column]), min(high, self.upper[column])
        if low < high:
            self.lower[column], self.upper[column] = low, high

    def joints_between(self, links):
        """Coordinates of the joints, ROOT_COORDINATES not counted, that lie between the root and any of these links."""
        rows = self.moves[:, [self.links.index(link) for link in links]].any(axis=1)
        return [column for column in range(len(self.joint_names)) if (self.coupling[rows, column] != 0).any()]

    def links_below(self, link):
        """A link and all that hangs on it."""
        if link == self.links[0]:
            return self.links
        return [self.links[column] for column in np.flatnonzero(self.moves[self.links.index(link) - 1])]

    def joints_apart(self, link, other):
        """How many joints that move lie between two links."""
        a, b = [self.moves[:, self.links.index(name)] for name in (link, other)]
        return int(((a != b) & (self.coupling != 0).any(axis=1)).sum())

    def place(self, posture):
        """Where everything is in a posture."""
        return PlacedRobot(self, posture)

    def all_joints(self, posture):
        """{name: position} of the joints that a motor moves."""
        return {name: float(value) for name, value in zip(self.joint_names, posture.joints)}


class PlacedRobot:
    """A robot in one posture."""

    def __init__(self, model, posture):
        self.model, self.posture = model, posture
        positions = model.coupling @ posture.joints + model.offsets
        local = model.origin_rotations @ turns(model.axes, np.where(model.slides, 0.0, positions))
        slid = model.origins + np.einsum("nij,nj->ni", model.origin_rotations, model.axes) * np.where(model.slides, positions, 0.0)[:, None]
        self.rotations, self.positions = np.empty((len(model.links), 3, 3)), np.empty((len(model.links), 3))
        self.rotations[0], self.positions[0] = posture.rotation, posture.position
        for child, parent in enumerate(model.parents, 1):
            self.positions[child] = self.positions[parent] + self.rotations[parent] @ slid[child - 1]
            self.rotations[child] = self.rotations[parent] @ local[child - 1]
        self.axes = np.einsum("nij,nj->ni", self.rotations[1:], model.axes)
        self.centres = self.positions + np.einsum("nij,nj->ni", self.rotations, model.centres)
        self.centre_of_mass = model.masses @ self.centres / model.mass if model.mass else self.positions[0]

    def link(self, name):
        """(rotation, position) of a link."""
        k = self.model.links.index(name)
        return self.rotations[k], self.positions[k]

    def point_jacobian(self, link, point):
        """Six rows, velocity of a point [m] that moves with a link and the link's angular velocity, per coordinate."""
        k = self.model.links.index(link)
        moved = self.model.moves[:, k, None]
        linear = np.where(self.model.slides[:, None], self.axes, cross_products(self.axes, point - self.positions[1:])) * moved
        angular = np.where(self.model.slides[:, None], 0.0, self.axes) * moved
        rows = np.zeros((6, ROOT_COORDINATES + len(self.model.joint_names)))
        rows[:3, :3], rows[:3, 3:6], rows[3:, 3:6] = np.eye(3), -skew(point - self.positions[0]), np.eye(3)
        rows[:3, 6:], rows[3:, 6:] = linear.T @ self.model.coupling, angular.T @ self.model.coupling
        return rows

    def centre_jacobian(self):
        """Three rows, velocity of the centre of mass per coordinate."""
        model = self.model
        masses = model.moves @ model.masses
        moments = model.moves @ (model.masses[:, None] * self.centres) - masses[:, None] * self.positions[1:]
        linear = np.where(model.slides[:, None], self.axes * masses[:, None], cross_products(self.axes, moments)) / model.mass
        rows = np.zeros((3, ROOT_COORDINATES + len(model.joint_names)))
        rows[:, :3], rows[:, 3:6], rows[:, 6:] = np.eye(3), -skew(self.centre_of_mass - self.positions[0]), linear.T @ model.coupling
        return rows
