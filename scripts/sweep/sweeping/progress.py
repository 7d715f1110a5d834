"""What a user sees: a line that changes on a terminal, and a summary at the end."""
import sys
import time

from sweeping.execution import DONE
from sweeping.figures import violated

PERIOD = 0.2  # [s] between lines
MOST_TOLD = 10  # runs that failed, one by one


class Progress:
    """A line on standard error, where that is a terminal."""

    def __init__(self, total):
        self.total, self.began, self.shown, self.at_begin = total, time.monotonic(), -PERIOD, None
        self.visible = sys.stderr.isatty()

    def show(self, collection):
        now = time.monotonic()
        left = len(collection.waiting) + len(collection.running)
        if self.at_begin is None:
            self.at_begin = left
        if not self.visible or now - self.shown < PERIOD:
            return
        self.shown = now
        ended = self.at_begin - left
        rest = "%d s left" % round((now - self.began) * left / ended) if ended else "begun"
        sys.stderr.write("\r\033[K%d/%d runs, %d running, %d failed, %s" % (
            self.total - left, self.total, len(collection.running), collection.failed, rest))
        sys.stderr.flush()

    def end(self):
        if self.visible:
            sys.stderr.write("\r\033[K")
            sys.stderr.flush()


def summary(sweep, runs, results):
    """Lines that say how many runs ended how, and which ones failed why."""
    counts = {}
    for run in runs:
        status = results[run.key]["status"]
        counts[status] = counts.get(status, 0) + 1
    bad = [(run, reason) for run, reason in ((run, failure(sweep, results[run.key])) for run in runs) if reason]
    outside = sum(results[run.key]["status"] == DONE for run, _ in bad)
    lines = ["%d run%s: %s%s" % (len(runs), "s" * (len(runs) != 1), ", ".join("%d %s" % (counts[status], status) for status in sorted(counts)),
                                "; %d of them did not keep what is required" % outside if outside else "")]
    lines += ["run %d (%s): %s" % (run.number, run.text(), reason) for run, reason in bad[:MOST_TOLD]]
    if len(bad) > MOST_TOLD:
        lines.append("and %d more, see results.csv" % (len(bad) - MOST_TOLD))
    return lines


def failure(sweep, result):
    """Why a run failed; empty if it did not."""
    if result["status"] == DONE:
        return "; ".join(violated(result["figures"], sweep.require))
    return result["status"] + (": " + result["message"] if result["message"] else "")
