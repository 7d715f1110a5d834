"""Bad sweeps are refused at the door, in one line with file, field and cure; designs hold what they promise."""
import sqlite3
import subprocess
import sys

import pytest

from sweep_case import MEASURE, ROOT

sys.path.insert(0, str(ROOT / "scripts" / "sweep"))
from sweeping.checked_yaml import Field  # noqa: E402
from sweeping.designs import DESIGNS  # noqa: E402
from sweeping.figures import MissingFigure, figure_of  # noqa: E402
from sweeping.parameters import read_parameter  # noqa: E402

SAMPLED = {"design": "latin", "samples": 3}
BAD = [
    ({"duraton": 1}, ["unknown key 'duraton'", "'duration'"]),
    ({"config": None}, ["'config' is missing"]),
    ({"config": "none.yaml"}, ["config: 'none.yaml' is no file"]),
    ({"duration": "long"}, ["duration: 'long' is no finite number"]),
    ({"duration": -1}, ["duration: '-1' is less than 0"]),
    ({"duration": True}, ["duration"]),
    ({"trajectory": 3}, ["trajectory: '3' is no text"]),
    ({"packages": ["a"]}, ["packages", "no map"]),
    ({"packages": {"a": "nowhere"}}, ["packages.a: 'nowhere' is no folder"]),
    ({"parameters": [1]}, ["parameters", "no map"]),
    ({"parameters": {"contact.friction": []}}, ["parameters.contact.friction: an empty list"]),
    ({"parameters": {"contact..friction": 1}}, ["no path of a parameter"]),
    ({"parameters": {"a": None}}, ["parameters.a: 'null' is no value"]),
    ({"parameters": {"a": {"form": 1, "to": 2, "steps": 3}}}, ["parameters.a: unknown key 'form'", "'from'"]),
    ({"parameters": {"a": {"from": 1, "to": 2}}}, ["parameters.a: 'steps' is missing"]),
    ({"parameters": {"a": {"from": 1, "to": 2, "steps": 1}}}, ["parameters.a: one step"]),
    ({"parameters": {"a": {"from": 0, "to": 2, "steps": 3, "log": True}}}, ["log needs bounds above 0"]),
    ({"parameters": {"a": {"uniform": [0, 1]}}}, ["parameters.a: a distribution has no grid", "latin"]),
    (dict(SAMPLED, parameters={"a": {"uniform": [1, 0]}}), ["parameters.a: uniform: 1 is not below 0"]),
    (dict(SAMPLED, parameters={"a": {"uniform": [1]}}), ["parameters.a.uniform: has 1 items; write 2"]),
    (dict(SAMPLED, parameters={"a": {"normal": [1, 0]}}), ["deviation 0 is not above 0"]),
    (dict(SAMPLED, parameters={"a": {"normal": [1, 1], "log": True}}), ["'log' does not go with 'normal'"]),
    ({"design": ["latin"]}, ["design: unknown value"]),
    ({"design": "latn"}, ["design: unknown value 'latn'", "'latin'"]),
    ({"design": "random"}, ["'samples' is missing"]),
    ({"samples": 3}, ["samples: does not go with design: grid"]),
    ({"design": "latin", "samples": 0}, ["samples: '0' is no whole number"]),
    ({"seeds": 0}, ["seeds: '0'"]),
    ({"seeds": []}, ["seeds: an empty list"]),
    ({"seeds": [1.5]}, ["seeds[0]: '1.5'"]),
    ({"seeds": 2, "parameters": {"random_seed": [1]}}, ["random_seed, too"]),
    ({"seeds": 500000}, ["1500000 runs are more than 1000000"]),
    ({"measure": {"status": "steps"}}, ["'status' is the name of another column"]),
    ({"measure": {"a": "bodies..x"}}, ["measure: a: 'bodies..x' is no path"]),
    ({"require": {"positon": {"max": 1}}}, ["require: unknown key 'positon'", "'position'"]),
    ({"require": {"position": {}}}, ["require.position: has no bound"]),
    ({"require": {"position": {"min": 2, "max": 1}}}, ["min 2 is above max 1"]),
    ({"plots": [{"x": "contact.friction"}]}, ["plots[0]: 'y' is missing"]),
    ({"plots": [{"x": "friction", "y": "position"}]}, ["plots[0].x: unknown value 'friction'", "'contact.friction'"]),
    ({"plots": [{"x": "contact.friction", "y": "position", "file": "../a.png"}]}, ["plots[0].file", "NAME.png"]),
    ({"plots": [{"x": "contact.friction", "y": "position"}] * 2}, ["plots[1]", "file of another plot"]),
]


