"""Feet that settle on the world where they are put down. Needs the Python module of a build."""
import copy
import math

import pytest
import yaml
from motion_case import ROOT, STEPS, WORLD, changed

try:
    from blem_sim import Simulator  # noqa: F401
except ImportError as error:
    pytest.skip("no Python module: %s" % error, allow_module_level=True)

SLOPE = 0.04  # [rad] of the ground, which falls towards +x


def sloping(case, **changes):
    """The humanoid's world with a slope in place of its plane."""
    config = yaml.safe_load(WORLD.read_text())
    config["environments"] = [{"name": "slope", "plane": [math.sin(SLOPE), 0.0, math.cos(SLOPE), 0.0], "friction": 0.9}]
    config.update(changes)
    return case.write("slope.yaml", config)


def step(settles):
    contacts = copy.deepcopy(STEPS["contacts"])
    contacts["right"]["settles"] = settles
    return changed(STEPS, contacts=contacts, phases=copy.deepcopy(STEPS["phases"][:2]))


def leaning(report):
    """Turn [rad] of the right foot about y at the end, and where its link is."""
    pose = report["phases"][-1]["end"]["links"]["right"]
    x, y, z, w = pose["quat_xyzw"]
    return math.asin(2 * (w * y - z * x)), pose["xyz"]


def test_a_foot_lies_on_the_slope_that_it_is_put_down_on(case):
    turned, (x, y, z) = leaning(case.plan(sloping(case), step(True), "--package", "blem_sim=%s" % ROOT))
    assert turned == pytest.approx(SLOPE, abs=1e-3)
    level, (x_level, y_level, _) = leaning(case.plan(sloping(case), step(False), "--package", "blem_sim=%s" % ROOT))
    assert level == pytest.approx(0.0, abs=1e-4)
    assert math.hypot(x - x_level, y - y_level) < 0.06 * 2 * SLOPE  # the sole's middle stays, the link's origin turns about it


def test_a_foot_without_ground_does_not_settle(case):
    line = case.refusal(sloping(case, environments=[{"name": "far", "plane": [0, 0, 1, -0.5]}]), step(True))
    assert "contacts.right: settles: link 'right_foot' does not come to rest within 30 mm" in line


def test_a_foot_does_not_settle_without_a_world(case):
    assert "settles: a URDF has no world" in case.refusal(ROOT / "urdf" / "blem_humanoid.urdf", step(True))


def test_settles_is_true_or_false(case):
    assert "contacts.right.settles" in case.refusal(WORLD, step(3))
