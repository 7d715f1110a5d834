"""A motion phase by phase: what holds, where the centre of mass goes, and the joints' positions at every sample, or a refusal."""
import collections
import math

import numpy as np
from kinematics import from_rpy
from sweeping.checked_yaml import InputError

from planning import support
from planning.clearance import touching
from planning.inverse_kinematics import joints_at_limits, reach
from planning.motion_file import FREE, CentreTarget, Phase
from planning.robot_model import ROOT_COORDINATES, Posture, rotation_vector
from planning.tasks import CENTRE, Between, ContactWay, PhaseTasks, frame_of
from planning.timing import timed

REACHED_M, REACHED_RAD = 1e-4, 1e-4      # a task is kept within these
BODY_M, BODY_RAD = 1e-3, 2e-3            # a body's target that a phase asks for is reached within these
ROUNDS, PHASE_ROUNDS, START_ROUNDS = 6, 400, 500  # of inverse kinematics for all ranks: at least per sample and per phase; to the start
ROOM = 2                                 # margins that a shift before a phase leaves, where there is so much room
EFFORT_SAMPLES = 5                       # of a phase

# One planned phase: its rows are PlacedRobots after those before. margin [m], speed and effort as shares of a joint's limit with its name; residual
# [m] and [rad]; gap: a Gap or None; region: corners of the support; frames: {contact: (rotation, middle)} at the end.
Planned = collections.namedtuple("Planned", "name duration holding margin speed effort gap residual region placed frames shares")


