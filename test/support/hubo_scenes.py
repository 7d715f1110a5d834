"""Hubo of the shared data (57 joints) as motions of scripts/plan_motion need it: its scene, its plan, and how far it ends from that."""
import json
import math
import subprocess

from scene_runs import world
from shared_data import SOURCE_DIR, package_options

BENT = {"LSP": 0.2, "LSR": 0.15, "RSP": 0.2, "RSR": -0.15, "LEP": -0.6, "REP": -0.6,
        "LHP": -0.3, "LKP": 0.6, "LAP": -0.3, "RHP": -0.3, "RKP": 0.6, "RAP": -0.3}  # [rad]


def bent_hubo(name):
    """A world of the shared data, its Hubo with bent joints and computed gains: the data's own let a hip that carries the robot sag by 3 degrees."""
    config = world(name, sensors=False)
    robot = config["robots"][0]
    robot.pop("gains")
    robot.update(motors="computed", joint_friction={}, initial_positions={"Body_%s_joint" % joint: angle for joint, angle in BENT.items()})
    return config


def plan(config, motion, folder):
    """Plans a motion for a configuration's file. Leaves motion.csv and started.yaml in a folder, returns the report; raises RuntimeError with what
    was said."""
    command = [str(SOURCE_DIR / "scripts" / "plan_motion"), str(config), str(motion), "--out", str(folder / "motion.csv"),
               "--report", str(folder / "plan.json"), "--config-out", str(folder / "started.yaml")] + package_options()
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, universal_newlines=True)
    if done.returncode:
        raise RuntimeError(done.stderr.strip())
    return json.loads((folder / "plan.json").read_text())


def off(body, planned):
    """Distance [m] and turn [rad] between a body of a run's report and a planned pose."""
    dot = abs(sum(a * b for a, b in zip(body["quat_xyzw"], planned["quat_xyzw"])))
    return math.dist(body["xyz"], planned["xyz"]), 2 * math.acos(min(1.0, dot))
