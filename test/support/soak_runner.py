"""Runs the GoogleTest programs of test/soak, and prints a row per test with its figures below it."""
import argparse
import os
import pathlib
import re
import subprocess

SOURCE_DIR = pathlib.Path(__file__).resolve().parents[2]
FIGURE = re.compile(r"^figure: (.+) = (\S+) ?(.*)$")
RESULT = re.compile(r"^\[\s*(OK|FAILED|SKIPPED)\s*\] (\S+?),? .*\((\d+) ms\)$")


def arguments(what, program):
    parser = argparse.ArgumentParser(description=what)
    parser.add_argument("tests", nargs="*", metavar="TEST", help="GoogleTest filters")
    parser.add_argument("--short", action="store_true", help="a few simulated seconds per test")
    parser.add_argument("--stepper", default="articulated", help="world_step, quick_step or articulated")
    parser.add_argument("--program", help="%s as built elsewhere; nothing is built then" % program)
    parser.add_argument("--list", action="store_true", help="names of the tests")
    return parser.parse_args()


def built(options, program):
    if options.program:
        return options.program
    subprocess.run([str(SOURCE_DIR / "scripts" / "build"), "--target", program], check=True, stdout=subprocess.DEVNULL)
    # Unit tests of a build with ROS lie where catkin puts programs.
    folder = SOURCE_DIR / "build_release"
    return str(next(path for path in (folder / program, folder / "devel/lib/blem_sim" / program) if path.exists()))


def run(command, environment):
    """Runs the tests and prints their rows as they end. Returns counts by OK, FAILED, SKIPPED."""
    counts = {"OK": 0, "FAILED": 0, "SKIPPED": 0}
    figures, said = [], []
    process = subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
    for line in process.stdout:
        line = line.rstrip()
        result, figure = RESULT.match(line), FIGURE.match(line)
        if result:
            counts[result.group(1)] += 1
            print("%-8s %-60s %8.1f s" % (result.group(1).lower(), result.group(2), int(result.group(3)) / 1000))
            for name, value, unit in figures:
                print("           %-70s %14s %s" % (name, value, unit))
            for words in said:
                print("           ! " + words, flush=True)
            figures, said = [], []
        elif figure:
            figures.append(figure.groups())
        elif line and not line.startswith(("[", "Running main", "Note:")):
            said.append(line)
    if process.wait() < 0 or (process.returncode and not counts["FAILED"]):
        print("%s died, exit %d: %s" % (command[0], process.returncode, " ".join(said[-3:])))
        counts["FAILED"] += 1
    return counts


def validate(what, program, searches=None):
    """What scripts/validate_solver and scripts/validate_contacts do. searches: (program, filter, times) of a unit-test program that is run
    with so many times its samples, too. Returns the exit status."""
    options = arguments(what, program)
    command = [built(options, program)]
    if options.list:
        return subprocess.run(command + ["--gtest_list_tests"]).returncode
    if options.tests:
        command.append("--gtest_filter=" + ":".join(options.tests))
    environment = dict(os.environ, BLEM_SIM_SOAK_STEPPER=options.stepper, BLEM_SIM_SOAK_SHORT="1" if options.short else "0")
    counts = run(command, environment)
    if searches and not options.tests:
        unit_tests, tests, times = searches
        beside = pathlib.Path(command[0]).parent / unit_tests if options.program else built(options, unit_tests)
        more = run([str(beside), "--gtest_filter=" + tests], dict(environment, BLEM_SIM_SAMPLES="1" if options.short else str(times)))
        counts = {key: counts[key] + more[key] for key in counts}
    print("%s: %d passed, %d failed, %d skipped" % (options.stepper, counts["OK"], counts["FAILED"], counts["SKIPPED"]))
    return 1 if counts["FAILED"] else 0
