"""YAML that is looked at before it is used: what is wrong is told in one line with file, field and cure."""
import difflib
import math
import re

import yaml


class InputError(Exception):
    """Bad input; its text is one line that names file, field and cure."""


class CheckedLoader(yaml.SafeLoader):
    """Numbers such as 1e-3 are numbers, as in YAML 1.2 and in blem_sim_run; a key that is there twice is refused."""

    def construct_mapping(self, node, deep=False):
        seen = set()
        for key_node, _ in node.value:
            key = self.construct_object(key_node, deep=True)
            if not isinstance(key, (str, int, float)):
                raise yaml.constructor.ConstructorError(None, None, "a key is no text; write one", key_node.start_mark)
            if key in seen:
                raise yaml.constructor.ConstructorError(None, None, "'%s' is there twice; name each once" % key, key_node.start_mark)
            seen.add(key)
        return super(CheckedLoader, self).construct_mapping(node, deep)


CheckedLoader.add_implicit_resolver(
    "tag:yaml.org,2002:float", re.compile(r"^[-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)[eE][-+]?[0-9]+$"), list("-+.0123456789"))


def read_yaml(path):
    """What a YAML file holds. Raises InputError if it cannot be read or is no YAML."""
    try:
        with open(str(path), encoding="utf-8-sig") as stream:
            return yaml.load(stream, Loader=CheckedLoader)
    except (OSError, UnicodeDecodeError) as error:
        raise InputError("%s: cannot be read: %s" % (path, getattr(error, "strerror", None) or "is no UTF-8 text"))
    except RecursionError:
        raise InputError("%s: is nested too deeply; write it flatter" % path)
    except (yaml.YAMLError, ValueError, OverflowError) as error:
        mark = getattr(error, "problem_mark", None)
        where = ":%d" % (mark.line + 1) if mark else ""
        raise InputError("%s%s: not YAML that can be used: %s" % (path, where, getattr(error, "problem", None) or " ".join(str(error).split())))


def flow(value):
    """A value as YAML on one line."""
    text = yaml.safe_dump(value, default_flow_style=True, width=math.inf, allow_unicode=True).strip()
    return text[:-4].rstrip() if text.endswith("\n...") else text


def nearest(name, known):
    """The end of a line about an unknown name: which known one is nearest, or all of them."""
    known = sorted(str(key) for key in known)
    close = difflib.get_close_matches(str(name), known, 1, 0.5)
    return "the nearest known one is '%s'" % close[0] if close else "known: %s" % (", ".join(known[:12]) or "none")


class Field:
    """A value of a YAML file, with the path under which lines about it name it."""

    def __init__(self, file, path, value):
        self.file, self.path, self.value = file, path, value

    def refuse(self, problem):
        raise InputError("%s: %s%s" % (self.file, self.path + ": " if self.path else "", problem))

    def below(self, key):
        return Field(self.file, "%s.%s" % (self.path, key) if self.path else str(key), self.value[key])

    def items(self):
        return [Field(self.file, "%s[%d]" % (self.path, k), value) for k, value in enumerate(self.list())]

    def map(self, known=None):
        """The value, a map whose keys are among the known ones (all if None)."""
        if not isinstance(self.value, dict):
            self.refuse("%s is no map; write KEY: VALUE" % self.shown())
        for key in self.value:
            if known is not None and key not in known:
                self.refuse("unknown key '%s'; %s" % (key, nearest(key, known)))
            if not isinstance(key, str):
                self.refuse("the key %s is no text; write it in quotes" % key)
        return self.value

    def list(self, length=None):
        if not isinstance(self.value, list):
            self.refuse("%s is no list; write [A, B]" % self.shown())
        if length is not None and len(self.value) != length:
            self.refuse("has %d items; write %d" % (len(self.value), length))
        return self.value

    def text(self):
        if not isinstance(self.value, str) or not self.value:
            self.refuse("%s is no text; write one" % self.shown())
        return self.value

    def choice(self, known):
        if isinstance(self.value, (list, dict)) or self.value not in known:
            self.refuse("unknown value %s; %s" % (self.shown(), nearest(self.value, known)))
        return self.value

    def flag(self):
        if not isinstance(self.value, bool):
            self.refuse("%s is neither true nor false; write one of them" % self.shown())
        return self.value

    def number(self, least=-math.inf):
        """The value, a finite number of at least `least`."""
        if isinstance(self.value, bool) or not isinstance(self.value, (int, float)) or not math.isfinite(self.value):
            self.refuse("%s is no finite number; write one" % self.shown())
        if self.value < least:
            self.refuse("%s is less than %g; write a larger number" % (self.shown(), least))
        return self.value

    def whole(self, least, most):
        if isinstance(self.value, bool) or not isinstance(self.value, int) or not least <= self.value <= most:
            self.refuse("%s is no whole number from %d to %d; write one" % (self.shown(), least, most))
        return self.value

    def shown(self):
        """The value, cut to a length that a line has room for."""
        text = flow(self.value).replace("\n", " ")
        return "'%s'" % (text if len(text) <= 40 else text[:37] + "...")
