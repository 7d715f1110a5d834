"""Folders for temporary files end with who made them: mkdtemp's stay, TemporaryDirectory's do not."""
from source_files import ROOT

FOLDERS = ("benchmark", "scripts", "src", "test")


def python_files():
    for folder in FOLDERS:
        for path in sorted((ROOT / folder).rglob("*")):
            if path.is_file() and (path.suffix == ".py" or path.read_bytes()[:40].startswith(b"#!/usr/bin/python3")):
                yield path


def test_nothing_makes_folders_that_stay():
    made = [str(path.relative_to(ROOT)) for path in python_files() if "mkdtemp(" in path.read_text() and path.name != "temporary_folders_test.py"]
    assert not made, "tempfile.TemporaryDirectory, or temporary_folder of test/ros/sim_client.py"
