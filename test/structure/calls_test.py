"""A call that changes a simulation has one name where it is told, where it is played again, and in the test that does both."""
import re

from source_files import ROOT, sources

TOLD = re.compile(r'\btell\("(\w+)"')
PLAYED = re.compile(r'^    \{"(\w+)",', re.MULTILINE)
TESTS = ("test/sim/inputs/simulator_input_test.cpp", "test/sim/state/saved_scene.h")  # the second has the way in which scenes set out


def told_calls():
    return {name for path in sources("src/sim") for name in TOLD.findall(path.read_text())}


def test_calls_that_are_told_are_played_again():
    code = (ROOT / "src/sim/inputs/apply_input.cpp").read_text()
    assert set(PLAYED.findall(code.split(" CALLS = {")[1].split("\n};")[0])) == told_calls()


def test_calls_that_are_told_are_tested():
    """By themselves, or by a call for several."""
    code = "".join((ROOT / path).read_text() for path in TESTS)
    assert len(told_calls()) > 20
    assert not [name for name in sorted(told_calls()) if not re.search(r"(?:\.|->)%ss?\(" % name, code)]
