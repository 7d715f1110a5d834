"""Hubo (57 joints) of the shared data takes steps and squats as planned. Skipped without the data."""
import sys

import pytest
from motion_case import ROOT, off

sys.path.insert(0, str(ROOT / "test" / "support"))
from hubo_scenes import bent_hubo  # noqa: E402
from shared_data import package_options, shared_data  # noqa: E402

pytestmark = pytest.mark.skipif(shared_data("robots") is None, reason="shared data not found (set BLEM_SIM_SHARED_DATA to its folder)")

SOLE = [(-0.145, 0.05), (-0.12, 0.075), (0.007, 0.077), (0.0665, 0.0325), (0.0665, -0.0325), (0.0214, -0.067), (-0.12, -0.067), (-0.145, -0.045)]
MOTION = {
    "margin": 0.025, "friction": 0.6, "rate": 20, "body": "Body_Torso5",
    "contacts": {name: {"link": link, "points": [[x, side * y, -0.1054] for x, y in SOLE]}
                 for name, link, side in (("left", "Body_LAR", 1), ("right", "Body_RAR", -1))},
    "start": {"contacts": {"left": {"xyz": [0, 0.08, 0.01], "rpy": [0, 0, 0]}, "right": {"xyz": [0, -0.08, 0.01], "rpy": [0, 0, 0]}},
              "com": {"over": ["left", "right"]}, "height": 0.95, "rpy": [0, 0, 0]}}
REST = {"name": "rest", "duration": 1}
STEPS = [REST, {"name": "right forward", "duration": 2, "move": {"right": {"by": [0.1, 0, 0], "lift": 0.05}}},
         {"name": "left forward", "duration": 2, "move": {"left": {"by": [0.2, 0, 0], "lift": 0.05}}},
         {"name": "right beside it", "duration": 2, "move": {"right": {"by": [0.1, 0, 0], "lift": 0.05}}},
         {"name": "stand", "duration": 2, "com": {"over": ["left", "right"]}}]
SQUAT = [REST, {"name": "down", "duration": 3, "body": {"rise": -0.15}}, {"name": "up", "duration": 3, "body": {"rise": 0.15}}]


def hubo_on_plane():
    config = bent_hubo("hubo_plane")
    config["environments"][0]["friction"] = 0.8
    return config


@pytest.mark.parametrize("phases", [STEPS, SQUAT], ids=["steps", "squat"])
def test_hubo_does_it(case, phases):
    started = case.folder / "started.yaml"
    plan = case.plan(case.write("hubo.yaml", hubo_on_plane()), dict(MOTION, phases=phases), "--config-out", started, *package_options())
    report = case.play(started, plan["duration_s"] + 2, *package_options())
    end = plan["phases"][-1]["end"]
    for link, pose in (("Body_Torso5", end["root"]), ("Body_LAR", end["links"]["left"]), ("Body_RAR", end["links"]["right"])):
        distance, turn = off(report["bodies"]["jaemiHubo::" + link], pose)
        assert distance < 0.002 and turn < 0.002, (link, distance, turn)
    assert report["status"]["CONTACT_UNRELIABLE"] == 0
