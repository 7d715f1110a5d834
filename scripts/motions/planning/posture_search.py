"""A finder of postures: where the centre of mass, the body and some joints go at the end of a phase, or at the start, so that joints bear least."""
import math

import numpy as np
from sweeping.checked_yaml import InputError, flow, nearest

from planning import support
from planning.inverse_kinematics import reach
from planning.motion_file import FREE, BodyTarget, CentreTarget
from planning.planner import REACHED_M
from planning.results import roll_pitch_yaw
from planning.robot_model import Posture

START = "start"            # the name under which the posture at the start is asked for
SETTLED = 6                # times that what a try came to is asked for in its turn, so that it is met where it is asked for
SPREADS = (1.0, 0.4, 0.15)  # of the three thirds of the tries, as shares of those below
SPREAD_M, SPREAD_HEIGHT, SPREAD_RAD = 0.06, 0.1, 0.35  # of the centre of mass, of the body, of angles
MISSED, SHORT = 100.0, 10.0  # costs of what is not reached, and of a margin or gap that is all used up
NEAR = 0.01                # cost of a joint that turns by 1 rad, rms, so that of two postures the nearer one is taken
ROUNDS = 60                # of inverse kinematics per try


class PostureSearch:
    """Tries targets, better and better ones, in an order that never changes. joints: names of those that are tried too. after: contacts that hold
    once what leaves next has left; efforts and margin are those of what holds now and of these."""

    def __init__(self, planner, joints, after, tries):
        self.planner, self.joints, self.after, self.tries = planner, joints, after, tries
        self.random = np.random.RandomState(0)

    def find(self, solved, first):
        """(targets, words) of the best try. Raises InputError if none is reached. @param solved function of targets that gives a PlacedRobot and
        what it misses [m or rad], or refuses @param first the targets that the search begins with: x, y of the centre of mass, height, roll, pitch, yaw, joints"""
        spreads = np.array([SPREAD_M] * 2 + [SPREAD_HEIGHT] + [SPREAD_RAD] * (3 + len(self.joints)))
        best, least, placed, words = np.asarray(first, float), math.inf, None, ""
        for tried in range(self.tries):
            spread = SPREADS[3 * tried // self.tries]
            targets = self.bounded(best + (spread * spreads * self.random.standard_normal(len(spreads)) if tried else 0.0))
            cost, there, said = self.cost(solved, targets)
            if cost < least:
                best, least, placed, words = targets, cost, there, said
        for _ in range(SETTLED):
            if least >= MISSED:
                raise InputError("%s: --find: none of %d postures reaches the contacts; bring them nearer, or try more (--tries)"
                                 % (self.planner.motion.file, self.tries))
            best = targets_met(self.planner, placed, self.joints)
            least, placed, words = self.cost(solved, best)
        return best, words

    def bounded(self, targets):
        """Targets with joints within their limits."""
        model = self.planner.model
        for k, name in enumerate(self.joints, 6):
            column = model.joint_names.index(name)
            targets[k] = np.clip(targets[k], model.lower[column], model.upper[column])
        return targets

    def cost(self, solved, targets):
        """(what a try costs, the PlacedRobot, words about it)."""
        planner = self.planner
        try:
            placed, missed = solved(targets)
        except InputError:
            return math.inf, None, ""
        share, joint = max((support.static_effort(placed, planner.points(names, placed), planner.robot.gravity) for names in self.after),
                           key=lambda each: each[0])
        margin = min(support.region_margin(support.support_region(planner.points(names, placed)), placed.centre_of_mass[:2]) for names in self.after)
        gap = planner.clearance.least_gap(placed, links_of(planner, self.after[0])) if planner.clearance else None
        changed = placed.posture.joints - planner.placed.posture.joints
        cost = NEAR * math.sqrt(float(changed @ changed) / len(changed)) + (MISSED * (1 + missed) if missed else 0.0)
        cost += min(share, SHORT) + SHORT * max(0.0, 1 - max(margin, -1.0) / max(planner.motion.margin, 1e-3))
        if gap and gap[3]:
            cost += SHORT * (1 + max(0.0, planner.clearance.wanted - gap[0]) / 0.01)
        near = "nothing near" if gap is None else "%.1f mm from '%s' to '%s'" % (1e3 * gap[0], gap[1], gap[2])
        return cost, placed, "effort %.0f %% (%s), margin %.1f mm, %s" % (100 * share, joint, 1e3 * margin, near)


def links_of(planner, names):
    """Links of contacts, and what hangs on them."""
    return {below for name in names for below in planner.model.links_below(planner.motion.contacts[name].link)}


def targets_met(planner, placed, joints):
    """Targets that a robot meets as it is placed; those that were asked for may give way to contacts."""
    rotation, position = placed.link(planner.body)
    indices = [planner.model.joint_names.index(name) for name in joints]
    return np.concatenate([placed.centre_of_mass[:2], [position[2]], roll_pitch_yaw(rotation), placed.posture.joints[indices]])


def told(asked, targets, joints):
    """Targets of a phase or a start as the motion file has them."""
    said = {"com": {"xy": targets[:2]}, "body": {"height": targets[2], "rpy": targets[3:6]}}
    if is_free(asked):
        said["com"] = FREE
    if joints:
        said["joints"] = dict(zip(joints, targets[6:]))
    return ["%s: %s" % (key, flow(value)) for key, value in rounded(said).items()]


def rounded(value):
    """A value of a motion file, its numbers with four digits."""
    if isinstance(value, str):
        return value
    if isinstance(value, dict):
        return {key: rounded(each) for key, each in value.items()}
    return [round(float(each), 4) for each in value] if np.ndim(value) else round(float(value), 4)


def is_free(asked):
    """Whether a phase or a start leaves the centre of mass free."""
    return asked.com is not None and asked.com.kind == FREE


def with_targets(asked, targets, joints):
    """A phase or a start that asks for these targets; a centre of mass that it leaves free stays so."""
    centre = asked.com if is_free(asked) else CentreTarget("xy", targets[:2])
    return asked._replace(com=centre, body=BodyTarget("height", targets[2], targets[3:6]), joints=dict(zip(joints, targets[6:])))


def find_phase(planner, number, tries):
    """Lines about the posture at the end of a phase. The motion is planned as far as that."""
    planner.plan(number)
    phase = planner.motion.phases[number]
    during, region = planner.begin(phase)
    held = planner.held_after(phase, during)
    leaving_next = planner.staying(planner.motion.phases[number + 1], held) if number + 1 < len(planner.motion.phases) else held
    joints, model, start = sorted(phase.joints), planner.model, planner.placed

    def solved(targets):
        asked = with_targets(phase, targets, joints)
        tasks = planner.tasks(asked, during, region)
        positions = start.posture.joints.copy()
        for name, value in asked.joints.items():
            positions[model.joint_names.index(name)] = value
        posture = reach(model, Posture(start.posture.rotation, start.posture.position, positions), lambda each: tasks.ranks(each, 1.0), tasks.free, ROUNDS)
        placed = model.place(posture)
        missed = max([0.0] + [max(each.metres, each.radians) for each in tasks.residuals(placed, 1.0)])
        return placed, missed if missed > REACHED_M else 0.0

    first = targets_met(planner, planner.placed, joints)
    if phase.body and phase.body.kind == "height":
        first[2] = phase.body.height
    if phase.body and phase.body.rpy is not None:
        first[3:6] = phase.body.rpy
    if phase.com and phase.com.kind == "xy":
        first[:2] = phase.com.value
    first[6:] = [phase.joints[name] for name in joints]
    targets, words = PostureSearch(planner, joints, [held, leaving_next] if leaving_next else [held], tries).find(solved, first)
    return told(phase, targets, joints) + [words]


def find_start(planner, tries):
    """Lines about the posture at the start, whose contacts the motion names."""
    start = planner.motion.start
    joints = sorted(start.joints)
    planner.go_to_start(start)
    reached = (planner.placed, planner.home, dict(planner.frames))
    first = targets_met(planner, planner.placed, joints)

    def solved(targets):
        planner.placed, planner.home, planner.frames = reached[0], reached[1], dict(reached[2])
        planner.take_body()
        planner.go_to_start(with_targets(start, targets, joints), ROUNDS)
        return planner.placed, 0.0

    targets, words = PostureSearch(planner, joints, [planner.holding], tries).find(solved, first)
    return told(start, targets, joints) + [words]


def find_posture(planner, name, tries):
    """Lines that tell targets for a phase of a name, or the start, and what they come to. Raises InputError for others."""
    motion = planner.motion
    if planner.model.fixed:
        raise InputError("%s: --find: the robot's base is fixed; leave it out" % motion.file)
    if name == START and motion.start:
        return find_start(planner, tries)
    names = [phase.name for phase in motion.phases]
    if name not in names:
        raise InputError("%s: --find: there is no phase '%s'; %s" % (motion.file, name, nearest(name, names + [START])))
    return find_phase(planner, names.index(name), tries)
