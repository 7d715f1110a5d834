"""Kinematics of a URDF in plain Python, independent of the simulator: poses of links, centre of mass, inverse kinematics.

A pose is a pair (R, p): rotation matrix as three rows, and position [m]. Units are m, rad, kg.
"""
import math
import xml.etree.ElementTree as ElementTree

IDENTITY = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
AT_ORIGIN = (IDENTITY, (0.0, 0.0, 0.0))


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def added(a, b, scale=1.0):
    return tuple(x + scale * y for x, y in zip(a, b))


def transposed(r):
    return tuple(zip(*r))


def turned(r, v):
    return (dot(r[0], v), dot(r[1], v), dot(r[2], v))


def product(a, b):
    columns = transposed(b)
    return tuple(tuple(dot(row, column) for column in columns) for row in a)


def composed(a, b):
    """The pose b, given in a's frame, in the frame that a is given in."""
    return product(a[0], b[0]), added(a[1], turned(a[0], b[1]))


def inverse(pose):
    back = transposed(pose[0])
    return back, tuple(-x for x in turned(back, pose[1]))


def rotation(axis, angle):
    """Matrix of a turn about a unit axis."""
    c, s, (x, y, z) = math.cos(angle), math.sin(angle), axis
    return ((c + x * x * (1 - c), x * y * (1 - c) - z * s, x * z * (1 - c) + y * s),
            (y * x * (1 - c) + z * s, c + y * y * (1 - c), y * z * (1 - c) - x * s),
            (z * x * (1 - c) - y * s, z * y * (1 - c) + x * s, c + z * z * (1 - c)))


def from_rpy(rpy):
    """Roll, pitch, yaw about fixed axes."""
    return product(rotation((0, 0, 1), rpy[2]), product(rotation((0, 1, 0), rpy[1]), rotation((1, 0, 0), rpy[0])))


