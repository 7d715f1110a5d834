"""Simulations that the planner asks: by the Python module blem_sim of the environment, else by that of scripts/build."""
import importlib
import sys

from sweeping.checked_yaml import InputError

from planning.robot_file import ROOT, with_own

BUILT = ROOT / "build_release" / "devel" / "lib" / "python3" / "dist-packages"


def simulator(asker, file, config, packages, folder=None):
    """blem_sim.Simulator of a configuration (a file, or a dict of a folder). @param asker key of the motion file that needs it
    Raises InputError where there is no module, or the configuration is refused."""
    try:
        return module().Simulator(config, packages=with_own(packages), **({"folder": folder} if folder else {}))
    except ImportError as error:
        raise InputError("%s: '%s' needs the Python module of a built blem_sim (%s); run scripts/build and source scripts/env.bash, or leave the key out" % (file, asker, error))
    except ValueError as error:
        raise InputError(str(error))


def module():
    """The module blem_sim."""
    try:
        return importlib.import_module("blem_sim")
    except ImportError:
        sys.path.append(str(BUILT))
        return importlib.import_module("blem_sim")
