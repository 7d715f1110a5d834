"""A folder in which scripts/plan_motion plans, and blem_sim_run (environment BLEM_SIM_RUN) plays what it planned."""
import contextlib
import copy
import csv
import io
import json
import os
import pathlib
import subprocess
import sys

import pytest
import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "scripts" / folder) for folder in ("motions", "sweep", "support")] + [str(ROOT / "test" / "support")]
from hubo_scenes import off  # noqa: E402,F401
from planning.command import main  # noqa: E402

MOTIONS = ROOT / "config" / "motions"
WORLD = MOTIONS / "humanoid_on_plane.yaml"
STEPS, SQUAT, CLIMBS, LEANS = [yaml.safe_load((MOTIONS / ("humanoid_%s.yaml" % name)).read_text()) for name in ("steps", "squat", "climbs", "leans")]


class MotionCase:
    """Calls of the programs in a folder of their own."""

    def __init__(self, folder):
        self.folder = folder

    def write(self, name, value):
        (self.folder / name).write_text(value if isinstance(value, str) else yaml.safe_dump(value, sort_keys=False))
        return self.folder / name

    def call(self, config, motion, *options):
        command = [str(ROOT / "scripts" / "plan_motion"), str(config), str(motion), "--out", str(self.folder / "motion.csv"),
                   "--report", str(self.folder / "plan.json")] + [str(option) for option in options]
        return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, timeout=300, cwd=str(self.folder))

    def plan(self, config, motion, *options):
        """The report of a plan that must succeed."""
        done = self.call(config, self.write("motion.yaml", motion), *options)
        assert done.returncode == 0, done.stderr
        return json.loads((self.folder / "plan.json").read_text())

    def refusal(self, config, motion, *options):
        """The one line of a plan that must be refused, in this process: starting one for each takes longer than refusing."""
        arguments = [str(config), str(self.write("motion.yaml", motion)), "--out", str(self.folder / "motion.csv")] + [str(option) for option in options]
        said = io.StringIO()
        with contextlib.redirect_stderr(said):
            assert main(arguments) == 2
        assert len(said.getvalue().strip().splitlines()) == 1, said.getvalue()
        assert not (self.folder / "motion.csv").exists()
        return said.getvalue().strip()

    def rows(self):
        """The trajectory: names of its columns and rows of numbers."""
        with open(str(self.folder / "motion.csv")) as stream:
            rows = list(csv.reader(stream))
        return rows[0], [[float(cell) for cell in row] for row in rows[1:]]

    def play(self, config, duration, *options):
        """The report of the trajectory's run."""
        program = os.environ.get("BLEM_SIM_RUN")
        if not program:
            pytest.skip("BLEM_SIM_RUN does not name a built blem_sim_run; run by scripts/test")
        report = self.folder / "run.json"
        command = [program, str(config), "--duration", str(duration), "--trajectory", str(self.folder / "motion.csv"), "--report", str(report),
                   "--package", "blem_sim=%s" % ROOT] + list(options)
        subprocess.run(command, check=True, timeout=300)
        return json.loads(report.read_text())


def changed(motion, **keys):
    """A copy of a motion with other keys; None leaves one out."""
    said = dict(copy.deepcopy(motion), **keys)
    return {key: value for key, value in said.items() if value is not None}
