"""Every room has one namespace, blem_sim::ROOM; that of ros is blem_sim::node, since `ros` is roscpp's."""
import re

from source_files import ROOT, sources

NAMESPACES = {"geometry": "geometry", "model": "model", "contact": "contact", "reduction": "reduction", "dynamics": "dynamics", "sim": "sim",
              "ros": "node", "python": "python"}
# The vocabulary of every room.
SHARED = ["include/blem_sim/geometry/types.h", "include/blem_sim/geometry/input_error.h"]
OPENED = re.compile(r"^namespace (blem_sim[\w:]*) \{", re.MULTILINE)


def strays(text, namespace):
    """Namespaces that a file of a room opens beside the room's own and those within it."""
    return [name for name in OPENED.findall(text) if name != namespace and not name.startswith(namespace + "::")]


def test_rooms_keep_to_their_namespaces():
    found = []
    for room, name in NAMESPACES.items():
        for path in sources("include/blem_sim/" + room, "src/" + room, "test/" + room):
            file = str(path.relative_to(ROOT))
            if file not in SHARED:
                found += ["%s: %s" % (file, stray) for stray in strays(path.read_text(), "blem_sim::" + name)]
    assert not found, "these belong into the namespace of their room:\n" + "\n".join(found)


def test_the_rule_sees_strays():
    text = "namespace blem_sim {\n}\nnamespace blem_sim::contact {\n}\nnamespace blem_sim::contact::kernels {\n}\nnamespace blem_sim::contacts {\n}\n"
    assert strays(text, "blem_sim::contact") == ["blem_sim", "blem_sim::contacts"]
