"""Texts, numbers and truths of SDF's elements, and what is told of a file."""
import math
from xml.etree import ElementTree


class InputError(Exception):
    """Bad input; its text is one line that names file, element and cure."""


class Report:
    """Lines for the user: what differs from Gazebo's, and what is left out."""

    def __init__(self):
        self.notes, self.left_out = [], []

    def note(self, line):
        if line not in self.notes:
            self.notes.append(line)

    def leave_out(self, line):
        if line not in self.left_out:
            self.left_out.append(line)


def parse(path):
    """The root element of an XML file. Raises InputError."""
    try:
        return ElementTree.parse(str(path)).getroot()
    except OSError as error:
        raise InputError("%s: cannot be read: %s" % (path, error.strerror))
    except (ElementTree.ParseError, ValueError) as error:
        raise InputError("%s: is no XML: %s; mend that line" % (path, error))


def read_file(path):
    """The root element of an SDF file. Raises InputError if it cannot be read or is none."""
    root = parse(path)
    if root.tag not in ("sdf", "gazebo"):
        raise InputError("%s: <%s> is no SDF; give a file with <sdf>" % (path, root.tag))
    return root


def version_of(root):
    """(1, 6) of <sdf version="1.6">; the newest that Gazebo classic reads if it is not told."""
    try:
        return tuple(int(part) for part in root.get("version", "1.7").split("."))
    except ValueError:
        raise InputError('<sdf version="%s"> is no version; write 1.6' % root.get("version"))


def text(element, path, default=None):
    """Text of the element at a path below, without spaces around; the default if it is missing or empty."""
    found = element.findtext(path) if element is not None else None
    return found.strip() if found and found.strip() else default


def numbers(value, count, where):
    """So many finite numbers of a text. Raises InputError."""
    try:
        result = [float(part) for part in value.split()]
    except ValueError:
        result = []
    if len(result) != count or not all(math.isfinite(number) for number in result):
        raise InputError("%s: '%s' must be %s" % (where, value.strip(), "a number" if count == 1 else "%d numbers" % count))
    return result


def number(element, path, default, where):
    """The number at a path below; inf and -inf are such."""
    value = text(element, path)
    if value is None:
        return default
    if value.lower().lstrip("+-") in ("inf", "infinity"):
        return -math.inf if value.startswith("-") else math.inf
    return numbers(value, 1, "%s: <%s>" % (where, path))[0]


def truth(element, path, default=False):
    """Whether the element at a path below says true or 1."""
    value = text(element, path)
    return default if value is None else value.lower() in ("1", "true")
