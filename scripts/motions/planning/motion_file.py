"""MOTION.yaml: contacts, margins and phases of a motion; all of it looked at before anything is planned. docs/motions.md is its manual."""
import collections

import numpy as np
from sweeping.checked_yaml import Field, read_yaml

KEYS = ("robot", "rate", "margin", "speed", "effort", "friction", "clearance", "shift_duration", "body", "contacts", "holding", "start", "phases")
CONTACT_KEYS = ("link", "points", "normal", "normals", "facing", "radius", "friction", "force", "keeps", "settles")
START_KEYS = ("contacts", "com", "height", "rpy", "joints")
PHASE_KEYS = ("name", "duration", "com", "body", "move", "release", "joints")
KEEPS = ("pose", "edge", "position")
FREE = "free"         # of a centre of mass that goes where contacts, body and joints take it
FASTEST_RATE, LONGEST_PHASE, MOST_PHASES, MOST_POINTS, FARTHEST = 1000, 3600, 1000, 64, 1000
SHORTEST_EDGE = 1e-3  # [m]

# Where a link may touch: points in the link's frame, middles of balls of a radius [m] that roll if it is not 0; outward normals of the environment, in
# the link's frame or, if `facing`, in the world; friction; most normal force [N] per point, None for the robot's weight; keeps: one of KEEPS, of a held
# link; edge: unit vector from the first point to the last in the link's frame, about which one that keeps its edge turns, else None; settles: whether it
# comes to rest on meshes where it is put down. Its middle is that of its points.
Contact = collections.namedtuple("Contact", "name link points normals facing radius friction force keeps edge settles middle")
# One target of the centre of mass: kind is "over" (value: names of contacts), "xy" or "by" (value: [m]), or FREE (value: None).
CentreTarget = collections.namedtuple("CentreTarget", "kind value")
# One target of the body: kind is "height" or "rise", or None; rpy or None.
BodyTarget = collections.namedtuple("BodyTarget", "kind height rpy")
# One way of a contact: to: middle (xyz) or None, else by: [m]; rpy of the link or None; lift: vector [m]; whether it holds at the end.
Way = collections.namedtuple("Way", "to by rpy lift lands")
Start = collections.namedtuple("Start", "contacts com body joints")
Phase = collections.namedtuple("Phase", "path name duration com body ways release joints")


class Motion:
    """What MOTION.yaml says. file names it in refusals."""

    def __init__(self, file):
        self.file = str(file)
        root = Field(self.file, "", read_yaml(file))
        root.map(KEYS)
        for key in ("contacts", "phases"):
            if key not in root.value:
                root.refuse("'%s' is missing; write it as docs/motions.md shows" % key)
        self.robot = optional(root, "robot", Field.text)
        self.rate = within(root, "rate", 50, 1, FASTEST_RATE)
        self.margin = within(root, "margin", 0.015, 0, 1)
        self.speed = within(root, "speed", 0.5, 0.01, 1)
        self.effort = within(root, "effort", 1.0, 0.01, 1)
        self.friction = within(root, "friction", 0.5, 0.01, 10)
        self.clearance = within(root, "clearance", None, 0, 1)
        self.shift_duration = within(root, "shift_duration", 2.0, 0.01, LONGEST_PHASE)
        self.body = optional(root, "body", Field.text)
        contacts = root.below("contacts")
        self.contacts = {name: read_contact(name, contacts.below(name), self.friction) for name in contacts.map()}
        if not self.contacts:
            contacts.refuse("is empty; name at least one contact")
        self.holding = names_in(root.below("holding"), self.contacts) if "holding" in root.value else sorted(self.contacts)
        self.start = read_start(root.below("start"), self.contacts) if "start" in root.value else None
        self.phases = [read_phase(item, k, self.contacts) for k, item in enumerate(root.below("phases").items())]
        if not 0 < len(self.phases) <= MOST_PHASES:
            root.below("phases").refuse("has %d items; write 1 to %d" % (len(self.phases), MOST_PHASES))

    def field(self, path, value):
        """A value that was read, so that its refusal names file and field."""
        return Field(self.file, path, value)


def optional(field, key, read, default=None):
    return read(field.below(key)) if key in field.value else default


def within(field, key, default, least, most):
    """A number between two bounds, or the default where the key is left out."""
    if key not in field.value:
        return default
    value = field.below(key).number(least)
    if value > most:
        field.below(key).refuse("%s is more than %g; write a smaller number" % (field.below(key).shown(), most))
    return value


def numbers(field, length):
    """A list of so many finite numbers, none beyond 1 km."""
    for item in field.items():
        if abs(item.number()) > FARTHEST:
            item.refuse("%s is beyond %g; write m and rad" % (item.shown(), FARTHEST))
    return np.array(field.list(length), float)


def names_in(field, known):
    names = [item.choice(known) for item in field.items()]
    for k, name in enumerate(names):
        if name in names[:k]:
            field.refuse("'%s' is there twice; name each once" % name)
    return names


def joint_targets(field):
    return {name: field.below(name).number() for name in field.map()}


def unit(field):
    vector = numbers(field, 3)
    if np.linalg.norm(vector) < 1e-6:
        field.refuse("%s has no direction; write [0, 0, 1]" % field.shown())
    return vector / np.linalg.norm(vector)


