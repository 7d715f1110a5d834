"""Pictures of scenes by view_world."""
import os
import pathlib
import shutil
import subprocess
import sys

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "test" / "support"), str(ROOT / "scripts" / "support")]
from scene_runs import program  # noqa: E402
from shared_data import package_options  # noqa: E402
from trajectory_file import write_trajectory  # noqa: E402


def viewer():
    """view_world, which is beside blem_sim_run."""
    return pathlib.Path(program()).parent / "view_world"


def cannot_draw():
    """Why there are no pictures here, in words; empty where there are."""
    if not os.access(str(viewer()), os.X_OK):
        return "%s is not there (it is left out without VTK)" % viewer()
    return "" if shutil.which("Xvfb") else "Xvfb is not installed"


def draw(folder, scene, time, camera, file, options=()):
    """Draws a scene with its contacts at a time [s]; leaves its scene.yaml, and its motion.csv if it has one, in a folder.

    scene: (configuration, rows of a trajectory or None). camera: of view_world, or None. Raises RuntimeError with what was said.
    """
    config, rows = scene
    (folder / "scene.yaml").write_text(yaml.safe_dump(config, sort_keys=False))
    command = [str(viewer()), str(folder / "scene.yaml"), str(file), "--at", str(time), "--contacts", "--size", "640x480"] + package_options()
    if camera:
        command += ["--camera=" + camera]
    if rows:
        write_trajectory(folder / "motion.csv", rows)
        command += ["--trajectory", str(folder / "motion.csv")]
    done = subprocess.run(command + list(options), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, universal_newlines=True)
    if done.returncode:
        raise RuntimeError("view_world, exit %d: %s" % (done.returncode, done.stderr.strip()))
