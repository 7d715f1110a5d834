"""Where the shared robots, scans and worlds are, if they are on this machine (as shared_data.h has it for C++)."""
import os
import pathlib

SOURCE_DIR = pathlib.Path(__file__).resolve().parents[2]
PACKAGES = {
    "huboplus": "robots/klampt/huboplus",
    "atlas": "robots/klampt/atlas",
    "pr2gripper": "robots/klampt/pr2gripper",
    "tx90pr2": "robots/klampt/tx90pr2",
    "tx90l": "robots/klampt/tx90l",
    "example-robot-data": "robots/example-robot-data",
    "robotiq_arg85_description": "robots/robotiq_arg85_description",
}


def shared_data(relative=""):
    """Path below the shared data (BLEM_SIM_SHARED_DATA, else ../shared/data beside the sources), or None if it is not there."""
    root = pathlib.Path(os.environ.get("BLEM_SIM_SHARED_DATA", SOURCE_DIR.parent / "shared" / "data"))
    path = root / relative
    return path if path.exists() else None


def package_options():
    """--package options of blem_sim_run for the shared robots."""
    options = []
    for name, folder in sorted(PACKAGES.items()):
        if shared_data(folder):
            options += ["--package", "%s=%s" % (name, shared_data(folder))]
    return options
