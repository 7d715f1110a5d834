"""Hubo sits down on the scanned chair by a motion that scripts/plan_motion plans: the case of Fig. 13."""
import math
import pathlib
import sys
import tempfile

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "test" / "support"), str(ROOT / "scripts" / "support")]
import kinematics  # noqa: E402
from climbing import LITTLE, NEAR, STANDS, STILL  # noqa: E402
from foot_forces import pose_in  # noqa: E402
from hubo_scenes import bent_hubo, off, plan  # noqa: E402
from scene_runs import read_trajectory, simulate  # noqa: E402
from shared_data import shared_data  # noqa: E402

MOTION = ROOT / "config" / "motions" / "hubo_onto_a_chair.yaml"
ROOT_LINK = "Body_Torso5"
FINGERS = ["%s%s" % (finger, part) for finger in ("Thumb", "Pinky", "Ring", "Middle", "Index") for part in ("Proximal", "Medial", "Distal")]
PARTS = {"buttocks": ["Body_LHR", "Body_RHR"], "thighs": ["Body_LHP", "Body_RHP"], "feet": ["Body_LAR", "Body_RAR"],
         "hands": ["Body_LWP", "Body_RWP"] + [side + finger for side in ("left", "right") for finger in FINGERS]}
SEATED, FREE_FEET, EACH, HELPED, WHOLE = 0.9, 0.05, 0.2, 0.3, 1e-4  # shares of the weight
SIT_ASKED = ("planned by scripts/plan_motion; contacts within the layer in all steps, the solver without trouble; armrests carry 30 % on the way; at the end"
             " the seat carries over 90 % of the weight and the floor below 5 %, their sum is the weight within 1e-4, root and links that hold are within"
             " 30 mm and 50 mrad of the plan, and the root is still within 1 mm for 2 s")


def chair():
    """The chair's world with a floor where the scan has holes, and links of Hubo that touch each other; contact sensors on what the chair may carry."""
    config = bent_hubo("paper_hubo_chair_150k")
    config["environments"].append({"name": "floor", "plane": [0, 0, 1, 0], "friction": 0.5})
    robot = config["robots"][0]
    robot.update(pose={"xyz": [-0.42, 0, 1], "rpy": [0, 0, math.pi]}, self_collision=True)
    robot["sensors"] = [{"name": link, "type": "contact", "link": link} for links in PARTS.values() for link in links]
    return config


def planned_sitting(folder):
    """(report of the plan, configuration where it starts); motion.csv is in the folder."""
    config = chair()
    (folder / "world.yaml").write_text(yaml.safe_dump(config, sort_keys=False))
    planned = plan(folder / "world.yaml", MOTION, folder)
    started = yaml.safe_load((folder / "started.yaml").read_text())["robots"][0]
    config["robots"][0].update({key: started[key] for key in ("pose", "initial_positions")})
    return planned, config


def sitting_scene():
    """(configuration, rows of the trajectory) for a picture."""
    with tempfile.TemporaryDirectory() as folder:
        _, config = planned_sitting(pathlib.Path(folder))
        return config, read_trajectory(pathlib.Path(folder) / "motion.csv")


def sits(scan=None):
    """The case. scan: of the shared data, on which the motion is played in place of the one that it is planned for."""
    def case(folder, options):
        planned, config = planned_sitting(folder)
        if scan:
            config["environments"][0]["uri"] = str(shared_data(scan))
        report, rows = simulate(folder, config, planned["duration_s"] + STANDS, 50, ["--trajectory", str(folder / "motion.csv")],
                                lambda column: ROOT_LINK in column or column.endswith(".force_z"))
        weight = -config["gravity"][2] * kinematics.Tree(config["robots"][0]["urdf"]).total_mass()
        return report, sit_figures(report, rows, planned, weight)
    return case


def carried(row, weight):
    """{part: share of the weight that it carries} in a row of states."""
    return {part: sum(float(row[link + ".force_z"]) for link in links) / weight for part, links in PARTS.items()}


def sit_figures(report, rows, planned, weight):
    """(what was measured, whether it holds) of a robot that sat down."""
    root, end = next(name for name in report["bodies"] if name.endswith("::" + ROOT_LINK)), planned["phases"][-1]["end"]
    links = yaml.safe_load(MOTION.read_text())["contacts"]
    ends = [(ROOT_LINK, end["root"])] + [(links[name]["link"], pose) for name, pose in end["links"].items()]
    offs = [off(report["bodies"][root.replace(ROOT_LINK, link)], pose) for link, pose in ends]
    far, turned = max(distance for distance, _ in offs), max(turn for _, turn in offs)
    last = [pose_in(row, root)[1] for row in rows if float(row["time"]) > report["simulated_s"] - 2]
    moved = max(math.dist(last[0], position) for position in last)
    shares = carried(rows[-1], weight)
    helped = max(carried(row, weight)["hands"] for row in rows)
    seat, rest = shares["buttocks"] + shares["thighs"], abs(sum(shares.values()) - 1)
    status, worst = report["status"], report["max_penetration"]["of_layer"]
    text = ("%.1f s planned; at the end buttocks carry %.1f %%, thighs %.1f %%, hands %.1f %%, feet %.1f %%, sum off m g by %.1e; armrests carry up to %.0f %%"
            " on the way; root and links within %.0f mm and %.0f mrad of the plan; root moves %.1e mm in the last 2 s; worst %.2f of layer, %d steps unreliable,"
            " %d with solver trouble, %d with a motor at its limit; real-time factor %.1f")
    text %= (planned["duration_s"], *[100 * shares[part] for part in ("buttocks", "thighs", "hands", "feet")], rest, 100 * helped, 1e3 * far, 1e3 * turned,
             1e3 * moved, worst, status["CONTACT_UNRELIABLE"], status["SOLVER_TROUBLE"], status["EFFORT_SATURATED"], report["real_time_factor"])
    trouble = status["CONTACT_UNRELIABLE"] + status["SOLVER_TROUBLE"] + status["STATE_NOT_FINITE"]
    there = far < NEAR and turned < LITTLE and moved < STILL
    seated = seat > SEATED and min(shares["buttocks"], shares["thighs"]) > EACH and shares["feet"] < FREE_FEET and helped > HELPED and rest < WHOLE
    return text, not trouble and there and seated
