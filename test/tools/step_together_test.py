"""Bad numbers are refused by step_together in one line, before it looks for a master."""
import pathlib
import subprocess
import sys

import pytest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "ros" / "step_together"
pytest.importorskip("rospy", reason="rospy is not installed")
pytest.importorskip("blem_sim.srv", reason="the services are not built, or not on this shell")


@pytest.mark.parametrize("option, value", [
    ("--steps", "0"), ("--steps", "some"), ("--steps", "4294967296"), ("--rate", "fast"), ("--rate", "nan"), ("--rate", "inf"), ("--patience", "0"),
    ("--patience", "nan"),
])
def test_bad_numbers_are_refused_in_one_line(option, value):
    command = [sys.executable, str(SCRIPT), "/nowhere", option, value]
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, timeout=20)
    assert result.returncode == 2, result.stderr
    assert "error: argument %s" % option in result.stderr and "'%s'" % value in result.stderr, result.stderr
