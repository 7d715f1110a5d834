"""Motions that cannot be: one line that names phase, link and cure; nothing is written."""
import pytest
import yaml
from motion_case import ROOT, SQUAT, STEPS, WORLD, changed

NAN = float("nan")
CROUCH = STEPS["phases"][0]


def with_phases(*phases):
    return changed(STEPS, phases=list(phases))


def with_contact(**keys):
    contacts = dict(STEPS["contacts"], left=dict(STEPS["contacts"]["left"], **keys))
    return changed(STEPS, contacts=contacts)


IMPOSSIBLE = {
    "far": (with_phases({"name": "leap", "duration": 1, "move": {"right": {"by": [0.9, 0, 0], "lift": 0.04}}}), ["leap", "right_foot", "out of reach"]),
    "wide": (with_phases({"name": "beside", "duration": 1, "com": {"by": [0, 0.3]}}), ["beside", "outside of the support of left, right", "margin is 20 mm"]),
    "deep": (with_phases({"name": "sink", "duration": 2, "body": {"rise": -0.5}}), ["sink", "at their limits"]),
    "tall": (with_phases({"name": "grow", "duration": 2, "body": {"rise": 0.3}}), ["grow", "pelvis"]),
    "narrow": (changed(STEPS, margin=0.08), ["right forward", "support of left leaves 55.0 mm"]),
    "weak": (changed(SQUAT, effort=0.1), ["arms forward", "of its effort limit at rest"]),
    "falls": (with_phases(CROUCH, {"name": "bow", "duration": 2, "com": "free", "body": {"rpy": [0, 0.15, 0]}}), ["bow", "com: free: the centre of mass comes", "left, right"]),
    "in the air": (with_phases({"name": "fly", "duration": 1, "move": {"left": {"by": [0, 0, 0.1]}, "right": {"by": [0, 0, 0.1]}}}), ["fly", "nothing"]),
    "unbalanced": (changed(STEPS, start={"com": {"xy": [0.2, 0.0]}}), ["the start", "outside of the support"]),
}


@pytest.mark.parametrize("name", sorted(IMPOSSIBLE))
def test_what_is_impossible_is_refused(case, name):
    motion, words = IMPOSSIBLE[name]
    line = case.refusal(WORLD, motion)
    assert "motion.yaml: " in line and all(word in line for word in words), line


BAD = {
    "unknown key": (changed(STEPS, marign=0.1), "unknown key 'marign'; the nearest known one is 'margin'"),
    "no phases": (changed(STEPS, phases=[]), "phases: has 0 items"),
    "phases missing": (changed(STEPS, phases=None), "'phases' is missing"),
    "unknown link": (with_contact(link="left_fot"), "contacts.left.link: unknown value 'left_fot'; the nearest known one is 'left_foot'"),
    "point": (with_contact(points=[[0, 0]]), "contacts.left.points[0]: has 2 items"),
    "edge": (with_contact(keeps="edge", points=[[0.1, 0, 0], [0.1, 0, 0]]), "contacts.left.points: has no edge, its first and last point are 0 mm apart"),
    "nan": (with_contact(points=[[0, 0, NAN]]), "contacts.left.points[0][2]"),
    "normal": (with_contact(normal=[0, 0, 0]), "contacts.left.normal"),
    "joint": (with_phases(dict(CROUCH, joints={"left_kne": 0.1})), "unknown value 'left_kne'; the nearest known one is 'left_knee'"),
    "beyond": (with_phases(dict(CROUCH, joints={"left_knee": 9.0})), "phases[0].joints.left_knee: 9 is outside the joint's limits -0.05 to 2.3"),
    "moved unknown": (with_phases(dict(CROUCH, move={"lef": {}})), "phases[0].move: unknown key 'lef'"),
    "both": (with_phases(dict(CROUCH, move={"left": {"to": [0, 0, 0], "by": [0, 0, 0]}})), "'to' and 'by' exclude each other"),
    "duration": (with_phases(dict(CROUCH, duration=-1)), "phases[0].duration: '-1' is less than 0.001"),
    "holding": (changed(STEPS, holding=["left", "left"]), "holding: 'left' is there twice"),
    "com": (with_phases(dict(CROUCH, com={"over": ["left"], "xy": [0, 0]})), "phases[0].com: has 2 keys"),
    "com in a word": (with_phases(dict(CROUCH, com="fre")), "phases[0].com: "),
    "round": (with_contact(radius=0.05), "contacts.left.radius: goes with 'facing'"),
    "kind": (changed(STEPS, holding=[["left"]]), "holding[0]: unknown value"),
    "list": ("[1, 2]\n", "is no map"),
    "yaml": ("a: [\n", "not YAML"),
    "robot": (changed(STEPS, robot="humanoi"), "robots: there is no 'humanoi'; the nearest known one is 'humanoid'"),
}


@pytest.mark.parametrize("name", sorted(BAD))
def test_bad_motions_are_refused(case, name):
    motion, words = BAD[name]
    line = case.refusal(WORLD, motion)
    assert words in line, line


def test_the_program_ends_with_2(case):
    done = case.call(WORLD, case.write("motion.yaml", BAD["list"][0]))
    assert done.returncode == 2 and done.stdout == "" and len(done.stderr.splitlines()) == 1


def test_bad_robots_are_refused(case):
    world = yaml.safe_load(WORLD.read_text())
    assert "robots" in case.refusal(case.write("empty.yaml", {"time_step": 0.001}), STEPS)
    assert "gravity along -z" in case.refusal(case.write("tilted.yaml", dict(world, gravity=[1, 0, -9])), STEPS)
    assert "cannot be read" in case.refusal(case.folder / "nowhere.yaml", STEPS)
    assert "is no file" in case.refusal(case.write("lost.yaml", dict(world, robots=[dict(world["robots"][0], urdf="package://nowhere/a.urdf")])), STEPS)
    assert "check_urdf" in case.refusal(case.write("bad.urdf", "<robot><joint name='a' type='fixed'/></robot>"), STEPS)
    floating = '<robot name="a"><link name="a"/><link name="b"/><joint name="j" type="floating"><parent link="a"/><child link="b"/></joint></robot>'
    assert "'j' is of type 'floating'" in case.refusal(case.write("floating.urdf", floating), STEPS)
    far = dict(world, robots=[dict(world["robots"][0], pose={"xyz": [1e308, 0, 0]})])
    assert "robots[0].pose.xyz" in case.refusal(case.write("far.yaml", far), STEPS)
    weightless = '<robot name="a"><link name="left_foot"/></robot>'
    assert "weighs nothing" in case.refusal(case.write("weightless.urdf", weightless), STEPS)
    assert "leave it out" in case.refusal(ROOT / "urdf" / "blem_humanoid.urdf", STEPS, "--config-out", "a.yaml")
    assert "--package" in case.refusal(WORLD, STEPS, "--package", "nothing")