def from_quaternion(x, y, z, w):
    return ((1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
            (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
            (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)))


def turn_between(a, b):
    """Rotation vector [rad], in the frame that both are given in, that takes the matrix a to b."""
    r = product(b, transposed(a))
    v = (0.5 * (r[2][1] - r[1][2]), 0.5 * (r[0][2] - r[2][0]), 0.5 * (r[1][0] - r[0][1]))
    sine, cosine = math.sqrt(dot(v, v)), 0.5 * (r[0][0] + r[1][1] + r[2][2] - 1)
    if sine < 1e-12:
        return v
    return tuple(x * math.atan2(sine, cosine) / sine for x in v)


def solved(matrix, right):
    """The solution of a small system with a positive definite matrix."""
    n = len(right)
    rows = [list(row) + [value] for row, value in zip(matrix, right)]
    for i in range(n):
        for k in range(i + 1, n):
            factor = rows[k][i] / rows[i][i]
            rows[k] = [x - factor * y for x, y in zip(rows[k], rows[i])]
    x = [0.0] * n
    for i in reversed(range(n)):
        x[i] = (rows[i][n] - sum(rows[i][k] * x[k] for k in range(i + 1, n))) / rows[i][i]
    return x


def _numbers(element, name, default):
    text = element.get(name) if element is not None else None
    return tuple(float(number) for number in text.split()) if text else default


def _origin(element):
    origin = element.find("origin")
    return from_rpy(_numbers(origin, "rpy", (0.0, 0.0, 0.0))), _numbers(origin, "xyz", (0.0, 0.0, 0.0))


class _Joint:
    def __init__(self, element):
        self.name, self.type = element.get("name"), element.get("type")
        self.parent, self.child = element.find("parent").get("link"), element.find("child").get("link")
        self.origin, self.axis = _origin(element), _numbers(element.find("axis"), "xyz", (1.0, 0.0, 0.0))
        limit = element.find("limit")
        self.lower, self.upper = (_numbers(limit, side, (way,))[0] for side, way in (("lower", -math.inf), ("upper", math.inf)))
        self.velocity, self.effort = (_numbers(limit, bound, (math.inf,))[0] for bound in ("velocity", "effort"))  # most that it may
        soft = element.find("safety_controller")
        self.soft_lower, self.soft_upper = (_numbers(soft, "soft_%s_limit" % side, (0.0,))[0] for side in ("lower", "upper"))
        mimic = element.find("mimic")
        self.mimics = None
        if mimic is not None:
            self.mimics = (mimic.get("joint"), float(mimic.get("multiplier", "1")), float(mimic.get("offset", "0")))

    def position(self, positions):
        if self.mimics:
            return self.mimics[1] * positions.get(self.mimics[0], 0.0) + self.mimics[2]
        return positions.get(self.name, 0.0)

    def pose(self, positions):
        """Of the child link in the parent's."""
        if self.type == "fixed":
            return self.origin
        if self.type == "prismatic":
            return composed(self.origin, (IDENTITY, added((0, 0, 0), self.axis, self.position(positions))))
        return composed(self.origin, (rotation(self.axis, self.position(positions)), (0.0, 0.0, 0.0)))


class Tree:
    """Links and joints of a URDF file. Positions are a map by joint name; joints left out stand at 0, mimic joints follow."""

    def __init__(self, urdf):
        robot = ElementTree.parse(str(urdf)).getroot()
        by_parent = {}
        for joint in map(_Joint, robot.findall("joint")):
            by_parent.setdefault(joint.parent, []).append(joint)
        children = {joint.child for joints in by_parent.values() for joint in joints}
        self.root = next(link.get("name") for link in robot.findall("link") if link.get("name") not in children)
        self.joints, queue = [], [self.root]  # parents before children
        while queue:
            found = by_parent.get(queue.pop(0), [])
            self.joints += found
            queue += [joint.child for joint in found]
        self.masses = {}  # link -> (mass [kg], centre of mass [m] in the link)
        for link in robot.findall("link"):
            inertial = link.find("inertial")
            if inertial is not None:
                self.masses[link.get("name")] = (float(inertial.find("mass").get("value")), _origin(inertial)[1])

    def total_mass(self):
        return sum(mass for mass, _ in self.masses.values())

    def link_poses(self, positions, root=AT_ORIGIN):
        """Link name -> pose in the world, with the root link at a pose."""
        poses = {self.root: root}
        for joint in self.joints:
            poses[joint.child] = composed(poses[joint.parent], joint.pose(positions))
        return poses

    def centre_of_mass(self, poses):
        sums = (0.0, 0.0, 0.0)
        for link, (mass, centre) in self.masses.items():
            rotation_of, position = poses[link]
            sums = added(sums, added(position, turned(rotation_of, centre)), mass)
        return tuple(x / self.total_mass() for x in sums)

    def beyond_limits(self, positions):
        """Names of the joints that stand outside their limits."""
        return [joint.name for joint in self.joints if joint.name in positions and not joint.lower <= positions[joint.name] <= joint.upper]

    def jacobian(self, link, point, joints, positions):
        """Columns (v, w) [m/rad, 1] of revolute joints: how a point [m, world] that moves with a link goes when a joint turns."""
        poses = self.link_poses(positions)
        above, at = set(), link
        by_child = {joint.child: joint for joint in self.joints}
        while at in by_child:
            above.add(by_child[at].name)
            at = by_child[at].parent
        columns = []
        for name in joints:
            joint = next(j for j in self.joints if j.name == name)
            rotation_of, position = composed(poses[joint.parent], joint.origin)
            axis = turned(rotation_of, joint.axis) if name in above else (0.0, 0.0, 0.0)
            columns.append(cross(axis, added(point, position, -1)) + tuple(axis))
        return columns

    def reach(self, link, goal, joints, start, damping=1e-3, rounds=300):
        """Inverse kinematics by damped least squares: positions that bring a link to a pose, as near to `start` as the descent goes.

        Only the named revolute joints move. Raises ValueError if the pose is still off by more than 1e-8 after so many rounds.
        """
        positions = dict(start)
        for _ in range(rounds):
            rotation_of, position = self.link_poses(positions)[link]
            error = added(goal[1], position, -1) + turn_between(rotation_of, goal[0])
            if max(map(abs, error)) < 1e-10:
                break
            columns = self.jacobian(link, position, joints, positions)
            square = [[sum(c[i] * c[k] for c in columns) + (damping ** 2 if i == k else 0.0) for k in range(6)] for i in range(6)]
            step = solved(square, error)
            change = [sum(x * y for x, y in zip(column, step)) for column in columns]
            scale = min(1.0, 0.2 / max(max(map(abs, change)), 1e-12))
            for name, value in zip(joints, change):
                positions[name] = positions.get(name, 0.0) + scale * value
        else:
            if max(map(abs, error)) > 1e-8:
                raise ValueError("%s does not reach %s: still off by %.3g" % (link, goal[1], max(map(abs, error))))
        return positions
