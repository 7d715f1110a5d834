"""Static equilibrium on contacts with friction, by linear programs: where the centre of mass may be, and what the joints must hold.

A robot at rest is balanced where forces within the friction cones of its contact points carry its weight and its moment. The horizontal
positions of the centre of mass for which there are such forces are a convex polygon [Bretl, Lall 2008]; on one flat floor it is the hull of the
contact points. Cones are pyramids of eight edges inside the true ones, so polygons are a little too small rather than too large.
"""
import collections
import math

import numpy as np
import scipy
from scipy.optimize import linprog

METHOD = "highs" if tuple(map(int, scipy.__version__.split(".")[:2])) >= (1, 6) else "revised simplex"  # exact corners; Ubuntu 20.04 has 1.3
EDGES = 8            # of a friction pyramid
RESOLVED = 1e-4      # [m] to which the polygon is known
MOST_CORNERS = 64
SAME_CORNER = 1e-6   # [m]

# A point that pushes: link, position [m] and unit normal out of the environment, both in the world; friction, and the most normal force as a share of
# the robot's weight.
ContactPoint = collections.namedtuple("ContactPoint", "link position normal friction most_force")


def pyramid(point):
    """Edges of a point's friction pyramid: rows of forces with a normal part of 1."""
    normal = np.asarray(point.normal)
    side = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
    side /= np.linalg.norm(side)
    other = np.cross(normal, side)
    angles = 2 * math.pi * np.arange(EDGES) / EDGES
    return normal + point.friction * (np.outer(np.cos(angles), side) + np.outer(np.sin(angles), other))


def force_rows(points):
    """All pyramids' edges, one below the other, and the rows that bound each point's normal force: (edges, bounds, most)."""
    edges = np.vstack([pyramid(point) for point in points])
    bounds = np.kron(np.eye(len(points)), np.ones(EDGES))
    return edges, bounds, np.array([point.most_force for point in points])


class Balance:
    """The linear program of a robot at rest on contact points; forces are in units of its weight."""

    def __init__(self, points):
        edges, self.bounds, self.most = force_rows(points)
        positions = np.repeat([point.position for point in points], EDGES, axis=0)
        self.middle = positions.mean(axis=0)
        moments = np.cross(positions - self.middle, edges)
        # Columns: edges' forces, then the centre of mass (x, y) from the middle. Its weight (0, 0, -1) has the moment (-y, x, 0).
        self.equal = np.zeros((6, len(edges) + 2))
        self.equal[:3, :-2], self.equal[3:, :-2] = edges.T, moments.T
        self.equal[3, -1], self.equal[4, -2] = -1.0, 1.0
        self.right = np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0])

    def farthest(self, direction):
        """The position (x, y) [m] of the centre of mass farthest along a direction, or None if nothing balances."""
        count = self.equal.shape[1]
        costs = np.zeros(count)
        costs[-2:] = -np.asarray(direction)
        above = np.hstack([self.bounds, np.zeros((len(self.bounds), 2))])
        found = linprog(costs, A_ub=above, b_ub=self.most, A_eq=self.equal, b_eq=self.right, method=METHOD,
                        bounds=[(0, None)] * (count - 2) + [(None, None)] * 2)
        return found.x[-2:] + self.middle[:2] if found.status == 0 else None


def support_region(points):
    """Corners (x, y) [m], counter-clockwise, of where the centre of mass may be; fewer than three if there is no such area."""
    if not points:
        return np.zeros((0, 2))
    balance = Balance(points)
    corners = [balance.farthest((math.cos(a), math.sin(a))) for a in (0.1, 2.2, 4.3)]
    if any(corner is None for corner in corners):
        return np.zeros((0, 2))
    corners, k = without_repeats(corners), 0
    while 1 < len(corners) < MOST_CORNERS and k < len(corners):
        a, b = corners[k], corners[(k + 1) % len(corners)]
        outward = np.array([b[1] - a[1], a[0] - b[0]]) / np.linalg.norm(b - a)
        corner = balance.farthest(outward)
        if corner is None or outward @ (corner - a) < RESOLVED:
            k += 1
        else:
            corners.insert(k + 1, corner)
    return np.array(without_repeats(corners))