def test_bad_sweeps(case):
    for keys, words in BAD:
        if "plots" in keys:
            pytest.importorskip("matplotlib", reason="python3-matplotlib is not installed")
        case.write_sweep(**keys)
        line = case.refusal("--dry-run")
        for word in ["sweep.yaml: "] + words:
            assert word in line, (keys, line)


@pytest.mark.parametrize("text, words", [
    ("config: [\n", ["sweep.yaml:2", "YAML"]), ("- a\n", ["no map"]), ("config: a\nconfig: b\n", ["sweep.yaml:2", "there twice"]), ("", ["no map"]),
    ("config: \"\\ud800\"\n", ["sweep.yaml"]), ("config: \0\n", ["YAML"]), ("duration: 1e999\nconfig: world.yaml\n", ["duration"]),
    ("config: world.yaml\nduration: 2001-02-30\n", ["YAML"]), ("[" * 5000, ["deep"]),
])
def test_files_that_are_no_sweeps(case, text, words):
    (case.folder / "sweep.yaml").write_bytes(text.encode("utf-8"))
    for word in words:
        assert word in case.refusal("--dry-run")


def test_command_line(case):
    case.write_sweep()
    for options, words in (
        (["--on", "cluster"], ["--on", "'cluster'"]), (["--on", "local:0"], ["local:0"]), (["--on", "dask:"], ["dask"]), (["--timeout", "nan"], ["--timeout"]),
        (["--retry", "-1"], ["--retry"]), (["--only", "9"], ["--only 9", "3 runs"]), (["--only", "0"], ["--only"]), (["--owt", "a"], ["--owt"]),
        (["--slurm-options", "-p x"], ["--slurm-options"]), (["--out", "/dev/null/a"], ["/dev/null/a"]), (["--out", ""], ["--out is empty"]),
        (["--keep-going", "--stop-on-failure"], ["not allowed"]),
    ):
        line = case.refusal(*options)
        assert all(word in line for word in words), line
    (case.folder / "sweep.yaml").unlink()
    assert "cannot be read" in case.refusal()


def test_results_that_cannot_be_used(case):
    case.write_sweep(measure=MEASURE)
    case.run()
    base = case.out / "runs.sqlite"
    base.write_bytes(b"no data base at all" * 100)
    assert "runs.sqlite: " in case.refusal() and "move it away" in case.refusal()
    base.unlink()
    case.run()
    with sqlite3.connect(str(base)) as changed:
        changed.execute("DROP TABLE figures")
        changed.execute("CREATE TABLE figures (other)")
    assert "runs.sqlite: no such column" in case.refusal()


def test_a_configuration_that_is_none(case):
    case.write_sweep()
    for text, words in (("- a\n", "no map"), ("a: [\n", "not YAML"), ("a: 1\na: 2\n", "there twice")):
        case.write("world.yaml", text)
        assert "world.yaml" in case.refusal() and words in case.refusal()


