"""What each demo promises, run as fast as it goes by blem_sim_run (environment BLEM_SIM_RUN)."""
import csv
import json
import math
import os
import pathlib
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
CONFIG = ROOT / "config"
HUMANOID_WEIGHT = 33.71 * 9.81  # [N]


def run(folder, config, duration, *options):
    """Runs a demo. Returns its report and its rows of state as dicts of numbers, without sensors that have none yet."""
    program = os.environ.get("BLEM_SIM_RUN")
    if not program:
        pytest.skip("BLEM_SIM_RUN does not name a built blem_sim_run; run by scripts/test")
    report, table = folder / "report.json", folder / "state.csv"
    command = [program, str(CONFIG / config), "--duration", str(duration), "--report", str(report), "--csv", str(table), "--csv-rate", "50"]
    subprocess.run(command + ["--package", "blem_sim=%s" % ROOT] + list(options), check=True, timeout=600)
    with open(str(table)) as stream:
        rows = [{key: float(value) for key, value in row.items() if value} for row in csv.DictReader(stream)]
    return json.loads(report.read_text()), rows


def untroubled(report, of_layer=0.01):
    """No step left a layer, was shortened or redone; nothing sank deeper than this share of its layers."""
    for bit in ("STEP_SHORTENED", "CONTACT_UNRELIABLE", "SOLVER_TROUBLE", "STATE_NOT_FINITE"):
        assert report["status"][bit] == 0, (bit, report["status"])
    assert report["max_penetration"]["of_layer"] < of_layer


def upright(report, height):
    pelvis = report["bodies"]["humanoid::pelvis"]
    assert abs(pelvis["xyz"][2] - height) < 0.005, pelvis
    assert abs(pelvis["quat_xyzw"][3]) > 0.999, pelvis


def test_humanoid_stands_on_the_scan(tmp_path):
    report, _ = run(tmp_path, "demo_humanoid_on_scan.yaml", 6, "--stats-from", "5")
    untroubled(report)
    upright(report, 0.610)
    # Each ankle's sensor and the foot below it; the feet carry all.
    soles = [report["sensors"][name]["mean"][2] for name in ("left_sole", "right_sole")]
    assert abs(sum(soles) - HUMANOID_WEIGHT) < 1e-3 * HUMANOID_WEIGHT


def test_humanoid_shifts_its_weight(tmp_path):
    report, _ = run(tmp_path, "demo_humanoid_on_scan.yaml", 10, "--trajectory", str(CONFIG / "demo_humanoid_sway.csv"))
    untroubled(report)
    upright(report, 0.610)
    for ankle in ("left_ankle", "right_ankle"):
        # In the child's axes the foot is pressed down: the shift loads one leg and then the other.
        assert report["sensors"][ankle]["min"][2] < -0.6 * HUMANOID_WEIGHT, report["sensors"][ankle]


def test_humanoid_stands_on_the_points(tmp_path):
    report, _ = run(tmp_path, "demo_point_cloud.yaml", 5, "--stats-from", "4")
    untroubled(report)
    upright(report, 0.6155)
    soles = [report["sensors"][name]["mean"][2] for name in ("left_sole", "right_sole")]
    assert abs(sum(soles) - HUMANOID_WEIGHT) < 1e-3 * HUMANOID_WEIGHT


def test_gripper_lifts_shakes_and_puts_back_the_mug(tmp_path):
    report, rows = run(tmp_path, "demo_gripper_mug.yaml", 10.5, "--trajectory", str(CONFIG / "demo_gripper_mug.csv"))
    untroubled(report, of_layer=0.1)  # rubber pads give way by 0.4 mm
    height = {round(row["time"], 3): row["mug::link_z"] for row in rows}
    assert abs(height[3.6] - height[1.0] - 0.1) < 1e-3
    # While it is shaken the mug moves with the pads.
    held = [row["mug::link_x"] - row["gripper::shake"] for row in rows if 3.6 <= row["time"] <= 6.8]
    assert max(held) - min(held) < 1e-6, (min(held), max(held))
    travel = [row["mug::link_x"] for row in rows if 3.6 <= row["time"] <= 6.8]
    assert max(travel) - min(travel) > 0.095
    assert abs(height[10.5] - height[0.5]) < 1e-5


def test_ten_cubes_stand(tmp_path):
    report, _ = run(tmp_path, "demo_cube_stack.yaml", 10)
    untroubled(report)
    for i in range(10):
        # Every cube carries a layer of 2.5 mm; between two of them lie two.
        x, y, z = report["bodies"]["cube_%d::link" % (i + 1)]["xyz"]
        assert abs(x) < 1e-4 and abs(y) < 1e-4, (i, x, y)
        assert abs(z - (0.0525 + 0.105 * i)) < 1e-4, (i, z)


def test_watcher_looks_around_and_sees_what_is_there(tmp_path):
    report, rows = run(tmp_path, "demo_robot_with_eyes.yaml", 10, "--trajectory", str(CONFIG / "demo_robot_with_eyes.csv"), "--stats-from", "1")
    untroubled(report, of_layer=0.1)
    foot = report["bodies"]["watcher::foot"]
    assert math.hypot(*foot["xyz"][:2]) < 1e-4 and foot["quat_xyzw"][3] > 0.9999, foot
    pan = [row["watcher::pan"] for row in rows]
    assert max(pan) == pytest.approx(0.7, abs=0.01) and min(pan) == pytest.approx(-0.7, abs=0.01)
    camera, scan = report["sensors"]["camera"], report["sensors"]["scan"]
    assert camera["samples"] == 15 * 9 and scan["samples"] == 10 * 9
    nearest, hits = camera["fields"].index("nearest"), camera["fields"].index("hits")
    # The floor below its view, 0.66 m under it, and never its own mast; holes and the end of the scan give no depth.
    assert 0.4 < camera["min"][nearest] and camera["max"][nearest] < 1.1
    assert 0.3 < camera["min"][hits] and camera["max"][hits] < 1
    # The upper cube is nearest to the lidar, which looks out of its own drum: between a face's middle and an edge away.
    centre = math.hypot(*report["bodies"]["upper_cube::link"]["xyz"][:2])
    assert centre - 0.0708 - 0.02 < scan["min"][scan["fields"].index("nearest")] < centre - 0.05
    for name, height in (("cube", 0.0525), ("lower_cube", 0.0525), ("upper_cube", 0.1575), ("mug", 0.0025)):
        body = report["bodies"][name + "::link"]
        assert abs(body["xyz"][2] - height) < 0.005, (name, body)
