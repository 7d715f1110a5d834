"""Single runs of a sweep: their command, and the key under which their result is kept."""
import hashlib
import json
import os
import subprocess

from sweeping.checked_yaml import InputError, flow
from sweeping.input_files import InputFiles
from sweeping.sweep_file import point_text

KEY_LENGTH = 16


class Run:
    """One simulation: its number from 1, parameter values, seed or None, command, and a key made of all that its result depends on."""

    def __init__(self, number, values, seed):
        self.number, self.values, self.seed = number, values, seed
        self.command, self.key = [], ""

    def text(self):
        return point_text(self.values, self.seed)


def version_of(program):
    """What `blem_sim_run --version` says. Raises InputError if it does not answer."""
    try:
        done = subprocess.run([program, "--version"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, timeout=60)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise InputError("%s: does not run: %s; name blem_sim_run by BLEM_SIM_RUN" % (program, getattr(error, "strerror", None) or "no answer"))
    if done.returncode or not done.stdout.strip():
        raise InputError("%s: does not tell its --version; name blem_sim_run by BLEM_SIM_RUN" % program)
    return done.stdout.strip()


def fixed_options(sweep):
    """Options of every run's command, and the same without the places of files, which change no result."""
    options = ["--duration", flow(sweep.duration)]
    if sweep.stats_from is not None:
        options += ["--stats-from", flow(sweep.stats_from)]
    placed = options + (["--trajectory", sweep.trajectory] if sweep.trajectory else [])
    for name, folder in sweep.packages.items():
        placed += ["--package", "%s=%s" % (name, folder)]
    return placed, options


def make_runs(sweep, program):
    """All runs of a sweep, with commands and keys."""
    version, files = version_of(program), InputFiles(sweep)
    placed, options = fixed_options(sweep)
    runs = []
    for number, (values, seed) in enumerate(sweep.points, 1):
        run = Run(number, values, seed)
        own = [option for name, value in values.items() for option in ("--set", "%s=%s" % (name, flow(value)))]
        own += ["--seed", str(seed)] if seed is not None else []
        run.command = [os.path.abspath(program), sweep.config] + placed + own + ["--report", "report.json"]
        made_of = json.dumps([version, options, own, files.digest(values)])
        run.key = hashlib.sha256(made_of.encode()).hexdigest()[:KEY_LENGTH]
        runs.append(run)
    return runs
