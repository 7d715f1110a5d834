"""Designs: which combinations of parameter values are run. Each is a list of {parameter: value}, the same for the same seed everywhere.

Random numbers of a parameter come from the seed and its name: another parameter beside it moves no value.
"""
import itertools
import random


def grid(parameters, samples, seed):
    """Every combination; the last parameter changes fastest."""
    names = list(parameters)
    return [dict(zip(names, values)) for values in itertools.product(*(parameters[name].values for name in names))]


def stream(seed, name):
    return random.Random("%d %s" % (seed, name))


def independent(parameters, samples, seed):
    """Samples drawn each for itself; more samples begin with the same ones."""
    streams = {name: stream(seed, name) for name in parameters}
    return [{name: parameters[name].at(streams[name].random()) for name in parameters} for _ in range(samples)]


def latin(parameters, samples, seed):
    """Latin hypercube: of each parameter, every one of `samples` equally likely parts is met once."""
    columns = {}
    for name, parameter in parameters.items():
        numbers, parts = stream(seed, name), list(range(samples))
        numbers.shuffle(parts)
        columns[name] = [parameter.at((part + numbers.random()) / samples) for part in parts]
    return [{name: columns[name][k] for name in parameters} for k in range(samples)]


DESIGNS = {"grid": grid, "random": independent, "latin": latin}
