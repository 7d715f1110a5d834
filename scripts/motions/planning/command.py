"""plan_motion from its command line to its exit status."""
import argparse
import pathlib
import sys

from sweeping.checked_yaml import InputError
from sweeping.options import Parser

from planning.clearance import Clearance
from planning.motion_file import Motion
from planning.planner import Planner
from planning.posture_search import find_posture
from planning.results import table, write_results
from planning.robot_file import read_robot
from planning.settling import Settling

FINE, BAD_INPUT = 0, 2
USAGE = """Plans a quasi-static motion of a robot: joint trajectories that keep contacts where they hold and the centre of mass over them.

CONFIG is the YAML of blem_sim_run, or a URDF; MOTION.yaml tells contacts and phases (docs/motions.md)."""
EXIT = "Exit status: 0 planned; 2 not possible or bad input, told in one line that names phase, link and cure."


def read_options(arguments):
    """The options. Raises InputError for bad ones."""
    parser = Parser(prog="plan_motion", description=USAGE, epilog=EXIT, formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False)
    parser.add_argument("config", metavar="CONFIG")
    parser.add_argument("motion", metavar="MOTION.yaml")
    parser.add_argument("--out", metavar="FILE.csv", help="the trajectory (NAME.csv for NAME.yaml, in the current folder)")
    parser.add_argument("--report", metavar="FILE.json", help="the table's figures, and poses of root and contacts at the end of each phase")
    parser.add_argument("--config-out", metavar="FILE.yaml", help="CONFIG with the robot where the motion starts")
    parser.add_argument("--find", metavar="PHASE", help="no plan: targets for the end of a phase, or for the 'start', at which joints bear least")
    parser.add_argument("--tries", metavar="N", type=int, default=150, help="postures that --find looks at")
    parser.add_argument("--package", metavar="NAME=DIR", action="append", default=[], help="folder of a package, beside ROS_PACKAGE_PATH")
    options = parser.parse_args(arguments)
    options.packages = {}
    for text in options.package:
        name, equals, folder = text.partition("=")
        if not name or not equals or not pathlib.Path(folder).is_dir():
            raise InputError("--package: '%s' is no NAME=DIR of a folder; correct it" % text)
        options.packages[name] = str(pathlib.Path(folder).resolve())
    if options.out is None:
        options.out = pathlib.Path(options.motion).stem + ".csv"
    if options.tries < 1:
        raise InputError("--tries: %d postures cannot be tried; give 1 or more" % options.tries)
    if options.config_out and options.config.endswith((".urdf", ".xml")):
        raise InputError("--config-out goes with a configuration, %s is a URDF; leave it out" % options.config)
    return options


def main(arguments):
    """Exit status of the program."""
    try:
        options = read_options(arguments)
        motion = Motion(options.motion)
        robot = read_robot(options.config, motion.robot, options.packages)
        clearance = Clearance(motion, robot, options.packages) if motion.clearance is not None else None
        settles = any(contact.settles for contact in motion.contacts.values())
        planner = Planner(motion, robot, clearance, Settling(motion, robot, options.packages) if settles else None)
        if options.find is not None:
            print("\n".join(find_posture(planner, options.find, options.tries)))
            return FINE
        planner.plan()
        write_results(planner, options)
    except InputError as error:
        print("plan_motion: %s" % error, file=sys.stderr)
        return BAD_INPUT
    print("\n".join(table(planner) + [str(options.out)]))
    return FINE
