"""Hubo climbs by motions that scripts/plan_motion plans: the cases of Figs. 2 and 8."""
import math
import pathlib
import sys

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "test" / "support"), str(ROOT / "scripts" / "support")]
from foot_forces import pose_in  # noqa: E402
from hubo_scenes import bent_hubo, off, plan  # noqa: E402
from scene_runs import simulate  # noqa: E402

STANDS = 5.0  # [s] after the motion
NEAR, LITTLE, STILL = 0.03, 0.05, 1e-3  # [m] and [rad] of the feet from the plan at the end; [m] of the root in the last two seconds
CLIMB_ASKED = ("planned by scripts/plan_motion; contacts within the layer in all steps, the solver without trouble, root and feet that stand within 30 mm and"
               " 50 mrad of the plan at the end, and the root still within 1 mm for 2 s")


def climbs(name, motion, pose=None):
    """A climb in a world of the shared data. motion: name of its file in config/motions. pose: of the robot before it goes to the motion's start."""
    def case(folder, options):
        file = ROOT / "config" / "motions" / (motion + ".yaml")
        planned, config = planned_climb(folder, name, file, pose)
        report, rows = simulate(folder, config, planned["duration_s"] + STANDS, 50, ["--trajectory", str(folder / "motion.csv")],
                                lambda column: "Body_Torso5" in column)
        return report, climb_figures(report, rows, planned, yaml.safe_load(file.read_text())["contacts"])
    return case


def planned_climb(folder, name, file, pose=None):
    """(report of the plan, configuration where it starts); motion.csv is in the folder."""
    config = bent_hubo(name)
    config["robots"][0]["pose"].update(pose or {})
    (folder / "world.yaml").write_text(yaml.safe_dump(config, sort_keys=False))
    planned = plan(folder / "world.yaml", file, folder)
    return planned, yaml.safe_load((folder / "started.yaml").read_text())


def climb_figures(report, rows, planned, contacts):
    """(what was measured, whether it holds) of a climb."""
    root = next(name for name in report["bodies"] if name.endswith("::Body_Torso5"))
    ends = planned["phases"][-1]["end"]["links"]
    feet = [off(report["bodies"][root.replace("Body_Torso5", contacts[name]["link"])], pose) for name, pose in ends.items()]
    feet.append(off(report["bodies"][root], planned["phases"][-1]["end"]["root"]))
    rise = planned["phases"][-1]["end"]["root"]["xyz"][2] - planned["start"]["root"]["xyz"][2]
    last = [pose_in(row, root)[1] for row in rows if float(row["time"]) > report["simulated_s"] - 2]
    moved = max(math.dist(last[0], position) for position in last)
    margin, effort = min(phase["margin_m"] for phase in planned["phases"]), max(phase["effort"]["share"] for phase in planned["phases"])
    status, worst = report["status"], report["max_penetration"]["of_layer"]
    far, turned = max(distance for distance, _ in feet), max(turn for _, turn in feet)
    text = ("%.1f s planned, margin %.0f mm, efforts up to %.0f %%; root %.2f m higher, it and feet within %.0f mm and %.0f mrad of the plan; root moves %.1e mm in"
            " the last 2 s; worst %.2f of layer, %d steps unreliable, %d with solver trouble; real-time factor %.1f")
    text %= (planned["duration_s"], 1e3 * margin, 100 * effort, rise, 1e3 * far, 1e3 * turned, 1e3 * moved, worst,
             status["CONTACT_UNRELIABLE"], status["SOLVER_TROUBLE"], report["real_time_factor"])
    trouble = status["CONTACT_UNRELIABLE"] + status["SOLVER_TROUBLE"] + status["STATE_NOT_FINITE"]
    return text, not trouble and far < NEAR and turned < LITTLE and moved < STILL
