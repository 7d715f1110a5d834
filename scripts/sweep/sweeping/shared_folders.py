"""How runs on other machines end: by outcome.json in their folders, which all machines share; and how they are asked to stop."""
from sweeping.execution import DIED, read_json


def ask_to_stop(folder):
    (folder / "stop").touch()


def outcome_in(folder, key):
    """The outcome in a run's folder, or None."""
    outcome = read_json(folder / "outcome.json")
    return outcome if isinstance(outcome, dict) and outcome.get("key") == key else None


def died(key, message):
    return {"key": key, "status": DIED, "exit_status": None, "message": message, "wall_s": None}
