"""What a phase asks of the robot at each moment, as tasks for inverse kinematics: contacts and centre of mass, then the body, then the posture."""
import collections

import numpy as np
from trajectory_file import smooth

from planning.robot_model import ROOT_COORDINATES, rotation_vector, turn

# Shares of a phase: a contact that is lifted rises until RISEN, travels between LEAVES and ARRIVES, and comes down from SINKS on.
RISEN, LEAVES, ARRIVES, SINKS = 0.35, 0.25, 0.75, 0.65

# Largest errors of the first rank: what it is of (a contact's name, or CENTRE), [m] and [rad].
Residual = collections.namedtuple("Residual", "of metres radians")
CENTRE = "centre of mass"


class ContactWay:
    """A contact from one frame to another, straight, or over `lift` [m, a vector] beyond the farther of both ends. A frame is (rotation of its link,
    position of its middle)."""

    def __init__(self, start, end, lift):
        self.start, self.end = start, end
        self.turned = rotation_vector(end[0] @ start[0].T)
        height = float(np.linalg.norm(lift))
        self.up = lift / height if height > 0 else lift
        self.risen = float(self.up @ (end[1] - start[1]))  # of the end above the start, along the lift
        self.top = max(0.0, self.risen) + height
        self.rests = start is end and height == 0

    def at(self, share):
        if self.rests:
            return self.start
        along = smooth(share, LEAVES, ARRIVES) if self.top > 0 else smooth(share, 0, 1)
        raised = self.top * smooth(share, 0, RISEN) - (self.top - self.risen) * smooth(share, SINKS, 1)
        beside = self.end[1] - self.start[1] - self.risen * self.up
        return turn(along * self.turned) @ self.start[0], self.start[1] + along * beside + raised * self.up


def frame_of(placed, contact):
    rotation, position = placed.link(contact.link)
    return rotation, position + rotation @ contact.middle


def kept_turns(contact, rotation):
    """Rows that pick, of an error of six, the turns that a contact may not make where its link has a rotation."""
    rows = np.hstack([np.zeros((3, 3)), np.eye(3)])
    if contact.keeps == "pose":
        return rows
    return rows[:0] if contact.edge is None else across(rotation @ contact.edge) @ rows


def across(axis):
    """Two unit vectors, as rows, at right angles to a unit vector and to each other."""
    side = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    side /= np.linalg.norm(side)
    return np.array([side, np.cross(axis, side)])


class Between:
    """A vector that goes smoothly from one value to another."""

    def __init__(self, start, end):
        self.start, self.end = np.asarray(start, float), np.asarray(end, float)

    def at(self, share):
        return self.start + smooth(share, 0, 1) * (self.end - self.start)


class PhaseTasks:
    """Tasks of one phase. ways: [(Contact, ContactWay)]; centre: Between of (x, y), or None; body: (link, Between of the height, way of its
    orientation as a ContactWay), or None; posture: Between of the joints' positions that the rest tends to; free: coordinates that may change."""

    def __init__(self, ways, centre, body, posture, free):
        self.ways, self.centre, self.body, self.posture, self.free = ways, centre, body, posture, free

    def first_rank(self, placed, share):
        """[(of, Jacobian, error)] of the contacts and the centre of mass."""
        rows = []
        for contact, way in self.ways:
            rotation, middle = way.at(share)
            is_rotation, is_middle = frame_of(placed, contact)
            arm = contact.radius * contact.normals[0] if way.rests else np.zeros(3)  # from where a ball that rolls touches to its middle
            rolled = np.cross(rotation_vector(is_rotation @ rotation.T), arm)
            jacobian = placed.point_jacobian(contact.link, is_middle - arm)
            error = np.append(middle + rolled - is_middle, rotation_vector(rotation @ is_rotation.T))
            kept = np.vstack([np.eye(6)[:3], kept_turns(contact, rotation)])
            rows.append((contact.name, kept @ jacobian, kept @ error))
        if self.centre is not None:
            rows.append((CENTRE, placed.centre_jacobian()[:2], self.centre.at(share) - placed.centre_of_mass[:2]))
        return rows

    def second_rank(self, placed, share):
        """(Jacobian, error) of the body: height and orientation."""
        if self.body is None:
            return np.zeros((0, len(self.free))), np.zeros(0)
        link, height, way = self.body
        rotation, position = placed.link(link)
        jacobian = placed.point_jacobian(link, position)[2:]
        return jacobian, np.append(height.at(share) - position[2], rotation_vector(way.at(share)[0] @ rotation.T))

    def ranks(self, placed, share):
        """All tasks, for inverse_kinematics.reach."""
        first = self.first_rank(placed, share)
        count = len(self.free)
        jacobian = np.vstack([np.zeros((0, count))] + [rows for _, rows, _ in first])
        error = np.concatenate([np.zeros(0)] + [each for _, _, each in first])
        posture = np.eye(count)[ROOT_COORDINATES:], self.posture.at(share) - placed.posture.joints
        return [(jacobian, error), self.second_rank(placed, share), posture]

    def residuals(self, placed, share):
        """[Residual] of the first rank."""
        return [Residual(of, float(np.abs(error[:3]).max()), float(np.abs(error[3:]).max()) if len(error) > 3 else 0.0)
                for of, _, error in self.first_rank(placed, share)]
