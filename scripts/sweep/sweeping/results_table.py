"""results.csv: a row per run in the sweep's order. All columns but the last, wall_s, are the same wherever the runs were made."""
import csv
import os

from sweeping.checked_yaml import flow


def columns(sweep, runs):
    seeds = ["seed"] if any(run.seed is not None for run in runs) else []
    return ["run", "key"] + list(sweep.parameters) + seeds + ["status"] + list(sweep.measure) + ["passed", "wall_s"]


def row(run, result):
    """{column: value} of a run."""
    cells = {"run": run.number, "key": run.key, "seed": run.seed, "status": result["status"], "wall_s": result["wall_s"],
             "passed": None if result["passed"] is None else bool(result["passed"])}
    cells.update(run.values)
    cells.update(result["figures"])
    return cells


def cell_text(value):
    if value is None:
        return ""
    return value if isinstance(value, str) else repr(value) if isinstance(value, float) else flow(value)


def write_results(path, sweep, runs, results):
    """Writes the table; it is there whole or not at all. @param results {key: ...} of Store.results"""
    part = str(path) + ".part"
    names = columns(sweep, runs)
    with open(part, "w", newline="", encoding="utf-8") as stream:
        table = csv.writer(stream, lineterminator="\n")
        table.writerow(names)
        for run in runs:
            cells = row(run, results[run.key])
            table.writerow([cell_text(cells.get(name)) for name in names])
    os.replace(part, str(path))
