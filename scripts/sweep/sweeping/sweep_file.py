"""SWEEP.yaml: what is run, what is taken out of the reports, what is asked of it and drawn; all of it looked at before the first run."""
import collections
import math
import pathlib
import re

from sweeping.checked_yaml import Field, flow, read_yaml
from sweeping.designs import DESIGNS
from sweeping.parameters import read_parameter

KEYS = ("config", "duration", "stats_from", "trajectory", "packages", "parameters", "design", "samples", "design_seed", "seeds", "measure", "require",
        "plots")
PLOT_KEYS = ("x", "y", "group", "title", "file", "log")
MOST_RUNS = 1000000
MOST_SEED = 2 ** 63 - 1
# A picture: figure y over x, one curve per value of group; log names logarithmic axes.
Plot = collections.namedtuple("Plot", "x y group title file log")
COLUMN = re.compile(r"[^\s,;\"']+")
FILE_NAME = re.compile(r"[\w.-]+\.png")


class Sweep:
    """What SWEEP.yaml says. Files are absolute; points is a list of ({parameter: value}, seed or None)."""

    def __init__(self, file):
        self.file = str(file)
        self.folder = pathlib.Path(file).resolve().parent
        root = Field(self.file, "", read_yaml(file))
        root.map(KEYS)
        if "config" not in root.value:
            root.refuse("'config' is missing; write config: FILE.yaml")
        self.config = self.existing(root.below("config"))
        self.duration = root.below("duration").number(0) if "duration" in root.value else 10
        self.stats_from = root.below("stats_from").number(0) if "stats_from" in root.value else None
        self.trajectory = self.existing(root.below("trajectory")) if "trajectory" in root.value else None
        self.packages = self.read_packages(root)
        self.design = root.below("design").choice(DESIGNS) if "design" in root.value else "grid"
        self.parameters = read_parameters(root)
        self.points = self.read_points(root)
        self.measure = read_measure(root, set(self.parameters) | {"run", "key", "seed", "status", "passed", "wall_s"})
        self.require = read_require(root, self.measure)
        self.plots = read_plots(root, self.measure, list(self.parameters) + ["seed"] * ("seeds" in root.value))

    def existing(self, field):
        """An absolute file, relative ones being meant from the folder of SWEEP.yaml."""
        path = self.folder / field.text()
        if not path.is_file():
            field.refuse("'%s' is no file; name one, relative to %s" % (field.value, self.folder))
        return str(path.resolve())

    def read_packages(self, root):
        if "packages" not in root.value:
            return {}
        field = root.below("packages")
        folders = {name: self.folder / field.below(name).text() for name in field.map()}
        for name, folder in folders.items():
            if not folder.is_dir():
                field.below(name).refuse("'%s' is no folder; name that of the package, relative to %s" % (field.value[name], self.folder))
        return {name: str(folder.resolve()) for name, folder in sorted(folders.items())}

    def read_points(self, root):
        count, seeds = self.read_count(root), read_seeds(root)
        if "seeds" in root.value and "random_seed" in self.parameters:
            root.below("seeds").refuse("parameters has random_seed, too; leave one of them out")
        if count * len(seeds) > MOST_RUNS:
            root.refuse("%d runs are more than %d; take fewer values, or design: latin with samples" % (count * len(seeds), MOST_RUNS))
        seed = root.below("design_seed").whole(0, MOST_SEED) if "design_seed" in root.value else 1
        chosen = DESIGNS[self.design](self.parameters, count, seed)
        return [(values, run_seed) for values in chosen for run_seed in seeds]

    def read_count(self, root):
        """How many combinations of parameters there will be."""
        if self.design != "grid":
            if "samples" not in root.value:
                root.refuse("'samples' is missing; design: %s needs samples: N" % self.design)
            return root.below("samples").whole(1, MOST_RUNS)
        for key in ("samples", "design_seed"):
            if key in root.value:
                root.below(key).refuse("does not go with design: grid; leave it out, or write design: random or latin")
        for name, parameter in self.parameters.items():
            if parameter.values is None:
                root.below("parameters").below(name).refuse("a distribution has no grid; write design: random or latin, or {from, to, steps}")
        return math.prod(len(parameter.values) for parameter in self.parameters.values())


