"""A motion keeps a clearance from the world and from itself, and postures are found for it. Needs the Python module of a build."""
import copy
import re
import sys

import pytest
import yaml
from motion_case import CLIMBS, MOTIONS, ROOT, STEPS, WORLD, changed

from planning.command import main

try:
    from blem_sim import Simulator  # noqa: F401
except ImportError as error:
    pytest.skip("no Python module: %s" % error, allow_module_level=True)

AT_STEPS = MOTIONS / "humanoid_at_steps.yaml"


def climb(clearance, lift):
    """The first three phases of the climb, with another lift of the foot."""
    phases = copy.deepcopy(CLIMBS["phases"][:2])
    phases[1]["move"]["right"]["lift"] = lift
    return changed(CLIMBS, phases=phases, clearance=clearance)


def test_a_foot_that_cuts_a_step_is_refused_with_place_and_time(case):
    assert case.plan(AT_STEPS, climb(None, 0.0))["phases"][-1]["gap"] is None
    (case.folder / "motion.csv").unlink()
    line = case.refusal(AT_STEPS, climb(0.005, 0.0))
    found = re.search(r"right on the first: link '(\w+)' comes within -\d+\.\d mm of '(\w+)' at (\d+) % of the phase \((\d+\.\d\d) s", line)
    assert found, line
    assert found.group(1) == "right_foot" and found.group(2) == "lower_step"


def test_a_foot_that_is_lifted_over_it_keeps_the_clearance(case):
    phases = case.plan(AT_STEPS, climb(0.005, 0.05))["phases"]
    gap = phases[-1]["gap"]
    assert gap is None or gap["m"] >= 0.005


def test_the_module_of_the_build_is_found_without_a_sourced_environment(case, monkeypatch):
    monkeypatch.delenv("PYTHONPATH", raising=False)
    assert case.plan(AT_STEPS, climb(0.005, 0.05))["phases"]


def test_limbs_that_cross_are_refused(case):
    motion = changed(STEPS, clearance=0.0, phases=[{"name": "arms in", "duration": 2, "joints": {"left_shoulder": 0.0, "right_shoulder": 0.0}},
                                                   {"name": "feet together", "duration": 2, "move": {"right": {"by": [0, 0.16, 0], "lift": 0.05}}}])
    line = case.refusal(WORLD, motion)
    assert "humanoid::" in line and "feet together" in line, line


def test_a_clearance_without_a_world_is_refused(case):
    urdf = ROOT / "urdf" / "blem_humanoid.urdf"
    assert "a URDF has no world" in case.refusal(urdf, changed(STEPS, clearance=0.01))


def found_targets(case, capsys, motion, name):
    """What --find says about a phase: keys of the motion file, and its last line."""
    options = ["--out", str(case.folder / "motion.csv"), "--find", name, "--tries", "12"]
    assert main([str(WORLD), str(case.write("motion.yaml", motion))] + options) == 0
    *lines, words = capsys.readouterr().out.strip().splitlines()
    return yaml.safe_load("\n".join(lines)), words


def test_targets_that_are_found_can_be_asked_for_and_are_no_worse(case, capsys):
    motion = changed(STEPS, phases=[{"name": "crouch", "duration": 2, "body": {"rise": -0.1}}])
    before = case.plan(WORLD, motion)["phases"][-1]["effort"]["share"]
    targets, words = found_targets(case, capsys, motion, "crouch")
    motion["phases"][0].update(targets)
    after = case.plan(WORLD, motion)["phases"][-1]
    assert after["effort"]["share"] < before
    assert after["margin_m"] >= STEPS["margin"] and "margin" in words
    assert found_targets(case, capsys, motion, "crouch") == found_targets(case, capsys, motion, "crouch")


def test_a_free_centre_of_mass_stays_free(case, capsys):
    motion = changed(STEPS, phases=[{"name": "crouch", "duration": 2, "com": "free", "body": {"rise": -0.05}}])
    targets, _ = found_targets(case, capsys, motion, "crouch")
    assert targets["com"] == "free"
    motion["phases"][0].update(targets)
    assert case.plan(WORLD, motion)["phases"][-1]["margin_m"] >= STEPS["margin"]


def test_a_posture_at_the_start_is_found(case, capsys):
    start = {"contacts": {"left": {"xyz": [0.03, 0.11, 0.0025]}, "right": {"xyz": [0.03, -0.11, 0.0025]}}}
    motion = changed(STEPS, start=start, phases=STEPS["phases"][:1])
    targets, words = found_targets(case, capsys, motion, "start")
    motion["start"].update({"com": targets["com"], "height": targets["body"]["height"], "rpy": targets["body"]["rpy"]})
    assert case.plan(WORLD, motion)["phases"][0]["margin_m"] > 0 and "effort" in words


def test_an_unknown_phase_is_refused(case, capsys):
    assert main([str(WORLD), str(case.write("motion.yaml", STEPS)), "--find", "leap"]) == 2
    assert "there is no phase 'leap'" in capsys.readouterr().err


def test_contacts_that_no_posture_reaches_are_refused(case, capsys):
    motion = changed(STEPS, phases=[{"name": "far", "duration": 2, "move": {"right": {"by": [3, 0, 0]}}}])
    assert main([str(WORLD), str(case.write("motion.yaml", motion)), "--find", "far", "--tries", "3"]) == 2
    assert "none of 3 postures reaches the contacts" in capsys.readouterr().err


def test_no_tries_are_refused(case, capsys):
    assert main([str(WORLD), str(case.write("motion.yaml", STEPS)), "--find", "start", "--tries", "0"]) == 2
    assert "--tries" in capsys.readouterr().err


if __name__ == "__main__":
    sys.exit(pytest.main([__file__]))
