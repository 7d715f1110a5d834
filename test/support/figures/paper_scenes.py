"""Scenes of the paper's worlds [Hauser 2013] from the shared data, as they are drawn: made when they are asked for."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import gripper_motions  # noqa: E402
from scene_runs import read_motion, world  # noqa: E402
from shared_data import shared_data  # noqa: E402
from sitting import sitting_scene  # noqa: E402

SWAY_STARTS = 1.0  # [s]
LEANING = {"xyz": [0.248, -0.00247315, 1.0], "rpy": [0.0, -0.25, 0.0]}  # before the ladder, on its heels
HAND_VIEW = "0.8,-0.4,1.0,0.4,0.1,0.83"
CHAIR_VIEW = "-1.6,-1.5,1.0,-0.2,0,0.5"


def as_it_is(name, pose=None):
    """A world of the shared data. pose: of its robot, if another."""
    def scene():
        config = world(name)
        if pose:
            config["robots"][0]["pose"] = pose
        return config, None
    return scene


def grasp(name, hand_height, closing_angle, reach_back=0.0):
    def scene():
        config = world(name)
        rest = gripper_motions.RESTS[name]
        return config, gripper_motions.grasp_scene(config, rest, hand_height, closing_angle, reach_back, 3.0)[1]
    return scene


def stir():
    config = world("paper_tray18")
    return config, gripper_motions.stir_scene(config, 3.0)[1]


def sway():
    config = world("hubo_plane", start_at=shared_data("motions/hubo_sway_path_opt.csv"))
    motion = read_motion("hubo_sway_path_opt")
    return config, [(0.0, motion[0][1])] + [(SWAY_STARTS + time, positions) for time, positions in motion]


# Picture: its scene, when it is taken [s], from where to where the camera looks [m].
PICTURES = {
    "stack3": (as_it_is("paper_stack3_gap1cm"), 2.0, None),
    "stack10": (as_it_is("paper_stack10_gap1cm"), 2.0, None),
    "stepladder": (as_it_is("paper_hubo_stepladder_1m"), 2.0, "0.6,-3.1,1.0,0.05,0,0.72"),
    "gripper_mug": (grasp("paper_gripper_mug", gripper_motions.PAD + 0.0145, math.pi / 2, reach_back=-0.018), 4.7, HAND_VIEW),
    "ladder": (as_it_is("hubo_ladder", LEANING), 0.5, "-2.3,-1.5,1.5,0.25,0,0.8"),
    "sway": (sway, 6.7, "2.2,-1.3,1.1,0.05,0,0.55"),
    "atlas_fractal": (as_it_is("paper_atlas_fractal"), 2.0, None),
    "gripper_block": (grasp("paper_gripper_block", 0.140, 0.0), 4.7, HAND_VIEW),
    "tray18": (stir, 5.5, "1.2,-0.55,1.45,0.58,0.12,0.72"),
    "chair": (as_it_is("paper_hubo_chair_150k", {"xyz": [0.7, 0.05, 1.0032431], "rpy": [0, 0, 0]}), 1.0, None),
    "chair_edge": (sitting_scene, 22.0, CHAIR_VIEW),
    "chair_sits": (sitting_scene, 50.0, CHAIR_VIEW),
}
