"""Recorded tosses of a cube: poses at 148 Hz as arrays of one row per toss, NaN behind a toss's last sample."""
import csv

import numpy as np

RATE = 148.0  # [Hz] of the recording
SIDE, MASS, INERTIA = 0.1048, 0.37, 0.00081  # [m], [kg], [kg m^2] nominal
CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)  # of a cube of side 2


class Tosses:
    """position [n, samples, 3] of the cube's middle, turn [n, samples, 4] its orientation (w x y z), velocity and spin at the first sample.

    In the recording's own units. samples[k]: how many samples toss k has.
    """

    def __init__(self, position, turn, velocity, spin, samples):
        self.position, self.turn, self.velocity, self.spin, self.samples = position, turn, velocity, spin, samples

    def __len__(self):
        return len(self.samples)

    def __getitem__(self, rows):
        return Tosses(self.position[rows], self.turn[rows], self.velocity[rows], self.spin[rows], self.samples[rows])


def read_tosses(path):
    """All tosses of a CSV: toss, time, x y z, qw qx qy qz, vx vy vz, wx wy wz (velocity of the middle and spin, world axes)."""
    with open(str(path)) as stream:
        rows = np.array([[float(x) for x in row] for row in list(csv.reader(stream))[1:]])
    tosses = [rows[rows[:, 0] == number] for number in np.unique(rows[:, 0])]
    samples = np.array([len(toss) for toss in tosses])
    table = np.full((len(tosses), samples.max(), rows.shape[1]), np.nan)
    for k, toss in enumerate(tosses):
        table[k, :len(toss)] = toss
    return Tosses(table[:, :, 2:5], table[:, :, 5:9], table[:, 0, 9:12], table[:, 0, 12:15], samples)


def product(a, b):
    """Of quaternions (w x y z), along the last axis."""
    w = a[..., 0] * b[..., 0] - np.sum(a[..., 1:] * b[..., 1:], axis=-1)
    v = a[..., :1] * b[..., 1:] + b[..., :1] * a[..., 1:] + np.cross(a[..., 1:], b[..., 1:])
    return np.concatenate([w[..., None], v], axis=-1)


def conjugate(q):
    return q * np.array([1.0, -1.0, -1.0, -1.0])


def rotated(q, v):
    """v turned by q."""
    return v + 2 * np.cross(q[..., 1:], np.cross(q[..., 1:], v) + q[..., :1] * v)


def quaternion_of(vector):
    """Of a rotation vector [rad]."""
    half = 0.5 * np.linalg.norm(vector, axis=-1, keepdims=True)
    return np.concatenate([np.cos(half), 0.5 * np.sinc(half / np.pi) * vector], axis=-1)


def vector_of(q):
    """The shorter rotation vector [rad] of a quaternion."""
    q = np.where(q[..., :1] < 0, -q, q)
    sine = np.linalg.norm(q[..., 1:], axis=-1, keepdims=True)
    angle = 2 * np.arctan2(sine, q[..., :1])
    return np.where(sine > 1e-12, angle / np.maximum(sine, 1e-300), 2.0) * q[..., 1:]


def corner_heights(position, turn, side):
    """[..., 8] of the cube's corners."""
    return position[..., None, 2] + rotated(turn[..., None, :], 0.5 * side * CORNERS)[..., 2]


def misses(tosses, position, turn, side):
    """Mean distance over the side, and mean angle [deg], of each toss; its first sample is not counted."""
    distance = np.linalg.norm(position - tosses.position, axis=-1)[:, 1:] / side
    angle = np.degrees(np.linalg.norm(vector_of(product(conjugate(tosses.turn), turn)), axis=-1))[:, 1:]
    return np.nanmean(distance, axis=1), np.nanmean(angle, axis=1)
