"""A folder with a small world and a sweep of it, and the call of blem_sim_sweep (environment BLEM_SIM_RUN, as scripts/test sets it)."""
import csv
import os
import pathlib
import sqlite3
import subprocess
import time

import pytest
import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "scripts" / "sweep" / "blem_sim_sweep"
EXAMPLE = ROOT / "config" / "sweeps" / "friction_on_slope.yaml"
WORLD = (ROOT / "config" / "sweeps" / "cube_on_slope.yaml").read_text()
MEASURE = {"position": "bodies.cube::link.xyz.0", "hash": "state_hash"}
SWEEP = {"config": "world.yaml", "packages": {"blem_sim": str(ROOT)}, "duration": 0.05, "parameters": {"contact.friction": [0.1, 0.2, 0.3]},
         "measure": MEASURE}


class SweepCase:
    """A sweep in a folder of its own; keys of SWEEP may be given anew, None leaves one out."""

    def __init__(self, folder):
        if not os.access(os.environ.get("BLEM_SIM_RUN", ""), os.X_OK):
            pytest.skip("BLEM_SIM_RUN does not name a built blem_sim_run; run by scripts/test")
        self.folder, self.out, self.environment = folder, folder / "out", dict(os.environ)
        self.write("world.yaml", WORLD)

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return self.folder / name

    def write_sweep(self, **keys):
        said = dict(SWEEP, **keys)
        return self.write("sweep.yaml", yaml.safe_dump({key: value for key, value in said.items() if value is not None}, sort_keys=False))

    def watch(self, before="true"):
        """Puts a script in the program's place that notes every start of a run. @param before shell commands that come first"""
        script = self.write("watched", "#!/bin/sh\n[ \"$1\" = --version ] || { basename \"$PWD\" >>%s; %s; }\nexec %s \"$@\"\n" % (
            self.folder / "starts", before, os.environ["BLEM_SIM_RUN"]))
        script.chmod(0o755)
        self.environment["BLEM_SIM_RUN"] = str(script)

    def starts(self):
        """Keys of the runs that were started, in order."""
        path = self.folder / "starts"
        return path.read_text().split() if path.exists() else []

    def command(self, *options):
        return [str(PROGRAM), str(self.folder / "sweep.yaml"), "--out", str(self.out)] + [str(option) for option in options]

    def call(self, *options):
        return subprocess.run(self.command(*options), stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, timeout=120,
                              env=self.environment, cwd=str(self.folder))

    def run(self, *options, status=0):
        """Runs the sweep, which has to end with a status. Returns its rows."""
        done = self.call(*options)
        assert done.returncode == status, done.stdout + done.stderr
        assert "Traceback" not in done.stderr, done.stderr
        return self.rows()

    def rows(self):
        """Rows of results.csv without the wall times."""
        with open(str(self.out / "results.csv")) as stream:
            return [{name: value for name, value in row.items() if name != "wall_s"} for row in csv.DictReader(stream)]

    def query(self, question):
        with sqlite3.connect(str(self.out / "runs.sqlite")) as base:
            return base.execute(question).fetchall()

    def refusal(self, *options):
        """The one line that bad input gets."""
        done = self.call(*options)
        assert done.returncode == 2, done.stdout + done.stderr
        assert done.stderr.count("\n") == 1 and done.stderr.startswith("blem_sim_sweep: "), done.stderr
        return done.stderr


def wait_until(condition, seconds=60):
    deadline = time.time() + seconds
    while not condition():
        assert time.time() < deadline, "waited in vain"
        time.sleep(0.01)


def column(rows, name):
    return [row[name] for row in rows]
