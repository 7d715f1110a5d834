"""The floors of a room: its sub-folders, of which the lower ones know nothing of the upper ones; small folders, files with names of their own."""
import collections
import pathlib
import re

from source_files import INCLUDE_IN_QUOTES, ROOT, sources

MOST_FILES = 25

# Floors of each room, and of its larger floors, the lowest first; files of a folder itself stand above its floors.
FLOORS = {
    "geometry": ["threads"],
    "model": ["checks", "soup", "ply", "clouds"],
    "contact": ["features", "kernels", "neighbourhood", "kept", "evaluation", "merging", "search", "cylinders"],
    "reduction": ["lanes", "patches", "choice"],
    "dynamics": ["lanes", "scene", "trees", "free_way", "problem", "iterate", "newton", "sweeps", "island", "ode"],
    "sim": ["numbers", "threads", "config", "wheels", "gazebo", "commands", "build", "clouds", "contacts", "guard", "sensors", "state", "inputs", "controllers"],
    "ros": ["messages", "sending", "loop", "clouds", "publishers", "services", "settings", "saving", "attachments", "controllers"],
    "sim/contacts": ["motion", "search", "constraints"],
    "sim/sensors": ["readings", "types"],
    "ros/publishers": ["ranges", "markers", "reports"],
    "ros/services": ["door"],
}
ROOMS = [folder for folder in FLOORS if "/" not in folder]


def height(room, path):
    """Floor of a file, counted from the lowest, and the floor there, and so on. @param path in the room's folder"""
    folder, heights = room, []
    for part in path.parts[:-1]:
        if folder not in FLOORS:
            break
        heights.append(FLOORS[folder].index(part))
        folder += "/" + part
    return heights + [len(FLOORS.get(folder, []))]


def wrong_include(room, path, include):
    """Why a file of a room may not include this header, or None."""
    if include.startswith("blem_sim/"):
        return None
    if not (ROOT / "src" / room / include).exists():
        return "there is no src/%s/%s: name headers from the room's folder on" % (room, include)
    return None if height(room, path) >= height(room, pathlib.Path(include)) else "the floor is above"


def files_of(room):
    """Paths in the room's folder."""
    return [path.relative_to(ROOT / "src" / room) for path in sources("src/" + room)]


def floors_of_document(text):
    """Floors by room, as the table has them: a row each, rooms named in the first of theirs."""
    floors, room = collections.defaultdict(list), None
    for name, floor in re.findall(r"^\| (\w*) ?\| `(\w+)` \| .* \|$", text, re.MULTILINE):
        room = name or room
        floors[room].append(floor)
    return floors


def test_document_names_every_floor():
    """In the rooms' table, the lowest first."""
    floors = floors_of_document((ROOT / "docs/architecture.md").read_text())
    for room in ROOMS:
        assert floors[room] == FLOORS[room], room


def test_the_rule_reads_rows_without_a_room():
    assert floors_of_document("| room | floor | what |\n| one | `a` | x |\n| | `b` | y |\n| two | `a` | z |\n") == {"one": ["a", "b"], "two": ["a"]}


def test_includes_point_down_inside_rooms():
    wrong = []
    for room in ROOMS:
        for path in files_of(room):
            for include in INCLUDE_IN_QUOTES.findall((ROOT / "src" / room / path).read_text()):
                reason = wrong_include(room, path, include)
                if reason:
                    wrong.append("src/%s/%s includes %s: %s" % (room, path, include, reason))
    assert not wrong, "\n".join(wrong)


def test_the_rule_sees_wrong_includes():
    path = pathlib.Path("features/edge_pair.h")
    assert wrong_include("contact", path, "search/contact_search.h")
    assert wrong_include("contact", path, "tolerances.h")
    assert wrong_include("contact", path, "features/tolerances.h") is None
    assert wrong_include("contact", pathlib.Path("narrow_phase.cpp"), "search/contact_search.h") is None
    path = pathlib.Path("contacts/search/pair_watch.cpp")
    assert wrong_include("sim", path, "contacts/constraints/made_solve.h")
    assert wrong_include("sim", path, "sensors/readings/delay_line.h")
    assert wrong_include("sim", path, "contacts/motion/meeting_speed.h") is None
    assert wrong_include("sim", pathlib.Path("sensors/types/sensor.cpp"), "sensors/sensor_channel.h")
    assert wrong_include("sim", pathlib.Path("sensors/sensor_channel.h"), "sensors/types/sensor.h") is None


def test_every_floor_is_there():
    found = collections.defaultdict(set)
    for room in ROOMS:
        for path in files_of(room):
            for folder in list(path.parents)[:-1]:
                found[str((room / folder).parent)].add(folder.name)
    for folder, floors in FLOORS.items():
        assert sorted(found[folder]) == sorted(floors), folder


def test_folders_are_small():
    """All but msg and srv: ROS finds types in these two folders alone."""
    tracked = [ROOT / top for top in ("src", "include", "test", "benchmark", "scripts", "docs")]
    for top in tracked:
        for folder in [top] + [path for path in top.rglob("*") if path.is_dir() and path.name != "__pycache__"]:
            files = [path.name for path in folder.iterdir() if path.is_file()]
            assert len(files) <= MOST_FILES, "%s has %d files" % (folder.relative_to(ROOT), len(files))


def test_no_two_headers_or_sources_share_a_name():
    """A header and its source do, in one folder or include/ and src/."""
    named = collections.defaultdict(list)
    for path in sources("include", "src"):
        named[path.name].append(str(path.relative_to(ROOT)))
    assert not [paths for paths in named.values() if len(paths) > 1]
