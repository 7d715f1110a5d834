"""Runs as tasks of a Dask cluster, whose workers share the folder of the results."""
import logging
import re
import socket
import subprocess
import sys

from sweeping import execution
from sweeping.checked_yaml import InputError
from sweeping.shared_folders import ask_to_stop, died, outcome_in

MOST_AT_ONCE = 5000  # tasks
PATIENCE = 10  # [s] for the scheduler to answer
ADDRESS = re.compile(r"(?:tcp://)?(?P<host>[^:/\s\[\]]+|\[[0-9a-fA-F:]+\]):(?P<port>\d{1,5})")


def require_listener(address):
    """Raises InputError if nobody listens at an address: Dask's client would wait and complain at length."""
    match = ADDRESS.fullmatch(address)
    if not match:
        raise InputError("--on dask:%s: is no address; write dask:HOST:PORT as dask-scheduler tells it" % address)
    try:
        socket.create_connection((match["host"].strip("[]"), int(match["port"])), PATIENCE).close()
    except (OSError, OverflowError, UnicodeError) as error:
        raise InputError("--on dask:%s: does not answer: %s; start dask-scheduler, or correct the address" % (
            address, getattr(error, "strerror", None) or "no such host"))


class DaskTasks:
    period = 0.05  # [s]

    def __init__(self, address):
        try:
            import distributed
        except ImportError:
            raise InputError("--on dask: python3-distributed is not installed; install it, or use --on local")
        require_listener(address)
        logging.getLogger("distributed").setLevel(logging.CRITICAL)
        try:
            self.client = distributed.Client(address, timeout=PATIENCE, set_as_default=False)
        except (OSError, ValueError, TypeError) as error:
            said = (str(error).strip().splitlines() or [type(error).__name__])[0]
            raise InputError("--on dask:%s: does not answer: %s; start dask-scheduler, or correct the address" % (address, said))
        if not self.client.scheduler_info()["workers"]:
            print("blem_sim_sweep: dask:%s has no worker yet; start dask-worker" % address, file=sys.stderr, flush=True)
        self.tasks = {}  # key -> (future, folder)

    def free(self):
        return MOST_AT_ONCE - len(self.tasks)

    def start(self, folders):
        """Submits runs. Returns {key: None}. @param folders {key: folder with task.json}"""
        for key, folder in folders.items():
            command = [sys.executable, execution.__file__, str(folder)]
            self.tasks[key] = (self.client.submit(subprocess.call, command, pure=False), folder)
        return dict.fromkeys(folders)

    def adopt(self, key, job, folder):
        """Whether a run of an earlier call goes on: the scheduler drops the tasks of a client that is gone."""
        return False

    def ended(self):
        """Outcomes of runs that have ended since the last look."""
        found = []
        for key, (future, folder) in list(self.tasks.items()):
            if future.done():
                found.append(outcome_in(folder, key) or died(key, self.reason(future)))
                del self.tasks[key]
        return found

    @staticmethod
    def reason(future):
        if future.status == "error":
            return "the worker failed: %s" % (str(future.exception()).strip().splitlines() or ["no word why"])[0]
        return "left no outcome (%s); do the workers share the folder?" % future.status

    def stop(self):
        for future, folder in self.tasks.values():
            ask_to_stop(folder)
            future.cancel()
        self.tasks = {}

    def close(self):
        self.client.close()
