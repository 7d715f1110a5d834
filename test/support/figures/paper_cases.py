"""The robot scenes of the paper [Hauser 2013, Figs. 2, 3, 8 to 13], from the shared data: what is asked of each, and its run."""
import math
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "test" / "support"), str(ROOT / "test" / "support" / "figures"), str(ROOT / "scripts" / "support")]
import gripper_motions  # noqa: E402
import kinematics  # noqa: E402
from climbing import CLIMB_ASKED, climbs  # noqa: E402
from foot_forces import FootForces, pose_in  # noqa: E402
from scene_runs import read_motion, simulate, world  # noqa: E402
from shared_data import shared_data  # noqa: E402
from sitting import SIT_ASKED, sits  # noqa: E402
from trajectory_file import write_trajectory  # noqa: E402


def unreliable(report):
    """Share of the steps in which bare meshes crossed."""
    return report["status"]["CONTACT_UNRELIABLE"] / report["steps"]


def between(rows, start, end):
    return [row for row in rows if start <= float(row["time"]) <= end]


class HeldObject:
    """Where an object was in the hand, row by row."""

    def __init__(self, rows, name):
        self.tree, self.name = kinematics.Tree(shared_data(gripper_motions.URDF)), name
        self.rows = rows
        self.prefix = next(key for key in rows[0] if key.endswith(gripper_motions.FINGER))[: -len(gripper_motions.FINGER)]

    def hand(self, row):
        positions = {joint: float(row[self.prefix + joint]) for joint in gripper_motions.ARM + [gripper_motions.FINGER]}
        return self.tree.link_poses(positions)[gripper_motions.HAND]

    def in_hand(self, row):
        return kinematics.composed(kinematics.inverse(self.hand(row)), pose_in(row, self.name))

    def slip(self, start, end):
        """Largest displacement [m] and turn [rad] in the hand from where it was at the start, and largest path of the hand [m]."""
        first, *others = between(self.rows, start, end)
        r0, p0 = self.in_hand(first)
        hand0 = self.hand(first)[1]
        poses = [self.in_hand(row) for row in others]
        return (max(math.dist(p, p0) for _, p in poses), max(math.hypot(*kinematics.turn_between(r0, r)) for r, _ in poses),
                max(math.dist(self.hand(row)[1], hand0) for row in others))


def gripper(name, hand_height, closing_angle, reach_back=0.0, thing=None):
    """Fig. 3 or 11: close, lift 10 cm, shake, put back. hand_height: of the hand's origin above the resting object's when it grasps.

    thing: made in place of the world's object, in the folder of the case.
    """
    def case(folder, options):
        config = world(name)
        if thing:
            config["objects"] = [thing(folder)]
        held = config["objects"][0]
        rests = held["pose"]["xyz"][2] if thing else gripper_motions.RESTS[name]
        motion, rows = gripper_motions.grasp_scene(config, rests, hand_height, closing_angle, reach_back, 3.0 if options.short else 10.0)
        write_trajectory(folder / "motion.csv", rows)
        report, states = simulate(folder, config, motion.end, 200, ["--trajectory", str(folder / "motion.csv")])
        return report, grasp_figures(report, states, held["name"] + "::link", motion)
    return case


SLIP = {"mug_cloud::link": 1e-3}  # [m] allowed, where it is not 0.05 mm
MUG_CLOUD = "scans/real/stereomug_mug.ply"  # its z = 0 is the table, on which it stood; what is below 15 mm was cut


def mug_cloud(folder):
    """Points of a mug that a stereo camera saw from one side. It stands on the wall it showed, so its centre of mass is put above that."""
    return {"name": "mug_cloud", "uri": str(shared_data(MUG_CLOUD)), "cloud": {"as": "points", "point_radius": "auto"}, "mass": 0.2,
            "com": [-0.022, 0.013, 0.03], "inertia": [2.5e-4, 0, 0, 2.5e-4, 0, 2.5e-4], "friction": 0.5,
            "pose": {"xyz": [0.4, 0.1, 0.645 - 0.015 + 0.0005], "rpy": [0, 0, -0.5]}}


def grasp_figures(report, states, name, motion):
    held = HeldObject(states, name)
    slip, turn, path = held.slip(motion.shake_from, motion.shake_to)
    stood, grasped, lifted = [pose_in(between(states, t, motion.end)[0], name) for t in (motion.DOWN, motion.CLOSED, motion.LIFTED)]
    back = pose_in(states[-1], name)
    risen, off = lifted[1][2] - grasped[1][2], math.dist(back[1], grasped[1])
    text = ("centred by %.1f mm as pads close, lifted %.1f mm, shaken +-%.1f mm, slip %.4f mm, turn %.1e rad; put back %.2f mm, %.1e rad"
            " off; worst %.2f of layer") % (
        1e3 * math.dist(stood[1], grasped[1]), 1e3 * risen, 1e3 * path, 1e3 * slip, turn, 1e3 * off,
        math.hypot(*kinematics.turn_between(grasped[0], back[0])), report["max_penetration"]["of_layer"])
    return text, slip < SLIP.get(name, 5e-5) and risen > 0.095 and path > 0.045 and off < 2e-3 and not unreliable(report)


