"""runs.sqlite: every run's parameters, status, figures, command and log. The one truth about what has been run; each change is one transaction."""
import fcntl
import pathlib
import shlex
import sqlite3

from sweeping.checked_yaml import InputError, flow
from sweeping.execution import DONE, read_json

WAITING, RUNNING = "waiting", "running"
SCHEMA = """
CREATE TABLE IF NOT EXISTS runs (key TEXT PRIMARY KEY, status TEXT NOT NULL, attempts INTEGER NOT NULL, job TEXT, exit_status INTEGER, message TEXT,
  wall_s REAL, passed INTEGER, seed INTEGER, command TEXT NOT NULL, folder TEXT NOT NULL, log TEXT NOT NULL);
CREATE TABLE IF NOT EXISTS sweep (number INTEGER PRIMARY KEY, key TEXT NOT NULL REFERENCES runs (key));
CREATE TABLE IF NOT EXISTS parameters (key TEXT NOT NULL REFERENCES runs (key), name TEXT NOT NULL, value TEXT NOT NULL, PRIMARY KEY (key, name));
CREATE TABLE IF NOT EXISTS figures (key TEXT NOT NULL REFERENCES runs (key), name TEXT NOT NULL, value, PRIMARY KEY (key, name));
"""


class Store:
    """The results below a folder; one program at a time has it. Raises InputError if it cannot be used."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder).resolve()
        try:
            (self.folder / "runs").mkdir(parents=True, exist_ok=True)
            self.lock = open(str(self.folder / "lock"), "w")
            fcntl.flock(self.lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise InputError("%s: another blem_sim_sweep is at work there; wait for it, or name another --out" % folder)
        except OSError as error:
            raise InputError("%s: cannot be written: %s; name another --out" % (folder, error.strerror))
        try:
            self.base = sqlite3.connect(str(self.folder / "runs.sqlite"), isolation_level=None)
            self.base.execute("PRAGMA journal_mode = WAL")
            self.base.executescript(SCHEMA)
        except sqlite3.Error as error:
            raise InputError("%s: %s; move it away, or name another --out" % (self.folder / "runs.sqlite", error))

    def close(self):
        self.base.close()
        self.lock.close()

    def run_folder(self, key):
        return self.folder / "runs" / key

    def enroll(self, runs):
        """Makes these runs the sweep; results of former ones stay, for when they are asked for again."""
        with self.base:
            self.base.execute("BEGIN")
            self.base.execute("DELETE FROM sweep")
            for run in runs:
                folder = "runs/" + run.key
                self.base.execute("INSERT OR IGNORE INTO runs (key, status, attempts, seed, command, folder, log) VALUES (?, ?, 0, ?, '', ?, ?)",
                                  (run.key, WAITING, run.seed, folder, folder + "/log.txt"))
                self.base.execute("UPDATE runs SET command = ? WHERE key = ?", (shown_command(run.command), run.key))
                self.base.execute("INSERT INTO sweep VALUES (?, ?)", (run.number, run.key))
                for name, value in run.values.items():
                    self.base.execute("INSERT OR REPLACE INTO parameters VALUES (?, ?, ?)", (run.key, name, flow(value)))

    def states(self):
        """{key: (status, job)} of the sweep's runs."""
        return {key: (status, job) for key, status, job in self.base.execute("SELECT key, status, job FROM runs WHERE key IN (SELECT key FROM sweep)")}

    def wait_again(self, key):
        self.base.execute("UPDATE runs SET status = ?, job = NULL WHERE key = ?", (WAITING, key))

    def begin(self, jobs):
        """@param jobs {key: name of its job in a queue, or None}"""
        with self.base:
            self.base.execute("BEGIN")
            for key, job in jobs.items():
                self.base.execute("UPDATE runs SET status = ?, job = ?, attempts = attempts + 1 WHERE key = ?", (RUNNING, job, key))

    def record(self, outcome):
        """Takes in how a run ended."""
        self.base.execute("UPDATE runs SET status = ?, exit_status = ?, message = ?, wall_s = ?, job = NULL WHERE key = ?",
                          tuple(outcome[name] for name in ("status", "exit_status", "message", "wall_s", "key")))

    def record_figures(self, key, figures, passed):
        with self.base:
            self.base.execute("BEGIN")
            self.base.execute("DELETE FROM figures WHERE key = ?", (key,))
            self.base.executemany("INSERT INTO figures VALUES (?, ?, ?)", [(key, name, value) for name, value in figures.items()])
            self.base.execute("UPDATE runs SET passed = ? WHERE key = ?", (passed, key))

    def report(self, key):
        """The kept report of a run, or None."""
        return read_json(self.run_folder(key) / "report.json")

    def outcome(self, key):
        """How a run in its folder ended, if nobody has recorded it yet; None if it did not."""
        outcome = read_json(self.run_folder(key) / "outcome.json")
        if not isinstance(outcome, dict) or outcome.get("key") != key or (outcome["status"] == DONE and self.report(key) is None):
            return None
        return outcome

    def results(self):
        """{key: {status, message, wall_s, passed, figures: {name: value}}} of the sweep's runs."""
        rows = self.base.execute("SELECT key, status, message, wall_s, passed FROM runs WHERE key IN (SELECT key FROM sweep)")
        results = {key: {"status": status, "message": message or "", "wall_s": wall_s, "passed": passed, "figures": {}}
                   for key, status, message, wall_s, passed in rows}
        for key, name, value in self.base.execute("SELECT key, name, value FROM figures WHERE key IN (SELECT key FROM sweep)"):
            results[key]["figures"][name] = value
        return results


def shown_command(command):
    """A command as a shell takes it."""
    return " ".join(shlex.quote(word) for word in command)
