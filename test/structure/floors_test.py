"""The floors of a room: its sub-folders, of which the lower ones know nothing of the upper ones; small folders, files with names of their own."""
import collections
import pathlib

from source_files import INCLUDE_IN_QUOTES, ROOT, sources

MOST_FILES = 25

# Floors of each room, the lowest first; files of the room's own folder stand above all of them.
FLOORS = {
    "geometry": [],
    "model": ["checks"],
    "contact": ["features", "kernels", "neighbourhood", "kept", "evaluation", "merging", "search"],
    "reduction": ["lanes", "patches", "choice"],
    "dynamics": ["lanes", "scene", "trees", "problem", "newton", "island", "ode"],
    "sim": ["numbers", "config", "gazebo", "commands", "build", "clouds", "contacts", "guard", "sensors", "state", "inputs", "controllers"],
    "ros": ["messages", "sending", "loop", "clouds", "publishers", "services", "settings", "saving", "attachments", "controllers"],
}


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


def files_of(room):
    """Paths in the room's folder."""
    return [path.relative_to(ROOT / "src" / room) for path in sources("src/" + room)]


def test_includes_point_down_inside_rooms():
    wrong = []
    for room in FLOORS:
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


def test_every_floor_is_there():
    for room, floors in FLOORS.items():
        folders = sorted({path.parts[0] for path in files_of(room) if len(path.parts) > 1})
        assert folders == sorted(floors), room


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
