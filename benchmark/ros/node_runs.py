#!/usr/bin/python3
"""The node under roslaunch with subscribers in another process, for benchmarks of it. Run alone: counts messages of TOPIC ..."""
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
sys.path.insert(0, str(HERE.parents[1] / "test" / "support"))
from shared_data import shared_data  # noqa: E402

PORT = 11733
# Others want the processors too: wall time says little without it. Only root may.
URGENT = ["nice", "-n", "-15"] if os.geteuid() == 0 else []
SETTLE = 3.0  # [s]


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


def listen(topics):
    """The process of the subscribers: counts raw messages, without looking into them, until it is told to end."""
    import rospy
    rospy.init_node("listener", disable_rostime=True, disable_signals=True)
    counts = collections.Counter()
    for topic in topics:
        rospy.Subscriber(topic, rospy.AnyMsg, lambda _, topic=topic: counts.update([topic]), tcp_nodelay=True)
    with contextlib.suppress(KeyboardInterrupt):
        for _ in sys.stdin:  # a line asks for the counts so far
            print(sum(counts.values()), flush=True)


class Listener(object):
    """Counts messages of topics in another process, as long as the stack lives."""

    def __init__(self, stack, topics):
        self._process = stack.enter_context(running([sys.executable, __file__] + topics, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
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
                return xmlrpc.client.ServerProxy(api).getPid("/node_runs")[2]
        time.sleep(0.2)
    sys.exit("the node did not start within 60 s")


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


Measured = collections.namedtuple("Measured", "pid steps stages published published_cpu factor threads heard seconds")


def measure(config_file, duration, topics):
    """Runs a configuration. threads: processor time of each [s]; heard: messages of the topics; stages, published: mean of a step [us]."""
    with contextlib.ExitStack() as stack:
        stack.enter_context(running(URGENT + ["roslaunch", "blem_sim", "simulate.launch", "config:=" + config_file], stdout=subprocess.DEVNULL))
        pid = node_process()
        reports = Reports()
        listener = Listener(stack, topics) if topics else None
        time.sleep(SETTLE)
        while not reports.come():
            time.sleep(0.1)
        reports.clear()
        before, heard, start = thread_seconds(pid), listener.count() if listener else 0, time.time()
        time.sleep(duration)
        after, heard, seconds = thread_seconds(pid), (listener.count() if listener else 0) - heard, time.time() - start
        means = reports.means()
        reports.stop()
    return Measured(pid, *means, {thread: used - before.get(thread, 0.0) for thread, used in after.items()}, heard, seconds)


@contextlib.contextmanager
def on_a_master():
    """A roscore of its own until the block ends; gives a function that writes a configuration into a file and returns its path."""
    os.environ["ROS_MASTER_URI"] = "http://localhost:%d" % PORT
    os.environ["ROS_PACKAGE_PATH"] = "%s:%s" % (os.environ.get("ROS_PACKAGE_PATH", ""), shared_data("robots/klampt"))
    with tempfile.TemporaryDirectory() as folder, running(["roscore", "-p", str(PORT)], stdout=subprocess.DEVNULL):
        os.environ["ROS_LOG_DIR"] = folder
        import rospy
        time.sleep(3)
        rospy.init_node("node_runs", disable_rostime=True, disable_signals=True)

        def written(config):
            path = os.path.join(folder, "config.yaml")
            with open(path, "w") as stream:
                yaml.safe_dump(config, stream, sort_keys=False)
            return path

        yield written


def write_table(out, columns, rows):
    """Writes rows as CSV and prints them."""
    with open(out, "w") as stream:
        table = csv.writer(stream, lineterminator="\n")
        table.writerow(columns)
        for row in rows:
            table.writerow(["%.4g" % value if isinstance(value, float) else value for value in row])
            print(dict(zip(columns, row)))


if __name__ == "__main__":
    listen(sys.argv[1:])
