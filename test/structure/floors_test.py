"""The floors of a room: its sub-folders, of which the lower ones know nothing of the upper ones; small folders, files with names of their own."""
import collections
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]
MOST_FILES = 25

# Floors of each room, the lowest first; files of the room's own folder stand above all of them.
FLOORS = {
    "geometry": [],
    "model": ["checks"],
    "contact": ["features", "kernels", "neighbourhood", "kept", "evaluation", "merging", "search"],
    "reduction": ["lanes", "patches", "choice"],
    "dynamics": ["lanes", "scene", "trees", "island", "ode"],
    "sim": ["numbers", "config", "commands", "build", "contacts", "guard", "sensors", "state"],
    "ros": ["messages", "sending", "loop", "publishers", "services"],
}
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.MULTILINE)


def height(room, path):
    """Floor of a file, counted from the lowest. @param path in the room's folder"""
    return len(FLOORS[room]) if len(path.parts) == 1 else FLOORS[room].index(path.parts[0])


def wrong_include(room, path, include):
    """Why a file of a room may not include this header, or None."""
    if include.startswith("blem_sim/"):
        return None
    if not (ROOT / "src" / room / include).exists():
        return "there is no src/%s/%s: name headers from the room's folder on" % (room, include)
    return None if height(room, path) >= height(room, pathlib.Path(include)) else "the floor is above"


def sources(room):
    folder = ROOT / "src" / room
    return [path.relative_to(folder) for path in sorted(folder.rglob("*")) if path.suffix in (".h", ".cpp")]


def test_includes_point_down_inside_rooms():
    wrong = []
    for room in FLOORS:
        for path in sources(room):
            for include in INCLUDE.findall((ROOT / "src" / room / path).read_text()):
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


def test_every_floor_is_there():
    for room, floors in FLOORS.items():
        folders = sorted({path.parts[0] for path in sources(room) if len(path.parts) > 1})
        assert folders == sorted(floors), room


def test_folders_are_small():
    tracked = [ROOT / top for top in ("src", "include", "test", "benchmark", "scripts", "docs", "msg", "srv")]
    for top in tracked:
        for folder in [top] + [path for path in top.rglob("*") if path.is_dir() and path.name != "__pycache__"]:
            files = [path.name for path in folder.iterdir() if path.is_file()]
            assert len(files) <= MOST_FILES, "%s has %d files" % (folder.relative_to(ROOT), len(files))


def test_no_two_headers_or_sources_share_a_name():
    """A header and its source do, in one folder or include/ and src/."""
    named = collections.defaultdict(list)
    for top in ("include", "src"):
        for path in sorted((ROOT / top).rglob("*")):
            if path.suffix in (".h", ".cpp"):
                named[path.name].append(str(path.relative_to(ROOT)))
    assert not [paths for paths in named.values() if len(paths) > 1]
