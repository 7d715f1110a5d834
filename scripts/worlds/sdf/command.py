"""world_from_sdf from its command line to its exit status."""
import argparse
import pathlib
import sys

from sdf.elements import InputError, Report
from sdf.files import Folders
from sdf.world import World

FINE, LEFT_OUT, BAD_INPUT = 0, 1, 2
USAGE = """Makes a configuration of blem_sim, URDF files and meshes of a world or model in Gazebo's SDF. docs/from_gazebo.md tells what becomes of it."""
EXIT = "Exit status: 0 all that can touch was made; 1 something was left out, told in a line each; 2 bad input, told in one line."


class Parser(argparse.ArgumentParser):
    """Refuses in one line."""

    def error(self, message):
        raise InputError("%s; --help says more" % message)


def read_options(arguments):
    parser = Parser(prog="world_from_sdf", description=USAGE, epilog=EXIT, allow_abbrev=False)
    parser.add_argument("file", metavar="FILE", type=pathlib.Path, help="a .world or .sdf file")
    parser.add_argument("--out", metavar="DIR", type=pathlib.Path, help="folder of what is made (NAME for NAME.world, in the current folder)")
    parser.add_argument("--models", metavar="DIR", action="append", default=[],
                        help="a folder with models, before those of GAZEBO_MODEL_PATH, ~/.gazebo/models and Gazebo's own; as often as needed")
    return parser.parse_args(arguments)


def main(arguments):
    """Exit status of the program."""
    report = Report()
    try:
        options = read_options(arguments)
        world = World(options.out or pathlib.Path(options.file.stem), Folders(options.models), report)
        world.read(options.file)
        path = world.write(options.file.name)
    except (InputError, OSError) as error:
        print("world_from_sdf: %s" % error, file=sys.stderr)
        return BAD_INPUT
    for line in report.notes:
        print("note: %s" % line, file=sys.stderr)
    for line in report.left_out:
        print("left out: %s" % line, file=sys.stderr)
    counts = ["%d %s" % (len(world.entries[kind]), kind) for kind in ("environments", "objects", "robots")]
    print("%s: %s" % (path, ", ".join(counts)))
    return LEFT_OUT if report.left_out else FINE
