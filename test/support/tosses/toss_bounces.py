"""The inertia of a tossed cube from bounces on one corner between two flights: angular momentum about it stays, whatever the law."""
import numpy as np

from tosses import CORNERS, RATE, corner_heights, product, quaternion_of, rotated
from toss_identification import CLEARANCE, SHORTEST, fit_starts, flights

ALONE = 0.006  # [m] that the second corner is above the one that touches, at least
MEETING = 0.002  # [m] of the touching corner, at most, between the two flights where they meet
LONGEST = 3  # samples from the end of the first flight to where they meet, at most
ROUNDS = 20


def second_flights(tosses, end, side):
    """Begin and end of the flight behind the first touch; the same sample where there is none."""
    clear = corner_heights(tosses.position, tosses.turn, side).min(axis=-1) > CLEARANCE
    behind = np.arange(clear.shape[1]) >= end[:, None]
    begin = np.argmax(clear & behind, axis=1)
    down = ~clear & (np.arange(clear.shape[1]) > begin[:, None])
    return begin, np.where((clear & behind).any(axis=1), np.where(down.any(axis=1), np.argmax(down, axis=1), tosses.samples), begin)


class Coasting:
    """Free flights after times [n] from their starts: centre of mass, its velocity, corners, and their velocities."""

    def __init__(self, starts, cube, time):
        arm = rotated(starts.turn, np.broadcast_to(cube.com, starts.position.shape))
        t = time[:, None]
        start = starts.velocity + np.cross(starts.spin, arm)
        self.spin, self.velocity = starts.spin, start + t * cube.gravity
        self.place = starts.position + arm + t * start + 0.5 * t**2 * cube.gravity
        turn = product(quaternion_of(t * starts.spin), starts.turn)
        self.corners = self.place[:, None] + rotated(turn[:, None], 0.5 * cube.side * CORNERS - cube.com)

    def corner(self, index):
        """Place and velocity of one corner of each."""
        at = self.corners[np.arange(len(index)), index]
        return at, self.velocity + np.cross(self.spin, at - self.place)


def inertia_over_mass(tosses, cube):
    """[m^2], the same about all axes, by least squares over all bounces on one corner; and how many these are."""
    end = flights(tosses, cube.side)
    begins, ends = second_flights(tosses, end, cube.side)
    kept = (end >= SHORTEST) & (ends - begins >= SHORTEST)
    tosses, end, begins, ends = tosses[kept], end[kept], begins[kept], ends[kept]
    before, after = fit_starts(tosses, cube, np.zeros(len(end), int), end), fit_starts(tosses, cube, begins, ends)
    time = end / RATE
    lowest = Coasting(before, cube, time).corners[..., 2].argmin(axis=1)
    for _ in range(ROUNDS):  # to where the corner's two paths are at the same height
        then, now = Coasting(after, cube, time - begins / RATE), Coasting(before, cube, time)
        (here, approach), (there, departure) = now.corner(lowest), then.corner(lowest)
        change = (here - there)[:, 2] / (departure - approach)[:, 2]
        time = time + np.clip(change, -1 / RATE, 1 / RATE)
    heights = np.sort(now.corners[..., 2], axis=1)
    used = (heights[:, 1] - heights[:, 0] > ALONE) & (np.linalg.norm(here - there, axis=1) < MEETING)
    used &= np.abs(time - end / RATE) < LONGEST / RATE
    kick, spin = np.cross(here - now.place, then.velocity - now.velocity)[used], (after.spin - before.spin)[used]
    return float(np.sum(kick * spin) / np.sum(spin * spin)), int(used.sum())
