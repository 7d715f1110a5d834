"""Static equilibrium: support regions that are known by hand, and efforts."""
import math

import numpy as np
import pytest
from motion_case import ROOT
from planning.robot_model import Posture, RobotModel
from planning.support import ContactPoint, region_margin, region_middle, static_effort, support_region, towards

from kinematics import Tree

UP = (0.0, 0.0, 1.0)
SOLE = [(0.0, 0.0, 0.0), (0.2, 0.0, 0.0), (0.2, 0.1, 0.0), (0.0, 0.1, 0.0)]


def points(positions, normal=UP, friction=0.5, most=1.0):
    return [ContactPoint("link", np.array(position, float), np.array(normal, float), friction, most) for position in positions]


def extent(region):
    return [(float(region[:, k].min()), float(region[:, k].max())) for k in range(2)]


def test_flat_support_is_the_hull_of_its_points():
    trapezium = SOLE[:2] + [(0.15, 0.1, 0.0), (0.05, 0.12, 0.0)]  # no side of it mirrors another
    region = support_region(points(trapezium + [(0.1, 0.05, 0.0)]))
    assert sorted(map(tuple, region.round(6) + 0.0)) == sorted(point[:2] for point in trapezium)


def test_margins_and_middles_of_a_region():
    region = support_region(points(SOLE))
    assert region_margin(region, np.array([0.1, 0.03])) == pytest.approx(0.03)
    assert region_margin(region, np.array([0.23, 0.14])) == pytest.approx(-0.05)
    assert region_middle(region) == pytest.approx([0.1, 0.05])
    assert towards(region, np.array([0.3, 0.05]), np.array([0.1, 0.05]), 0.02) == pytest.approx([0.18, 0.05], abs=1e-4)


def test_soles_at_different_heights_count_as_on_one_floor():
    """With friction enough, as the vertical forces of steps need no other."""
    step = [(x, y + 0.2, 0.3) for x, y, _ in SOLE]
    region = support_region(points(SOLE + step))
    assert all(region_margin(region, np.array(point[:2]) + 1e-9) > -1e-6 for point in SOLE + step)


def test_a_slope_beyond_friction_supports_nothing():
    for degrees, stands in ((25, True), (28, False)):  # tan 26.57 = 0.5
        angle = math.radians(degrees)
        slope = [(x * math.cos(angle), y, x * math.sin(angle)) for x, y, _ in SOLE]
        region = support_region(points(slope, (-math.sin(angle), 0, math.cos(angle))))
        assert (len(region) >= 3) == stands, degrees


def test_a_hand_on_a_wall_reaches_as_far_as_feet_hold_it():
    """Feet at x = 0 with friction 0.5 bear a push of half the weight, 1 m up: the centre of mass may be 0.5 m before them."""
    feet = points([(0, -0.1, 0), (0, 0.1, 0)])
    hands = points([(0.3, -0.1, 1.0), (0.3, 0.1, 1.0)], (-1, 0, 0), friction=1e-3)
    (back, front), (right, left) = extent(support_region(feet + hands))
    assert front == pytest.approx(0.5, abs=2e-3) and back == pytest.approx(0.0, abs=2e-3)
    assert right == pytest.approx(-0.1, abs=2e-3) and left == pytest.approx(0.1, abs=2e-3)
    weak = points([(0.3, -0.1, 1.0), (0.3, 0.1, 1.0)], (-1, 0, 0), friction=1e-3, most=0.1)
    assert extent(support_region(feet + weak))[0][1] == pytest.approx(0.2, abs=2e-3), "two hands of a tenth of the weight each"


def test_a_hand_that_pulls_a_rung_holds_what_is_behind_the_feet():
    feet = points([(0, -0.1, 0), (0, 0.1, 0)])
    rung = points([(0.3, -0.1, 1.0), (0.3, 0.1, 1.0)], (1, 0, 0), friction=1e-3)  # the rung pushes the fingers away from the robot
    assert extent(support_region(feet + rung))[0][0] == pytest.approx(-0.5, abs=2e-3)


def pendulum(tmp_path):
    """A link of 2 kg, 0.5 m out on a hinge about y at a base; motor of 20 N m."""
    urdf = tmp_path / "pendulum.urdf"
    urdf.write_text("""<robot name="p"><link name="world"/><link name="arm"><inertial><origin xyz="0.5 0 0"/><mass value="2"/></inertial></link>
<joint name="hinge" type="revolute"><parent link="world"/><child link="arm"/><axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="20" velocity="1"/></joint></robot>""")
    return RobotModel(Tree(urdf), True, {}, {})


def test_effort_of_a_pendulum(tmp_path):
    model = pendulum(tmp_path)
    for angle in (0.0, 1.0):
        share, joint = static_effort(model.place(Posture(np.eye(3), np.zeros(3), [angle])), [], 9.81)
        assert joint == "hinge" and share == pytest.approx(2 * 9.81 * 0.5 * math.cos(angle) / 20)
    tip = [ContactPoint("arm", np.array([0.5, 0.0, 0.0]), np.array(UP), 0.5, 1.0)]
    assert static_effort(model.place(Posture(np.eye(3), np.zeros(3), [0.0])), tip, 9.81)[0] == pytest.approx(0, abs=1e-6), "a rest below it carries all"


def test_effort_on_one_leg_is_what_the_mass_beside_it_asks():
    """The hip's roll holds all that is not the standing leg: its weight times its distance beside the hinge."""
    tree = Tree(ROOT / "urdf" / "blem_humanoid.urdf")
    others = {joint.name: 1e9 for joint in tree.joints if joint.name != "left_hip_roll"}
    model = RobotModel(tree, False, others, {})
    placed = model.place(Posture(np.eye(3), np.zeros(3), np.zeros(len(model.joint_names))))
    middle = placed.centre_of_mass[:2]
    corners = points([(middle[0] + x, middle[1] + y, -0.6) for x in (-0.1, 0.1) for y in (-0.05, 0.05)])
    share, joint = static_effort(placed, [point._replace(link="left_foot") for point in corners], 9.81)
    hinge = next(k for k, each in enumerate(tree.joints) if each.name == "left_hip_roll")
    beside = ~model.moves[hinge]
    arm = (model.masses[beside] * (placed.centres[beside, 1] - placed.positions[hinge + 1, 1])).sum()
    assert joint == "left_hip_roll" and share == pytest.approx(abs(arm) * 9.81 / 90, rel=1e-6)
