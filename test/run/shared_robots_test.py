"""Real robots stand and hold on real ground until they have settled (scripts/validate_robots runs the same for longer). Skipped without the
shared data."""
import os
import pathlib
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "test" / "support"))
from shared_data import shared_data  # noqa: E402

pytestmark = [
    pytest.mark.skipif(shared_data("robots") is None, reason="shared data not found (set BLEM_SIM_SHARED_DATA to its folder)"),
    pytest.mark.skipif("BLEM_SIM_RUN" not in os.environ, reason="BLEM_SIM_RUN does not name a built blem_sim_run; run by scripts/test"),
]


SECONDS = {"hubo_plane": 4, "hubo_fractal_1": 6, "paper_hubo_stepladder_150k": 4, "hubo_point_cloud": 6, "atlas": 10, "panda": 2, "ur5": 2, "anymal": 2}


def validate(case, seconds, *options):
    command = [str(ROOT / "scripts" / "validate_robots"), case, "--duration", str(seconds)] + list(options)
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True, timeout=600)
    assert done.returncode == 0, done.stdout


@pytest.mark.parametrize("case", sorted(SECONDS))
def test_stands_or_holds(case):
    validate(case, SECONDS[case])


@pytest.mark.parametrize("robot", ["anymal", "atlas", "huboplus", "panda", "pr2gripper", "robotiq", "tx90l", "tx90pr2", "ur5"])
def test_holds_without_gains(robot):
    validate("bare_" + robot, 10)


def test_hubo_stands_with_world_step():
    validate("hubo_plane", 1, "--stepper", "world_step", "--max-contacts", "6")


def test_hubo_follows_the_sway():
    validate("hubo_sway", 7)
