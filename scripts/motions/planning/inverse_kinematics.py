"""Inverse kinematics by damped least squares: tasks of a lower rank give way to those of a higher one, joints stay within their limits."""
import numpy as np

from planning.robot_model import ROOT_COORDINATES

# Squares of the damping of singular values by rank: a constant, and what the length of the error adds, since a task that stays unserved would make
# steps leap where it has little way left [Sugihara 2011].
DAMPING = ((1e-6, 0.0), (1e-3, 2.0), (0.1, 0.3))
KEPT = 1e-3          # singular value from which on a direction belongs to its rank, and lower ones leave it alone
LONGEST_STEP = (0.2, 0.05, 0.05)  # [m, rad] of a coordinate in one round, by rank
SMALL_STEP = 1e-7    # [m, rad] at which the descent ends; what is left is of the order of its square
LAST_ROUNDS = 20     # at most, for the first rank alone
AT_LIMIT = 1e-6      # [rad or m] from a limit


def ranked_step(ranks, step, room):
    """The step of the coordinates that serves tasks in the order of their ranks. @param ranks list of (Jacobian, error)
    @param step what is decided already @param room diagonal matrix of the coordinates that are still free"""
    for (constant, slope), longest, (jacobian, error) in zip(DAMPING, LONGEST_STEP, ranks):
        if not len(error):
            continue
        damping = constant + slope * np.linalg.norm(error)
        left, values, right = np.linalg.svd(jacobian @ room, full_matrices=False)
        added = room @ (right.T @ (values / (values ** 2 + damping) * (left.T @ (error - jacobian @ step))))
        step = step + added * min(1.0, longest / max(np.abs(added).max(), 1e-12))
        kept = right[values > KEPT]
        room = room - kept.T @ kept
    return step


def bounded_step(model, posture, ranks, free):
    """A step that leaves no joint beyond its limits: those that would be are put on them, and the others serve the tasks."""
    step, room = np.zeros(len(free)), np.diag(free.astype(float))
    for _ in range(len(model.joint_names)):
        wanted = ranked_step(ranks, step, room)
        ahead = posture.joints + wanted[ROOT_COORDINATES:]
        beyond = ((ahead < model.lower) | (ahead > model.upper)) & (np.diag(room)[ROOT_COORDINATES:] > 0)
        if not beyond.any():
            return wanted
        for joint in np.flatnonzero(beyond):
            step[ROOT_COORDINATES + joint] = np.clip(ahead[joint], model.lower[joint], model.upper[joint]) - posture.joints[joint]
            room[ROOT_COORDINATES + joint, ROOT_COORDINATES + joint] = 0.0
    return wanted


def reach(model, posture, ranks_in, free, rounds):
    """A posture near the given one that serves tasks: so many rounds for all ranks, then the first rank to the end.

    @param ranks_in function of a PlacedRobot: its ranks, as for ranked_step @param free coordinates that may change"""
    for count, most in ((None, rounds), (1, LAST_ROUNDS)):
        for _ in range(most):
            step = bounded_step(model, posture, ranks_in(model.place(posture))[:count], free)
            posture = posture.moved(step)
            posture.joints = np.clip(posture.joints, model.lower, model.upper)
            if np.abs(step).max() < SMALL_STEP:
                break
    return posture


def joints_at_limits(model, posture, free):
    """Names of the joints that stand at one of their limits, among the coordinates that may change."""
    at = free[ROOT_COORDINATES:] & ((posture.joints < model.lower + AT_LIMIT) | (posture.joints > model.upper - AT_LIMIT))
    return [name for name, is_at in zip(model.joint_names, at) if is_at]
