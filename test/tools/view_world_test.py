"""Pictures of view_world: things are where the camera model says, contacts are shown, the same input gives the same bytes, bad input one line.

BLEM_SIM_RUN tells where the built programs are (scripts/test sets it).
"""
import math
import os
import pathlib
import shutil
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "test" / "support"))
from shared_data import shared_data  # noqa: E402

CUBE = ROOT / "meshes" / "cube_10cm.stl"
PROGRAM = pathlib.Path(os.environ.get("BLEM_SIM_RUN", "")).parent / "view_world"
HALF_HEIGHT = math.radians(20)  # of the view
WIDTH, HEIGHT = 320, 240
FLOATING = """
gravity: [0, 0, 0]
file_roots: [%s]
objects:
  - {name: cube, uri: %s, mass: 1, pose: {xyz: [0.1, 0.2, 0.3]}, boundary_width: 0.02}
""" % (CUBE.parent, CUBE)
RESTING = """
file_roots: [%s]
environments: [{name: ground, plane: [0, 0, 1, 0]}]
objects: [{name: cube, uri: %s, mass: 1, pose: {xyz: [0, 0, 0.0525]}}]
""" % (CUBE.parent, CUBE)


@pytest.fixture(autouse=True)
def programs():
    if "BLEM_SIM_RUN" not in os.environ or not PROGRAM.is_file():
        pytest.skip("BLEM_SIM_RUN does not name a built blem_sim_run beside view_world (left out without VTK); run by scripts/test")
    if not shutil.which("Xvfb"):
        pytest.skip("Xvfb is not installed")
    pytest.importorskip("PIL.Image", reason="pictures are read by python3-pil, which is not installed")


def call(config, output, *options, **environment):
    command = [str(PROGRAM), str(config), str(output), "--size", "%dx%d" % (WIDTH, HEIGHT)] + list(options)
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, timeout=120,
                          env=dict(os.environ, **environment))


def draw(folder, config, *options, name="picture.png", **environment):
    """Draws a world. Returns the picture's file."""
    (folder / "world.yaml").write_text(config)
    result = call(folder / "world.yaml", folder / name, *options, **environment)
    assert result.returncode == 0, result.stderr
    return folder / name


class Picture:
    def __init__(self, file):
        from PIL import Image
        self.image = Image.open(str(file)).convert("RGB")
        assert self.image.size == (WIDTH, HEIGHT)
        self.at = self.image.load()

    def places(self, holds):
        return [(x, y) for x in range(WIDTH) for y in range(HEIGHT) if holds(x, y)]

    def drawn(self):
        """Pixels that are no background, which is the same along each row."""
        return self.places(lambda x, y: self.at[x, y] != self.at[0, y])

    def changed(self, other):
        return self.places(lambda x, y: self.at[x, y] != other.at[x, y])