class Planner:
    """Plans the phases of a motion one after the other. Raises InputError, in one line, where one is not possible."""

    def __init__(self, motion, robot, clearance=None, settling=None):
        self.motion, self.robot, self.model, self.clearance, self.settling = motion, robot, robot.model, clearance, settling
        self.body = motion.body or self.model.links[0]
        self.check_names()
        used = self.model.joints_between([contact.link for contact in motion.contacts.values()] + [self.body])
        self.free = np.zeros(ROOT_COORDINATES + len(self.model.joint_names), bool)
        self.free[:ROOT_COORDINATES] = not self.model.fixed
        self.free[[ROOT_COORDINATES + column for column in used]] = True
        self.placed = self.model.place(robot.posture)
        self.home = robot.posture.joints.copy()
        self.holding, self.planned = list(motion.holding), []
        self.frames = {name: frame_of(self.placed, motion.contacts[name]) for name in self.holding}
        self.take_body()

    def take_body(self):
        """The body's height and orientation as they are become those that it is to keep."""
        rotation, position = self.placed.link(self.body)
        self.height, self.orientation = position[2], rotation

    def check_names(self):
        motion, names = self.motion, {joint.name: joint for joint in self.model.tree.joints}
        if self.body not in self.model.links:
            motion.field("body", self.body).choice(self.model.links)
        for name, contact in motion.contacts.items():
            motion.field("contacts.%s.link" % name, contact.link).choice(self.model.links)
        asked = [(phase.path + ".joints", phase.joints) for phase in motion.phases] + ([("start.joints", motion.start.joints)] if motion.start else [])
        for path, joints in asked:
            for name, value in joints.items():
                field = motion.field(path + "." + name, value)
                if name in names and names[name].mimics:
                    field.refuse("the joint mimics '%s'; name that one" % names[name].mimics[0])
                motion.field(path, name).choice(self.model.joint_names)
                column = self.model.joint_names.index(name)
                if not self.model.lower[column] <= value <= self.model.upper[column]:
                    field.refuse("%g is outside the joint's limits %g to %g; stay within" % (value, self.model.lower[column], self.model.upper[column]))
        if self.model.fixed:
            self.refuse_balance()

    def refuse_balance(self):
        """A fixed base has no balance: targets of the centre of mass and of the body mean nothing."""
        for phase in self.motion.phases:
            for key, value in (("com", phase.com), ("body", phase.body)):
                if value:
                    self.motion.field(phase.path, None).refuse("the robot's base is fixed; leave '%s' out" % key)

    def plan(self, count=None):
        """The planned phases, so many or all of them. self.start is where the motion begins."""
        if self.motion.start:
            self.go_to_start(self.motion.start)
            self.check_body(phase_of_start(self.motion.start))
        self.start, self.start_frames = self.placed, dict(self.frames)
        if not self.model.fixed:
            region = self.region(self.holding, "the start")
            margin = support.region_margin(region, self.placed.centre_of_mass[:2])
            if margin < self.motion.margin - REACHED_M:
                self.refuse("the start", "the centre of mass is %s the support of %s, margin is %g mm; write start: {com: {over: [%s]}}, or a smaller"
                            " margin" % (beside(margin), ", ".join(self.holding), 1e3 * self.motion.margin, ", ".join(self.holding)))
        for phase in self.motion.phases[:count]:
            self.plan_phase(phase)
        return self.planned

    def refuse(self, name, problem):
        raise InputError("%s: %s: %s" % (self.motion.file, name, problem))

    # -- what holds

    def points(self, names, placed):
        """ContactPoints of contacts where they are."""
        weight, points = self.model.mass * self.robot.gravity, []
        for name in names:
            contact = self.motion.contacts[name]
            rotation, middle = frame_of(placed, contact)
            share = contact.force / weight if contact.force else 1.0
            normals = contact.normals if contact.facing else contact.normals @ rotation.T
            points += [support.ContactPoint(contact.link, middle + rotation @ (point - contact.middle) - contact.radius * normal, normal, contact.friction, share)
                       for point, normal in zip(contact.points, normals)]
        return points

    def region(self, names, phase):
        """Where the centre of mass may be while these hold."""
        if not names:
            self.refuse(phase, "nothing holds the robot; let a contact hold, or write fixed_base: true in the configuration of a robot that is fixed")
        region = support.support_region(self.points(names, self.placed))
        if len(region) < 3:
            self.refuse(phase, "no forces of %s within friction balance the robot; let more contacts hold, or correct points, normal and friction"
                        % ", ".join(names))
        return region

    def middle(self, names, phase):
        """Middle of a region that has room for the margin."""
        region = self.region(names, phase)
        middle = support.region_middle(region)
        room = support.region_margin(region, middle)
        if room < self.motion.margin:
            self.refuse(phase, "the support of %s leaves %.1f mm about its middle, margin is %g mm; let more contacts hold, or write a smaller margin"
                        % (", ".join(names), 1e3 * room, 1e3 * self.motion.margin))
        return middle

    # -- phases

    def plan_phase(self, phase):
        during, region = self.begin(phase)
        self.follow(phase, during, region)
        self.holding = self.held_after(phase, during)

    def staying(self, phase, holding):
        """Those of the contacts that hold which a phase does not take off."""
        return [name for name in holding if name not in phase.ways and name not in phase.release]

    def held_after(self, phase, during):
        return during + [name for name, way in phase.ways.items() if way.lands]

    def begin(self, phase):
        """(contacts that hold during a phase, their support), the centre of mass being over them."""
        during = self.staying(phase, self.holding)
        region = None
        if not self.model.fixed:
            region = self.region(during, phase.name)
            if len(during) < len(self.holding) and support.region_margin(region, self.placed.centre_of_mass[:2]) < self.motion.margin:
                self.shift(during, phase)
                region = self.region(during, phase.name)
        for name in phase.release:
            self.frames.pop(name, None)
        return during, region

    def shift(self, holding, phase):
        """A phase before another: the centre of mass goes over what will hold."""
        name = "shift for %s" % phase.name
        target = support.towards(self.region(holding, phase.name), self.placed.centre_of_mass[:2], self.middle(holding, phase.name), ROOM * self.motion.margin)
        before = Phase(phase.path, name, self.motion.shift_duration, CentreTarget("xy", target), None, {}, [], {})
        self.follow(before, self.holding, self.region(self.holding, name))

    def follow(self, phase, during, region):
        """Plans the joints' way through a phase in which `during` hold, and books it."""
        tasks = self.tasks(phase, during, region)
        start = self.placed
        targets = {self.model.joint_names.index(name): (start.posture.joints[self.model.joint_names.index(name)], value)
                   for name, value in phase.joints.items()}
        placed, duration, speed = timed(self, phase, lambda shares: self.samples(tasks, targets, shares, phase), self.lowest_contact(during))
        shares = [(k + 1) / len(placed) for k in range(len(placed))]
        residuals = [each for one, share in zip(placed, shares) for each in tasks.residuals(one, share)]
        margin = self.least_margin(phase, during, region, [start] + placed)
        self.placed = placed[-1]
        self.check_body(phase)
        for contact, _ in tasks.ways:
            self.frames[contact.name] = frame_of(self.placed, contact)
        effort = self.largest_effort(phase.name, during, [start] + placed)
        gap = self.least_gap(phase, during, placed, duration)
        self.planned.append(Planned(phase.name, duration, during, margin, speed, effort, gap, (max([0.0] + [each.metres for each in residuals]),
                            max([0.0] + [each.radians for each in residuals])), region, placed, dict(self.frames), shares))

    def tasks(self, phase, during, region):
        ways = [(self.motion.contacts[name], still(frame)) for name, frame in self.frames.items() if name not in phase.ways]
        for name, way in phase.ways.items():
            contact = self.motion.contacts[name]
            start = frame_of(self.placed, contact)
            rotation = start[0] if way.rpy is None else np.array(from_rpy(way.rpy))
            end = (rotation, way.to if way.to is not None else start[1] + way.by)
            ways.append((contact, ContactWay(start, self.settled(contact, end) if way.lands else end, way.lift)))
        free = self.free.copy()
        for name, value in phase.joints.items():
            column = self.model.joint_names.index(name)
            free[ROOT_COORDINATES + column] = False
            self.home[column] = value
        posture = Between(self.placed.posture.joints, self.home)
        if self.model.fixed:
            return PhaseTasks(ways, None, None, posture, free)
        self.aim_body(phase.body)
        rotation, position = self.placed.link(self.body)
        body = (self.body, Between(position[2], self.height), ContactWay((rotation, position), (self.orientation, position), np.zeros(3)))
        return PhaseTasks(ways, self.centre_way(phase, during, region), body, posture, free)

    def settled(self, contact, frame):
        """A frame that a contact is put down at, as it comes to rest there if it settles."""
        return self.settling.rest(contact, frame) if contact.settles else frame

    def aim_body(self, target):
        """Height and orientation that the body is to have from now on."""
        if target is None:
            return
        if target.kind:
            self.height = target.height if target.kind == "height" else self.height + target.height
        if target.rpy is not None:
            self.orientation = np.array(from_rpy(target.rpy))

    def centre_way(self, phase, during, region):
        """The way of the centre of mass as a Between of (x, y), or None if the phase leaves it free."""
        if phase.com is not None and phase.com.kind == FREE:
            return None
        return Between(self.placed.centre_of_mass[:2], self.centre_target(phase, during, region))

    def centre_target(self, phase, during, region):
        """Where the centre of mass goes, (x, y), which lies within the support by the margin."""
        if phase.com is None:
            return self.placed.centre_of_mass[:2]
        if phase.com.kind == "over":
            for name in phase.com.value:
                if name not in self.frames:
                    self.refuse(phase.name, "com: over: '%s' is nowhere yet; let it hold, or move it, first" % name)
            target = self.middle(phase.com.value, phase.name)
        else:
            target = phase.com.value + (self.placed.centre_of_mass[:2] if phase.com.kind == "by" else 0.0)
        margin = support.region_margin(region, target)
        if margin < self.motion.margin - REACHED_M:
            self.refuse(phase.name, "com: (%.3f, %.3f) is %s the support of %s, margin is %g mm; move it in, or let more contacts hold"
                        % (target[0], target[1], beside(margin), ", ".join(during), 1e3 * self.motion.margin))
        return target

    def samples(self, tasks, targets, shares, phase):
        """The robot at each of these shares of a phase."""
        posture, placed, rounds = self.placed.posture, [], max(ROUNDS, PHASE_ROUNDS // len(shares))
        for share in shares:
            joints = posture.joints.copy()
            for column, (start, end) in targets.items():
                joints[column] = Between(start, end).at(share)
            posture = reach(self.model, Posture(posture.rotation, posture.position, joints), lambda each: tasks.ranks(each, share), tasks.free, rounds)
            placed.append(self.model.place(posture))
            self.check_reached(tasks, placed[-1], share, phase)
        return placed

    # -- refusals

    def check_reached(self, tasks, placed, share, phase):
        missed = [each for each in tasks.residuals(placed, share) if each.metres > REACHED_M or each.radians > REACHED_RAD]
        if not missed:
            return
        worst = max(missed, key=lambda each: (each.of in phase.ways, each.metres + each.radians))
        at = self.limits_met([placed])
        off = "%.1f mm and %.3f rad off at %d %% of the phase" % (1e3 * worst.metres, worst.radians, round(100 * share))
        if worst.of == CENTRE:
            self.refuse(phase.name, "the centre of mass cannot be brought to where it is asked, %s; %slower the body (body: {rise: -0.05}), bring the"
                        " contacts closer, or give com: xy" % (off, at))
        contact = self.motion.contacts[worst.of]
        lower = "" if self.model.fixed else ", or another height of the body (body: {rise: -0.05})"
        self.refuse(phase.name, "contact '%s' (link '%s') is out of reach, %s; %schoose a nearer target or less lift%s"
                    % (worst.of, contact.link, off, at, lower))

    def limits_met(self, placed):
        """Words about the joints that are at a limit at any of these moments."""
        met = [name for name in self.model.joint_names if any(name in joints_at_limits(self.model, each.posture, self.free) for each in placed)]
        return "at their limits: %s; " % ", ".join(met) if met else ""

    def check_body(self, phase):
        """A height or orientation that a phase asks for is reached at its end."""
        if phase.body is None:
            return
        rotation, position = self.placed.link(self.body)
        off = abs(position[2] - self.height) if phase.body.kind else 0.0
        turned = np.linalg.norm(rotation_vector(rotation @ self.orientation.T)) if phase.body.rpy is not None else 0.0
        if off > BODY_M or turned > BODY_RAD:
            self.refuse(phase.name, "the body (link '%s') ends %.1f mm and %.3f rad from its target; %sask for less, or give the phase more time"
                        % (self.body, 1e3 * off, turned, self.limits_met([self.placed])))

    def least_margin(self, phase, during, region, placed):
        """The least distance [m] of the centre of mass from the edge of its support, None on a fixed base; a refusal of a free one that comes too near."""
        if region is None:
            return None
        margin = min(support.region_margin(region, each.centre_of_mass[:2]) for each in placed)
        if phase.com is not None and phase.com.kind == FREE and margin < self.motion.margin - REACHED_M:
            self.refuse(phase.name, "com: free: the centre of mass comes %s the support of %s, margin is %g mm; ask for less of the body and joints, or write com: xy"
                        % (beside(margin), ", ".join(during), 1e3 * self.motion.margin))
        return margin

    def largest_effort(self, name, during, placed):
        """(share, joint) over some samples of a phase; a refusal beyond what the motion allows."""
        indices = sorted({int(round(k * (len(placed) - 1) / (EFFORT_SAMPLES - 1))) for k in range(EFFORT_SAMPLES)})
        found = [support.static_effort(placed[k], self.points(during, placed[k]), self.robot.gravity) for k in indices]
        share, joint = max(found, key=lambda each: each[0])
        if share == math.inf:
            self.refuse(name, "no forces of %s within friction balance the robot as its links turn; let more contacts hold" % ", ".join(during))
        if share > self.motion.effort:
            self.refuse(name, "joint '%s' needs %.0f %% of its effort limit at rest, effort is %.0f %%; load it less (com, height of the body), or let more"
                        " contacts hold" % (joint, 100 * share, 100 * self.motion.effort))
        return share, joint

    def least_gap(self, phase, during, placed, duration):
        """The Gap of a phase, None if nothing comes near; a refusal where it is smaller than the motion's clearance."""
        if self.clearance is None:
            return None
        gap, too_small = self.clearance.along(placed, lambda k: touching(self.model, self.motion.contacts, during, phase, (k + 1) / len(placed)))
        if too_small:
            share = (gap.sample + 1) / len(placed)
            self.refuse(phase.name, "link '%s' comes within %.1f mm of '%s' at %d %% of the phase (%.2f s of the motion), clearance is %g mm; lift it"
                        " higher, turn the body or its contacts away, or move joints" % (gap.link, 1e3 * gap.metres, gap.other, round(100 * share),
                        sum(each.duration for each in self.planned) + share * duration, 1e3 * self.clearance.wanted))
        return gap

    def lowest_contact(self, during):
        heights = [point.position[2] for point in self.points(during, self.placed)]
        return min(heights) if heights else None

    # -- the start

    def go_to_start(self, start, rounds=START_ROUNDS):
        """Brings the robot to the posture that a motion's start describes."""
        model = self.model
        joints = self.placed.posture.joints.copy()
        for name, value in start.joints.items():
            joints[model.joint_names.index(name)] = value
        self.placed = model.place(Posture(self.placed.posture.rotation, self.placed.posture.position, joints))
        self.home = joints.copy()
        ways = []
        for name, way in start.contacts.items():
            contact = self.motion.contacts[name]
            rotation, _ = frame_of(self.placed, contact)
            goal = (rotation if way.rpy is None else np.array(from_rpy(way.rpy)), way.to)
            ways.append((contact, still(self.settled(contact, goal))))
        stands = {self.motion.contacts[name].link for name in start.contacts}
        for name in self.holding:
            if self.motion.contacts[name].link not in stands:
                ways.append((self.motion.contacts[name], still(frame_of(self.placed, self.motion.contacts[name]))))
        self.solve_start(ways, start, rounds)
        self.frames = {name: frame_of(self.placed, self.motion.contacts[name]) for name in list(self.frames) + list(start.contacts)}
        self.home = self.placed.posture.joints.copy()
        self.take_body()

    def solve_start(self, ways, start, rounds):
        """First the contacts and the body; then, from there, the centre of mass."""
        free = self.free.copy()
        free[[ROOT_COORDINATES + self.model.joint_names.index(name) for name in start.joints]] = False
        phase = phase_of_start(start)
        for centre in (False, True):
            self.aim_body(start.body)
            position = self.placed.link(self.body)[1]
            body = None if self.model.fixed else (self.body, Between(self.height, self.height), still((self.orientation, position)))
            target = None
            if centre and start.com is not None and start.com.kind != FREE:
                target = self.centre_target(phase, self.holding, self.region(self.holding, phase.name))
                target = Between(target, target)
            tasks = PhaseTasks(ways, target, body, Between(self.home, self.home), free)
            posture = reach(self.model, self.placed.posture, lambda each: tasks.ranks(each, 1.0), free, rounds)
            self.placed = self.model.place(posture)
            self.check_reached(tasks, self.placed, 1.0, phase)


def phase_of_start(start):
    """What a start asks for, as a phase that takes no time."""
    return Phase("start", "the start", 0.0, start.com, start.body, {}, [], {})


def still(frame):
    return ContactWay(frame, frame, np.zeros(3))


def beside(margin):
    """A margin in words."""
    return "%.1f mm outside of" % (-1e3 * margin) if margin < 0 else "%.1f mm inside" % (1e3 * margin)
