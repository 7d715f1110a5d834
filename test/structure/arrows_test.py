"""The arrows between the rooms: who may include whom, and which library belongs to which room."""
import pathlib
import re

from source_files import INCLUDE, ROOT, sources

# A room may include its own headers and those of the rooms listed.
BELOW = {
    "geometry": [],
    "model": ["geometry"],
    "contact": ["geometry"],
    "reduction": ["contact", "geometry"],
    "dynamics": ["contact", "model", "geometry"],
    "sim": ["dynamics", "reduction", "contact", "model", "geometry"],
    "ros": ["sim", "dynamics", "reduction", "contact", "model", "geometry"],
    "python": ["sim", "dynamics", "reduction", "contact", "model", "geometry"],
}

# First component (or whole name) of a library's headers -> the rooms that may include them.
LIBRARIES = {
    "ode": ["dynamics"],
    "urdf_model": ["model"], "urdf_parser": ["model"], "urdf_world": ["model"], "urdf_exception": ["model"], "console_bridge": ["model"],
    "assimp": ["model"], "pcl": ["model"],
    "yaml-cpp": ["sim", "ros", "python"],
    "pybind11": ["python"],
    "ros": ["ros"], "tf2_ros": ["ros"], "tf2": ["ros"], "actionlib": ["ros"], "diagnostic_updater": ["ros"], "rosbag": ["ros"], "blem_sim_msgs": ["ros"],
    "XmlRpcValue.h": ["ros"], "xmlrpcpp": ["ros"],
}
ROS_MESSAGES = re.compile(r"^\w+_(msgs|srvs)$")


def files_of(room):
    return sources("include/blem_sim/" + room, "src/" + room)


def wrong_include(room, include):
    """Why this include is not allowed in this room, or None."""
    parts = include.split("/")
    if parts[0] == "blem_sim" and len(parts) == 3:
        return None if parts[1] == room or parts[1] in BELOW[room] else "room %s is not below %s" % (parts[1], room)
    if parts[0] == "blem_sim" or ROS_MESSAGES.match(parts[0]):
        return None if room == "ros" else "messages belong to the ros room"
    allowed = LIBRARIES.get(parts[0])
    return None if allowed is None or room in allowed else "%s belongs to %s" % (parts[0], ", ".join(allowed))


def test_every_room_has_sources():
    for room in BELOW:
        assert list(files_of(room)), "no sources found for room %s" % room


def test_includes_point_down():
    wrong = []
    for room in BELOW:
        for path in files_of(room):
            for include in INCLUDE.findall(path.read_text()):
                reason = wrong_include(room, include)
                if reason:
                    wrong.append("%s includes %s: %s" % (path.relative_to(ROOT), include, reason))
    assert not wrong, "\n".join(wrong)


def test_the_rule_sees_wrong_includes():
    assert wrong_include("geometry", "blem_sim/contact/collider.h")
    assert wrong_include("contact", "blem_sim/model/loaders.h")
    assert wrong_include("sim", "ode/ode.h")
    assert wrong_include("sim", "ros/ros.h")
    assert wrong_include("dynamics", "sensor_msgs/JointState.h")
    assert wrong_include("dynamics", "blem_sim/StepReport.h")
    assert wrong_include("sim", "pybind11/pybind11.h")
    assert wrong_include("python", "ros/ros.h")
    assert wrong_include("ros", "blem_sim/StepReport.h") is None
    assert wrong_include("sim", "blem_sim/dynamics/world.h") is None


def test_libraries_link_downwards():
    """blem_sim_room(NAME LIBS...) in cmake/rooms.cmake names only rooms below."""
    text = (ROOT / "cmake" / "rooms.cmake").read_text()
    calls = re.findall(r"^blem_sim_room\((\w+)([^)]*)\)", text, re.MULTILINE)
    assert {room for room, _ in calls} >= {"geometry", "model", "contact", "reduction", "dynamics", "sim"}
    for room, libraries in calls:
        for below in re.findall(r"blem_sim_(\w+)", libraries):
            assert below in BELOW[room], "%s links %s" % (room, below)


def test_project_speaks_of_no_machine():
    """No absolute path of a home or of a work folder in a text file."""
    path_of_a_machine = re.compile(r"(?:^|[\s\"'=(])/(?:home|root|work)/\w")
    wrong = []
    for path in sorted(ROOT.rglob("*")):
        if not path.is_file() or path.suffix not in (".h", ".cpp", ".py", ".md", ".yaml", ".launch", ".txt", ".cmake", ".test", ".rst", ".urdf", ".rviz", ""):
            continue
        relative = path.relative_to(ROOT)
        if relative.parts[0] in ("build", ".git") or relative.parts[0].startswith("build") or path == pathlib.Path(__file__):
            continue
        try:
            text = path.read_text()
        except UnicodeDecodeError:
            continue
        if path_of_a_machine.search(text):
            wrong.append(str(relative))
    assert not wrong, wrong
