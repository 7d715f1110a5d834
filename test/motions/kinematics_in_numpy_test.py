"""The planner's kinematics: Jacobians against differences, mimic joints and limits, ranks of tasks."""
import numpy as np
import pytest
from motion_case import ROOT
from planning.inverse_kinematics import joints_at_limits, reach
from planning.robot_model import Posture, RobotModel, rotation_vector, turn

from kinematics import Tree

ARM = """<robot name="arm"><link name="world"/>
<link name="upper"><inertial><origin xyz="0.1 0 0"/><mass value="1"/></inertial></link>
<link name="lower"><inertial><origin xyz="0.2 0 0"/><mass value="2"/></inertial></link>
<link name="slide"><inertial><origin xyz="0 0.1 0"/><mass value="3"/></inertial></link><link name="tip"/>
<joint name="shoulder" type="revolute"><parent link="world"/><child link="upper"/><axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="9" velocity="4"/></joint>
<joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/><origin xyz="0.3 0 0" rpy="0.1 0 0"/><axis xyz="0 0 1"/>
  <limit lower="-1" upper="1.5" effort="9" velocity="4"/><mimic joint="shoulder" multiplier="-2" offset="0.5"/></joint>
<joint name="rail" type="prismatic"><parent link="lower"/><child link="slide"/><origin xyz="0.3 0 0"/><axis xyz="1 0 0"/><limit lower="0" upper="0.2" effort="9" velocity="4"/></joint>
<joint name="end" type="fixed"><parent link="slide"/><child link="tip"/><origin xyz="0.1 0 0"/></joint></robot>"""


@pytest.fixture(params=["arm", "humanoid"])
def model(request, tmp_path):
    urdf = tmp_path / "arm.urdf"
    urdf.write_text(ARM)
    return RobotModel(Tree(urdf if request.param == "arm" else ROOT / "urdf" / "blem_humanoid.urdf"), False, {}, {})


def random_posture(model, seed):
    random = np.random.default_rng(seed)
    joints = random.uniform(np.maximum(model.lower, -0.4), np.minimum(model.upper, 0.4))
    return Posture(turn(random.normal(size=3)), random.normal(size=3), joints)


def test_links_and_masses_are_where_the_tree_has_them(model):
    posture = random_posture(model, 1)
    placed = model.place(posture)
    poses = model.tree.link_poses(model.all_joints(posture), (tuple(map(tuple, posture.rotation)), tuple(posture.position)))
    for link in model.links:
        assert np.abs(np.array(poses[link][0]) - placed.link(link)[0]).max() < 1e-12 and np.abs(np.array(poses[link][1]) - placed.link(link)[1]).max() < 1e-12
    assert placed.centre_of_mass == pytest.approx(model.tree.centre_of_mass(poses), abs=1e-12)


def test_jacobians_are_what_differences_are(model):
    posture, link = random_posture(model, 2), model.links[-1]
    placed, size = model.place(posture), 1e-6
    point = placed.link(link)[1] + [0.1, -0.2, 0.3]
    local = placed.link(link)[0].T @ (point - placed.link(link)[1])
    for k in range(6 + len(model.joint_names)):
        step = np.zeros(6 + len(model.joint_names))
        step[k] = size
        ahead, back = model.place(posture.moved(step)), model.place(posture.moved(-step))
        ends = [each.link(link)[1] + each.link(link)[0] @ local for each in (ahead, back)]
        turned = rotation_vector(ahead.link(link)[0] @ back.link(link)[0].T)
        difference = np.append(ends[0] - ends[1], turned) / (2 * size)
        assert placed.point_jacobian(link, point)[:, k] == pytest.approx(difference, abs=1e-7), k
        assert placed.centre_jacobian()[:, k] == pytest.approx((ahead.centre_of_mass - back.centre_of_mass) / (2 * size), abs=1e-7), k


def test_limits_of_what_mimics_bound_its_leader(tmp_path):
    urdf = tmp_path / "arm.urdf"
    urdf.write_text(ARM)
    model = RobotModel(Tree(urdf), True, {}, {})
    assert model.joint_names == ["shoulder", "rail"]
    assert model.lower == pytest.approx([-0.5, 0.0]) and model.upper == pytest.approx([0.75, 0.2])  # elbow = 0.5 - 2 shoulder
    assert model.velocity == pytest.approx([2.0, 4.0]) and list(model.effort) == [9.0, 9.0]


def tip_tasks(goal, height):
    """First the tip's x and y, then the rail's position."""
    def ranks(placed):
        tip = placed.link("tip")[1]
        row = np.zeros((1, 8))
        row[0, 7] = 1.0
        return [(placed.point_jacobian("tip", tip)[:1], goal[:1] - tip[:1]), (row, np.array([height]) - placed.posture.joints[1:])]
    return ranks


def test_lower_ranks_give_way_and_limits_hold(tmp_path):
    urdf = tmp_path / "arm.urdf"
    urdf.write_text(ARM)
    model, free = RobotModel(Tree(urdf), True, {}, {}), np.array([False] * 6 + [True] * 2)
    start = Posture(np.eye(3), np.zeros(3), [0.3, 0.1])
    both = reach(model, start, tip_tasks(np.array([0.6]), 0.15), free, 200)
    assert model.place(both).link("tip")[1][0] == pytest.approx(0.6, abs=1e-8) and both.joints[1] == pytest.approx(0.15, abs=1e-6)
    beyond = reach(model, start, tip_tasks(np.array([0.6]), 0.5), free, 200)
    assert model.place(beyond).link("tip")[1][0] == pytest.approx(0.6, abs=1e-8) and beyond.joints[1] == pytest.approx(0.2, abs=1e-9)
    assert joints_at_limits(model, beyond, free) == ["rail"]