def test_texts_are_not_drawn(case):
    pytest.importorskip("matplotlib", reason="python3-matplotlib is not installed")
    case.write_sweep(duration=0.001, plots=[{"x": "contact.friction", "y": "hash"}])
    done = case.call()
    assert done.returncode == 2 and "sweep.yaml: plots: y: hash is '" in done.stderr and done.stderr.count("\n") == 1
    assert len(case.rows()) == 3, "the table is there"


def test_a_reader_that_leaves(case):
    case.write_sweep(parameters={"contact.friction": {"from": 0, "to": 1, "steps": 3000}})
    listed = subprocess.Popen(case.command("--dry-run"), env=case.environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    listed.stdout.readline()
    listed.stdout.close()
    assert listed.stderr.read() == b"" and listed.wait(60) == 1


def test_programs_that_are_none(case):
    case.write_sweep()
    for program, words in (("/nowhere", "'/nowhere' is no program"), ("/bin/false", "--version")):
        case.environment["BLEM_SIM_RUN"] = program
        assert words in case.refusal()


def test_figures_that_the_first_report_does_not_have(case):
    for path, words in (("bodies.cub::link.xyz.0", "'cube::link'"), ("bodies.cube::link.xyz.3", "list of 3"), ("bodies.cube::link.xyz", "name one item"),
                        ("steps.x", "nothing below 'steps'"), ("bodies", "is a map"), ("stauts.SOLVER_TROUBLE", "'status'")):
        case.write_sweep(measure=dict(MEASURE, wrong=path), duration=0.001)
        line = case.refusal()
        assert "sweep.yaml: measure.wrong: " + path in line and words in line, line


def test_names_with_dots_are_found():
    report = {"bodies": {"a.b::c": {"xyz": [1, 2]}, "a": {}}}
    assert figure_of(report, "bodies.a.b::c.xyz.1") == 2
    with pytest.raises(MissingFigure):
        figure_of(report, "bodies.a.c")


def parameter(value):
    return read_parameter(Field("sweep.yaml", "p", value))


def test_ranges():
    assert parameter({"from": 0, "to": 0.3, "steps": 4}).values == [0, 0.1, 0.2, 0.3]
    assert parameter({"from": 0.001, "to": 1, "steps": 4, "log": True}).values == [0.001, 0.01, 0.1, 1]
    assert parameter({"from": 4, "to": 2, "steps": 3}).values == [4, 3, 2]
    assert parameter("articulated").values == ["articulated"]


def test_latin_meets_every_part_once():
    parameters = {"a": parameter({"uniform": [0, 50]}), "b": parameter({"uniform": [1e-3, 1e2], "log": True}), "c": parameter([1, 2])}
    points = DESIGNS["latin"](parameters, 50, 7)
    assert sorted(int(point["a"]) for point in points) == list(range(50))
    assert sum(point["b"] < 10 ** -0.5 for point in points) == 25
    assert [point["c"] for point in points].count(1) == 25
    assert points == DESIGNS["latin"](parameters, 50, 7) != DESIGNS["latin"](parameters, 50, 8)


def test_random_samples_have_their_distribution():
    parameters = {"a": parameter({"normal": [3, 0.5]}), "b": parameter({"uniform": [2, 4]})}
    points = DESIGNS["random"](parameters, 4000, 1)
    mean = sum(point["a"] for point in points) / 4000
    assert abs(mean - 3) < 0.03 and abs(sum((point["a"] - mean) ** 2 for point in points) / 4000 - 0.25) < 0.02
    assert 2 <= min(point["b"] for point in points) < 2.01 and 3.99 < max(point["b"] for point in points) < 4
    assert abs(sum((point["a"] - 3) * (point["b"] - 3) for point in points) / 4000) < 0.02, "one parameter tells nothing of another"
    assert points[:100] == DESIGNS["random"](parameters, 100, 1), "more samples begin with the same ones"
    alone = DESIGNS["random"]({"b": parameters["b"]}, 100, 1)
    assert [point["b"] for point in alone] == [point["b"] for point in points[:100]], "another parameter moves no value"
