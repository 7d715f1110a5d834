"""Motions that scripts/plan_motion plans: within their limits, and in the simulator the robot does not fall and ends where it was planned to."""
import math
import xml.etree.ElementTree as ElementTree

import pytest
from motion_case import CLIMBS, LEANS, MOTIONS, ROOT, SQUAT, STEPS, WORLD, MotionCase, changed, off

NEAR, LITTLE = 0.003, 0.006  # [m], [rad] from the plan at the end
PLANS = {"steps": (WORLD, STEPS), "squat": (WORLD, SQUAT), "climbs": (MOTIONS / "humanoid_at_steps.yaml", CLIMBS)}


@pytest.fixture(scope="module")
def planned(tmp_path_factory):
    """{name: (case, report)} of the repository's motions, each planned once."""
    cases = {name: MotionCase(tmp_path_factory.mktemp(name)) for name in PLANS}
    return {name: (case, case.plan(PLANS[name][0], changed(PLANS[name][1], rate=25))) for name, case in cases.items()}


def limits():
    robot = ElementTree.parse(str(ROOT / "urdf" / "blem_humanoid.urdf")).getroot()
    return {joint.get("name"): {key: float(joint.find("limit").get(key)) for key in ("lower", "upper", "velocity")}
            for joint in robot.findall("joint") if joint.get("type") == "revolute"}


def ends_as_planned(case, plan, world):
    """Plays the trajectory and compares the robot's links at the end."""
    report = case.play(world, plan["duration_s"] + 1.0)
    end = plan["phases"][-1]["end"]
    for bit in ("CONTACT_UNRELIABLE", "SOLVER_TROUBLE"):
        assert report["status"][bit] == 0, (bit, report["status"])
    for link, pose in [("pelvis", end["root"])] + [(name + "_foot", pose) for name, pose in end["links"].items()]:
        distance, turn = off(report["bodies"]["humanoid::" + link], pose)
        assert distance < NEAR and turn < LITTLE, (link, distance, turn)


@pytest.mark.parametrize("name, phases", [("steps", 10), ("squat", 5), ("climbs", 10)])
def test_humanoid_does_it(planned, name, phases):
    case, plan = planned[name]
    assert len(plan["phases"]) == phases
    for phase in plan["phases"]:
        assert phase["margin_m"] >= 0.02 and phase["residual"]["m"] < 1e-4 and phase["residual"]["rad"] < 1e-4, phase
        assert phase["speed"]["share"] <= 0.5 and phase["effort"]["share"] < 1, phase
    ends_as_planned(case, plan, PLANS[name][0])


def test_feet_go_where_they_are_told(planned):
    _, plan = planned["steps"]
    start, end = plan["start"]["links"], plan["phases"][-1]["end"]["links"]
    forward = [end[name]["xyz"][0] - start[name]["xyz"][0] for name in ("left", "right")]
    assert forward[1] == pytest.approx(0.24, abs=1e-6)
    # Turned by 0.15 rad about its sole's middle, 3 cm before the ankle.
    assert forward[0] == pytest.approx(0.24 + 0.03 * (1 - 0.98877), abs=1e-4)
    assert end["left"]["xyz"][2] == pytest.approx(start["left"]["xyz"][2], abs=1e-6)
    _, climbs = planned["climbs"]
    for name in ("left", "right"):
        went = [b - a for a, b in zip(climbs["start"]["links"][name]["xyz"], climbs["phases"][-1]["end"]["links"][name]["xyz"])]
        assert went == pytest.approx([0.5, 0.0, 0.16], abs=1e-6)
    _, squat = planned["squat"]
    assert squat["phases"][1]["end"]["root"]["xyz"][2] == pytest.approx(squat["start"]["root"]["xyz"][2] - 0.2, abs=1e-3)


def test_the_trajectory_keeps_positions_and_speeds_within_limits(case):
    plan = case.plan(WORLD, changed(SQUAT, speed=0.1))
    assert plan["duration_s"] > 8.2, "phases of 8 s become longer at a tenth of the joints' speed"
    names, rows = case.rows()
    assert names[0] == "time" and len(rows) == round(plan["duration_s"] * 50) + 1
    for joint, limit in limits().items():
        positions, rates = [[row[names.index(name)] for row in rows] for name in (joint, joint + "_vel")]
        assert limit["lower"] <= min(positions) and max(positions) <= limit["upper"]
        assert max(map(abs, rates)) <= 0.1001 * limit["velocity"]
        for before, after, rate in zip(positions, positions[2:], rates[1:]):
            assert abs((after - before) * 25 - rate) < 1e-6
        assert rates[0] == rates[-1] == 0


