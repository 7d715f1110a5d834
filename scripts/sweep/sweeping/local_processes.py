"""Runs as processes of this machine, a number of them at once."""
import os

from sweeping.execution import Attempt, read_json


class LocalProcesses:
    period = 0.005  # [s] between looks at what is running

    def __init__(self, count=None):
        self.count = count or len(os.sched_getaffinity(0))
        self.attempts = {}

    def free(self):
        return self.count - len(self.attempts)

    def start(self, folders):
        """Begins runs. Returns {key: None}. @param folders {key: folder with task.json}"""
        for key, folder in folders.items():
            self.attempts[key] = Attempt(folder, read_json(folder / "task.json"))
        return dict.fromkeys(folders)

    def adopt(self, key, job, folder):
        """Whether a run of an earlier call goes on: here none outlives its sweep."""
        return False

    def ended(self):
        """Outcomes of runs that have ended since the last look."""
        found = {key: attempt.poll() for key, attempt in self.attempts.items()}
        for key in [key for key, outcome in found.items() if outcome]:
            del self.attempts[key]
        return [outcome for outcome in found.values() if outcome]

    def stop(self):
        for attempt in self.attempts.values():
            if attempt.process:
                attempt.process.terminate()
        for attempt in self.attempts.values():
            attempt.stop()
        self.attempts = {}

    def close(self):
        pass