def read_parameters(root):
    if "parameters" not in root.value:
        return {}
    field = root.below("parameters")
    for name in field.map():
        if not name or "" in name.split(".") or "=" in name or not COLUMN.fullmatch(name):
            field.refuse("'%s' is no path of a parameter; write KEY.PATH as for blem_sim_run --set" % name)
    return {name: read_parameter(field.below(name)) for name in field.value}


def read_seeds(root):
    if "seeds" not in root.value:
        return [None]
    field = root.below("seeds")
    if not isinstance(field.value, list):
        return list(range(1, field.whole(1, MOST_RUNS) + 1))
    if not field.value:
        field.refuse("an empty list leaves no run; write seeds, or their number")
    return [item.whole(0, MOST_SEED) for item in field.items()]


def read_measure(root, taken):
    """{name: path in the report}. @param taken names that other columns have"""
    if "measure" not in root.value:
        return {}
    field = root.below("measure")
    if isinstance(field.value, list):
        paths = {item.text(): item.value for item in field.items()}
    else:
        paths = {name: field.below(name).text() for name in field.map()}
    for name, path in paths.items():
        if name in taken:
            field.refuse("'%s' is the name of another column; choose another one" % name)
        if not COLUMN.fullmatch(name):
            field.refuse("'%s' is no name of a column; write one without spaces, commas and quotes" % name)
        if "" in path.split("."):
            field.refuse("%s: '%s' is no path; write names with dots between them" % (name, path))
    return paths


def read_require(root, measure):
    """{name: (least, most)}"""
    if "require" not in root.value:
        return {}
    field, bounds = root.below("require"), {}
    for name in field.map(measure):
        bound = field.below(name)
        if not bound.map(("min", "max")):
            bound.refuse("has no bound; write {min: A}, {max: B} or both")
        least, most = [bound.below(key).number() if key in bound.value else end for key, end in (("min", -math.inf), ("max", math.inf))]
        if least > most:
            bound.refuse("min %g is above max %g; exchange them" % (least, most))
        bounds[name] = (least, most)
    return bounds


def read_plots(root, measure, parameters):
    if "plots" not in root.value:
        return []
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        root.below("plots").refuse("python3-matplotlib is not installed; install it, or leave plots out")
    plots = [read_plot(item, measure, parameters) for item in root.below("plots").items()]
    for k, plot in enumerate(plots):
        if plot.file in [other.file for other in plots[:k]]:
            root.below("plots").items()[k].refuse("%s is the file of another plot; write file: NAME.png" % plot.file)
    return plots


def read_plot(field, measure, parameters):
    field.map(PLOT_KEYS)
    for key in ("x", "y"):
        if key not in field.value:
            field.refuse("'%s' is missing; name a parameter or a figure of measure" % key)
    for key in ("x", "y", "group"):
        if key in field.value:
            field.below(key).choice(list(measure) + parameters)
    x, y, group = [field.value.get(key) for key in ("x", "y", "group")]
    log = field.below("log").choice(("x", "y", "xy")) if "log" in field.value else ""
    file = field.below("file").text() if "file" in field.value else re.sub(r"[^\w.-]+", "_", "%s_over_%s.png" % (y, x))
    if not FILE_NAME.fullmatch(file):
        field.below("file").refuse("'%s' is no name of a picture; write NAME.png" % file)
    title = field.below("title").text() if "title" in field.value else "%s over %s" % (y, x)
    return Plot(x, y, group, title, file, log)


def point_text(values, seed):
    """A point as a user reads it: contact.friction=0.3 seed=2."""
    return " ".join("%s=%s" % (name, flow(value)) for name, value in list(values.items()) + [("seed", seed)] * (seed is not None))
