#!/usr/bin/python3
"""What publishing takes of the node's step, in real use: roscore, the node under roslaunch, subscribers in another process.

Usage: ros_side.py OUT.csv [SECONDS a run]     expects the built package on this shell
hubo_plane of the shared data at 1 kHz of wall time; joint states and four wrenches at every step, contact markers at 100 Hz. Runs with
and without subscribers take turns. Says so and writes nothing if the shared data are not here.
"""
import collections
import contextlib
import csv
import os
import pathlib
import signal
import statistics
import subprocess
import sys
import tempfile
import time
import xmlrpc.client

import yaml

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "test" / "support"))
from scene_runs import world  # noqa: E402
from shared_data import shared_data  # noqa: E402

PORT = 11733
WRENCHES = ["LF_ForceSensor", "RF_ForceSensor", "LH_ForceSensor", "RH_ForceSensor"]
RATES = {"joint_state_rate": 0, "marker_rate": 100}  # [Hz], 0 = every step
TOPICS = ["/joint_states", "/blem_sim/contact_markers"] + ["/" + name for name in WRENCHES]
# Others want the processors too: wall time says little without it. Only root may.
URGENT = ["nice", "-n", "-15"] if os.geteuid() == 0 else []
SETTLE, ROUNDS = 3.0, 3  # [s], runs of each kind
# us a step; "cpu" is processor time, the others wall time. The step is all that its thread does but publishing.
COLUMNS = ["subscribers", "steps", "step_cpu_us", "publish_cpu_us", "publish_over_step_cpu", "stages_us", "publish_us", "other_threads_cpu_us",
           "real_time_factor", "messages_per_step"]


@contextlib.contextmanager
def running(command, **options):
    """A process and all it started, until the block ends."""
    process = subprocess.Popen(command, start_new_session=True, **options)
    try:
        yield process
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGINT)
        try:
            process.wait(15)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)


def listen():
    """The process of the subscribers: counts raw messages, without looking into them, until it is told to end."""
    import rospy
    rospy.init_node("listener", disable_rostime=True, disable_signals=True)
    counts = collections.Counter()
    for topic in TOPICS:
        rospy.Subscriber(topic, rospy.AnyMsg, lambda _, topic=topic: counts.update([topic]), tcp_nodelay=True)
    with contextlib.suppress(KeyboardInterrupt):
        for _ in sys.stdin:  # a line asks for the counts so far
            print(sum(counts.values()), flush=True)


class Listener(object):
    def __init__(self, stack):
        self._process = stack.enter_context(running([sys.executable, __file__, "--listen"], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                                    universal_newlines=True, bufsize=1))

    def count(self):
        self._process.stdin.write("\n")
        self._process.stdin.flush()
        return int(self._process.stdout.readline())


def thread_seconds(pid):
    """Processor time of every thread of a process so far [s]."""
    seconds = {}
    for thread in pathlib.Path("/proc/%d/task" % pid).iterdir():
        with contextlib.suppress(FileNotFoundError):
            seconds[int(thread.name)] = int((thread / "schedstat").read_text().split()[0]) * 1e-9
    return seconds


def node_process():
    """Process id of the node."""
    import rospy
    master = rospy.get_master()
    deadline = time.time() + 60
    while time.time() < deadline:
        with contextlib.suppress(OSError):
            code, _, api = master.lookupNode("/blem_sim")
            if code == 1:
                return xmlrpc.client.ServerProxy(api).getPid("/ros_side")[2]
        time.sleep(0.2)
    sys.exit("ros_side: the node did not start within 60 s")


