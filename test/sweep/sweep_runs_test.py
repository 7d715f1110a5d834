"""blem_sim_sweep runs what it is told, once, resumes, and tells what failed."""
import math
import os
import pathlib
import shutil
import signal
import sqlite3
import subprocess
import time

import pytest

from sweep_case import EXAMPLE, PROGRAM, ROOT, column, wait_until

ANGLE, GRAVITY, TIME, STEP = math.radians(20), 9.81, 0.5, 0.001
SLOPE = 0.5  # friction
RULES = {"min": min, "harmonic_mean": lambda a, b: 2 * a * b / (a + b), "mean": lambda a, b: (a + b) / 2, "product": lambda a, b: a * b}


def test_the_example_slides_as_theory_says(case):
    """As far as steps of constant acceleration reach while the pair's friction is below tan(20 deg); else not at all."""
    shutil.copytree(str(EXAMPLE.parent), str(case.folder / "sweeps"))
    example = EXAMPLE.read_text().replace("../..", str(ROOT)).replace("cube_on", "sweeps/cube_on").replace("steps: 11", "steps: 6")
    case.write("sweep.yaml", example[:example.index("plots:")])
    rows = case.run()
    assert len(rows) == 24
    for row in rows:
        friction = RULES[row["contact.friction_rule"]](float(row["objects.0.friction"]), SLOPE)
        pull = GRAVITY * (math.sin(ANGLE) - friction * math.cos(ANGLE))
        assert float(row["position"]) == pytest.approx(-max(pull, 0) * TIME * (TIME + STEP) / 2, abs=2e-6), row
    slid = {(row["contact.friction_rule"], row["objects.0.friction"]) for row in rows if float(row["position"]) < -1e-3}
    assert slid == {(rule, text) for rule, law in RULES.items() for text in ("0", "0.2", "0.4", "0.6", "0.8", "1")
                    if law(float(text), SLOPE) < math.tan(ANGLE)}


def test_grid_with_seeds(case):
    case.write_sweep(parameters={"contact.friction": [0.1, 0.2], "solver.stepper": ["articulated", "world_step"]}, seeds=[3, 5], duration=0.01)
    rows = case.run()
    assert [(row["run"], row["contact.friction"], row["solver.stepper"], row["seed"]) for row in rows] == [
        (str(k + 1), friction, stepper, seed) for k, (friction, stepper, seed) in enumerate(
            (friction, stepper, seed) for friction in ("0.1", "0.2") for stepper in ("articulated", "world_step") for seed in ("3", "5"))]
    assert set(column(rows, "status")) == {"done"} and len(set(column(rows, "hash"))) > 2
    assert case.query("SELECT count(*) FROM parameters") == [(16,)]


@pytest.mark.parametrize("design", ["random", "latin"])
def test_samples_are_run_and_come_again(case, design):
    keys = dict(design=design, samples=4, parameters={"contact.friction": {"uniform": [0.1, 0.5]}}, duration=0.01)
    case.write_sweep(**keys)
    first = case.run()
    assert len({float(value) for value in column(first, "contact.friction")}) == 4
    case.watch()
    assert case.run() == first and case.starts() == []
    case.write_sweep(design_seed=2, **keys)
    assert not set(column(case.run(), "contact.friction")) & set(column(first, "contact.friction"))


def test_the_same_table_however_many_at_once(case):
    case.write_sweep(seeds=3)
    one = case.run("--on", "local:1")
    shutil.rmtree(str(case.out))
    assert case.run("--on", "local:2") == one
    assert all(float(row["position"]) < 0 for row in one)


@pytest.mark.parametrize("count", [1, 2])
def test_so_many_at_once(case, count):
    case.write_sweep(parameters={"contact.friction": [0.1, 0.2, 0.3, 0.4]})
    case.watch("echo 1 >>%s; sleep 0.15; echo -1 >>%s" % (case.folder / "turns", case.folder / "turns"))
    case.run("--on", "local:%d" % count)
    turns = [int(word) for word in (case.folder / "turns").read_text().split()]
    assert max(sum(turns[:k]) for k in range(len(turns))) == count


