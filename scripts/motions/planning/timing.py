"""How long a phase takes: as long as asked, longer where a joint would be too fast or the centre of mass too quick for a robot that counts as at
rest."""
import math

import numpy as np

LEAST_SWAY = 0.005   # [m] that accelerations may always shift the centre of pressure by
SPARE = 1.002        # beyond what is needed, since samples lie elsewhere
MOST_TRIES = 4
LEAP = 1.3           # how much longer a phase may have to be after it was made as long as needed, where its way has no leap
LONGEST = 3600.0     # [s]


def timed(planner, phase, samples_at, ground):
    """(placed robots at the samples, duration [s], (share, joint) of the largest speed). @param samples_at function of shares of the phase
    @param ground height [m] of the lowest contact, None if nothing holds"""
    motion, duration = planner.motion, phase.duration
    for tried in range(MOST_TRIES):
        count = max(2, int(math.ceil(duration * motion.rate - 1e-9)))
        duration = count / motion.rate
        placed = samples_at([(k + 1) / count for k in range(count)])
        way = [planner.placed] + placed
        share, joint = largest_speed(planner.model, way, 1 / motion.rate)
        longer = max(share / motion.speed, math.sqrt(sway(planner, way, ground) / max(0.5 * motion.margin, LEAST_SWAY)))
        if longer <= 1:
            return placed, duration, (share, joint)
        if tried and longer > LEAP:
            break
        duration *= longer * SPARE
        if duration > LONGEST:
            planner.refuse(phase.name, "joint '%s' would need %.0f s; raise its velocity limit or 'speed'" % (joint, duration))
    planner.refuse(phase.name, "joint '%s' leaps from one sample to the next, whatever the time; %schange the height of the body (body:"
                   " {rise: ...}), bring the contacts closer, or write com: with less of a shift" % (joint, planner.limits_met(way)))


def largest_speed(model, way, step):
    """(share of its velocity limit, joint) of the fastest joint along the cubics through samples, at rest at both ends."""
    joints = np.array([placed.posture.joints for placed in way])
    means = np.diff(joints, axis=0) / step
    knots = np.zeros_like(joints)
    knots[1:-1] = (joints[2:] - joints[:-2]) / (2 * step)
    middles = 1.5 * means - 0.25 * (knots[1:] + knots[:-1])
    shares = np.maximum(np.abs(knots).max(axis=0), np.abs(middles).max(axis=0)) / model.velocity
    if not len(shares):
        return 0.0, None
    fastest = int(np.argmax(shares))
    return float(shares[fastest]), model.joint_names[fastest]


def sway(planner, way, ground):
    """How far [m] accelerations of the centre of mass shift the centre of pressure, at most."""
    if planner.model.fixed or ground is None:
        return 0.0
    centres = np.array([placed.centre_of_mass for placed in way])
    centres = np.vstack([centres[:1], centres, centres[-1:]])  # at rest before and after
    accelerations = np.linalg.norm(centres[2:, :2] - 2 * centres[1:-1, :2] + centres[:-2, :2], axis=1) * planner.motion.rate ** 2
    return float((accelerations * (centres[1:-1, 2] - ground)).max() / planner.robot.gravity)