# [m] between the inner sides of the walls, in x and in y; height of the bottom
TRAY = ((0.31, 0.90), (-0.165, 0.425), gripper_motions.TRAY_BOTTOM)


def tray(folder, options):
    """Fig. 12."""
    config = world("paper_tray18")
    motion, rows = gripper_motions.stir_scene(config, 2.0 if options.short else 20.0)
    write_trajectory(folder / "motion.csv", rows)
    report, states = simulate(folder, config, motion.end, 50, ["--trajectory", str(folder / "motion.csv")])
    return report, tray_figures(report, states, [mug["name"] + "::link" for mug in config["objects"]], motion)


def tray_figures(report, states, mugs, motion):
    before, after = between(states, motion.DOWN, motion.end)[0], states[-1]
    ends = [pose_in(after, mug)[1] for mug in mugs]
    moved = sum(math.dist(pose_in(before, mug)[1], end) > 0.02 for mug, end in zip(mugs, ends))
    outside = sum(not all(low < x < high for x, (low, high) in zip(end, TRAY[:2])) or end[2] < TRAY[2] for end in ends)
    deepest = report["max_penetration"]
    text = "stirred %.1f s at %.2f m/s: %d of %d mugs moved over 2 cm, %d outside; bare meshes cross in %d steps, worst %.2f of layer (%s)"
    text %= (motion.stirred - motion.BEGUN, motion.SPEED, moved, len(mugs), outside, report["status"]["CONTACT_UNRELIABLE"],
             deepest["of_layer"], " on ".join(deepest["pair"]))
    return text, not outside and deepest["of_layer"] < 1 and not unreliable(report) and moved >= 3


HUBO = "jaemiHubo"
FEET = {"left": ("LF_ForceSensor", "Body_LAR"), "right": ("RF_ForceSensor", "Body_RAR")}
SOLES = {"left": (-0.0405, 0.005, -0.1054), "right": (-0.0405, -0.005, -0.1054)}  # [m] middle of each sole in its foot link
SWAY_STARTS, SWAY_HELD = 3.0, 2.0  # [s] the robot lands and settles; it stands still on one foot, and again at the end


def there_and_back(motion):
    """The motion, a pause, and the motion backwards."""
    length, ways = motion[-1][0], [(SWAY_STARTS + time, q) for time, q in motion]
    turn = SWAY_STARTS + length + SWAY_HELD
    return [(0.0, motion[0][1])] + ways + [(turn + length - time, q) for time, q in reversed(motion)]


def without_integral(config):
    """Robots whose servos are PD: with I they creep and hunt against the joints' dry friction for minutes."""
    for robot in config["robots"]:
        for gains in robot["gains"].values():
            gains["i"] = 0
    return config


def hubo_sway(integral):
    """Fig. 9."""
    def case(folder, options):
        rows = there_and_back(read_motion("hubo_sway_path_opt"))
        write_trajectory(folder / "motion.csv", rows)
        config = world("hubo_plane", start_at=shared_data("motions/hubo_sway_path_opt.csv"))
        if not integral:
            without_integral(config)
        forces = FootForces(kinematics.Tree(config["robots"][0]["urdf"]), HUBO, FEET, SOLES, -config["gravity"][2], config["time_step"])
        end = rows[-1][0] + (2.0 if options.short else 10.0)
        report, states = simulate(folder, config, end, 0, ["--trajectory", str(folder / "motion.csv")], forces.wanted)
        forces.read(states)
        if options.plot and not integral:
            forces.plot(options.plot)
        return report, sway_figures(forces, report, SWAY_STARTS + read_motion("hubo_sway_path_opt")[-1][0], end, not integral)
    return case


def ripple(values):
    mean = sum(values) / len(values)
    return math.sqrt(sum((value - mean) ** 2 for value in values) / len(values))


