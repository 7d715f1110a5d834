"""What a recorded cube is and how each toss began, from its flights alone: no law of contact is asked."""
import numpy as np

from tosses import INERTIA, MASS, RATE, SIDE, conjugate, corner_heights, product, quaternion_of, rotated, vector_of

GRAVITY = 9.81  # [m/s^2] where the tosses were made
CLEARANCE = 0.002  # [m] of the lowest corner above the floor: less may have touched
SHORTEST = 6  # samples of a flight that tell something
ROUNDS = 3  # of Gauss and Newton's method


class Cube:
    """In the recording's units: side, gravity [3], centre of mass from the middle [3], mass, inertia / mass (the same about all axes)."""

    def __init__(self, side=SIDE, gravity=(0, 0, -GRAVITY), com=(0, 0, 0), inertia=INERTIA / MASS):
        self.side, self.gravity, self.com, self.mass = side, np.array(gravity, float), np.array(com, float), MASS
        self.inertia = inertia


class Starts:
    """Of each toss: position and velocity of the middle, orientation, spin (world axes), at one of its samples."""

    def __init__(self, position, velocity, turn, spin):
        self.position, self.velocity, self.turn, self.spin = position, velocity, turn, spin

    def __getitem__(self, rows):
        return Starts(self.position[rows], self.velocity[rows], self.turn[rows], self.spin[rows])


def recorded_starts(tosses):
    """The first samples."""
    return Starts(tosses.position[:, 0].copy(), tosses.velocity.copy(), tosses.turn[:, 0].copy(), tosses.spin.copy())


def flights(tosses, side):
    """Up to which sample of each toss nothing may have touched."""
    clear = corner_heights(tosses.position, tosses.turn, side).min(axis=-1) > CLEARANCE
    return np.argmin(np.concatenate([clear, np.zeros((len(tosses), 1), bool)], axis=1), axis=1)


class Flights:
    """Samples [begin, end) of each toss, in which nothing touches it, as arrays from the first one on."""

    def __init__(self, tosses, begin, end):
        length = int((end - begin).max())
        places = np.minimum(begin[:, None] + np.arange(length), tosses.samples[:, None] - 1)
        rows = np.arange(len(tosses))[:, None]
        self.within = np.arange(length) < (end - begin)[:, None]
        self.position, self.turn = tosses.position[rows, places], tosses.turn[rows, places]
        self.times = np.arange(length) / RATE


def fit_turns(flown):
    """Orientations at the start of each flight and spins (world axes), by least squares: these stay, as the inertia has no axes."""
    rows, last = np.arange(len(flown.turn)), flown.within.sum(axis=1) // 2
    turn = flown.turn[:, 0]
    spin = vector_of(product(flown.turn[rows, last], conjugate(turn))) * RATE / last[:, None]

    def residuals(change):
        path = product(quaternion_of((spin + change[:, 3:])[:, None] * flown.times[:, None]),
                       product(quaternion_of(change[:, :3]), turn)[:, None])
        return np.where(flown.within[..., None], vector_of(product(path, conjugate(flown.turn))), 0)

    step, none = 1e-5, np.zeros((len(turn), 6))
    for _ in range(ROUNDS):
        left = residuals(none)
        slopes = np.stack([((residuals(none + step * axis) - left) / step).reshape(len(turn), -1) for axis in np.eye(6)], axis=-1)
        change = -(np.linalg.pinv(slopes) @ left.reshape(len(turn), -1, 1))[..., 0]
        turn, spin = product(quaternion_of(change[:, :3]), turn), spin + change[:, 3:]
    return turn, spin


def fit_paths(flown, known=None):
    """Gravity and centre of mass, in one array, and position and velocity of the centre of mass at each start.

    known: that array, where it is not to be fitted. The path of the middle is p + v t + g t^2 / 2 - R com.
    """
    weight, t = flown.within.astype(float), flown.times
    basis = np.stack([weight, weight * t], axis=-1)
    solve = np.linalg.pinv(basis)

    def beside(values):  # what position and velocity do not explain
        values = values * weight[..., None]
        return values - basis @ (solve @ values)

    columns = [np.broadcast_to(-0.5 * t[:, None]**2 * axis, flown.position.shape) for axis in np.eye(3)]
    columns += [rotated(flown.turn, np.broadcast_to(axis, flown.position.shape)) for axis in np.eye(3)]
    if known is None:
        matrix = np.stack([beside(column).ravel() for column in columns], axis=-1)
        known = np.linalg.lstsq(matrix, -beside(flown.position).ravel(), rcond=None)[0]
    path = flown.position + sum(k * column for k, column in zip(known, columns))
    position, velocity = np.swapaxes(solve @ (path * weight[..., None]), 0, 1)
    return known, position, velocity


def fit_starts(tosses, cube, begin, end):
    """Starts at the sample `begin` of each toss, from its flight up to `end`."""
    flown = Flights(tosses, begin, end)
    turn, spin = fit_turns(flown)
    _, position, velocity = fit_paths(flown, np.concatenate([cube.gravity, cube.com]))
    arm = rotated(turn, np.broadcast_to(cube.com, position.shape))
    return Starts(position - arm, velocity - np.cross(spin, arm), turn, spin)


def fitted_starts(tosses, cube):
    """Starts from whole flights before the first touch, and the recorded ones of tosses that fly too shortly."""
    end = flights(tosses, cube.side)
    starts, flown = recorded_starts(tosses), end >= SHORTEST
    fitted = fit_starts(tosses[flown], cube, np.zeros(int(flown.sum()), int), end[flown])
    for name in ("position", "velocity", "turn", "spin"):
        getattr(starts, name)[flown] = getattr(fitted, name)
    return starts


def identify_flight(tosses):
    """The cube of all tosses in the recording's units, but for its inertia: gravity tells the scale."""
    end = flights(tosses, SIDE)
    kept = end >= SHORTEST
    known = fit_paths(Flights(tosses[kept], np.zeros(int(kept.sum()), int), end[kept]))[0]
    return Cube(SIDE * float(np.linalg.norm(known[:3])) / GRAVITY, known[:3], known[3:])
