"""What was planned: as a trajectory, a table, a report and a configuration that starts where the motion does."""
import copy
import json
import math
import os
import pathlib

import numpy as np
import yaml
from sweeping.checked_yaml import InputError, read_yaml
from trajectory_file import write_trajectory

from planning.robot_model import quaternion

HEADINGS = ("phase", "s", "margin mm", "speed %", "effort %", "gap mm", "residual mm", "mrad")


def rows_of(planner):
    """[(time, {joint: position})] of the whole motion."""
    step, model = 1.0 / planner.motion.rate, planner.model
    placed = [planner.start] + [each for phase in planner.planned for each in phase.placed]
    return [(k * step, model.all_joints(each.posture)) for k, each in enumerate(placed)]


def table(planner):
    """Lines that tell of each phase, and of all of it."""
    cells = [HEADINGS]
    for phase in planner.planned:
        margin = "-" if phase.margin is None else "%.1f" % (1e3 * phase.margin)
        speed, effort = ["%.0f %s" % (100 * share, joint or "") for share, joint in (phase.speed, phase.effort)]
        gap = "-" if phase.gap is None else "%.1f %s" % (1e3 * phase.gap.metres, phase.gap.link)
        cells.append((phase.name, "%.2f" % phase.duration, margin, speed, effort, gap, "%.3f" % (1e3 * phase.residual[0]), "%.3f" % (1e3 * phase.residual[1])))
    widths = [max(len(row[k]) for row in cells) for k in range(len(HEADINGS))]
    lines = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in cells]
    return lines + ["%d phases, %.2f s" % (len(planner.planned), sum(phase.duration for phase in planner.planned))]


def pose_of(rotation, position):
    return {"xyz": [float(x) for x in position], "quat_xyzw": [float(x) for x in quaternion(rotation)]}


def moment(planner, placed, frames):
    """One moment of the motion for the report. Links that touch are where blem_sim_run would say they are, at their link's origin."""
    contacts = {name: pose_of(*placed.link(planner.motion.contacts[name].link)) for name in frames}
    return {"root": pose_of(placed.posture.rotation, placed.posture.position), "com": [float(x) for x in placed.centre_of_mass], "links": contacts}


def report(planner):
    """All of it as plain data."""
    phases = []
    for phase in planner.planned:
        phases.append({
            "name": phase.name, "duration_s": phase.duration, "holding": phase.holding, "margin_m": phase.margin,
            "speed": {"share": phase.speed[0], "joint": phase.speed[1]}, "effort": {"share": phase.effort[0], "joint": phase.effort[1]},
            "gap": None if phase.gap is None else {"m": phase.gap.metres, "link": phase.gap.link, "other": phase.gap.other},
            "residual": {"m": phase.residual[0], "rad": phase.residual[1]},
            "support": None if phase.region is None else [[float(x) for x in corner] for corner in phase.region],
            "end": moment(planner, phase.placed[-1], phase.frames)})
    return {"start": moment(planner, planner.start, planner.start_frames), "phases": phases,
            "duration_s": sum(phase.duration for phase in planner.planned)}


def roll_pitch_yaw(rotation):
    """Angles about fixed axes [rad]."""
    return [math.atan2(rotation[2, 1], rotation[2, 2]), math.asin(max(-1.0, min(1.0, -rotation[2, 0]))), math.atan2(rotation[1, 0], rotation[0, 0])]


def started_config(planner, out):
    """The configuration with the robot where the motion starts; files in it are named from the folder of `out`."""
    robot = planner.robot
    config = copy.deepcopy(read_yaml(robot.file))
    row, posture = config["robots"][robot.number], planner.start.posture
    row["pose"] = {"xyz": [round(float(x), 9) for x in posture.position], "rpy": [round(x, 9) for x in roll_pitch_yaw(posture.rotation)]}
    row["initial_positions"] = {name: round(value, 9) for name, value in planner.model.all_joints(posture).items()}
    rename_files(config, pathlib.Path(robot.file).resolve().parent, pathlib.Path(out).resolve().parent)
    return config


def rename_files(value, old, new):
    """Changes relative files of a configuration in folder `old` so that they hold in folder `new`."""
    if isinstance(value, dict):
        for key, item in value.items():
            if key in ("uri", "urdf") and isinstance(item, str) and "://" not in item:
                value[key] = os.path.relpath(str(old / item), str(new))
            else:
                rename_files(item, old, new)
    elif isinstance(value, list):
        for item in value:
            rename_files(item, old, new)


def write_results(planner, options):
    """Writes the files that were asked for. Raises InputError if one cannot be written."""
    try:
        write_trajectory(options.out, rows_of(planner))
        if options.report:
            pathlib.Path(options.report).write_text(json.dumps(report(planner), indent=1) + "\n")
        if options.config_out:
            pathlib.Path(options.config_out).write_text(yaml.safe_dump(started_config(planner, options.config_out), sort_keys=False, width=140))
    except OSError as error:
        raise InputError("%s: cannot be written: %s; name another file" % (error.filename, error.strerror))
