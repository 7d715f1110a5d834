"""The command line of blem_sim_sweep."""
import argparse
import math
import os
import pathlib
import shlex
import shutil

from sweeping.checked_yaml import InputError

ROOT = pathlib.Path(__file__).resolve().parents[3]
PROGRAM = "blem_sim_run"
USAGE = """Runs a configuration many times with other parameters, and makes a table and plots of the reports.

The same command resumes a sweep that was stopped; nothing is run twice. docs/sweeps.md is the manual of SWEEP.yaml."""
EXIT = "Exit status: 0 all runs finished and kept what is required; 1 some did not; 2 bad input, told in one line."


class Parser(argparse.ArgumentParser):
    """Refuses in one line."""

    def error(self, message):
        raise InputError("%s; --help says more" % message)


def seconds(text):
    value = float(text)
    if not 0 < value < math.inf:
        raise ValueError(text)
    return value


def count_of(text):
    """A whole number of at least 0. Raises ValueError for others, as the next one does."""
    if not text.isdigit():
        raise ValueError(text)
    return int(text)


def positive(text):
    if count_of(text) == 0:
        raise ValueError(text)
    return int(text)


def read_options(arguments):
    """The options. Raises InputError for bad ones."""
    parser = Parser(prog="blem_sim_sweep", description=USAGE, epilog=EXIT, formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False)
    parser.add_argument("sweep", metavar="SWEEP.yaml")
    parser.add_argument("--out", metavar="DIR", help="folder of the results (NAME_results for NAME.yaml, in the current folder)")
    parser.add_argument("--on", default="local", metavar="WHERE", help="local[:N] processes (as many as processors); slurm; dask:ADDRESS of a scheduler")
    parser.add_argument("--slurm-options", default="", metavar="'...'", help="given to sbatch: --slurm-options='--partition=batch --mem=1G'")
    parser.add_argument("--dry-run", action="store_true", help="lists the runs and their commands, and runs none")
    parser.add_argument("--only", type=positive, metavar="N", help="run N alone; with --dry-run its command, to be given to a shell")
    parser.add_argument("--timeout", type=seconds, metavar="S", help="[s] of wall time after which a run is ended")
    parser.add_argument("--retry", type=count_of, default=0, metavar="N", help="tries runs that timed out or died N times more, in an earlier call too")
    parser.add_argument("--again", action="store_true", help="runs all of it anew")
    failure = parser.add_mutually_exclusive_group()
    failure.add_argument("--keep-going", action="store_true", help="goes on after a run failed (default)")
    failure.add_argument("--stop-on-failure", action="store_true", help="ends at the first run that fails")
    options = parser.parse_args(arguments)
    if options.out == "":
        raise InputError("--out is empty; name a folder")
    if options.out is None:
        options.out = pathlib.Path(options.sweep).stem + "_results"
    options.slurm_options = split_words("--slurm-options", options.slurm_options)
    options.on = place_of(options.on)
    if options.slurm_options and options.on[0] != "slurm":
        raise InputError("--slurm-options goes with --on slurm; leave it out")
    return options


def split_words(option, text):
    try:
        return shlex.split(text)
    except ValueError as error:
        raise InputError("%s: '%s': %s; correct it" % (option, text, error))


def place_of(text):
    """('local', number or None), ('slurm', None) or ('dask', address)"""
    name, colon, rest = text.partition(":")
    if name == "local" and (not colon or (rest.isdigit() and int(rest) > 0)):
        return name, int(rest) if colon else None
    if (name, colon) == ("slurm", "") or (name == "dask" and rest):
        return name, rest or None
    raise InputError("--on: '%s' is unknown; write local, local:N, slurm or dask:ADDRESS" % text)


def program():
    """The file of blem_sim_run: BLEM_SIM_RUN, else the one installed or built with this program, else that on PATH. Raises InputError."""
    prefixes = [pathlib.Path(prefix) for prefix in os.environ.get("CMAKE_PREFIX_PATH", "").split(":") if prefix]
    places = [ROOT / "lib" / "blem_sim"] + [prefix / "lib" / "blem_sim" for prefix in prefixes]
    places.append(ROOT / "build_release" / "devel" / "lib" / "blem_sim")
    named = os.environ.get("BLEM_SIM_RUN")
    for path in [named] if named else [str(place / PROGRAM) for place in places] + [shutil.which(PROGRAM) or ""]:
        if os.path.isfile(path) and os.access(path, os.X_OK):
            return os.path.abspath(path)
    if named:
        raise InputError("BLEM_SIM_RUN: '%s' is no program; name blem_sim_run, or unset it" % named)
    raise InputError("%s is not there; run scripts/build and source scripts/env.bash, or name it by BLEM_SIM_RUN" % PROGRAM)
