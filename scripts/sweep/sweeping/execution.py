#!/usr/bin/python3
"""Executes one run in its folder: task.json says what, report.json and log.txt are left, and outcome.json tells, last, how it ended.

A file `stop` in the folder ends the run without an outcome.

Usage: execution.py FOLDER    on a node of a cluster that shares the folder; needs nothing but Python
"""
import ctypes
import json
import os
import pathlib
import signal
import subprocess
import sys
import time

DONE, REFUSED, NOT_FINITE, TIMED_OUT, DIED = "done", "refused", "not finite", "timed out", "died"
STATUS_OF_EXIT = {0: DONE, 2: REFUSED, 3: NOT_FINITE}
POLL_PERIOD = 0.005  # [s]
GRACE = 2.0  # [s] between asking a run to end and ending it
LOG_LINE = 500  # characters of the log's last line that are kept


def write_json(path, value):
    """Writes a file that is there whole or not at all."""
    path = pathlib.Path(path)
    part = path.with_name(path.name + ".part")
    part.write_text(json.dumps(value, indent=1))
    os.replace(str(part), str(path))


def read_json(path):
    """What a JSON file holds, or None if there is none that is whole."""
    try:
        return json.loads(pathlib.Path(path).read_text())
    except (OSError, ValueError):
        return None


def end_with_parent():
    """Lets the kernel end this process when the one that began it ends, however that ends."""
    PR_SET_PDEATHSIG = 1
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


class Attempt:
    """A run that is under way. @param task {key, command, timeout or None, environment}"""

    def __init__(self, folder, task):
        self.folder, self.task = pathlib.Path(folder), task
        for name in ("outcome.json", "report.json"):
            if (self.folder / name).exists():
                (self.folder / name).unlink()
        self.started, self.process, self.problem = time.monotonic(), None, ""
        with open(str(self.folder / "log.txt"), "wb") as log:
            try:
                self.process = subprocess.Popen(
                    task["command"], cwd=str(self.folder), stdin=subprocess.DEVNULL, stdout=log, stderr=log, start_new_session=True,
                    preexec_fn=end_with_parent, env=dict(os.environ, **task["environment"]))
            except OSError as error:
                self.problem = "%s: does not start: %s" % (task["command"][0], error.strerror)

    def poll(self):
        """How the run ended, written to outcome.json too; None while it goes on."""
        if self.process is None:
            return self.ended(DIED, None, self.problem)
        status = self.process.poll()
        if status is not None:
            return self.ended(*self.judged(status))
        if self.task["timeout"] is not None and time.monotonic() - self.started > self.task["timeout"]:
            self.stop()
            return self.ended(TIMED_OUT, None, "took more than %g s" % self.task["timeout"])
        return None

    def stop(self):
        """Ends the run without an outcome."""
        if self.process is None or self.process.poll() is not None:
            return
        self.process.terminate()
        try:
            self.process.wait(GRACE)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()

    def judged(self, status):
        """(outcome, exit status, message) of a program that ended."""
        if status < 0:
            return DIED, status, "ended by signal %d" % -status
        if status == 0 and not isinstance(read_json(self.folder / "report.json"), dict):
            return DIED, status, "left no whole report"
        return STATUS_OF_EXIT.get(status, DIED), status, self.last_line()

    def last_line(self):
        lines = (self.folder / "log.txt").read_text(encoding="utf-8", errors="replace").strip().splitlines()
        return lines[-1][:LOG_LINE] if lines else ""

    def ended(self, status, exit_status, message):
        outcome = {"key": self.task["key"], "status": status, "exit_status": exit_status, "message": message,
                   "wall_s": round(time.monotonic() - self.started, 3)}
        write_json(self.folder / "outcome.json", outcome)
        return outcome


def main():
    end_with_parent()
    folder = pathlib.Path(sys.argv[1])
    if (folder / "stop").exists():
        return 1
    attempt = Attempt(folder, read_json(folder / "task.json"))
    while attempt.poll() is None:
        if (folder / "stop").exists():
            attempt.stop()
            return 1
        time.sleep(POLL_PERIOD)
    return 0


if __name__ == "__main__":
    sys.exit(main())