def sway_figures(forces, report, there, end, rests):
    weight, sums, left = forces.tree.total_mass() * forces.gravity, forces.sums(), forces.measured["left"]
    spans = ((SWAY_STARTS - 1, end), (end - 1, end), (there + 1, there + 2))
    moving, rest, held = [forces.steps_between(*span) for span in spans]
    off = max(abs(sums[k] - forces.sum_theory[k]) for k in moving) / weight
    aside = sorted(abs(left[k] - forces.balanced["left"][k]) / weight for k in moving)
    carried = [sum(left[k] for k in steps) / len(steps) / weight for steps in (held, rest)]
    ripples = [ripple([values[k] for k in rest]) for values in (sums, left, forces.measured["right"])]
    text = ("left foot carries %.1f %% there, %.1f %% back; sum off m (g + a) by at most %.1e of m g; a foot off the quasi-static share"
            " between the centres of pressure: median %.1e, at most %.1e of m g; ripple over the last second: sum %.1e, left %.1e, right"
            " %.1e N" % (100 * carried[0], 100 * carried[1], off, aside[len(aside) // 2], aside[-1], *ripples))
    ok = off < 5e-3 and carried[0] > 0.75 and carried[1] < 0.5 and not unreliable(report)
    return text, ok and (max(ripples) < 0.1 or not rests)


def root_path(rows, root):
    """Height of the root at the start, at its lowest, at the end; when it had sunk by 0.3 m, or None; its lean at the end [rad]."""
    heights = [pose_in(row, root)[1][2] for row in rows]
    fallen = next((float(row["time"]) for row, height in zip(rows, heights) if height < heights[0] - 0.3), None)
    (first, _), (last, _) = pose_in(rows[0], root), pose_in(rows[-1], root)
    lean = math.acos(max(-1.0, min(1.0, kinematics.dot([row[2] for row in first], [row[2] for row in last]))))
    return heights[0], min(heights), heights[-1], fallen, lean


def on_its_own(name, duration, motion=None, start=0.0, pose=None):
    """A robot with nothing but its servos. start [s]: the data's own start, counted apart, where the robot stands inside the terrain.

    pose: of the root, if it is not to start where the world says.
    """
    def case(folder, options):
        config, extra, length = world(name), [], min(duration, 3.0) if options.short else duration
        config["robots"][0]["pose"].update(pose or {})
        if motion:
            write_trajectory(folder / "motion.csv", read_motion(motion))
            extra = ["--trajectory", str(folder / "motion.csv")]
        root = config["robots"][0]["name"] + "::Body_Torso5"
        begun, rows = [], []
        if start:
            report, rows = simulate(folder, config, start, 100, extra + ["--save-state", str(folder / "state.bin")], pose_column(root))
            begun, extra = [report], ["--load-state", str(folder / "state.bin")]
        report, later = simulate(folder, config, length - start, 100, extra, pose_column(root))
        return report, path_figures(root_path(rows + later, root), begun, report)
    return case


def pose_column(body):
    return lambda column: column.startswith(body + "_")


def path_figures(path, begun, report):
    first, lowest, last, fallen, lean = path
    text = "root at %.3f m, lowest %.3f m, at the end %.3f m, leaning %.2f rad: %s" % (
        first, lowest, last, lean, "fell at %.2f s" % fallen if fallen else "did not fall")
    for start in begun:
        text += "; in the first %.1f s bare meshes cross in %d steps, of layer %.1f (%s)" % (
            start["simulated_s"], start["status"]["CONTACT_UNRELIABLE"], start["max_penetration"]["of_layer"],
            " on ".join(start["max_penetration"]["pair"]))
    deepest = report["max_penetration"]
    text += "; %s within the layer in %.2f %% of %d steps, worst %.2f of it (%s, %.2f s), %.0f contacts found a step" % (
        "then" if begun else "contacts", 100 - 100 * unreliable(report), report["steps"], deepest["of_layer"], " on ".join(deepest["pair"]),
        deepest["time_s"], report["contacts"]["raw_mean"])
    return text, unreliable(report) < 1e-3 and not report["status"]["STATE_NOT_FINITE"]


def atlas(integral):
    """Fig. 10. The pose is that of the root and of every joint, at each tenth of a second against that at 10 s."""
    def case(folder, options):
        config = world("paper_atlas_fractal")
        if not integral:
            without_integral(config)
        report, rows = simulate(folder, config, 30.0 if options.short else 180.0, 10)
        text, still = stillness(between(rows, 9.999, report["simulated_s"]))
        within, worst = 100 - 100 * unreliable(report), report["max_penetration"]["of_layer"]
        text += "; %.2f %% of steps within the layer, worst %.2f of it" % (within, worst)
        return report, (text, still)
    return case


def stillness(rows):
    """How far Atlas moved from the first row's pose, and whether that is within 1 mm and 1e-3 rad."""
    first, *others = rows
    r0, p0 = pose_in(first, ATLAS_ROOT)
    poses = [pose_in(row, ATLAS_ROOT) for row in others]
    moved = max(math.dist(p, p0) for _, p in poses)
    turned = max(math.hypot(*kinematics.turn_between(r0, r)) for r, _ in poses)
    joints = [key[: -len("_desired")] for key in first if key.endswith("_desired")]
    bent, joint = max((max(abs(float(row[j]) - float(first[j])) for row in others), j) for j in joints)
    text = "from %s s to %s s: root %.1e mm, %.1e rad, joints %.1e rad (%s)" % (
        first["time"], others[-1]["time"], 1e3 * moved, turned, bent, joint)
    return text, moved < 1e-3 and turned < 1e-3 and bent < 1e-3


ATLAS_ROOT = "atlas::pelvis"
GRASP_ASKED = "lifts 10 cm, shakes +-5 cm, slip < 0.05 mm, back within 2 mm, no bare meshes cross"
WHOLE_ASKED = "finite throughout, contacts within the layer in > 99.9 % of the steps"
# [m] of the hand above the object. The pads lie within a face of the cube, half over its upper edge, or on the mug's wall below its rim.
# Name: what is asked, and the run of it in a folder, with options short and plot (file for the feet's forces, or None).
CASES = {
    "gripper_block": (GRASP_ASKED, gripper("paper_gripper_block", 0.140, 0.0)),
    "gripper_block_edge": (GRASP_ASKED, gripper("paper_gripper_block", gripper_motions.PAD + 0.04, 0.0)),
    "gripper_mug": (GRASP_ASKED, gripper("paper_gripper_mug", gripper_motions.PAD + 0.0145, math.pi / 2, reach_back=-0.018)),
    "gripper_mug_cloud": ("points of a stereo camera, taken by the sides: lifts 10 cm, shakes +-5 cm, slip < 1 mm, back within 2 mm",
                          gripper("paper_gripper_mug", gripper_motions.PAD + 0.075, 0.0, thing=mug_cloud)),
    "tray18": ("18 mugs of 22,300 triangles stirred for 20 s: no bare meshes cross, none leaves the tray", tray),
    "hubo_sway": ("onto the left foot and back, servoI = 0; sum = m g + m a within 0.5 %, at rest ripple < 0.1 N", hubo_sway(False)),
    "hubo_sway_servo_i": ("the same with the servos' I; sum = m g + m a within 0.5 %; ripple stated", hubo_sway(True)),
    "hubo_ladder": (WHOLE_ASKED, on_its_own("hubo_ladder", 3.0, start=0.5)),
    "hubo_ladder_fall": (WHOLE_ASKED + "; begins before the ladder, leaning back on its heels, and falls onto it",
                         on_its_own("hubo_ladder", 6.0, pose={"xyz": [0.248, -0.00247315, 1.0], "rpy": [0.0, -0.25, 0.0]})),
    "hubo_ladder_climb": (CLIMB_ASKED, climbs("hubo_ladder", "hubo_up_a_ladder", pose={"xyz": [0.02, 0.4, 1.0], "rpy": [0, 0, 1.57]})),
    "hubo_stepladder": (WHOLE_ASKED, on_its_own("paper_hubo_stepladder_150k", 10.0)),
    "hubo_stepladder_climb": (CLIMB_ASKED, climbs("paper_hubo_stepladder_150k", "hubo_up_a_stepladder")),
    "hubo_stepladder_1m_climb": (CLIMB_ASKED, climbs("paper_hubo_stepladder_1m", "hubo_up_a_stepladder")),
    "hubo_chair": (WHOLE_ASKED, on_its_own("paper_hubo_chair_150k", 3.0)),
    "hubo_chair_floor": (WHOLE_ASKED + "; on the other side of the chair, where the scan has a floor",
                         on_its_own("paper_hubo_chair_150k", 10.0, pose={"xyz": [0.7, 0.05, 1.0032431]})),
    "hubo_chair_sits": (SIT_ASKED, sits()),
    "hubo_chair_sits_raw": (SIT_ASKED + "; on a scan whose noise is not averaged", sits("scans/synthetic_kinect/chair_raw_60k.ply")),
    "hubo_stair_rail": (WHOLE_ASKED, on_its_own("hubo_stair_rail", 15.0, motion="hubo_stair_rail_traj")),
    "atlas_fractal": ("on hands and feet, servoI = 0; the same pose from 10 s to 3 minutes within 1 mm, 1e-3 rad", atlas(False)),
    "atlas_fractal_servo_i": ("the same with the servos' I", atlas(True)),
}


def measure(case, folder, options):
    """Runs a case. Returns (report, what was measured, whether it holds); of a run that ended early (None, what it said, False)."""
    try:
        report, (measured, ok) = case(folder, options)
    except RuntimeError as problem:
        return None, str(problem), False
    return report, measured, ok
