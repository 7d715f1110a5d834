"""blem_sim_sweep from its command line to its exit status."""
import os
import signal
import sqlite3
import sys

from sweeping.checked_yaml import InputError
from sweeping.collection import Collection, FirstFailure
from sweeping.dask_tasks import DaskTasks
from sweeping.local_processes import LocalProcesses
from sweeping.options import program, read_options
from sweeping.plots import draw_plots
from sweeping.progress import Progress, failure, summary
from sweeping.results_table import write_results
from sweeping.runs import make_runs
from sweeping.slurm_jobs import SlurmJobs
from sweeping.store import Store, shown_command
from sweeping.sweep_file import Sweep

FINE, FAILED, BAD_INPUT = 0, 1, 2


def interrupt(*_):
    """A signal to end is answered as Ctrl-C is."""
    raise KeyboardInterrupt


def main(arguments):
    """Exit status of the program."""
    for number in (signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(number) != signal.SIG_IGN:  # as nohup leaves it
            signal.signal(number, interrupt)
    try:
        options = read_options(arguments)
        sweep = Sweep(options.sweep)
        runs = make_runs(sweep, program())
        if options.only is not None and options.only > len(runs):
            raise InputError("--only %d: the sweep has %d runs; name one of them" % (options.only, len(runs)))
        if options.dry_run:
            return list_runs(runs, options.only)
        return work(sweep, runs, options)
    except InputError as error:
        print("blem_sim_sweep: %s" % error, file=sys.stderr)
        return BAD_INPUT
    except BrokenPipeError:
        sys.stdout = open(os.devnull, "w")  # the reader has gone; nothing is left to be told
        return FAILED
    except sqlite3.Error as error:
        print("blem_sim_sweep: %s/runs.sqlite: %s; make room, move it away, or name another --out" % (options.out, error), file=sys.stderr)
        return BAD_INPUT
    except OSError as error:
        print("blem_sim_sweep: %s: %s; make room, or name another --out" % (error.filename or "results", error.strerror), file=sys.stderr)
        return BAD_INPUT
    except KeyboardInterrupt:
        print("blem_sim_sweep: stopped; the same command goes on from here", file=sys.stderr)
        return FAILED


def list_runs(runs, only):
    """Prints the runs with their commands, or the command of one."""
    for run in runs:
        if only is None:
            print("run %d (%s)\n  %s" % (run.number, run.text(), shown_command(run.command)))
        elif run.number == only:
            print(shown_command(run.command))
    return FINE


def runner_of(options):
    kind, detail = options.on
    if kind == "slurm":
        return SlurmJobs(options.out, options.slurm_options)
    return DaskTasks(detail) if kind == "dask" else LocalProcesses(detail)


def work(sweep, runs, options):
    """Makes the runs that are left; writes table and plots whatever happens. Returns the exit status."""
    runner = runner_of(options)
    store = Store(options.out)
    try:
        store.enroll(runs)
        wanted = [run for run in runs if options.only in (None, run.number)]
        collection, progress = Collection(sweep, wanted, store, options), Progress(len({run.key for run in wanted}))
        try:
            collection.resume(runner)
            collection.work(runner, progress)
        except FirstFailure:
            pass
        finally:
            end_runs(collection, runner)
            progress.end()
            write_results(store.folder / "results.csv", sweep, runs, store.results())
        return finish(sweep, runs, store, options)
    finally:
        store.close()
        runner.close()


def end_runs(collection, runner):
    """Stops what is still running; it waits for the next call."""
    runner.stop()
    for key in collection.running:
        collection.store.wait_again(key)


def finish(sweep, runs, store, options):
    """Draws the plots and tells how it went. Returns the exit status."""
    results = store.results()
    wanted = [run for run in runs if options.only in (None, run.number)]
    lines = summary(sweep, wanted, results)
    if options.only is not None:
        lines += ["%s = %s" % each for each in results[wanted[0].key]["figures"].items()]
        lines += [shown_command(wanted[0].command), str(store.run_folder(wanted[0].key))]
    print("\n".join(lines), flush=True)
    plots = draw_plots(store.folder, sweep, runs, results)
    print("\n".join(str(file) for file in [store.folder / "results.csv", store.folder / "runs.sqlite"] + plots), flush=True)
    return FAILED if any(failure(sweep, results[run.key]) for run in wanted) else FINE
