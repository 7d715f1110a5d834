"""Runs that wait are begun, and what has ended is taken into the store, until nothing is left."""
import os
import time

from sweeping.checked_yaml import InputError
from sweeping.execution import DIED, DONE, TIMED_OUT, write_json
from sweeping.figures import MissingFigure, figure_of, figures_of, violated
from sweeping.store import RUNNING, WAITING

TRIED_AGAIN = (DIED, TIMED_OUT)
ENVIRONMENT = ("ROS_PACKAGE_PATH", "LD_LIBRARY_PATH")  # of this shell, for runs elsewhere


class FirstFailure(Exception):
    """A run failed, and none is wanted after that."""


class Collection:
    """What is left to do of a sweep. @param options timeout, retry, stop_on_failure, again"""

    def __init__(self, sweep, runs, store, options):
        self.sweep, self.store, self.options = sweep, store, options
        self.runs = {run.key: run for run in runs}
        self.tries = dict.fromkeys(self.runs, 0)
        self.waiting, self.running, self.failed = [], set(), 0
        self.paths_are_known = False

    def resume(self, runner):
        """Takes up what an earlier call left: what has ended since, what goes on, what has to begin again."""
        for key, (status, job) in self.store.states().items():
            if key not in self.runs:
                continue
            folder = self.store.run_folder(key)
            ended = self.store.outcome(key) if status == RUNNING else None
            if self.options.again or (status in TRIED_AGAIN and self.options.retry) or (status == DONE and self.store.report(key) is None):
                self.wait(key)
            elif ended:
                self.take(ended)
            elif status == RUNNING and runner.adopt(key, job, folder):
                self.running.add(key)
            elif status in (WAITING, RUNNING):
                self.wait(key)
            else:
                self.judge(key, status)
        self.waiting.sort(key=lambda key: self.runs[key].number)

    def wait(self, key):
        self.store.wait_again(key)
        self.waiting.append(key)

    def work(self, runner, progress):
        """Until all runs have ended. Raises FirstFailure, InputError for figures that no report has."""
        while self.waiting or self.running:
            if self.options.stop_on_failure and self.failed:
                raise FirstFailure()
            self.begin(runner)
            for outcome in runner.ended():
                self.running.discard(outcome["key"])
                self.take(outcome)
            progress.show(self)
            time.sleep(runner.period)

    def begin(self, runner):
        batch = self.waiting[: max(runner.free(), 0)]
        if not batch:
            return
        del self.waiting[: len(batch)]
        for key in batch:
            self.prepare(key)
        self.running.update(batch)  # first: an interrupt from here on lets them wait again
        self.store.begin(runner.start({key: self.store.run_folder(key) for key in batch}))

    def prepare(self, key):
        """Writes what a run's folder begins with."""
        folder = self.store.run_folder(key)
        folder.mkdir(exist_ok=True)
        for name in ("outcome.json", "stop"):
            if (folder / name).exists():
                (folder / name).unlink()
        environment = {name: os.environ[name] for name in ENVIRONMENT if name in os.environ}
        write_json(folder / "task.json", {"key": key, "command": self.runs[key].command, "timeout": self.options.timeout, "environment": environment})
        self.tries[key] += 1

    def take(self, outcome):
        """Records how a run ended, or lets it wait again."""
        key = outcome["key"]
        self.store.record(outcome)
        if outcome["status"] in TRIED_AGAIN and self.tries[key] <= self.options.retry:
            self.wait(key)
        else:
            self.judge(key, outcome["status"])

    def judge(self, key, status):
        """Takes the figures out of a report that is done; counts runs that failed."""
        passed, figures = False, {}
        if status == DONE:
            report = self.store.report(key)
            self.require_known_paths(report)
            figures = figures_of(report, self.sweep.measure)
            passed = not violated(figures, self.sweep.require)
        self.store.record_figures(key, figures, passed)
        self.failed += not passed

    def require_known_paths(self, report):
        """Raises InputError if the first report has no such figures; those of later ones may lack some."""
        if self.paths_are_known:
            return
        for name, path in self.sweep.measure.items():
            try:
                figure_of(report, path)
            except MissingFigure as problem:
                raise InputError("%s: measure.%s: %s: %s" % (self.sweep.file, name, path, problem))
        self.paths_are_known = True