class Reports(object):
    """~step_report and /diagnostics since the last clear()."""

    def __init__(self):
        import rospy
        from blem_sim.msg import StepReport
        from diagnostic_msgs.msg import DiagnosticArray
        self._reports, self._published = [], []
        self._subscribers = [rospy.Subscriber("/blem_sim/step_report", StepReport, lambda report: self._reports.append(report)),
                             rospy.Subscriber("/diagnostics", DiagnosticArray, self._on_diagnostics)]

    def _on_diagnostics(self, message):
        for status in message.status:
            self._published += [1e3 * float(entry.value) for entry in status.values if entry.key == "publishing, processor time [ms]"]

    def come(self):
        return self._reports and self._published

    def clear(self):
        self._reports.clear()
        self._published.clear()

    def stop(self):
        for subscriber in self._subscribers:
            subscriber.unregister()

    def means(self):
        """(steps, stages [us], publishing [us], its processor time [us], real-time factor)."""
        reports = list(self._reports)
        steps = sum(report.steps for report in reports)
        mean = collections.Counter()
        for report in reports:
            for stage, seconds in zip(report.stages, report.stage_seconds):
                mean[stage] += 1e6 * seconds * report.steps / steps
        published = mean.pop("publish")
        factor = statistics.mean(report.real_time_factor for report in reports)
        return steps, sum(mean.values()), published, statistics.mean(self._published), factor


def run(config_file, duration, subscribes):
    """One row."""
    with contextlib.ExitStack() as stack:
        stack.enter_context(running(URGENT + ["roslaunch", "blem_sim", "simulate.launch", "config:=" + config_file], stdout=subprocess.DEVNULL))
        pid = node_process()
        reports = Reports()
        listener = Listener(stack) if subscribes else None
        time.sleep(SETTLE)
        while not reports.come():
            time.sleep(0.1)
        reports.clear()
        before, heard = thread_seconds(pid), listener.count() if listener else 0
        time.sleep(duration)
        after, heard = thread_seconds(pid), (listener.count() if listener else 0) - heard
        steps, stages, published, published_cpu, factor = reports.means()
        reports.stop()
    used = {thread: 1e6 * (seconds - before.get(thread, 0.0)) / steps for thread, seconds in after.items()}
    step = used.pop(pid) - published_cpu
    return [len(TOPICS) if subscribes else 0, steps, step, published_cpu, published_cpu / step, stages, published, sum(used.values()), factor,
            heard / steps]


def main(out, duration):
    if shared_data("worlds") is None:
        print("ros_side: skipped, the shared data are not here (set BLEM_SIM_SHARED_DATA to their folder)")
        return
    os.environ["ROS_MASTER_URI"] = "http://localhost:%d" % PORT
    os.environ["ROS_PACKAGE_PATH"] = "%s:%s" % (os.environ.get("ROS_PACKAGE_PATH", ""), shared_data("robots/klampt"))
    config = dict(world("hubo_plane"), **RATES)
    for sensor in config["robots"][0]["sensors"]:
        sensor["rate"] = 0
    with tempfile.TemporaryDirectory() as folder, running(["roscore", "-p", str(PORT)], stdout=subprocess.DEVNULL):
        os.environ["ROS_LOG_DIR"] = folder
        config_file = os.path.join(folder, "hubo_plane.yaml")
        with open(config_file, "w") as stream:
            yaml.safe_dump(config, stream, sort_keys=False)
        import rospy
        time.sleep(3)
        rospy.init_node("ros_side", disable_rostime=True, disable_signals=True)
        rows = [run(config_file, duration, subscribes) for _ in range(ROUNDS) for subscribes in (False, True)]
    with open(out, "w") as stream:
        table = csv.writer(stream, lineterminator="\n")
        table.writerow(COLUMNS)
        for row in rows:
            table.writerow(["%.4g" % value if isinstance(value, float) else value for value in row])
            print(dict(zip(COLUMNS, row)))


if __name__ == "__main__":
    if sys.argv[1:] == ["--listen"]:
        listen()
    elif len(sys.argv) in (2, 3):
        main(sys.argv[1], float(sys.argv[2]) if len(sys.argv) == 3 else 10.0)
    else:
        sys.exit(__doc__)
