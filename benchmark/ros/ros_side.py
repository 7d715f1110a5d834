#!/usr/bin/python3
"""What publishing takes of the node's step, in real use: roscore, the node under roslaunch, subscribers in another process.

Usage: ros_side.py OUT.csv [SECONDS a run]     expects the built package on this shell
hubo_plane of the shared data at 1 kHz of wall time; joint states and four wrenches at every step, contact markers at 100 Hz. Runs with
and without subscribers take turns. Says so and writes nothing if the shared data are not here.
"""
import sys

from node_runs import measure, on_a_master, write_table
from scene_runs import world
from shared_data import shared_data

WRENCHES = ["LF_ForceSensor", "RF_ForceSensor", "LH_ForceSensor", "RH_ForceSensor"]
RATES = {"joint_state_rate": 0, "marker_rate": 100}  # [Hz], 0 = every step
TOPICS = ["/joint_states", "/blem_sim/contact_markers"] + ["/" + name for name in WRENCHES]
ROUNDS = 3  # of each kind
# us a step; "cpu" is processor time, the others wall time. The step is all that its thread does but publishing.
COLUMNS = ["subscribers", "steps", "step_cpu_us", "publish_cpu_us", "publish_over_step_cpu", "stages_us", "publish_us", "other_threads_cpu_us",
           "real_time_factor", "messages_per_step"]


def run(config_file, duration, topics):
    """One row."""
    run = measure(config_file, duration, topics)
    used = {thread: 1e6 * seconds / run.steps for thread, seconds in run.threads.items()}
    step = used.pop(run.pid) - run.published_cpu
    return [len(topics), run.steps, step, run.published_cpu, run.published_cpu / step, run.stages, run.published, sum(used.values()), run.factor,
            run.heard / run.steps]


def main(out, duration):
    if shared_data("worlds") is None:
        print("ros_side: skipped, the shared data are not here (set BLEM_SIM_SHARED_DATA to their folder)")
        return
    config = dict(world("hubo_plane"), **RATES)
    for sensor in config["robots"][0]["sensors"]:
        sensor["rate"] = 0
    with on_a_master() as written:
        config_file = written(config)
        write_table(out, COLUMNS, [run(config_file, duration, topics) for _ in range(ROUNDS) for topics in ([], TOPICS)])


if __name__ == "__main__":
    if len(sys.argv) in (2, 3):
        main(sys.argv[1], float(sys.argv[2]) if len(sys.argv) == 3 else 10.0)
    else:
        sys.exit(__doc__)
