"""The demos' meshes, robots and motions: made by what is in this package, and sound before any simulation.

BLEM_SIM_RUN tells where the built programs are (scripts/test sets it).
"""
import csv
import importlib.util
import os
import pathlib
import struct
import subprocess

import pytest
import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
MESHES, CONFIG, URDF = ROOT / "meshes", ROOT / "config", ROOT / "urdf"


def load_script(name):
    spec = importlib.util.spec_from_file_location(name, str(ROOT / "scripts" / "support" / (name + ".py")))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


motions = load_script("make_demo_motions")
robots = load_script("make_demo_robots")


@pytest.fixture(scope="module")
def made_meshes(tmp_path_factory):
    program = pathlib.Path(os.environ.get("BLEM_SIM_RUN", "")).parent / "make_demo_scenes"
    if "BLEM_SIM_RUN" not in os.environ or not program.is_file():
        pytest.skip("BLEM_SIM_RUN does not name a built blem_sim_run beside make_demo_scenes; run by scripts/test")
    folder = tmp_path_factory.mktemp("meshes")
    subprocess.run([str(program), str(folder)], check=True, stdout=subprocess.DEVNULL)
    return folder


def numbers_of(path):
    """Header and floats of one of our binary files; PLY: vertices as floats, faces as bytes in the header."""
    data = path.read_bytes()
    if path.suffix == ".stl":
        count = struct.unpack_from("<I", data, 80)[0]
        floats = [f for i in range(count) for f in struct.unpack_from("<9f", data, 84 + 50 * i + 12)]
        return str(count), floats
    vertices = motions.read_vertices(str(path))
    floats = [f for v in vertices for f in v]
    if path.suffix == ".pcd":
        return str(len(vertices)), floats
    start = data.index(b"end_header\n") + len(b"end_header\n")
    return data[:start] + data[start + 4 * len(floats):], floats


def mesh_names():
    return sorted(p.name for p in MESHES.iterdir() if p.suffix in (".stl", ".ply", ".pcd"))


@pytest.mark.parametrize("name", mesh_names())
def test_mesh_is_what_make_demo_scenes_makes(name, made_meshes):
    header, floats = numbers_of(MESHES / name)
    made_header, made_floats = numbers_of(made_meshes / name)
    assert header == made_header
    assert len(floats) == len(made_floats)
    assert max(abs(a - b) for a, b in zip(floats, made_floats)) <= 1e-6


def test_every_mesh_made_is_kept(made_meshes):
    assert sorted(os.listdir(str(made_meshes))) == mesh_names()


@pytest.mark.parametrize("name", ["blem_humanoid.urdf", "demo_gripper.urdf", "demo_watcher.urdf"])
def test_urdf_is_what_make_demo_robots_makes(name, tmp_path):
    subprocess.run(["/usr/bin/python3", str(ROOT / "scripts" / "support" / "make_demo_robots.py"), str(tmp_path)], check=True)
    assert (tmp_path / name).read_text() == (URDF / name).read_text()


@pytest.mark.parametrize("name", ["demo_humanoid_sway.csv", "demo_gripper_mug.csv", "demo_robot_with_eyes.csv"])
def test_trajectory_is_what_make_demo_motions_makes(name, tmp_path):
    subprocess.run(["/usr/bin/python3", str(ROOT / "scripts" / "support" / "make_demo_motions.py"), str(tmp_path)], check=True)
    assert (tmp_path / name).read_text() == (CONFIG / name).read_text()


def test_scan_is_large_and_full_of_holes():
    data = (MESHES / "scanned_floor.ply").read_bytes()
    start = data.index(b"end_header\n") + len(b"end_header\n")
    header = data[:start].decode()
    vertices, faces = (int(line.split()[-1]) for line in header.split("\n") if line.startswith("element"))
    edges = {}
    for i in range(faces):
        _, a, b, c = struct.unpack_from("<B3i", data, start + 12 * vertices + 13 * i)
        for edge in ((a, b), (b, c), (c, a)):
            key = min(edge), max(edge)
            edges[key] = edges.get(key, 0) + 1
    assert faces >= 100000
    assert len(data) < 3e6
    assert sum(count == 1 for count in edges.values()) > 2000
    assert max(edges.values()) == 2


def surface_is_closed(path):
    edges = {}
    for triangle in robots.read_stl(str(path)):
        for i in range(3):
            edges[(triangle[i], triangle[(i + 1) % 3])] = edges.get((triangle[i], triangle[(i + 1) % 3]), 0) + 1
    return all(count == 1 and edges.get((b, a)) == 1 for (a, b), count in edges.items())


@pytest.mark.parametrize("name", [n for n in mesh_names() if n.startswith(("humanoid_", "gripper_", "finger_", "cube_", "watcher_"))])
def test_link_meshes_are_closed_and_wound_outwards(name):
    assert surface_is_closed(MESHES / name)
    assert robots.volume_properties(robots.read_stl(str(MESHES / name)))[0] > 0


def test_mug_is_an_open_shell():
    assert not surface_is_closed(MESHES / "shell_mug.stl")


def read_motion(name):
    with open(str(CONFIG / name)) as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


@pytest.mark.parametrize("name, urdf", [("demo_humanoid_sway.csv", "blem_humanoid.urdf"), ("demo_gripper_mug.csv", "demo_gripper.urdf"),
                                        ("demo_robot_with_eyes.csv", "demo_watcher.urdf")])
