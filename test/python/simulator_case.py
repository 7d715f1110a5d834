"""A world for the tests of the Python module: an arm, a cube and the ground."""
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "run"))
from run_scene import CUBE_OFF, WORLD, arm_urdf  # noqa: E402

import blem_sim  # noqa: E402

GRAVITY = 9.81


class SimulatorCase(unittest.TestCase):
    """A folder with the files of the world in it."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        for name, text in (("world.yaml", WORLD), ("arm.urdf", arm_urdf()), ("cube.off", CUBE_OFF)):
            (self.folder / name).write_text(text)

    def world(self, **settings):
        return blem_sim.Simulator(self.folder / "world.yaml", **settings)

    def cube(self, height, mass=2.0):
        """A cube of 0.1 m above the ground. @param height [m] of its centre"""
        config = {"environments": [{"name": "ground", "plane": [0, 0, 1, 0]}],
                  "objects": [{"name": "cube", "uri": "cube.off", "mass": mass, "pose": {"xyz": [0, 0, height]}}]}
        return blem_sim.Simulator(config, folder=self.folder)
