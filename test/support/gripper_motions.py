"""Motions of the TX90 arm with the PR2 gripper, as trajectories for blem_sim_run: grasping from above, and stirring."""
import math
import sys

from shared_data import SOURCE_DIR, shared_data

sys.path.insert(0, str(SOURCE_DIR / "scripts" / "support"))
from kinematics import Tree  # noqa: E402
from trajectory_file import smooth  # noqa: E402

URDF = "robots/klampt/tx90pr2/tx90pr2.urdf"
ARM = ["Link_%d_joint" % k for k in range(1, 7)]
FINGER = "gripper_Link_1_joint"  # the driver's joint; the three others mimic it
HAND = "gripper_Link_0"
ELBOW_UP = [0.1, -0.3, -1.6, 0.0, -1.8, 0.0]  # [rad] where the search for the arm's posture begins
PAD = 0.134        # [m] from the hand's origin to the middle of the pads along its x axis, when they are some 9 cm apart
FREE = 0.034       # [m] from the hand's origin to where an object 8 cm wide would meet the fingers, short of PAD
OPEN = 0.85        # [rad] pads some 125 mm apart
SQUEEZE = 0.40     # [rad] past the touch of an 8 cm object: the motor is at its limit
ROW_STEP = 0.01    # [s] between the rows of a trajectory


def hand_pose(xyz, closing_angle):
    """Hand pointing down with its origin at xyz and its pads closing along a horizontal line at an angle to the world's x."""
    c, s = math.cos(closing_angle), math.sin(closing_angle)
    return ((0, c, s), (0, s, -c), (-1, 0, 0)), xyz


class Grasp:
    """Down to an object, close, lift, shake, put back, open, leave. All times in s, all lengths in m.

    hand: the hand's origin when it grasps; closing_angle [rad]; shaking along the horizontal direction at 45 degrees to the closing
    line, so that both the pads' normal and their friction carry it.
    """
    ABOVE, LIFT, AMPLITUDE, RATE = 0.12, 0.10, 0.05, 1.0
    SETTLED, DOWN, CLOSED, LIFTED = 0.8, 2.0, 3.0, 4.5

    def __init__(self, hand, closing_angle, shaking):
        self.hand, self.closing_angle = hand, closing_angle
        self.shake_from, self.shake_to = self.LIFTED + 0.5, self.LIFTED + 0.5 + shaking
        self.put_back = self.shake_to + 2.0
        self.opened, self.left = self.put_back + 1.5, self.put_back + 2.7
        self.end = self.left + 0.5

    def at(self, t):
        """Hand pose and finger angle."""
        height = self.ABOVE * (1 - smooth(t, self.SETTLED, self.DOWN) + smooth(t, self.opened, self.left))
        height += self.LIFT * (smooth(t, self.CLOSED + 0.3, self.LIFTED) - smooth(t, self.shake_to + 0.3, self.put_back))
        strength = smooth(t, self.shake_from, self.shake_from + 1) - smooth(t, self.shake_to - 1, self.shake_to)
        out = self.AMPLITUDE * strength * math.sin(2 * math.pi * self.RATE * (t - self.shake_from))
        angle = self.closing_angle + math.pi / 4
        xyz = (self.hand[0] + out * math.cos(angle), self.hand[1] + out * math.sin(angle), self.hand[2] + height)
        closed = smooth(t, self.DOWN + 0.2, self.CLOSED) - smooth(t, self.put_back + 0.3, self.opened)
        return hand_pose(xyz, self.closing_angle), OPEN - SQUEEZE * closed


RESTS = {"paper_gripper_block": 0.6875, "paper_gripper_mug": 0.6958}  # [m] height of the object's origin on the table
TRAY_BOTTOM = 0.645  # [m]


def grasp_scene(config, rest, hand_height, closing_angle, reach_back, shaking):
    """A world of the gripper and one object, ready to be grasped: changes the configuration. Returns (motion, its joints' rows).

    rest [m]: height of the object's origin; hand_height [m]: of the hand's origin above it; reach_back [m]: of the hand, in the object's x.
    """
    pose = config["objects"][0]["pose"]
    (x, y, _), yaw = pose["xyz"], pose["rpy"][2]
    motion = Grasp((x + reach_back * math.cos(yaw), y + reach_back * math.sin(yaw), rest + hand_height), yaw + closing_angle, shaking)
    rows = joint_rows(motion)
    robot = config["robots"][0]
    robot["initial_positions"] = rows[0][1]
    robot["gains"][FINGER]["i_clamp"] = robot["effort_limits"][FINGER]  # no more integral than the motor can give, or it never opens
    return motion, rows


def stir_scene(config, stirring):
    """The tray of mugs, ready to be stirred for some time [s]: changes the configuration. Returns (motion, its joints' rows)."""
    motion = Stir((0.6, 0.13), (0.6, 0.383), TRAY_BOTTOM + 0.015 + 0.167, stirring)
    rows = joint_rows(motion)
    config["robots"][0]["initial_positions"] = rows[0][1]
    return motion, rows


def joint_rows(motion, step=ROW_STEP):
    """The motion's joint positions at every step: a list of (time, map by joint). Raises ValueError where the arm cannot follow."""
    tree, rows, positions = Tree(shared_data(URDF)), [], dict(zip(ARM, ELBOW_UP))
    for k in range(int(round(motion.end / step)) + 1):
        pose, finger = motion.at(k * step)
        positions = dict(tree.reach(HAND, pose, ARM, positions), **{FINGER: finger})
        if tree.beyond_limits(positions):
            raise ValueError("beyond their limits at %.2f s: %s" % (k * step, ", ".join(tree.beyond_limits(positions))))
        rows.append((k * step, positions))
    return rows


class Stir:
    """Closed fingers go down into a tray beside its things and through them along a circle. Times in s, lengths in m.

    middle: of the circle; entry: where the hand goes down; depth: height of the hand's origin while it stirs.
    """
    RADIUS, SPEED, ABOVE, CLOSED = 0.10, 0.10, 0.30, 0.10
    SETTLED, DOWN, BEGUN = 1.2, 2.5, 4.0

    def __init__(self, middle, entry, depth, stirring):
        self.middle, self.entry, self.depth = middle, entry, depth
        self.stirred = self.BEGUN + stirring
        self.end = self.stirred + 0.5

    def at(self, t):
        """Hand pose and finger angle."""
        turns = 2 * math.pi * self.RADIUS / self.SPEED
        angle = 0.5 * math.pi - 2 * math.pi * max(0.0, min(t, self.stirred) - self.BEGUN) / turns * smooth(t, self.BEGUN, self.BEGUN + 1)
        on_circle = (self.middle[0] + self.RADIUS * math.cos(angle), self.middle[1] + self.RADIUS * math.sin(angle))
        s = smooth(t, self.DOWN, self.BEGUN)
        x, y = [a + s * (b - a) for a, b in zip(self.entry, on_circle)]
        return hand_pose((x, y, self.depth + self.ABOVE * (1 - smooth(t, self.SETTLED, self.DOWN))), 0.0), self.CLOSED