def without_repeats(corners):
    kept = []
    for corner in corners:
        if all(np.linalg.norm(corner - other) > SAME_CORNER for other in kept):
            kept.append(corner)
    return kept


def region_margin(region, point):
    """Distance [m] from a point (x, y) to the edge of a region, negative outside; -inf if there is no region."""
    if len(region) < 3:
        return -math.inf
    ends = np.roll(region, -1, axis=0)
    along = ends - region
    outward = np.stack([along[:, 1], -along[:, 0]], axis=1) / np.linalg.norm(along, axis=1)[:, None]
    inside = -np.einsum("ij,ij->i", outward, point - region)
    if inside.min() >= 0:
        return float(inside.min())
    share = np.clip(np.einsum("ij,ij->i", point - region, along) / np.einsum("ij,ij->i", along, along), 0, 1)
    return -float(np.linalg.norm(region + share[:, None] * along - point, axis=1).min())


def region_middle(region):
    """Centroid of a region, (x, y) [m]."""
    ends = np.roll(region, -1, axis=0)
    crosses = region[:, 0] * ends[:, 1] - ends[:, 0] * region[:, 1]
    return np.einsum("i,ij->j", crosses, region + ends) / (3 * crosses.sum())


def towards(region, start, middle, margin):
    """The first point on the way from `start` to `middle` that has a margin, or the middle."""
    low, high = 0.0, 1.0
    if region_margin(region, start) >= margin:
        return start
    while high - low > 1e-4:  # the margin grows along the way, as the region is convex
        share = 0.5 * (low + high)
        low, high = (low, share) if region_margin(region, start + share * (middle - start)) >= margin else (share, high)
    return start + high * (middle - start)


def static_effort(placed, points, gravity):
    """(share, joint) of the effort limit that the most loaded joint needs at rest, with contact forces shared out as kindly as balance allows.

    share is infinite if nothing balances; joint is None if no joint has a limit. gravity [m/s^2], positive."""
    model = placed.model
    weight = model.mass * gravity
    limited = np.flatnonzero(np.isfinite(model.effort) & (model.effort > 0))
    if not len(limited) or not weight:
        return 0.0, None
    held = weight * placed.centre_jacobian()[2]  # efforts that gravity asks for
    lifts = np.zeros((len(held), 0))
    above, most = np.zeros((0, 0)), np.zeros(0)
    if points:
        edges, above, most = force_rows(points)
        jacobians = [placed.point_jacobian(point.link, point.position)[:3] for point in points]
        lifts = weight * np.hstack([jacobian.T @ edges[EDGES * k:EDGES * (k + 1)].T for k, jacobian in enumerate(jacobians)])
    count = lifts.shape[1]
    limits, rows = model.effort[limited], 6 + limited
    # Unknowns: forces, then the share s, with |held - lifts forces| <= s limits.
    columns = -limits[:, None]
    upper = np.vstack([np.hstack([lifts[rows], columns]), np.hstack([-lifts[rows], columns]), np.hstack([above, np.zeros((len(above), 1))])])
    costs = np.append(np.zeros(count), 1.0)
    equal = {} if model.fixed else {"A_eq": np.hstack([lifts[:6], np.zeros((6, 1))]) / weight, "b_eq": held[:6] / weight}
    found = linprog(costs, A_ub=upper, b_ub=np.concatenate([held[rows], -held[rows], most]), bounds=[(0, None)] * (count + 1), method=METHOD, **equal)
    if found.status != 0:
        return math.inf, None
    needs = np.abs(held[rows] - lifts[rows] @ found.x[:count]) / limits
    return float(needs.max()), model.joint_names[limited[int(np.argmax(needs))]]
