#!/usr/bin/python3
"""Writes the scenes of scene_benchmark that are made from the shared data: NAME.yaml and, where the robot moves, NAME.csv.

Usage: prepare_scenes.py FOLDER
Says so and writes nothing if the shared data are not here.
"""
import math
import pathlib
import sys

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "test" / "support"), str(ROOT / "scripts" / "support")]
import gripper_motions  # noqa: E402
from scene_runs import read_motion, world  # noqa: E402
from shared_data import shared_data  # noqa: E402
from trajectory_file import smooth, write_trajectory  # noqa: E402

ROW_STEP = 0.02  # [s]
TRAY_BOTTOM = 0.645  # [m] height


def arms_swung(config, duration):
    """Rows of a robot that stands and swings its arms by +-0.3 rad at 0.5 Hz; the swing grows over the first second."""
    start = config["robots"][0]["initial_positions"]
    rows = []
    for k in range(int(round(duration / ROW_STEP)) + 1):
        t = k * ROW_STEP
        swing = 0.3 * smooth(t, 0.0, 1.0) * math.sin(math.pi * t)
        turned = {joint: start[joint] + sign * swing for joint, sign in
                  (("Body_LSP_joint", 1), ("Body_RSP_joint", -1), ("Body_LEP_joint", -1), ("Body_REP_joint", -1))}
        rows.append((t, dict(start, **turned)))
    return rows


class EarlyStir(gripper_motions.Stir):
    """The fingers are among the mugs after a second."""
    SETTLED, DOWN, BEGUN = 0.3, 0.7, 1.0


def stirred_tray():
    config = world("paper_tray18")
    motion = EarlyStir((0.6, 0.13), (0.6, 0.383), TRAY_BOTTOM + 0.015 + 0.167, 3.0)
    rows = gripper_motions.joint_rows(motion)
    config["robots"][0]["initial_positions"] = rows[0][1]
    return config, rows


def swaying_hubo():
    return world("hubo_plane", start_at=shared_data("motions/hubo_sway_path_opt.csv")), read_motion("hubo_sway_path_opt")


def standing_hubo_with_arms(name):
    config = world(name)
    return config, arms_swung(config, 4.0)


SCENES = {
    "hubo_plane": lambda: (world("hubo_plane"), None),
    "hubo_plane_sway": swaying_hubo,
    "stepladder_150k": lambda: standing_hubo_with_arms("paper_hubo_stepladder_150k"),
    "stepladder_1m": lambda: standing_hubo_with_arms("paper_hubo_stepladder_1m"),
    "tray18": stirred_tray,
}


def main(folder):
    if shared_data("worlds") is None:
        print("prepare_scenes: skipped, the shared data are not here (set BLEM_SIM_SHARED_DATA to their folder)")
        return
    folder.mkdir(parents=True, exist_ok=True)
    for name, make in SCENES.items():
        config, rows = make()
        with open(str(folder / (name + ".yaml")), "w") as stream:
            yaml.safe_dump(config, stream, sort_keys=False)
        if rows:
            write_trajectory(folder / (name + ".csv"), rows)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]))
