"""Every file includes what it uses of the headers that some builds precompile (cmake/compile_time.cmake), by itself or by headers of ours."""
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


def included(path, seen):
    """Names of all headers that a file includes, those of our own headers too."""
    names = set()
    for name in INCLUDE.findall(path.read_text()):
        names.add(name)
        room = path.relative_to(ROOT).parts
        places = [path.parent, ROOT / "include", ROOT / "test", ROOT / "src" / "ros"] + [ROOT / "src" / part for part in room[1:2]]
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


def unknown(code, functions, known):
    """Those of the tests' functions that `code` calls and that neither it nor the `known` texts declare."""
    return [name for name in functions if re.search(r"(?<![\w.>:])%s\(" % name, code)
            and not any(re.search(r"(?!return|else)\b\w[\w>&*]* [&*]?%s\(" % name, text) for text in [code] + known)]


def test_files_include_the_headers_of_the_tests_whose_functions_they_call():
    texts = {path: COMMENT.sub(" ", path.read_text()) for path in sources("include", "src", "test")}
    functions = sorted({name for path in sources("test") if path.suffix == ".h" for name in TEST_FUNCTION.findall(texts[path])})
    assert len(functions) > 100
    wrong = []
    for path in sources("test"):
        seen = {path}
        included(path, seen)
        wrong += ["%s calls %s" % (path.relative_to(ROOT), name)
                  for name in unknown(texts[path], functions, [texts[file.resolve()] for file in seen])]
    assert not wrong, "\n".join(wrong)


def test_the_rule_sees_a_function_of_a_header_that_is_not_included():
    assert unknown("narrowPhase(searchRoom());", ["searchRoom"], ["int other();"]) == ["searchRoom"]
    assert unknown("narrowPhase(searchRoom());", ["searchRoom"], ["inline Room* searchRoom() {}"]) == []
    assert unknown("return searchRoom();", ["searchRoom"], []) == ["searchRoom"]
    assert unknown("narrowPhase(my.searchRoom());", ["searchRoom"], []) == []
