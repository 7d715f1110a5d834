"""Scripts refuse names that they do not know before they begin to run or to build."""
import pathlib
import subprocess

import pytest

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"


@pytest.mark.parametrize("command, known", [
    (["validate_scenes", "nothing"], "gripper"), (["validate_robots", "atlas", "nothing"], "hubo_plane"), (["validate_worlds", "nothing"], ""),
    (["fuzz", "1", "nothing"], "urdf"), (["fuzz", "soon"], "SECONDS"),
])
def test_unknown_names_are_refused_in_one_line(command, known):
    result = subprocess.run([str(SCRIPTS / command[0])] + command[1:], stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, timeout=60)
    if "skipped" in result.stdout or "missing" in result.stderr:
        pytest.skip(result.stdout + result.stderr)
    assert result.returncode == 2, result.stderr
    assert command[-1] in result.stderr and known in result.stderr and result.stderr.count("\n") == 1, result.stderr


def test_fuzz_tells_its_usage():
    result = subprocess.run([str(SCRIPTS / "fuzz"), "--help"], stdout=subprocess.PIPE, universal_newlines=True, timeout=20)
    assert result.returncode == 0 and "Usage: scripts/fuzz" in result.stdout
