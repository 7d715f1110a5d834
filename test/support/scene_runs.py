"""Worlds of the shared data through blem_sim_run, for the scripts that validate."""
import argparse
import csv
import json
import os
import pathlib
import subprocess
import sys

import yaml

import convert_world
from shared_data import SOURCE_DIR, package_options, shared_data


def program():
    """blem_sim_run: BLEM_SIM_RUN, else that of scripts/build; ends the script if there is none."""
    built = SOURCE_DIR / "build_release" / "devel" / "lib" / "blem_sim" / "blem_sim_run"
    path = os.environ.get("BLEM_SIM_RUN", str(built))
    if not os.access(path, os.X_OK):
        sys.exit("%s: %s is not there; run scripts/build, or set BLEM_SIM_RUN" % (pathlib.Path(sys.argv[0]).name, path))
    return path


def require_known(names, known):
    """Ends the program, before its first run, if a name is none of the known ones."""
    unknown = [name for name in names if name not in known]
    if unknown:
        print("%s: there is no %s; there are: %s" % (pathlib.Path(sys.argv[0]).name, ", ".join(unknown), " ".join(known)), file=sys.stderr)
        sys.exit(2)


def world(name, **choices):
    """A world as a configuration; choices are those of convert_world."""
    options = argparse.Namespace(motor="implicit_pd", sensors=True, self_collision=False, start_at=None)
    options.__dict__.update(choices)
    with open(str(shared_data("worlds/%s.yaml" % name))) as stream:
        return convert_world.convert(yaml.safe_load(stream), options)


def execute(folder, config, duration, options=(), timeout=None):
    """Runs a configuration in a folder. Returns (exit status, report or None, what was said on standard error)."""
    with open(str(folder / "config.yaml"), "w") as stream:
        yaml.safe_dump(config, stream, sort_keys=False)
    report = folder / "report.json"
    if report.exists():
        report.unlink()
    command = [program(), str(folder / "config.yaml"), "--duration", str(duration), "--report", str(report)] + package_options()
    done = subprocess.run(command + list(options), stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, timeout=timeout)
    return done.returncode, json.loads(report.read_text()) if report.exists() else None, done.stderr.strip()


def simulate(folder, config, duration, csv_rate, options=(), wanted=None):
    """Runs a configuration. Returns its report and its rows over time, as texts by column; raises RuntimeError with what was said.

    wanted: which columns to keep beside the time, as a function of the name; all of them if None.
    """
    table = folder / "state.csv"
    status, report, said = execute(folder, config, duration, ["--csv", str(table), "--csv-rate", str(csv_rate)] + list(options))
    if status:
        raise RuntimeError("exit %d: %s" % (status, said))
    with open(str(table)) as stream:
        rows = csv.reader(stream)
        names = next(rows)
        kept = [k for k, name in enumerate(names) if k == 0 or wanted is None or wanted(name)]
        return report, [{names[k]: row[k] for k in kept} for row in rows]


def read_motion(name):
    """A motion of the shared data, as of read_trajectory."""
    return read_trajectory(shared_data("motions/%s.csv" % name))


def read_trajectory(path):
    """A trajectory's file as a list of (time, positions by joint); of rows with the same time the first."""
    rows = []
    with open(str(path)) as stream:
        for row in csv.DictReader(stream):
            if not rows or float(row["time"]) > rows[-1][0]:
                rows.append((float(row["time"]), {key: float(value) for key, value in row.items() if key.endswith("_joint")}))
    return rows
