"""Names in unnamed namespaces: two files that may be compiled together (cmake/compile_time.cmake) have none in common."""
import collections
import re

from source_files import ROOT, sources

PROGRAMS = ["src/geometry", "src/model", "src/contact", "src/reduction", "src/dynamics", "src/sim", "src/ros", "test/geometry", "test/model",
            "test/contact", "test/reduction", "test/dynamics", "test/sim", "test/ros"]
UNNAMED = re.compile(r"^namespace \{\n(.*?)^\}  // namespace\n", re.MULTILINE | re.DOTALL)
TYPE = re.compile(r"^(?:template <[^\n]*>\n)?(?:struct|class|enum class|enum) (?:alignas\(\w+\) )?(\w+)", re.MULTILINE)
CONSTANT = re.compile(r"^(?:constexpr|const|static const|thread_local)\b[^\n(={]*?(\w+)(?:\[\w*\])*(?: =|\(|\{)", re.MULTILINE)
FURTHER_CONSTANT = re.compile(r", ([A-Z][A-Z0-9_]*) = ")
FUNCTION = re.compile(r"^(?!constexpr|const |using|return|TEST|TYPED_TEST|INSTANTIATE|static_assert|struct|class|enum|#|//|/\*|\}| )[\w:<>,&*\[\] ]*?(\w+)\([^\n]*$",
                      re.MULTILINE)


def constants_of(text):
    return set(CONSTANT.findall(text)) | {name for line in text.splitlines() if line.startswith("constexpr ") for name in FURTHER_CONSTANT.findall(line)}


def names_of(text):
    """Types, constants and functions of a file's unnamed namespaces. An alias may be declared twice alike."""
    names = set()
    for block in UNNAMED.findall(text):
        for rule in (TYPE, CONSTANT, FUNCTION):
            names.update(rule.findall(block))
        names |= constants_of(block)
    return names


def test_files_compiled_together_share_no_name():
    shared = []
    for program in PROGRAMS:
        files = collections.defaultdict(list)
        for path in sorted((ROOT / program).rglob("*.cpp")):
            for name in names_of(path.read_text()):
                files[name].append(str(path.relative_to(ROOT)))
        shared += ["%s: %s" % (name, ", ".join(paths)) for name, paths in sorted(files.items()) if len(paths) > 1]
    assert not shared, "rename in all but one file:\n" + "\n".join(shared)


def test_no_name_is_that_of_a_header():
    """One in an unnamed namespace hides the header's from all files that are compiled with it: types of the rooms, and constants of a room
    and of its tests."""
    types = set()
    for path in sources("include", "src"):
        if path.suffix == ".h":
            types.update(TYPE.findall(path.read_text()))
    hidden = []
    for program in PROGRAMS:
        room = program.split("/")[1]
        headers = [path for folder in ("include/blem_sim/" + room, "src/" + room, "test/" + room, "test/support") for path in (ROOT / folder).rglob("*.h")]
        constants = set().union(*(constants_of(path.read_text()) for path in headers))
        for path in sorted((ROOT / program).rglob("*.cpp")):
            blocks = UNNAMED.findall(path.read_text())
            names = {name for block in blocks for name in set(TYPE.findall(block)) & types | constants_of(block) & constants}
            hidden += ["%s: %s" % (path.relative_to(ROOT), name) for name in sorted(names)]
    assert not hidden, "rename:\n" + "\n".join(hidden)


def test_the_rule_sees_names():
    text = """namespace blem_sim {
namespace {

constexpr double FAR = 1, NEAR = 2;  // [m]
const Vector3 CUBE(1, 1, 1);
using Clock = Other::Clock;
struct Found {
  int inside;
};
template <class T>
std::vector<T> sorted(T first) {
  return {first};
}
bool isNear(double x) { return check(x); }

TEST(Some, Thing) { isNear(1); }

}  // namespace
int outside() { return 1; }
}  // namespace blem_sim
"""
    assert names_of(text) == {"FAR", "NEAR", "CUBE", "Found", "sorted", "isNear"}
