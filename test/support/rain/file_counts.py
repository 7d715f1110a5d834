"""Triangles and points that the files of meshes and clouds hold, read from their headers and rows alone; polygons of n corners are n - 2 triangles."""
import struct
import xml.etree.ElementTree as ElementTree


def count(path):
    """(triangles, points without faces) that a file holds, broken ones included."""
    return {"stl": stl, "ply": ply, "pcd": pcd, "off": off, "obj": obj, "dae": collada}[path.suffix[1:].lower()](path)


def stl(path):
    data = path.read_bytes()
    binary = struct.unpack_from("<I", data, 80)[0] if len(data) >= 84 else 0
    if len(data) == 84 + 50 * binary:
        return binary, 0
    return sum(row.split()[:1] == ["facet"] for row in data.decode(errors="replace").splitlines()), 0


def ply(path):
    """Of triangles alone, as all of the shared ones are."""
    header = path.read_bytes().split(b"end_header")[0].decode().splitlines()
    counts = {row.split()[1]: int(row.split()[2]) for row in header if row.startswith("element")}
    return counts.get("face", 0), 0 if counts.get("face") else counts["vertex"]


def pcd(path):
    header = path.read_bytes().split(b"DATA")[0].decode().splitlines()
    return 0, next(int(row.split()[1]) for row in header if row.startswith("POINTS"))


def off(path):
    numbers = path.read_text().split()
    faces, at, triangles = int(numbers[2]), 4 + 3 * int(numbers[1]), 0
    for _ in range(faces):
        triangles += int(numbers[at]) - 2
        at += 1 + int(numbers[at])
    return triangles, 0


def obj(path):
    rows = [row.split() for row in path.read_text().splitlines()]
    return sum(len(row) - 3 for row in rows if row[:1] == ["f"]), 0


def collada(path):
    """Of all instances of geometries below the scene's nodes."""
    root = ElementTree.parse(path).getroot()
    space = {"c": root.tag[1:].split("}")[0]}
    triangles = {geometry.get("id"): geometry_triangles(geometry, space) for geometry in root.iterfind(".//c:geometry", space)}
    scenes = root.iterfind(".//c:visual_scene//c:instance_geometry", space)
    return sum(triangles[instance.get("url")[1:]] for instance in scenes), 0


def geometry_triangles(geometry, space):
    plain = sum(int(part.get("count")) for part in geometry.iterfind(".//c:triangles", space))
    lists = [part.find("c:vcount", space).text for part in geometry.iterfind(".//c:polylist", space) if int(part.get("count"))]
    return plain + sum(int(corners) - 2 for text in lists for corners in text.split())
