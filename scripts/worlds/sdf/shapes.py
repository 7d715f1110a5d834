"""Shapes of SDF as triangles, for what stands still, and as shapes of URDF."""
import math
from xml.etree import ElementTree

import numpy as np

from sdf.elements import InputError, number, numbers, text

FLATTENED = 1e-4  # [m] by which sides of a round shape lie within it
SIDES = (24, 256)


def shape_of(geometry, where):
    """Element of the one shape that a <geometry> has. Raises InputError for one that blem_sim has not."""
    shape = next((child for child in geometry if child.tag in READERS or child.tag == "mesh"), None) if geometry is not None else None
    if shape is None:
        other = geometry[0].tag if geometry is not None and len(geometry) else "empty"
        raise InputError("%s: <geometry> %s is not read; write a mesh, box, cylinder, sphere or capsule" % (where, other))
    return shape


def box(shape, where):
    return ("box", numbers(text(shape, "size", "1 1 1"), 3, where + ": <size>"))


def cylinder(shape, where):
    return ("cylinder", [number(shape, "radius", 0.5, where), number(shape, "length", 1.0, where)])


def sphere(shape, where):
    return ("sphere", [number(shape, "radius", 0.5, where)])


def capsule(shape, where):
    return ("capsule", [number(shape, "radius", 0.5, where), number(shape, "length", 1.0, where)])


READERS = {"box": box, "cylinder": cylinder, "sphere": sphere, "capsule": capsule}


def parts_of(shape, where):
    """The shape as boxes, cylinders and spheres: name, sizes [m], height [m] of its middle along z."""
    name, sizes = READERS[shape.tag](shape, where)
    if min(sizes) <= 0:
        raise InputError("%s: a <%s> with a size of %g is none; write metres above 0" % (where, name, min(sizes)))
    if name != "capsule":
        return [(name, sizes, 0.0)]
    radius, length = sizes
    return [("cylinder", sizes, 0.0), ("sphere", [radius], 0.5 * length), ("sphere", [radius], -0.5 * length)]


def urdf_shape(name, sizes):
    element = ElementTree.Element(name)
    if name == "box":
        element.set("size", "%.9g %.9g %.9g" % tuple(sizes))
    else:
        element.set("radius", "%.9g" % sizes[0])
        if name == "cylinder":
            element.set("length", "%.9g" % sizes[1])
    return element


def sides_of(radius):
    return int(min(max(math.ceil(math.pi / math.acos(max(0.0, 1 - FLATTENED / radius))), SIDES[0]), SIDES[1]))


def turned(profile, sides):
    """Triangles of a profile of (radius, height) that is turned about z, from the lowest point to the highest."""
    points, rings = [], []
    for radius, height in profile:
        count = 1 if radius == 0 else sides
        rings.append([len(points) + k for k in range(count)])
        points += [(radius * math.cos(2 * math.pi * k / sides), radius * math.sin(2 * math.pi * k / sides), height) for k in range(count)]
    triangles = []
    for low, high in zip(rings, rings[1:]):
        for k in range(sides):
            a, b = low[k % len(low)], low[(k + 1) % len(low)]
            c, d = high[k % len(high)], high[(k + 1) % len(high)]
            triangles += [(a, b, d)] if a != b else []
            triangles += [(a, d, c)] if c != d else []
    return np.array(points), triangles


def triangles_of(name, sizes):
    """Points [m] and triangles, counter-clockwise from outside."""
    if name == "box":
        points = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]) * sizes
        squares = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
        return points, [t for a, b, c, d in squares for t in ((a, b, c), (a, c, d))]
    radius, sides = sizes[0], sides_of(sizes[0])
    if name == "cylinder":
        half = 0.5 * sizes[1]
        return turned([(0, -half), (radius, -half), (radius, half), (0, half)], sides)
    rows = sides // 2
    arc = [math.pi * k / rows for k in range(rows + 1)]
    profile = [(0.0 if k in (0, rows) else radius * math.sin(angle), -radius * math.cos(angle)) for k, angle in enumerate(arc)]
    return turned(profile, sides)


class Mesh:
    """Triangles of several shapes in one frame."""

    def __init__(self):
        self.points, self.triangles = [], []

    def add(self, name, sizes, X):
        """X: pose of the shape in the mesh's frame."""
        points, triangles = triangles_of(name, sizes)
        first = len(self.points)
        self.points += [X[:3, :3] @ point + X[:3, 3] for point in points]
        self.triangles += [[first + corner for corner in triangle] for triangle in triangles]

    def write(self, path):
        lines = ["OFF", "%d %d 0" % (len(self.points), len(self.triangles))]
        lines += ["%.9g %.9g %.9g" % tuple(point) for point in self.points]
        lines += ["3 %d %d %d" % tuple(triangle) for triangle in self.triangles]
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")
