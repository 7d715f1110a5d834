#!/usr/bin/python3
"""Turns a world of the shared data (worlds/NAME.yaml, Klamp't's terms) into a configuration of blem_sim.

Usage: convert_world.py WORLD.yaml OUT.yaml [--motor pid|implicit_pd] [--sensors] [--self-collision]
                        [--start-at MOTION.csv]
Prints the --package options that blem_sim_run then needs. File names in OUT.yaml are absolute: it is for this machine only.
"""
import argparse
import csv
import math
import shlex
import sys

import yaml

sys.path.insert(0, __file__.rsplit("/", 1)[0])
from shared_data import package_options, shared_data  # noqa: E402  (found beside this file)

SURFACE_KEYS = {
    "boundary_width": ("padding",),
    "friction": ("kFriction",),
    "restitution": ("kRestitution",),
    "stiffness": ("kStiffness", "stiffness"),
    "damping": ("kDamping", "damping"),
}


def surface(source):
    """Contact settings of a terrain, object, robot or link; infinite stiffness is our default and left out."""
    settings = {}
    for ours, theirs in SURFACE_KEYS.items():
        for key in theirs:
            if key in source and math.isfinite(source[key]):
                settings[ours] = source[key]
    return settings


def pose(source, prefix=""):
    return {"xyz": source.get(prefix + "xyz", [0, 0, 0]), "rpy": source.get(prefix + "rpy", [0, 0, 0])}


def driven_joints(driver):
    """The joint a driver's gains act on: of an affine driver the first, which the others mimic (its scale is 1)."""
    return driver["joint"] if driver["type"] == "normal" else driver["joints"][0]


def sensors(description):
    """Ankle and wrist force-torque sensors, tilt sensors, an IMU at the root; Klamp't sits on links, we on the joint above."""
    rows = [{"name": "imu", "type": "imu", "link": description["base"]["root_link"]}]
    for sensor in description.get("sensors", []):
        if sensor["type"] == "ForceTorqueSensor":
            rows.append({"name": sensor["name"], "type": "force_torque", "joint": sensor["link"] + "_joint"})
        elif sensor["type"] == "TiltSensor":
            rows.append({"name": sensor["name"], "type": "tilt", "link": sensor["link"]})
    return rows


def convert_robot(robot, options):
    description = yaml.safe_load(open(shared_data("robots/klampt/%s/%s.yaml" % (robot["robot"], robot["robot"]))))
    drivers = description.get("drivers", [])
    row = {
        "name": robot["name"],
        "urdf": str(shared_data(robot["urdf"])),
        "fixed_base": description["base"]["type"] == "fixed",
        "pose": pose(robot, "base_"),
        "initial_positions": robot.get("joint_positions", {}),
        "self_collision": options.self_collision,
        "disable_collisions": description.get("no_self_collision", []),
        "gains": {driven_joints(d): {"p": d["servoP"], "i": d["servoI"], "d": d["servoD"]} for d in drivers},
        "joint_friction": {driven_joints(d): {"dry": d["dryFriction"], "viscous": d["viscousFriction"]} for d in drivers},
        "effort_limits": {driven_joints(d): d["tmax"] for d in drivers if "tmax" in d},
        "motor": options.motor,
        "motors": "free",
        "links": {link["link"]: surface(link) for link in robot.get("link_surfaces", [])},
    }
    row.update(surface(robot.get("default_surface", {})))
    if options.sensors and not row["fixed_base"]:
        row["sensors"] = sensors(description)
    if options.start_at:
        row.update(first_posture(options.start_at))
    return row


def first_posture(motion):
    """Root pose and joint positions in the first row of one of the shared motions."""
    with open(str(motion)) as stream:
        first = {name: float(value) for name, value in next(csv.DictReader(stream)).items()}
    xyz, rpy = [first["root_" + key] for key in "xyz"], [first["root_" + key] for key in ("roll", "pitch", "yaw")]
    return {"pose": {"xyz": xyz, "rpy": rpy}, "initial_positions": {name: q for name, q in first.items() if name.endswith("_joint")}}


def convert_terrain(terrain):
    row = {"name": terrain["name"], "uri": str(shared_data(terrain["mesh"])), "scale": terrain.get("mesh_scale", [1, 1, 1])}
    row["pose"] = pose(terrain)
    row.update(surface(terrain))
    return row


def convert_object(source):
    row = {"name": source["name"], "uri": str(shared_data(source["mesh"])), "scale": source.get("mesh_scale", [1, 1, 1])}
    row["mesh_pose"] = pose(source, "mesh_")
    row["pose"] = pose(source)
    row["mass"] = source["mass"]
    for key in ("com", "inertia"):
        if key in source:
            row[key] = source[key]
    if "initial_velocity_linear" in source:
        row["linear_velocity"] = source["initial_velocity_linear"]
    row.update(surface(source))
    return row


def give_own_names(rows):
    """Klamp't lets names repeat; we do not."""
    taken = set()
    for row in rows:
        name, number = row["name"], 2
        while row["name"] in taken:
            row["name"] = "%s_%d" % (name, number)
            number += 1
        taken.add(row["name"])


def convert(world, options):
    paper = world.get("paper_settings", {})
    config = {
        "time_step": paper.get("time_step_s", 0.001),
        "gravity": world["simulation"]["gravity"],
        "contact": {
            "friction_rule": "harmonic_mean",  # mu = 2 / (1 / k1 + 1 / k2)
            "max_contacts_per_robot": paper.get("max_contacts_per_robot", 50),
            "max_contacts_per_object": paper.get("max_contacts_per_object", 20),
        },
        "environments": [convert_terrain(terrain) for terrain in world["terrains"]],
        "robots": [convert_robot(robot, options) for robot in world["robots"]],
        "objects": [convert_object(source) for source in world["objects"]],
    }
    give_own_names(config["robots"] + config["environments"] + config["objects"])
    return config


def arguments(argv):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("world")
    parser.add_argument("out")
    parser.add_argument("--motor", default="pid", choices=["pid", "implicit_pd"])
    parser.add_argument("--sensors", action="store_true", help="the robot's force-torque and tilt sensors, and an IMU")
    parser.add_argument("--self-collision", action="store_true")
    parser.add_argument("--start-at", metavar="MOTION.csv", help="the robot starts in the first row of this motion")
    return parser.parse_args(argv)


def main(argv):
    options = arguments(argv)
    with open(options.world) as stream:
        world = yaml.safe_load(stream)
    with open(options.out, "w") as stream:
        yaml.safe_dump(convert(world, options), stream, sort_keys=False, default_flow_style=None, width=140)
    print(" ".join(shlex.quote(option) for option in package_options()))


if __name__ == "__main__":
    main(sys.argv[1:])