def subtract(a, b):
    return [p - q for p, q in zip(a, b)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(p * q for p, q in zip(a, b))


def unit(a):
    return [p / math.sqrt(dot(a, a)) for p in a]


def project(camera, point):
    """Place of a point in the picture [pixels from the left, from above]; z is up. @param camera x, y, z, tx, ty, tz"""
    along = unit(subtract(camera[3:], camera[:3]))
    right = unit(cross(along, [0, 0, 1]))
    up = cross(right, along)
    way = subtract(point, camera[:3])
    focal = 0.5 * HEIGHT / math.tan(HALF_HEIGHT)
    return 0.5 * WIDTH + focal * dot(way, right) / dot(way, along), 0.5 * HEIGHT - focal * dot(way, up) / dot(way, along)


def corners(middle, half):
    return [[middle[0] + x, middle[1] + y, middle[2] + z] for x in (-half, half) for y in (-half, half) for z in (-half, half)]


def bounds(places):
    return [f(place[i] for place in places) for f in (min, max) for i in (0, 1)]


def option(camera):
    return "--camera=" + ",".join("%g" % number for number in camera)


CAMERA = [0.9, -0.5, 0.8, 0.15, 0.2, 0.25]


def test_cube_is_where_the_camera_sees_it(tmp_path):
    drawn = Picture(draw(tmp_path, FLOATING, option(CAMERA))).drawn()
    expected = bounds([project(CAMERA, corner) for corner in corners([0.1, 0.2, 0.3], 0.05)])
    # The last pixel that is drawn begins a pixel before the edge.
    assert bounds(drawn) == pytest.approx([expected[0], expected[1], expected[2] - 1, expected[3] - 1], abs=1)
    assert len(drawn) > 1000


def test_layers_stand_around_the_cube(tmp_path):
    drawn = Picture(draw(tmp_path, FLOATING, option(CAMERA), "--layers")).drawn()
    along = unit(subtract(CAMERA[3:], CAMERA[:3]))
    seen = []
    for corner in corners([0.1, 0.2, 0.3], 0.05):
        x, y = project(CAMERA, corner)
        r = 0.5 * HEIGHT / math.tan(HALF_HEIGHT) * 0.02 / dot(subtract(corner, CAMERA[:3]), along)
        seen += [[x - r, y - r], [x + r - 1, y + r - 1]]
    assert bounds(drawn) == pytest.approx(bounds(seen), abs=1.5)


def test_default_camera_frames_what_moves(tmp_path):
    drawn = bounds(Picture(draw(tmp_path, FLOATING)).drawn())
    assert drawn[0] > 0 and drawn[1] > 0 and drawn[2] < WIDTH - 1 and drawn[3] < HEIGHT - 1
    assert 0.4 * HEIGHT < drawn[3] - drawn[1]
    assert 0.5 * (drawn[0] + drawn[2]) == pytest.approx(0.5 * WIDTH, abs=10)


def test_time_moves_what_falls(tmp_path):
    falling = FLOATING.replace("[0, 0, 0]", "[0, 0, -10]")
    drawn = Picture(draw(tmp_path, falling, option(CAMERA), "--at", "0.2")).drawn()
    expected = bounds([project(CAMERA, corner) for corner in corners([0.1, 0.2, 0.3 - 0.2], 0.05)])
    assert bounds(drawn)[1] == pytest.approx(expected[1], abs=2)  # semi-implicit steps fall 1 mm farther


def test_contacts_are_shown_with_their_forces(tmp_path):
    camera = [0.5, -0.4, 0.3, 0, 0, 0.05]
    plain = Picture(draw(tmp_path, RESTING, option(camera), "--at", "0.5", name="plain.png"))
    shown = Picture(draw(tmp_path, RESTING, option(camera), "--at", "0.5", "--contacts"))
    changed = shown.changed(plain)
    scale = 0.25 * math.sqrt(dot(subtract(camera[:3], camera[3:]), subtract(camera[:3], camera[3:])))
    feet = [[x, y, 0] for x in (-0.05, 0.05) for y in (-0.05, 0.05)]
    heads = [[x, y, scale / 4 - 0.004] for x, y, _ in feet]  # each carries a quarter of the weight
    for point in feet + heads:
        x, y = (int(round(number)) for number in project(camera, point))
        near = [(x + dx, y + dy) for dx in (-1, 0, 1) for dy in (-1, 0, 1)]
        assert any(place in changed for place in near), point
    for x, y in changed:
        red, green, blue = shown.at[x, y]
        assert green > red or shown.at[x, y] != plain.at[x, y]
    greens = [place for place in changed if shown.at[place][1] > 2 * shown.at[place][0]]
    assert len(greens) > 0.5 * len(changed)
    beyond = bounds([project(camera, [x, y, z]) for x, y, _ in feet for z in (-0.01, scale / 4 + 0.005)])
    assert all(beyond[0] - 6 <= x <= beyond[2] + 6 and beyond[1] - 2 <= y <= beyond[3] + 6 for x, y in changed)


def test_points_of_a_cloud_are_where_they_are(tmp_path):
    points = [[0, 0, 0], [0.2, 0, 0], [0, 0.2, 0.2]]
    header = "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 3\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 3\nDATA ascii\n"
    (tmp_path / "cloud.pcd").write_text(header + "".join("%g %g %g\n" % tuple(point) for point in points))
    config = "environments: [{name: cloud, uri: cloud.pcd, cloud: {as: points, point_radius: 0.02}}]"
    picture = Picture(draw(tmp_path, config, option(CAMERA)))
    drawn = set(picture.drawn())
    focal = 0.5 * HEIGHT / math.tan(HALF_HEIGHT)
    area = 0
    for point in points:
        x, y = project(CAMERA, point)
        assert (int(x), int(y)) in drawn
        way = subtract(point, CAMERA[:3])
        # Half a pixel around the disk is drawn in part.
        area += math.pi * (focal * 0.02 / math.sqrt(dot(way, way)) + 0.5) ** 2
    assert len(drawn) == pytest.approx(area, rel=0.1)


def test_motion_is_followed(tmp_path):
    config = (ROOT / "config" / "demo_gripper_mug.yaml").read_text()
    options = [option([1, -1, 0.5, 0, 0, 0.2]), "--package", "blem_sim=%s" % ROOT, "--at", "0.6"]
    still = draw(tmp_path, config, *options, name="still.png")
    moved = draw(tmp_path, config, *(options + ["--trajectory", str(ROOT / "config" / "demo_gripper_mug.csv")]), name="moved.png")
    assert Picture(still).changed(Picture(moved))


@pytest.mark.parametrize("options", [["--contacts", "--layers"], ["--set", "objects.0.pose.xyz=[0, 0, 0.1]"]])
def test_same_input_same_bytes(options, tmp_path):
    """Neither a display nor the number of threads that draw shows."""
    pictures = [draw(tmp_path, RESTING, "--at", "0.1", *options, name=name, DISPLAY=display, LP_NUM_THREADS=threads).read_bytes()
                for name, display, threads in (("a.png", "", "1"), ("b.png", ":77", "3"))]
    assert pictures[0] == pictures[1]


@pytest.mark.parametrize("name", ["stack3", "ladder"])
def test_worlds_of_the_paper_are_the_same_picture_each_time(name, tmp_path):
    """A stack of cubes, a humanoid that leans on a ladder, as docs/worlds.md shows them."""
    if shared_data("worlds") is None:
        pytest.skip("the shared data are not here")
    pictures = []
    for run in ("first", "second"):
        (tmp_path / run).mkdir()
        subprocess.run([str(ROOT / "docs" / "images" / "worlds" / "make_pictures"), name, "--out", str(tmp_path / run)], check=True, timeout=120)
        pictures.append((tmp_path / run / (name + ".png")).read_bytes())
    assert pictures[0] == pictures[1]


def test_video_is_a_folder_of_pictures_of_which_the_last_is_the_picture_at_its_end(tmp_path):
    camera = option([0.5, -0.4, 0.3, 0, 0, 0.05])
    falling = RESTING.replace("0.0525", "0.1")
    folder = draw(tmp_path, falling, camera, "--at", "0.2", "--fps", "20", "--video", "--contacts", name="frames")
    names = sorted(path.name for path in folder.iterdir())
    assert names == ["frame_%05d.png" % i for i in range(5)]
    frames = [(folder / name).read_bytes() for name in names]
    assert draw(tmp_path, falling, camera, "--at", "0.2", "--contacts").read_bytes() == frames[4]
    assert draw(tmp_path, falling, camera, "--at", "0", "--contacts").read_bytes() == frames[0]
    assert len(set(frames)) > 2  # it lies in the end


def test_video_is_a_film_where_ffmpeg_is(tmp_path):
    if not shutil.which("ffmpeg"):
        pytest.skip("ffmpeg is not installed")
    film = draw(tmp_path, RESTING, "--at", "0.2", "--video", name="film's.mp4").read_bytes()
    assert film[4:8] == b"ftyp"


def test_film_without_ffmpeg_is_refused(tmp_path):
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin" / "Xvfb").symlink_to(shutil.which("Xvfb"))
    (tmp_path / "world.yaml").write_text(RESTING)
    result = call(tmp_path / "world.yaml", tmp_path / "film.mp4", "--video", PATH=str(tmp_path / "bin"))
    assert result.returncode == 2
    assert "ffmpeg is not installed" in result.stderr and result.stderr.count("\n") == 1


def test_picture_without_xvfb_is_refused(tmp_path):
    (tmp_path / "world.yaml").write_text(RESTING)
    result = call(tmp_path / "world.yaml", tmp_path / "picture.png", PATH=str(tmp_path))
    assert result.returncode == 2
    assert "Xvfb is not installed" in result.stderr and result.stderr.count("\n") == 1


@pytest.mark.parametrize("arguments, words", [
    (["world.yaml"], "CONFIG.yaml and OUT.png are needed"),
    (["world.yaml", "a.png", "b.png"], "3 files"),
    (["missing.yaml", "a.png"], "missing.yaml"),
    (["world.yaml", "a.jpg"], "ends in .png"),
    (["world.yaml", "."], "ends in .png"),
    (["world.yaml", "nowhere/a.png"], "there is no folder"),
    (["world.yaml", "world.yaml", "--video"], "is a file"),
    (["world.yaml", ""], "OUT.png is empty"),
    (["world.yaml", "a.png", "--camera", "1,2,3"], "--camera: '1,2,3' is not"),
    (["world.yaml", "a.png", "--camera", "1,2,3,4,5,nan"], "--camera"),
    (["world.yaml", "a.png", "--camera", "1,2,3,4,5,6,"], "--camera: '1,2,3,4,5,6,' is not"),
    (["world.yaml", "a.png", "--camera", "1,2,3,1,2,3"], "the eye is where it looks at"),
    (["world.yaml", "a.png", "--size", "101x100"], "even numbers"),
    (["world.yaml", "a.png", "--size", "100x100000"], "even numbers"),
    (["world.yaml", "a.png", "--at", "-1"], "--at: '-1' is not a number"),
    (["world.yaml", "a.png", "--at"], "its value is missing"),
    (["world.yaml", "a.png", "--fps", "0"], "--fps"),
    (["world.yaml", "a.png", "--shadows"], "unknown option"),
    (["world.yaml", "a.png", "--trajectory", "missing.csv"], "no robot"),
    (["world.yaml", "a.png", "--set", "colour=red"], "colour"),
])
def test_bad_input_is_told_in_one_line(arguments, words, tmp_path):
    (tmp_path / "world.yaml").write_text(RESTING)
    result = subprocess.run([str(PROGRAM)] + arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, timeout=60,
                            cwd=str(tmp_path))
    assert result.returncode == 2
    assert result.stderr.startswith("view_world: ") and words in result.stderr and result.stderr.count("\n") == 1, result.stderr
    assert not (tmp_path / "a.png").exists()
