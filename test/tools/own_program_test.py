"""docs/extending.md: the package of the page builds against blem_sim, and its program runs."""
import pathlib
import re
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGE = """<package format="2">
  <name>falling_cube</name> <version>0.0.1</version> <description>A program of one's own</description>
  <maintainer email="someone@example.com">someone</maintainer> <license>BSD</license>
  <buildtool_depend>catkin</buildtool_depend> <depend>blem_sim</depend>
</package>
"""
CUBE = """<robot name="cube"><link name="cube">
  <inertial><mass value="2"/><inertia ixx="0.003" ixy="0" ixz="0" iyy="0.003" iyz="0" izz="0.003"/></inertial>
  <collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>
</link></robot>"""
WORLD = """environments: [{name: ground, plane: [0, 0, 1, 0]}]
objects: [{name: cube, urdf: cube.urdf, pose: {xyz: [0, 0, 0.2]}}]
"""


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    folder = tmp_path_factory.mktemp("falling_cube")
    page = (ROOT / "docs" / "extending.md").read_text()
    for name, language in (("CMakeLists.txt", "cmake"), ("fall.cpp", "cpp")):
        (folder / name).write_text(re.search(r"^```%s\n(.*?)^```$" % language, page, re.MULTILINE | re.DOTALL).group(1))
    (folder / "package.xml").write_text(PACKAGE)
    build = folder / "build"
    build.mkdir()
    for command in (["cmake", "..", "-DPYTHON_EXECUTABLE=/usr/bin/python3"], ["cmake", "--build", "."]):
        made = subprocess.run(command, cwd=build, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        assert made.returncode == 0, made.stdout
    return build / "devel" / "lib" / "falling_cube" / "fall"


def run(program, folder, world):
    (folder / "cube.urdf").write_text(CUBE)
    (folder / "world.yaml").write_text(world)
    return subprocess.run([str(program), str(folder / "world.yaml")], stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)


def test_cube_has_fallen_onto_the_ground(program, tmp_path):
    ran = run(program, tmp_path, WORLD)
    assert (ran.returncode, ran.stdout) == (0, "cube at 0.0525 m\n"), ran.stderr


def test_bad_input_is_one_line(program, tmp_path):
    ran = run(program, tmp_path, WORLD.replace("cube.urdf", "cub.urdf"))
    assert ran.returncode == 1 and ran.stderr.count("\n") == 1 and "cub.urdf" in ran.stderr
