"""How near links come to the world and to each other along a motion: asked of the simulator's own search for contacts, by its Python module."""
import collections

import numpy as np
from sweeping.checked_yaml import InputError

from planning.robot_model import quaternion
from planning.simulation import simulator
from planning.tasks import RISEN, SINKS

SEEN = 0.02      # [m] beyond the clearance that is asked for, within which gaps are told
NEAR_JOINTS = 2  # joints between links that cross as they bend, as a shin and a foot do at an ankle that turns about two axes

# The least gap of some samples: [m] between layers, the link, what it comes near to ("model::link"), and the number of the sample.
Gap = collections.namedtuple("Gap", "metres link other sample")


class Clearance:
    """A robot among the things of its configuration. Raises InputError where there is no simulator, or it refuses the configuration."""

    def __init__(self, motion, robot, packages):
        self.wanted = motion.clearance
        if robot.name is None:
            raise InputError("%s: clearance: a URDF has no world; name a configuration, or leave the key out" % motion.file)
        self.prefix, self.model = robot.name + "::", robot.model
        self.scene = simulator("clearance", motion.file, robot.file, packages).clearance(robot.name)
        self.rows = [self.model.links.index(link) for link in self.scene.links]
        self.names = self.scene.colliders

    def approaches(self, placed, distance):
        """[(link, other, gap [m], crossed)] of pairs whose layers are within a distance [m], links at one joint of several axes left out."""
        poses = [np.append(placed.positions[row], quaternion(placed.rotations[row])) for row in self.rows]
        rows = [(self.names[row["a"]][len(self.prefix):], self.names[row["b"]], float(row["gap"]), bool(row["crossed"]))
                for row in self.scene.find(np.array(poses), distance)]
        return [row for row in rows if not row[1].startswith(self.prefix) or self.model.joints_apart(row[0], row[1][len(self.prefix):]) > NEAR_JOINTS]

    def least_gap(self, placed, touching):
        """The Gap of one posture that is smallest beside what is allowed, and whether it is less than that, or None if all is far away. Links that
        touch, and links of the robot among each other, may come as near as they like, but bare meshes may not cross."""
        found = None
        for link, other, gap, crossed in self.approaches(placed, self.wanted + SEEN):
            free = other.startswith(self.prefix) or link in touching
            if crossed or not free:
                found = min(found or (np.inf,), (gap, link, other, crossed or gap < self.wanted), key=lambda each: each[0])
        return found

    def along(self, placed, touching_at):
        """(Gap, whether it is too small) over the samples of a phase; (None, False) if nothing comes near. @param touching_at function of a
        sample's number: links that may touch then"""
        worst, number = None, None
        for k, each in enumerate(placed):
            found = self.least_gap(each, touching_at(k))
            if found and (worst is None or found[0] < worst[0]):
                worst, number = found, k
        return (Gap(worst[0], worst[1], worst[2], number), worst[3]) if worst else (None, False)


def touching(model, contacts, holding, phase, share):
    """Links that may touch the world at a share of a phase: those of contacts that hold, that rise or come down, and what hangs on them."""
    names = list(holding)
    for name, way in phase.ways.items():
        lifted = way.lift.any()
        if not lifted or share <= RISEN or share >= SINKS:
            names.append(name)
    names += [name for name in phase.release if share <= RISEN]
    return {below for name in names for below in model.links_below(contacts[name].link)}
