#!/usr/bin/python3
"""A depth camera of 640 x 480 pixels at 30 Hz in the head of a humanoid that stands before a scan of a million triangles, in real time:
images that another process gets, without noise and with a Kinect's.

Usage: camera_side.py OUT.csv [SECONDS a run]     expects the built package on this shell
Says so and writes nothing if the shared data are not here.
"""
import sys

from node_runs import measure, on_a_master, write_table
from scene_runs import world
from shared_data import shared_data

CAMERA = {"name": "eyes", "type": "depth_camera", "link": "Body_HNP", "pose": {"xyz": [0.06, 0, 0.05], "rpy": [0, 0.5, 0]}, "width": 640,
          "height": 480, "hfov": 1.0, "range": [0.4, 5], "rate": 30}
NOISE = {"none": {}, "kinect": {"noise": {"model": "kinect"}}}
COLUMNS = ["noise", "images_per_second", "real_time_factor", "step_us", "step_processors", "other_processors"]


def run(written, noise, duration):
    """One row. Processors: processor time over wall time, of the stepping thread and of all others of the node."""
    config = dict(world("paper_hubo_stepladder_1m"), real_time_factor=1.0)
    config["robots"][0]["sensors"].append(dict(CAMERA, **NOISE[noise]))
    run = measure(written(config), duration, ["/eyes/depth/image_raw"])
    step = run.threads.pop(run.pid)
    return [noise, run.heard / run.seconds, run.factor, run.stages, step / run.seconds, sum(run.threads.values()) / run.seconds]


def main(out, duration):
    if shared_data("worlds") is None:
        print("camera_side: skipped, the shared data are not here (set BLEM_SIM_SHARED_DATA to their folder)")
        return
    with on_a_master() as written:
        write_table(out, COLUMNS, [run(written, noise, duration) for noise in NOISE])


if __name__ == "__main__":
    if len(sys.argv) in (2, 3):
        main(sys.argv[1], float(sys.argv[2]) if len(sys.argv) == 3 else 15.0)
    else:
        sys.exit(__doc__)
