"""Motions as CSV files for blem_sim_run --trajectory and scripts/ros/play_trajectory, and how they set out and arrive."""
import csv


def smooth(t, start, end):
    """0 before start, 1 after end, in between a polynomial of degree 5 without a jump in acceleration."""
    s = min(max((t - start) / (end - start), 0.0), 1.0)
    return s * s * s * (10 - 15 * s + 6 * s * s)


def rates(rows, k):
    """Velocities by joint in a row of a motion, from the rows on both sides; 0 at its ends."""
    (t0, before), (t1, after) = rows[max(0, k - 1)], rows[min(len(rows) - 1, k + 1)]
    still = k in (0, len(rows) - 1)
    return {name: 0.0 if still else (after[name] - before[name]) / (t1 - t0) for name in rows[k][1]}


def write_trajectory(path, rows):
    """A list of (time, positions by joint) for --trajectory, with velocities from differences: the run goes along cubics."""
    names = list(rows[0][1])
    with open(str(path), "w") as stream:
        table = csv.writer(stream)
        table.writerow(["time"] + names + [name + "_vel" for name in names])
        for k, (time, positions) in enumerate(rows):
            velocities = rates(rows, k)
            table.writerow(["%.6f" % time] + ["%.9f" % positions[name] for name in names] + ["%.9f" % velocities[name] for name in names])