def test_motion_stays_within_limits(name, urdf):
    limits = {}
    for joint in motions.xml.parse(str(URDF / urdf)).getroot().findall("joint"):
        if joint.find("limit") is not None:
            limits[joint.get("name")] = {key: float(value) for key, value in joint.find("limit").attrib.items()}
    rows = read_motion(name)
    assert set(rows[0]) - {"time"} == set(limits)
    for before, after in zip(rows, rows[1:]):
        for joint, limit in limits.items():
            assert limit["lower"] <= after[joint] <= limit["upper"]
            assert abs(after[joint] - before[joint]) / (after["time"] - before["time"]) <= 0.5 * limit["velocity"]


def sole_corners(poses, side):
    r, p = poses[side + "_foot"]
    heel, toe, half_width = motions.SOLE
    corners = [(x, y, -motions.ANKLE_HEIGHT) for x in (heel, toe) for y in (-half_width, half_width)]
    return [[p[i] + motions.turned(r, corner)[i] for i in range(3)] for corner in corners]


def sway_postures():
    """(joints, pelvis position) over the motion; the pelvis is where the left sole lies flat on z = 0 at its place."""
    urdf = motions.humanoid_urdf()
    for joints in read_motion("demo_humanoid_sway.csv")[::10]:
        poses, _ = motions.link_poses(urdf, joints, (0, 0, 0))
        _, ankle = poses["left_foot"]
        yield urdf, joints, [motions.ANKLE_X - ankle[0], 0.5 * motions.FEET_APART - ankle[1], motions.ANKLE_HEIGHT - ankle[2]]


def test_feet_stay_flat_and_apart_while_the_hips_sway():
    reached = []
    for urdf, joints, pelvis in sway_postures():
        poses, _ = motions.link_poses(urdf, joints, pelvis)
        for corner in sole_corners(poses, "left") + sole_corners(poses, "right"):
            assert abs(corner[2]) < 1e-5
        assert poses["left_foot"][1][1] - poses["right_foot"][1][1] == pytest.approx(motions.FEET_APART, abs=1e-5)
        reached.append(pelvis[1])
    assert max(reached) == pytest.approx(0.04, abs=1e-4) and min(reached) == pytest.approx(-0.04, abs=1e-4)


def test_centre_of_mass_stays_well_inside_the_support_polygon():
    for urdf, joints, pelvis in sway_postures():
        poses, _ = motions.link_poses(urdf, joints, pelvis)
        total, com = motions.centre_of_mass(motions.masses(urdf, poses))
        assert 25 < total < 35
        heel, toe, half_width = motions.SOLE
        assert motions.ANKLE_X + heel + 0.05 < com[0] < motions.ANKLE_X + toe - 0.05
        assert abs(com[1]) < 0.5 * motions.FEET_APART + half_width - 0.05


def distal_links(urdf, joint_name):
    joint = next(j for j in urdf.findall("joint") if j.get("name") == joint_name)
    links = [joint.find("child").get("link")]
    for link in links:
        links += [j.find("child").get("link") for j in urdf.findall("joint") if j.find("parent").get("link") == link]
    return links


def static_torques(urdf, joints, pelvis):
    """Torque [N m] that holds each joint: what weighs and what pushes on the links beyond it; soles pushed at their middles."""
    poses, axes = motions.link_poses(urdf, joints, pelvis)
    bodies = motions.masses(urdf, poses)
    total, com = motions.centre_of_mass(bodies)
    left_share = min(max(0.5 + com[1] / motions.FEET_APART, 0), 1)
    loads = [(link, c, -9.81 * mass) for link, mass, c in bodies]
    for side, share in (("left", left_share), ("right", 1 - left_share)):
        corners = sole_corners(poses, side)
        middle = [sum(corner[i] for corner in corners) / 4 for i in range(3)]
        loads.append((side + "_foot", middle, 9.81 * total * share))
    torques = {}
    for name, (origin, axis) in axes.items():
        beyond = distal_links(urdf, name)
        moment = [0.0, 0.0]
        for link, point, force in loads:
            if link in beyond:
                moment[0] += (point[1] - origin[1]) * force
                moment[1] -= (point[0] - origin[0]) * force
        torques[name] = -(axis[0] * moment[0] + axis[1] * moment[1])
    return torques


def test_motors_hold_the_robot_with_half_their_effort():
    for urdf, joints, pelvis in sway_postures():
        efforts = {j.get("name"): float(j.find("limit").get("effort")) for j in urdf.findall("joint") if j.find("limit") is not None}
        for name, torque in static_torques(urdf, joints, pelvis).items():
            assert abs(torque) < 0.5 * efforts[name], name


@pytest.mark.parametrize("config, cloud, layer", [("demo_humanoid_on_scan.yaml", "scanned_floor.ply", 0.0025),
                                                  ("demo_point_cloud.yaml", "scanned_floor.pcd", 0.0065)])
def test_humanoid_starts_close_above_the_ground(config, cloud, layer):
    robot = yaml.safe_load((CONFIG / config).read_text())["robots"][0]
    urdf = motions.humanoid_urdf()
    poses, _ = motions.link_poses(urdf, robot["initial_positions"], robot["pose"]["xyz"])
    gaps = []
    for side in ("left", "right"):
        heights = motions.ground_heights(str(MESHES / cloud), side)
        assert len(heights) > 200 and max(heights) - min(heights) < 0.012
        bottoms = [corner[2] for corner in sole_corners(poses, side)]
        assert max(bottoms) - min(bottoms) < 1e-4
        gaps.append(min(bottoms) - max(heights) - layer)
    assert 0 < min(gaps) < 1e-3
    assert max(gaps) < 2e-3
    first = read_motion("demo_humanoid_sway.csv")[0]
    for joint, angle in robot["initial_positions"].items():
        assert angle == pytest.approx(first[joint], abs=1e-4)
