"""Tosses through blem_sim_run, all in one world, and through the engines of benchmark/tosses."""
import os
import pathlib
import subprocess
import tempfile

import numpy as np

import scene_runs
from shared_data import SOURCE_DIR
from tosses import CORNERS, RATE

STEPS = 10  # between samples
SPACING = 5.0  # [m] between tosses in one world
FACES = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))  # of CORNERS, seen from outside


def write_cube(path, side):
    with open(str(path), "w") as stream:
        stream.write("OFF\n8 12 0\n")
        for corner in 0.5 * side * CORNERS:
            stream.write("%.17g %.17g %.17g\n" % tuple(corner))
        for a, b, c, d in FACES:
            stream.write("3 %d %d %d\n3 %d %d %d\n" % (a, b, c, a, c, d))


def spots(count):
    """Where each toss has its own ground [count, 3]."""
    columns = int(np.ceil(np.sqrt(count)))
    k = np.arange(count)
    return SPACING * np.stack([k % columns, k // columns, 0 * k], axis=-1).astype(float)


def roll_pitch_yaw(q):
    w, x, y, z = q
    return [float(np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))), float(np.arcsin(np.clip(2 * (w * y - z * x), -1, 1))),
            float(np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)))]


def configuration(cube, starts, surface):
    """surface: contact settings, and floor [m]."""
    contact = {key: float(value) for key, value in surface.items() if key != "floor"}
    inertia = float(cube.mass * cube.inertia)
    ground = {"name": "floor", "plane": [0, 0, 1, float(surface["floor"])]}
    ground.update({key: value for key, value in contact.items() if key != "boundary_width"})
    objects = []
    for k, spot in enumerate(spots(len(starts.position))):
        objects.append({
            "name": "toss%d" % k, "uri": "cube.off", "mass": float(cube.mass), "com": [float(x) for x in cube.com],
            "inertia": [inertia, 0.0, 0.0, inertia, 0.0, inertia],
            "pose": {"xyz": [float(x) for x in starts.position[k] + spot], "rpy": roll_pitch_yaw(starts.turn[k])},
            "linear_velocity": [float(x) for x in starts.velocity[k]], "angular_velocity": [float(x) for x in starts.spin[k]]})
    return {"time_step": 1 / (STEPS * RATE), "gravity": [float(x) for x in cube.gravity], "contact": dict(contact, shrink=True),
            "environments": [ground], "objects": objects}


class BlemSim:
    """worlds: tosses of like length share one; their number changes nothing but the time it takes."""

    def __init__(self, worlds=1):
        self.worlds = worlds

    def replay(self, tosses, cube, starts, surface):
        """Positions [n, samples, 3] of the middle and orientations [n, samples, 4]; NaN behind the longest toss of a world."""
        position, turn = np.full_like(tosses.position, np.nan), np.full_like(tosses.turn, np.nan)
        for rows in np.array_split(np.argsort(tosses.samples, kind="stable"), self.worlds):
            length = int(tosses.samples[rows].max())
            position[rows, :length], turn[rows, :length] = self.in_one_world(length, cube, starts[rows], surface)
        return position, turn

    def in_one_world(self, samples, cube, starts, surface):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            write_cube(folder / "cube.off", cube.side)
            duration = (samples - 0.5) / RATE
            status, _, said = scene_runs.execute(folder, configuration(cube, starts, surface), duration,
                                                 ["--csv", str(folder / "poses.csv"), "--csv-rate", str(RATE)])
            if status:
                raise RuntimeError("exit %d: %s" % (status, said))
            rows = np.loadtxt(str(folder / "poses.csv"), delimiter=",", skiprows=1)[:, 1:]
        rows = rows.reshape(len(rows), len(starts.position), 7).swapaxes(0, 1)[:, :samples - 1]
        position = rows[..., :3] - spots(len(starts.position))[:, None]
        turn = rows[..., [6, 3, 4, 5]]
        return (np.concatenate([starts.position[:, None], position], axis=1), np.concatenate([starts.turn[:, None], turn], axis=1))


def peer_program():
    """toss_peers: BLEM_SIM_TOSS_PEERS, else that of scripts/build; None if there is none."""
    path = os.environ.get("BLEM_SIM_TOSS_PEERS", str(SOURCE_DIR / "build_release" / "toss_peers"))
    return path if os.access(path, os.X_OK) else None


def peer_names():
    program = peer_program()
    if program is None:
        return []
    return subprocess.run([program], stdout=subprocess.PIPE, universal_newlines=True, check=True).stdout.split()


class Peer:
    def __init__(self, name):
        self.name = name

    def replay(self, tosses, cube, starts, surface):
        settings = {key: value for key, value in surface.items() if key != "floor"}
        words = [1 / (STEPS * RATE), surface["floor"], cube.side, cube.mass, *cube.gravity, *cube.com, *3 * [cube.mass * cube.inertia],
                 len(settings)]
        for key, value in sorted(settings.items()):
            words += [key, value]
        words += [STEPS, len(tosses)]
        for k, samples in enumerate(tosses.samples):
            words += [samples, *starts.position[k], *starts.turn[k], *starts.velocity[k], *starts.spin[k]]
        done = subprocess.run([peer_program(), self.name], input=" ".join(str(word) for word in words), stdout=subprocess.PIPE,
                              universal_newlines=True, check=True)
        rows = np.array([[float(x) for x in line.split()] for line in done.stdout.splitlines()])
        position, turn = np.full_like(tosses.position, np.nan), np.full_like(tosses.turn, np.nan)
        first = 0
        for k, samples in enumerate(tosses.samples):
            position[k, 1:samples], turn[k, 1:samples] = rows[first:first + samples - 1, :3], rows[first:first + samples - 1, 3:]
            first += samples - 1
        return position, turn