def test_hands_on_a_wall_hold_what_feet_alone_do_not(case):
    """The centre of mass stays beyond the toes, where feet alone cannot hold it."""
    plan = case.plan(MOTIONS / "humanoid_at_wall.yaml", changed(LEANS, rate=25))
    alone, leaning = plan["phases"][0], plan["phases"][2]
    toes = max(x for x, _ in alone["support"])
    assert leaning["end"]["com"][0] > toes + 0.015 and leaning["margin_m"] > LEANS["margin"]
    until = sum(phase["duration_s"] for phase in plan["phases"][:3])
    at_wall = case.play(MOTIONS / "humanoid_at_wall.yaml", until)
    distance, turn = off(at_wall["bodies"]["humanoid::pelvis"], leaning["end"]["root"])
    assert distance < 0.005 and turn < 0.01
    without = case.play(WORLD, until)
    assert off(without["bodies"]["humanoid::pelvis"], leaning["end"]["root"])[1] > 0.5, "it falls where there is no wall"


@pytest.mark.parametrize("radius", [0.0, 0.03])
def test_a_foot_turns_about_its_toes(case, radius):
    """Where the rear leg is too short for a flat foot the heel rises; the toes' ends stay, or roll where they are round."""
    toes = {"link": "left_foot", "points": [[0.14, -0.055, radius - 0.06], [0.14, 0.055, radius - 0.06]], "facing": [0, 0, 1], "keeps": "edge",
            "radius": radius}
    phases = [STEPS["phases"][0], {"name": "far", "duration": 2, "move": {"right": {"by": [0.25, 0, 0], "lift": 0.04}}},
              {"name": "heel up", "duration": 3, "release": ["left"], "com": {"over": ["right"]}, "body": {"rise": 0.03}}]
    feet = {name: {"xyz": [0.5, y, 0.0025], "rpy": [0, 0, 0]} for name, y in (("left", 0.12), ("right", -0.12))}
    plan = case.plan(WORLD, changed(STEPS, rate=25, contacts=dict(STEPS["contacts"], left_toes=toes), holding=["left", "left_toes", "right"], phases=phases,
                                    start={"contacts": feet, "com": {"over": ["left", "right"]}, "height": 0.57, "rpy": [0, 0, 0]}))
    flat, turned = plan["start"]["links"]["left_toes"], plan["phases"][-1]["end"]["links"]["left_toes"]
    angle = 2 * math.asin(math.hypot(*turned["quat_xyzw"][:3]))
    assert angle > 0.2, "the heel rises"
    for point in toes["points"]:
        went = [b - a for a, b in zip(in_world(flat, point), in_world(turned, point))]
        assert went == pytest.approx([radius * angle, 0.0, 0.0], abs=3e-4)


def test_a_free_centre_of_mass_goes_with_the_body(case):
    """Both feet and an orientation leave it no other place than where the pelvis carries it."""
    bow = {"name": "bow", "duration": 2, "com": "free", "body": {"rpy": [0, 0.05, 0]}}
    plan = case.plan(WORLD, changed(STEPS, rate=25, phases=[STEPS["phases"][0], bow]))
    before, after = [phase["end"] for phase in plan["phases"]]
    pitch = 2 * math.asin(after["root"]["quat_xyzw"][1])
    assert pitch == pytest.approx(0.05, abs=2e-3) and after["com"][0] > before["com"][0] + 0.003
    assert plan["phases"][1]["margin_m"] >= STEPS["margin"]


def in_world(pose, point):
    """A point of a link's frame in the world, by the quaternion of its pose."""
    *v, w = pose["quat_xyzw"]
    t = [2 * x for x in crossed(v, point)]
    return [p + q + w * a + b for p, q, a, b in zip(pose["xyz"], point, t, crossed(v, t))]


def crossed(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def test_a_start_is_found_and_written(case):
    start = {"contacts": {"left": {"xyz": [0.5, 0.12, 0.0025], "rpy": [0, 0, 0]}, "right": {"xyz": [0.5, -0.12, 0.0025], "rpy": [0, 0, 0]}},
             "com": {"over": ["left", "right"]}, "height": 0.57, "rpy": [0, 0, 0], "joints": {"left_elbow": -1.0}}
    plan = case.plan(WORLD, changed(SQUAT, start=start, phases=[{"duration": 1}]), "--config-out", case.folder / "started.yaml")
    at = plan["start"]
    assert at["root"]["xyz"][2] == pytest.approx(0.57, abs=1e-3) and at["com"][0] == pytest.approx(0.5, abs=1e-4)
    report = case.play(case.folder / "started.yaml", 1.0)
    for link, pose in (("pelvis", at["root"]), ("left_foot", at["links"]["left"])):
        distance, turn = off(report["bodies"]["humanoid::" + link], pose)
        assert distance < NEAR and turn < LITTLE, link
    assert report["joints"]["humanoid::left_elbow"]["position"] == pytest.approx(-1.0, abs=2e-3)


def test_the_same_plan_has_the_same_bytes(case):
    motion = changed(STEPS, phases=STEPS["phases"][:2])
    case.plan(WORLD, motion)
    first = (case.folder / "motion.csv").read_bytes()
    case.plan(WORLD, motion)
    assert (case.folder / "motion.csv").read_bytes() == first
