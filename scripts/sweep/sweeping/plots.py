"""Plots of a sweep as PNG files: points of runs that are done; in a grid, lines through their means."""
import os
import statistics

from sweeping.checked_yaml import InputError, flow
from sweeping.execution import DONE
from sweeping.results_table import row

SIZE, RESOLUTION = (7.0, 4.5), 110  # [inch], [pixels/inch]


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def draw_plots(folder, sweep, runs, results):
    """Draws all plots. Returns their files. Raises InputError for figures that are no numbers."""
    if not sweep.plots:
        return []
    import matplotlib
    matplotlib.use("Agg")
    cells = [row(run, results[run.key]) for run in runs if results[run.key]["status"] == DONE]
    return [draw(folder / plot.file, plot, cells, sweep) for plot in sweep.plots]


def draw(path, plot, cells, sweep):
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(figsize=SIZE, dpi=RESOLUTION)
    for label, points in curves(plot, cells, sweep.file).items():
        style = {"label": label} if plot.group else {}
        color = axes.plot([x for x, _ in points], [y for _, y in points], "o", markersize=4, **style)[0].get_color()
        if sweep.design == "grid":
            means = means_over(points)
            axes.plot([x for x, _ in means], [y for _, y in means], "-", linewidth=1, color=color)
    axes.set(xlabel=plot.x, ylabel=plot.y, title=plot.title, xscale="log" if "x" in plot.log else axes.get_xscale(),
             yscale="log" if "y" in plot.log else "linear")
    axes.grid(alpha=0.3)
    if plot.group and axes.get_legend_handles_labels()[0]:
        axes.legend(title=plot.group)
    figure.tight_layout()
    part = str(path) + ".part"
    figure.savefig(part, format="png", metadata={"Software": None})
    pyplot.close(figure)
    os.replace(part, str(path))
    return path


def curves(plot, cells, file):
    """{value of the group as text: [(x, y)]}; x are texts if not all of them are numbers."""
    cells = [each for each in cells if each.get(plot.x) is not None and each.get(plot.y) is not None]
    for each in cells:
        if not is_number(each[plot.y]):
            raise InputError("%s: plots: y: %s is '%s' in run %d, no number; plot another figure" % (file, plot.y, each[plot.y], each["run"]))
    numbers, made = all(is_number(each[plot.x]) for each in cells), {}
    for each in cells:
        label = flow(each.get(plot.group)) if plot.group else ""
        made.setdefault(label, []).append((each[plot.x] if numbers else flow(each[plot.x]), each[plot.y]))
    return made


def means_over(points):
    """[(x, mean of y)], sorted by x where that is a number."""
    by_x = {}
    for x, y in points:
        by_x.setdefault(x, []).append(y)
    means = [(x, statistics.fmean(values)) for x, values in by_x.items()]
    return sorted(means) if all(is_number(x) for x in by_x) else means
