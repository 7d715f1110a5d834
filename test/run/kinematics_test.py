"""The validation scripts' own kinematics: against the simulator's poses, and the inverse against the forward one. Skipped without the shared
data."""
import math
import os
import pathlib
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "test" / "support"), str(ROOT / "scripts" / "support")]
import gripper_motions  # noqa: E402
import kinematics  # noqa: E402
from scene_runs import execute, world  # noqa: E402
from shared_data import shared_data  # noqa: E402

pytestmark = pytest.mark.skipif(shared_data("robots") is None, reason="shared data not found (set BLEM_SIM_SHARED_DATA to its folder)")


def apart(a, b):
    """Distance [m] and turn [rad] between two poses."""
    return math.dist(a[1], b[1]), math.hypot(*kinematics.turn_between(a[0], b[0]))


@pytest.mark.skipif("BLEM_SIM_RUN" not in os.environ, reason="BLEM_SIM_RUN does not name a built blem_sim_run; run by scripts/test")
@pytest.mark.parametrize("name", ["hubo_plane", "paper_gripper_block"])
def test_links_stand_where_the_simulator_has_them(name, tmp_path):
    config = world(name, sensors=False)
    robot = config["robots"][0]
    status, report, said = execute(tmp_path, config, 0.05)
    assert status == 0, said
    tree = kinematics.Tree(robot["urdf"])
    poses = {body.split("::")[1]: (kinematics.from_quaternion(*state["quat_xyzw"]), tuple(state["xyz"]))
             for body, state in report["bodies"].items() if body.startswith(robot["name"] + "::")}
    positions = {joint.split("::")[1]: state["position"] for joint, state in report["joints"].items()}
    ours = tree.link_poses(positions, poses.get(tree.root, kinematics.AT_ORIGIN))
    assert len(poses) > 8
    for link, pose in poses.items():
        distance, turn = apart(pose, ours[link])
        assert distance < 1e-9 and turn < 1e-9, link


def test_the_arm_reaches_every_pose_of_the_grasp():
    motion = gripper_motions.Grasp((0.4, 0.1, 0.83), -0.5, 2.0)
    tree = kinematics.Tree(shared_data(gripper_motions.URDF))
    for time, positions in gripper_motions.joint_rows(motion, step=0.25):
        distance, turn = apart(tree.link_poses(positions)[gripper_motions.HAND], motion.at(time)[0])
        assert distance < 1e-8 and turn < 1e-8


def test_a_pose_out_of_reach_is_refused():
    tree = kinematics.Tree(shared_data(gripper_motions.URDF))
    with pytest.raises(ValueError):
        tree.reach(gripper_motions.HAND, gripper_motions.hand_pose((3.0, 0.0, 0.5), 0.0), gripper_motions.ARM, {})
