"""Every file includes what it uses of the headers that some builds precompile (cmake/compile_time.cmake), by itself or by headers of ours."""
import functools
import re

from source_files import INCLUDE, ROOT, sources

COMMENT = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.DOTALL)

# What a file says -> the headers that give it.
PROVIDERS = {
    r"\bEigen::|\bVector3\b": ["Eigen/"],
    r"\bstd::(?:sort|stable_sort|max|min|clamp|find_if|any_of|all_of|none_of|lower_bound|upper_bound|fill|copy|transform|count_if|"
    r"reverse|unique|max_element|min_element|nth_element|equal|lexicographical_compare)\(": ["algorithm"],
    r"\bstd::array<": ["array"],
    r"\bstd::(?:sqrt|abs|sin|cos|atan2|hypot|floor|ceil|isfinite|isnan|pow|exp)\(": ["cmath"],
    r"\bu?int(?:8|16|32|64)_t\b": ["cstdint"],
    r"\bstd::function<": ["functional"],
    r"\bstd::numeric_limits<": ["limits"],
    r"\bstd::(?:multi)?map<": ["map"],
    r"\bstd::(?:unique_ptr|shared_ptr|make_unique|make_shared|weak_ptr)\b": ["memory"],
    r"\bstd::(?:iota|accumulate|partial_sum)\(": ["numeric"],
    r"\bstd::(?:multi)?set<": ["set"],
    r"\bstd::(?:string|to_string)\b": ["string"],
    r"\bstd::vector<": ["vector"],
    r"\bfor \([^;(){}]* : \{": ["initializer_list", "algorithm", "functional", "map", "memory", "set", "string", "vector", "Eigen/", "gtest/",
                                  "ros/"],
    r"^TEST(?:_F|_P)?\(": ["gtest/gtest.h"],
    r"\bros::(?:NodeHandle|Publisher|Subscriber|ServiceServer)\b": ["ros/"],
    r"\bROS_(?:INFO|WARN|ERROR)": ["ros/console.h"],
    r"\bboost::make_shared\b": ["boost/make_shared.hpp"],
}

# A function of a header of the tests: its name has two words, so that it is nobody's variable.
TEST_FUNCTION = re.compile(r"^inline [^(;={]*?\b([a-z]+[A-Z]\w*)\(", re.MULTILINE)

# A type of ours of two words.
TYPE = re.compile(r"^(?:class|struct|enum class) ([A-Z][a-z]+[A-Z]\w*)(?: final)?(?: : [^;{]*)?\s*\{", re.MULTILINE)


@functools.lru_cache(maxsize=None)
def included_names(path):
    return INCLUDE.findall(path.read_text())


def included(path, seen):
    """Names of all headers that a file includes, those of our own headers too."""
    names = set()
    for name in included_names(path):
        names.add(name)
        room = path.relative_to(ROOT).parts
        places = [path.parent] + [ROOT / place for place in ("include", "test", "src/ros", "src/tools", "src/tools/common")] + [
            ROOT / "src" / part for part in room[1:2]]
        for own in (place / name for place in places):
            if own.is_file() and own not in seen:
                seen.add(own)
                names |= included(own, seen)
    return names


def missing(text, names):
    """Headers that `text` needs and that are not among the names it includes."""
    code = COMMENT.sub(" ", text)
    return [headers[0] for pattern, headers in PROVIDERS.items()
            if re.search(pattern, code, re.MULTILINE) and not any(name.startswith(header) for name in names for header in headers)]


def test_files_include_what_they_use():
    wrong = []
    for path in sources("include", "src", "test"):
        wrong += ["%s uses <%s>" % (path.relative_to(ROOT), header) for header in missing(path.read_text(), included(path, {path}))]
    assert not wrong, "\n".join(wrong)


def test_the_rule_sees_what_is_missing():
    assert missing("std::vector<int> a;", {"string"}) == ["vector"]
    assert missing("std::vector<int> a;", {"vector"}) == []
    assert missing("// std::vector<int>", set()) == []
    assert missing("TEST(A, b) {}", {"vector"}) == ["gtest/gtest.h"]
    assert missing("for (const int n : {1, 2})", {"csignal"}) == ["initializer_list"]


def is_test(path):
    return path.relative_to(ROOT).parts[0] == "test"


def unknown_functions(code, functions, known):
    """Those of the tests' functions that `code` calls and that neither it nor the `known` texts declare."""
    called = set(re.findall(r"(?<![\w.>:])(\w+)\(", code))
    return [name for name in functions if name in called
            and not any(re.search(r"(?!return|else)\b\w[\w>&*]* [&*]?%s\(" % name, text) for text in [code] + known)]


def unknown_types(code, types, known):
    """Those of our types that `code` names outside of tests' names and that neither it nor the `known` texts declare."""
    named = set(re.findall(r"(?<![\w.>:])[A-Z]\w+", re.sub(r"^TEST.*$", "", code, flags=re.MULTILINE)))
    return [name for name in types if name in named
            and not any(re.search(r"(?:class|struct|using) %s\b" % name, text) for text in [code] + known)]


def test_files_include_the_headers_of_ours_that_they_use():
    texts = {path: COMMENT.sub(" ", path.read_text()) for path in sources("include", "src", "test")}
    headers = [path for path in texts if path.suffix == ".h"]
    functions = sorted({name for path in headers if is_test(path) for name in TEST_FUNCTION.findall(texts[path])})
    types = sorted({name for path in headers for name in TYPE.findall(texts[path])})
    assert len(functions) > 100 and len(types) > 500
    wrong = []
    for path, code in texts.items():
        seen = {path}
        included(path, seen)
        known = [texts[file.resolve()] for file in seen]
        unknown = unknown_types(code, types, known) + (unknown_functions(code, functions, known) if is_test(path) else [])
        wrong += ["%s does not include %s" % (path.relative_to(ROOT), name) for name in unknown]
    assert not wrong, "\n".join(wrong)


def test_the_rule_sees_what_is_not_included():
    assert unknown_functions("narrowPhase(searchRoom());", ["searchRoom"], ["int other();"]) == ["searchRoom"]
    assert unknown_functions("narrowPhase(searchRoom());", ["searchRoom"], ["inline Room* searchRoom() {}"]) == []
    assert unknown_functions("return searchRoom();", ["searchRoom"], []) == ["searchRoom"]
    assert unknown_functions("narrowPhase(my.searchRoom());", ["searchRoom"], []) == []
    assert unknown_types("void run(SimulationLoop* loop);", ["SimulationLoop"], ["class Simulator {"]) == ["SimulationLoop"]
    assert unknown_types("void run(SimulationLoop* loop);", ["SimulationLoop"], ["class SimulationLoop;"]) == []
    assert unknown_types("TEST(SimulationLoop, Runs) {", ["SimulationLoop"], []) == []
