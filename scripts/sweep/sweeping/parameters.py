"""Values that a parameter of a sweep may take, and how shares in [0, 1) become such values."""
import math
import statistics

MOST_STEPS = 1000000
KINDS = {"from": ("from", "to", "steps", "log"), "uniform": ("uniform", "log"), "normal": ("normal",)}
KEYS = sorted({key for keys in KINDS.values() for key in keys})


def rounded(value):
    """A computed number with twelve digits, whole ones as int: programs that want a whole number take it."""
    value = float("%.12g" % value)
    return int(value) if value == int(value) and abs(value) < 2 ** 53 else value


class Choices:
    """Values one by one; a grid has all of them."""

    def __init__(self, values):
        self.values = values

    def at(self, share):
        return self.values[min(int(share * len(self.values)), len(self.values) - 1)]


class Uniform:
    """Numbers between two bounds, evenly or, with log, evenly in their logarithm."""
    values = None

    def __init__(self, low, high, log):
        self.low, self.high, self.log = low, high, log

    def at(self, share):
        return rounded(between(self.low, self.high, share, self.log))


class Normal:
    """Numbers of a normal distribution."""
    values = None

    def __init__(self, mean, deviation):
        self.distribution = statistics.NormalDist(mean, deviation)

    def at(self, share):
        return rounded(self.distribution.inv_cdf(min(max(share, 1e-12), 1 - 1e-12)))


def between(low, high, share, log):
    if log:
        return math.exp(math.log(low) + (math.log(high) - math.log(low)) * share)
    return low + (high - low) * share


def read_parameter(field):
    """The values of a field below `parameters`: one value, a list, {from, to, steps}, {uniform} or {normal}. Raises InputError."""
    if isinstance(field.value, list):
        for item in field.items():
            refuse_unusable(item)
        if not field.value:
            field.refuse("an empty list leaves no run; write values")
        return Choices(field.value)
    if not isinstance(field.value, dict):
        refuse_unusable(field)
        return Choices([field.value])
    kind = next((kind for kind in KINDS if kind in field.map(KEYS)), None)
    if kind is None:
        field.refuse("is no range; write {from, to, steps}, {uniform: [A, B]}, {normal: [MEAN, STD]} or a list of values")
    for key in field.value:
        if key not in KINDS[kind]:
            field.refuse("'%s' does not go with '%s'; leave it out" % (key, kind))
    return {"from": read_steps, "uniform": read_uniform, "normal": read_normal}[kind](field)


def refuse_unusable(field):
    if field.value is None or (isinstance(field.value, float) and math.isnan(field.value)):
        field.refuse("%s is no value; write one" % field.shown())


def read_log(field, low, high):
    log = "log" in field.value and field.below("log").flag()
    if log and min(low, high) <= 0:
        field.refuse("log needs bounds above 0; correct them or leave log out")
    return log


def read_steps(field):
    for key in ("to", "steps"):
        if key not in field.value:
            field.refuse("'%s' is missing; write {from: A, to: B, steps: N}" % key)
    low, high = field.below("from").number(), field.below("to").number()
    steps, log = field.below("steps").whole(1, MOST_STEPS), read_log(field, low, high)
    if steps == 1 and low != high:
        field.refuse("one step does not reach from %g to %g; write steps: 2 or more" % (low, high))
    return Choices([rounded(between(low, high, k / max(steps - 1, 1), log)) for k in range(steps)])


def read_uniform(field):
    field.below("uniform").list(2)
    low, high = [item.number() for item in field.below("uniform").items()]
    if low >= high:
        field.refuse("uniform: %g is not below %g; exchange them" % (low, high))
    return Uniform(low, high, read_log(field, low, high))


def read_normal(field):
    field.below("normal").list(2)
    mean, deviation = [item.number() for item in field.below("normal").items()]
    if deviation <= 0:
        field.refuse("normal: the deviation %g is not above 0; correct it" % deviation)
    return Normal(mean, deviation)
