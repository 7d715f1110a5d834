"""Figures out of a report, by dotted paths such as bodies.cube::link.xyz.2, and the bounds they have to keep."""
import math

from sweeping.checked_yaml import nearest


class MissingFigure(Exception):
    """The report has no such figure; the text says what is there."""


def figure_of(report, path):
    """The number or text at a path; names in the report may have dots themselves. Raises MissingFigure."""
    value, steps = report, path.split(".")
    while steps:
        if isinstance(value, dict):
            taken = next((k for k in range(len(steps), 0, -1) if ".".join(steps[:k]) in value), 0)
            if not taken:
                raise MissingFigure("the report has no '%s'; %s" % (steps[0], nearest(steps[0], value)))
            value, steps = value[".".join(steps[:taken])], steps[taken:]
        elif isinstance(value, list):
            if not steps[0].isdigit() or int(steps[0]) >= len(value):
                raise MissingFigure("'%s' is no item of a list of %d; items are numbered from 0" % (steps[0], len(value)))
            value, steps = value[int(steps[0])], steps[1:]
        else:
            raise MissingFigure("there is nothing below '%s', which is a value" % ".".join(path.split(".")[: -len(steps)]))
    if isinstance(value, dict):
        raise MissingFigure("is a map; name one of it: %s" % ", ".join(list(value)[:12]))
    if isinstance(value, list):
        raise MissingFigure("is a list of %d; name one item by its number from 0" % len(value))
    return value


def figures_of(report, measure):
    """{name: figure} of a report; None where it has none. @param measure {name: path}"""
    found = {}
    for name, path in measure.items():
        try:
            found[name] = figure_of(report, path)
        except MissingFigure:
            found[name] = None
    return found


def violated(figures, require):
    """Names of the bounds that figures do not keep, with what was asked. @param require {name: (least, most)}"""
    return ["%s = %s, asked %s" % (name, figures.get(name), bounds_text(*bounds))
            for name, bounds in require.items() if not keeps(figures.get(name), *bounds)]


def keeps(value, least, most):
    return isinstance(value, (int, float)) and math.isfinite(value) and least <= value <= most


def bounds_text(least, most):
    return " and ".join(["at least %g" % least] * (least > -math.inf) + ["at most %g" % most] * (most < math.inf))
