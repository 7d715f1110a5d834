"""A small world for the tests of blem_sim_run, and the call of the program (environment BLEM_SIM_RUN)."""
import json
import os
import pathlib
import subprocess
import tempfile
import textwrap
import unittest

SOURCE_DIR = pathlib.Path(__file__).resolve().parents[2]

CUBE_OFF = """OFF
8 12 0
-0.05 -0.05 -0.05
0.05 -0.05 -0.05
0.05 0.05 -0.05
-0.05 0.05 -0.05
-0.05 -0.05 0.05
0.05 -0.05 0.05
0.05 0.05 0.05
-0.05 0.05 0.05
3 0 2 1
3 0 3 2
3 4 5 6
3 4 6 7
3 0 1 5
3 0 5 4
3 1 2 6
3 1 6 5
3 2 3 7
3 2 7 6
3 3 0 4
3 3 4 7
"""

LINK = """<link name="{name}">
  <inertial><origin xyz="0 0 {z}"/><mass value="{mass}"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial>
  <collision><origin xyz="0 0 {z}"/><geometry>{shape}</geometry></collision>
</link>"""
JOINT = """<joint name="{name}" type="{type}"><parent link="{parent}"/><child link="{child}"/><origin xyz="0 0 {z}"/><axis xyz="0 1 0"/>
  <limit lower="-2" upper="2" effort="50" velocity="5"/></joint>"""


def arm_urdf(mass=1.0, shape='<box size="0.04 0.04 0.2"/>'):
    """Two links that swing about y on a heavy box."""
    return "\n".join([
        '<?xml version="1.0"?><robot name="arm">',
        LINK.format(name="base", z=0, mass=5, shape='<box size="0.3 0.3 0.1"/>'),
        LINK.format(name="upper", z=0.1, mass=mass, shape=shape),
        LINK.format(name="lower", z=0.1, mass=0.5, shape='<box size="0.03 0.03 0.2"/>'),
        JOINT.format(name="shoulder", type="revolute", parent="base", child="upper", z=0.1),
        JOINT.format(name="elbow", type="continuous", parent="upper", child="lower", z=0.25),
        "</robot>",
    ])


WORLD = """
time_step: 0.001
environments:
  - {name: ground, plane: [0, 0, 1, 0]}
robots:
  - name: arm
    urdf: arm.urdf
    pose: {xyz: [0, 0, 0.0525]}
    initial_positions: {shoulder: 0.3}
    gains: {default: {p: 60, i: 5, d: 4}}
    motor: pid
    sensors:
      - {name: shoulder_wrench, type: force_torque, joint: shoulder, noise: {stddev: 0.1}}
      - {name: imu, type: imu, link: upper, rate: 200, noise: {accel_stddev: 0.01, gyro_bias_stddev: 0.02}}
      - {name: base_contact, type: contact, link: base}
      - {name: tilt, type: tilt, link: lower, rate: 50}
      - {name: motors, type: motor_current, torque_constant: {default: 0.5}}
objects:
  - {name: cube, uri: cube.off, mass: 1, pose: {xyz: [0.5, 0, 0.08], rpy: [0.1, 0.2, 0.3]}}
"""

TRAJECTORY = "time,root_x,shoulder,elbow\n0,0,0.3,0\n0.2,0,-0.3,0.5\n0.4,0,0.2,0.2\n"


class RunCase(unittest.TestCase):
    """A folder with the world in it, and the program."""

    def setUp(self):
        self.program = os.environ.get("BLEM_SIM_RUN", "")
        if not os.access(self.program, os.X_OK):
            self.fail("set BLEM_SIM_RUN to the program blem_sim_run (scripts/test does)")
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.write("world.yaml", WORLD)
        self.write("arm.urdf", arm_urdf())
        self.write("cube.off", CUBE_OFF)
        self.write("motion.csv", TRAJECTORY)

    def write(self, name, text):
        (self.folder / name).write_text(textwrap.dedent(text) if isinstance(text, str) else text)
        return str(self.folder / name)

    def run_program(self, *arguments, timeout=120):
        return subprocess.run([self.program] + [str(a) for a in arguments], cwd=str(self.folder), stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, universal_newlines=True, timeout=timeout)

    def report(self, *arguments):
        """The report of a run that must finish; numbers that JSON does not know fail the test."""
        done = self.run_program(*arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr, "", "silent where there is no terminal")
        return json.loads(done.stdout, parse_constant=lambda word: self.fail("%s in the report" % word))

    def refusal(self, *arguments):
        """The one line that a run with bad input says."""
        done = self.run_program(*arguments)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(done.stdout, "")
        self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
        return done.stderr.strip()