def test_what_ended_unrecorded_is_not_run_again(case):
    """As a sweep leaves it that is killed between a run's end and its record."""
    case.write_sweep()
    expected = case.run()
    with sqlite3.connect(str(case.out / "runs.sqlite")) as base:
        base.execute("UPDATE runs SET status = 'running', wall_s = NULL")
    case.watch()
    assert case.run() == expected and case.starts() == []


def test_runs_end_with_a_killed_sweep(case):
    case.write_sweep()
    case.watch("echo $$ >pid; sleep 30")
    killed = subprocess.Popen(case.command("--on", "local:1"), env=case.environment)
    wait_until(lambda: "".join(path.read_text() for path in case.out.glob("runs/*/pid")).endswith("\n"))
    process = next(case.out.glob("runs/*/pid")).read_text().strip()
    assert lives(process)
    killed.kill()
    killed.wait()
    wait_until(lambda: not lives(process), 10)


def lives(process):
    """Whether a process goes on; what has ended may wait for its parent to hear of it."""
    try:
        return "\nState:\tZ" not in (pathlib.Path("/proc") / process / "status").read_text()
    except OSError:
        return False


def test_resumes_after_it_was_killed(case):
    case.write_sweep(parameters={"contact.friction": {"from": 0.1, "to": 0.3, "steps": 12}})
    expected = case.run()
    shutil.rmtree(str(case.out))
    case.watch("sleep 0.1")
    killed = subprocess.Popen(case.command("--on", "local:2"), env=case.environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    wait_until(lambda: len(list(case.out.glob("runs/*/outcome.json"))) >= 4)
    killed.kill()
    killed.wait()
    time.sleep(0.3)  # the runs that went on ended with it
    finished = {path.parent.name for path in case.out.glob("runs/*/outcome.json")}
    assert 4 <= len(finished) < 12 and not (case.out / "results.csv").exists()
    assert case.run() == expected
    starts = case.starts()
    assert all(starts.count(key) == 1 for key in finished)
    assert len(set(starts)) == 12 and len(starts) <= 14


def test_an_interrupt_ends_the_runs_and_tells_how_to_go_on(case):
    case.write_sweep()
    case.watch("[ -e %s ] || sleep 30" % (case.folder / "fast"))
    stopped = subprocess.Popen(case.command("--on", "local:1"), env=case.environment, stderr=subprocess.PIPE, universal_newlines=True)
    wait_until(case.starts)
    stopped.send_signal(signal.SIGINT)
    _, said = stopped.communicate(timeout=20)
    assert stopped.returncode == 1 and said == "blem_sim_sweep: stopped; the same command goes on from here\n"
    assert column(case.rows(), "status") == ["waiting"] * 3
    case.write("fast", "")
    assert column(case.run(), "status") == ["done"] * 3


def test_what_fails_its_requirement(case):
    case.write_sweep(require={"position": {"min": -0.003}})
    done = case.call()
    assert done.returncode == 1
    assert "3 runs: 3 done; 1 of them did not keep" in done.stdout and "asked at least -0.003" in done.stdout
    assert column(case.rows(), "passed") == ["false", "true", "true"]
    case.watch()
    case.write_sweep(require={"position": {"min": -0.1}})
    assert column(case.run(), "passed") == ["true"] * 3 and case.starts() == [], "judged anew without a run"


def test_a_refused_run_stops_no_other(case):
    case.write_sweep(parameters={"contact.friction": [-1, 0.2]})
    done = case.call()
    assert done.returncode == 1 and "refused: blem_sim_run: " in done.stdout and "friction" in done.stdout
    assert column(case.rows(), "status") == ["refused", "done"]
    assert case.query("SELECT exit_status FROM runs WHERE status = 'refused'") == [(2,)]
    case.write_sweep(parameters={"contact.friction": [-1, 0.2, 0.25]})
    assert column(case.run("--stop-on-failure", status=1), "status") == ["refused", "done", "waiting"]


def test_runs_that_take_too_long_or_die(case):
    case.write_sweep(parameters={"contact.friction": [0.1, 0.2, 0.3]})
    case.watch("case \"$*\" in *friction=0.1*) sleep 30;; *friction=0.2*) kill -9 $$;; esac")
    assert column(case.run("--timeout", 0.4, "--retry", 1, status=1), "status") == ["timed out", "died", "done"]
    assert sorted(case.starts().count(key) for key in set(case.starts())) == [1, 2, 2]
    case.run("--timeout", 0.4, status=1)
    assert len(case.starts()) == 5, "nothing is run twice unless it is asked for"
    case.watch()
    assert column(case.run("--retry", 1), "status") == ["done"] * 3


def test_what_has_changed_is_run_again(case):
    mesh = (ROOT / "meshes" / "cube_10cm.stl").read_bytes()
    (case.folder / "cube.stl").write_bytes(mesh)
    case.write("world.yaml", (case.folder / "world.yaml").read_text().replace("package://blem_sim/meshes/cube_10cm.stl", "cube.stl"))
    case.write_sweep()
    case.watch()
    first = case.run()
    case.write("world.yaml", (case.folder / "world.yaml").read_text().replace("mass: 1.0", "mass: 2.0"))
    second = case.run()
    assert len(case.starts()) == 6 and not set(column(first, "key")) & set(column(second, "key"))
    (case.folder / "cube.stl").write_bytes(mesh[:40] + b"other" + mesh[45:])  # in the header
    case.run()
    assert len(case.starts()) == 9
    (case.folder / "cube.stl").write_bytes(mesh)
    assert case.run() == second and len(case.starts()) == 9, "former results are kept"
    case.run("--again")
    assert len(case.starts()) == 12


def test_one_run_and_its_command(case):
    case.write_sweep()
    case.watch()
    listed = case.call("--dry-run")
    assert listed.returncode == 0 and listed.stdout.count("--report") == 3 and not case.out.exists()
    command = case.call("--dry-run", "--only", 2).stdout
    assert command in listed.stdout and "contact.friction=0.2" in command
    subprocess.run(command, shell=True, cwd=str(case.folder), check=True)
    assert (case.folder / "report.json").exists()
    assert column(case.run("--only", 2), "status") == ["waiting", "done", "waiting"]


def test_plots_show_something(case):
    image = pytest.importorskip("matplotlib.image", reason="python3-matplotlib is not installed")
    case.write_sweep(seeds=2, plots=[{"x": "contact.friction", "y": "position", "group": "seed"}, {"x": "seed", "y": "position", "file": "s.png"}])
    case.run()
    for name in ("position_over_contact.friction.png", "s.png"):
        assert (case.out / name).read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
        picture = image.imread(str(case.out / name))[:, :, :3]
        coloured = (picture.max(axis=2) - picture.min(axis=2) > 0.3).sum()
        assert picture.shape[0] > 300 and coloured > 100, "curves in colour"


def test_the_same_run_is_made_once(case):
    case.write_sweep(design="random", samples=3, parameters={"contact.friction": [0.2]})
    case.watch()
    assert column(case.run(), "status") == ["done"] * 3 and len(case.starts()) == 1


def test_installed_beside_the_program(case):
    """As cmake installs it: the program of its own folder is used, and no file is left there."""
    place = case.folder / "lib" / "blem_sim"
    shutil.copytree(str(PROGRAM.parent), str(place), ignore=shutil.ignore_patterns("__pycache__"))
    case.watch()
    shutil.copy(case.environment.pop("BLEM_SIM_RUN"), str(place / "blem_sim_run"))
    case.write_sweep()
    before = sorted(place.rglob("*"))
    done = subprocess.run([str(place / PROGRAM.name)] + case.command()[1:], env=case.environment, stdout=subprocess.DEVNULL)
    assert done.returncode == 0 and len(case.starts()) == 3 and sorted(place.rglob("*")) == before


def test_two_at_one_place(case):
    case.write_sweep()
    case.watch("sleep 30")
    first = subprocess.Popen(case.command(), env=case.environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        wait_until(case.starts)
        assert "another blem_sim_sweep is at work" in case.refusal()
    finally:
        os.kill(first.pid, signal.SIGTERM)
        first.wait(20)
