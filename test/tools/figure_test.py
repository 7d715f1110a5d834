"""scripts/figure: its door, a figure without data whole, and what it says where data are not here.

BLEM_SIM_RUN tells where the built programs are (scripts/test sets it).
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "test" / "support"), str(ROOT / "test" / "support" / "figures")]
pytest.importorskip("numpy", reason="figures need python3-numpy, which is not installed")
from figure_table import FIGURES  # noqa: E402
from method_scenes import WIDTH, comb, pairs_in_reach  # noqa: E402

WITHOUT_DATA = [1, 4, 5, 6, 7]


def figure(*words, **environment):
    return subprocess.run([str(ROOT / "scripts" / "figure"), *map(str, words)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          universal_newlines=True, timeout=300, env=dict(os.environ, **environment))


def reached(number, folder):
    """Numbers of a figure without data, run short: case by name."""
    if "BLEM_SIM_RUN" not in os.environ:
        pytest.skip("BLEM_SIM_RUN does not name a built blem_sim_run; run by scripts/test")
    done = figure(number, "--short", "--out", folder, BLEM_SIM_SHARED_DATA=str(folder / "none"))
    assert done.returncode == 0, done.stdout + done.stderr
    return {row["case"]: row for row in json.loads((folder / "numbers.json").read_text())["cases"]}, done.stdout


@pytest.mark.parametrize("word", ["0", "14", "one", "../1", "-1"])
def test_unknown_figure_is_one_line(word):
    done = figure(*([word] if word[0] != "-" else ["--", word]))
    assert (done.returncode, len(done.stderr.splitlines()), done.stdout) == (2, 1, ""), done.stderr
    assert word in done.stderr and "--list" in done.stderr


def test_list_names_every_figure_and_what_needs_data():
    lines = figure("--list").stdout.splitlines()
    assert [int(line.split()[0]) for line in lines] == list(range(1, 14))
    assert [int(line.split()[0]) for line in lines if line.endswith(" no data")] == WITHOUT_DATA


def test_missing_data_are_said(tmp_path):
    for number in sorted(set(FIGURES) - set(WITHOUT_DATA)):
        done = figure(number, "--out", tmp_path / "out", "--data", tmp_path)
        assert (done.returncode, len(done.stdout.splitlines())) == (0, 1), done.stdout + done.stderr
        assert "skipped" in done.stdout and "worlds/" in done.stdout
    assert not (tmp_path / "out").exists()


def test_stack_has_its_numbers_and_its_picture(tmp_path):
    cases, said = reached(1, tmp_path)
    assert set(cases) == {"three_cubes", "ten_cubes"} and all(row["ok"] for row in cases.values())
    for name, count in (("three_cubes", 3), ("ten_cubes", 10)):
        bodies = json.loads((tmp_path / "report.json").read_text())[name]["bodies"]
        for k in range(count):
            assert bodies["cube_%d::link" % (k + 1)]["xyz"] == pytest.approx([0, 0, 0.0525 + 0.105 * k], abs=1e-6)
    if "no picture" in said or not shutil.which("Xvfb"):
        pytest.skip("no pictures here: " + said.splitlines()[-1])
    images = pytest.importorskip("matplotlib.image", reason="pictures are read by python3-matplotlib, which is not installed")
    picture = images.imread(str(tmp_path / "picture.png"))[:, :, :3]
    red, green, blue = picture[:, :, 0], picture[:, :, 1], picture[:, :, 2]
    assert ((blue - red > 0.3).sum() > 1000) and ((red - blue > 0.3).sum() > 1000), "a blue and a yellow cube are in sight"
    assert not (abs(picture - picture[0, 0]) > 0.3).any(axis=2)[:, :100].any(), "nothing is cut at the left edge"
    assert green.shape == (480, 640)


def test_corner_and_combs_hold(tmp_path):
    for number in (4, 5, 6):
        (tmp_path / str(number)).mkdir()
        assert all(row["ok"] for row in reached(number, tmp_path / str(number))[0].values())


def test_brute_force_counts_what_is_in_reach():
    lower, upper = comb(2, 0.3, True), comb(3, 0.3, False) * (1, 1, -1)
    assert pairs_in_reach(lower, upper + (0, 0, 0.9 * WIDTH), WIDTH) == (24, 6)
    assert pairs_in_reach(lower, upper + (0, 0, 1.1 * WIDTH), WIDTH) == (0, 0)