def read_contact(name, field, friction):
    field.map(CONTACT_KEYS)
    for key in ("link", "points"):
        if key not in field.value:
            field.refuse("'%s' is missing; write link: NAME and points: [[x, y, z], ...] in its frame" % key)
    points = np.array([numbers(item, 3) for item in field.below("points").items()])
    if not 0 < len(points) <= MOST_POINTS:
        field.below("points").refuse("has %d items; write 1 to %d" % (len(points), MOST_POINTS))
    keeps = field.below("keeps").choice(KEEPS) if "keeps" in field.value else "pose"
    radius = within(field, "radius", 0.0, 0, FARTHEST)
    if radius and "facing" not in field.value:
        field.below("radius").refuse("goes with 'facing', as a ball turns under its contact; write facing: [0, 0, 1]")
    return Contact(name, field.below("link").text(), points, read_normals(field, len(points)), "facing" in field.value, radius,
                   within(field, "friction", friction, 0.01, 10), within(field, "force", None, 1e-3, 1e6), keeps,
                   read_edge(field, points) if keeps == "edge" else None, optional(field, "settles", Field.flag, False), points.mean(axis=0))


def read_edge(field, points):
    """Unit vector along the edge of a contact that turns about it."""
    along = points[-1] - points[0]
    length = np.linalg.norm(along)
    if length < SHORTEST_EDGE:
        field.below("points").refuse("has no edge, its first and last point are %g mm apart; write the edge's ends" % (1e3 * length))
    return along / length


def read_normals(field, count):
    """Normals of a contact's points, from one of three keys."""
    given = [key for key in ("normal", "normals", "facing") if key in field.value]
    if len(given) > 1:
        field.refuse("'%s' and '%s' exclude each other; leave one of them out" % tuple(given[:2]))
    if given == ["normals"]:
        field.below("normals").list(count)
        return np.array([unit(item) for item in field.below("normals").items()])
    return np.array([unit(field.below(given[0])) if given else np.array([0.0, 0.0, 1.0])] * count)


def read_start(field, contacts):
    field.map(START_KEYS)
    stands = {}
    if "contacts" in field.value:
        below = field.below("contacts")
        for name in below.map(contacts):
            stands[name] = read_way(below.below(name), ("xyz", "rpy"))
    return Start(stands, optional(field, "com", lambda each: read_centre(each, contacts)), read_body(field), optional(field, "joints", joint_targets, {}))


def read_centre(field, contacts):
    """A target of the centre of mass."""
    if field.value == FREE:
        return CentreTarget(FREE, None)
    field.map(("over", "xy", "by"))
    if len(field.value) != 1:
        field.refuse("has %d keys; write over: [CONTACT], xy: [x, y] or by: [x, y], or free" % len(field.value))
    (kind,) = field.value
    below = field.below(kind)
    value = names_in(below, contacts) if kind == "over" else numbers(below, 2)
    if kind == "over" and not value:
        below.refuse("names no contact; write one")
    return CentreTarget(kind, value)


def read_body(field):
    """Height and orientation among a map's keys, or None."""
    if "height" in field.value and "rise" in field.value:
        field.refuse("'height' and 'rise' exclude each other; leave one of them out")
    kind = next((key for key in ("height", "rise") if key in field.value), None)
    rpy = optional(field, "rpy", lambda each: numbers(each, 3))
    if kind is None and rpy is None:
        return None
    return BodyTarget(kind, within(field, kind, None, -FARTHEST, FARTHEST) if kind else None, rpy)


def read_way(field, known=("to", "by", "rpy", "lift", "lands")):
    """Where a contact goes. In a start the key is xyz, and there is no way."""
    field.map(known)
    goal = "to" if "to" in known else "xyz"
    if goal in field.value and "by" in field.value:
        field.refuse("'to' and 'by' exclude each other; leave one of them out")
    if goal == "xyz" and goal not in field.value:
        field.refuse("'xyz' is missing; write xyz: [x, y, z] of the contact's middle")
    to = optional(field, goal, lambda each: numbers(each, 3))
    by = optional(field, "by", lambda each: numbers(each, 3), np.zeros(3))
    rpy = optional(field, "rpy", lambda each: numbers(each, 3))
    lift = np.zeros(3)
    if "lift" in field.value:
        below = field.below("lift")
        lift = numbers(below, 3) if isinstance(below.value, list) else np.array([0.0, 0.0, below.number(0)])
    return Way(to, by, rpy, lift, field.below("lands").flag() if "lands" in field.value else True)


def read_phase(field, number, contacts):
    field.map(PHASE_KEYS)
    if "duration" not in field.value:
        field.refuse("'duration' is missing; write it in seconds")
    duration = within(field, "duration", None, 1e-3, LONGEST_PHASE)
    body = None
    if "body" in field.value:
        below = field.below("body")
        below.map(("height", "rise", "rpy"))
        body = read_body(below)
    ways = {}
    if "move" in field.value:
        below = field.below("move")
        ways = {name: read_way(below.below(name)) for name in below.map(contacts)}
    release = names_in(field.below("release"), contacts) if "release" in field.value else []
    for name in release:
        if name in ways:
            field.below("release").refuse("'%s' is moved in this phase, too; leave it out of one" % name)
    name = field.below("name").text() if "name" in field.value else "phase %d" % (number + 1)
    return Phase(field.path, name, duration, optional(field, "com", lambda each: read_centre(each, contacts)), body, ways, release,
                 optional(field, "joints", joint_targets, {}))
