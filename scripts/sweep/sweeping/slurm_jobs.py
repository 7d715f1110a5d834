"""Runs as job arrays of Slurm, submitted by sbatch; they outlive this program, and a later call takes them over."""
import getpass
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import time

from sweeping import execution
from sweeping.checked_yaml import InputError
from sweeping.shared_folders import ask_to_stop, died, outcome_in

MOST_IN_ARRAY = 1000  # tasks; Slurm's default MaxArraySize is 1001
PATIENCE = 30.0  # [s] for an outcome of a job that has left the queue: folders are shared with delay
LOOK_PERIOD = 2.0  # [s] between looks at the queue
STATE = re.compile(r"\bJobState=(\w+)(?: Reason=(\S+))?")


def call(*words):
    """(exit status, standard output, first line of standard error) of a command."""
    done = subprocess.run(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
    return done.returncode, done.stdout.strip(), (done.stderr.strip().splitlines() or ["no word why"])[0]


class SlurmJobs:
    period = 0.5  # [s]

    def __init__(self, folder, options):
        if not shutil.which("sbatch"):
            raise InputError("--on slurm: sbatch is not on PATH; go to a machine that submits jobs, or use --on local")
        self.folder, self.options = pathlib.Path(folder).resolve() / "slurm", options
        self.jobs = {}  # key -> (job, folder)
        self.gone = {}  # key -> when its job was first missed
        self.looked = 0.0

    def free(self):
        return MOST_IN_ARRAY

    def start(self, folders):
        """Submits runs as one array. Returns {key: job}. @param folders {key: folder with task.json}, at most MOST_IN_ARRAY"""
        self.folder.mkdir(exist_ok=True)
        tasks = self.folder / ("tasks_%d.txt" % time.time_ns())
        tasks.write_text("".join("%s\n" % folder for folder in folders.values()))
        script = 'exec %s %s "$(sed -n "$((SLURM_ARRAY_TASK_ID + 1))p" %s)"' % tuple(
            shlex.quote(str(word)) for word in (sys.executable, execution.__file__, tasks))
        status, said, problem = call("sbatch", "--parsable", "--job-name=blem_sim_sweep", "--array=0-%d" % (len(folders) - 1),
                                     "--output=%s/%%A_%%a.log" % self.folder, *self.options, "--wrap=" + script)
        if status or not said:
            raise InputError("--on slurm: sbatch refuses: %s; correct --slurm-options" % problem)
        started = {key: "%s_%d" % (said.split(";")[0], k) for k, key in enumerate(folders)}
        self.jobs.update({key: (job, folders[key]) for key, job in started.items()})
        return started

    def adopt(self, key, job, folder):
        """Whether a run of an earlier call is still in the queue, or waits to be looked at."""
        if job is None:
            return False
        self.jobs[key] = (job, folder)
        return True

    def ended(self):
        """Outcomes of runs that have ended since the last look."""
        found = [outcome for outcome in (outcome_in(folder, key) for key, (_, folder) in self.jobs.items()) if outcome]
        for outcome in found:
            self.forget(outcome["key"])
        return found + self.vanished()

    def forget(self, key):
        job, _ = self.jobs.pop(key)
        self.gone.pop(key, None)
        log = self.folder / (job + ".log")
        if log.is_file() and log.stat().st_size == 0:
            log.unlink()

    def vanished(self):
        """Outcomes of runs whose jobs have left the queue without one."""
        now = time.monotonic()
        if not self.jobs or now - self.looked < LOOK_PERIOD:
            return []
        self.looked = now
        status, said, _ = call("squeue", "--noheader", "--array", "--user=" + getpass.getuser(), "--format=%i")
        if status:
            return []  # a queue that does not answer now says nothing about the jobs
        queued = set(said.split())
        found = []
        for key, (job, folder) in list(self.jobs.items()):
            if job in queued:
                self.gone.pop(key, None)
            elif now - self.gone.setdefault(key, now) > PATIENCE:
                found.append(outcome_in(folder, key) or died(key, self.reason(job)))
                self.forget(key)
        return found

    def reason(self, job):
        _, said, _ = call("scontrol", "show", "job", job)
        state = STATE.search(said)
        return "Slurm's job %s left no outcome: %s; see %s.log" % (job, " ".join(filter(None, state.groups())) if state else "unknown to the queue",
                                                                   self.folder / job)

    def stop(self):
        for _, folder in self.jobs.values():
            ask_to_stop(folder)
        if self.jobs:
            call("scancel", *sorted({job.split("_")[0] for job, _ in self.jobs.values()}))
        self.jobs = {}

    def close(self):
        pass
