"""Functions take at most five parameters, or a struct that says what they are."""
import re

from source_files import ROOT, sources

MOST_PARAMETERS = 5
COMMENT_OR_TEXT = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.DOTALL)
NAME = re.compile(r"([\w~]+)\)?\s*$")
# A type, and a name: a call's arguments have no such pair, or hold an operator.
PARAMETER = re.compile(r"^\s*(?:const\s+)?[\w:]+(?:<[^()]*>)?(?:::\w+)?\s*(?:const\s*)?[&*]*\s*(?:const\s+)?[&*]*\s*\w+(?:\[\w*\])?(?:\s*=.*)?\s*$", re.DOTALL)
RETURNED = re.compile(r"\breturn\s+$")
WITHOUT_NAME = re.compile(r"^\s*(?:const\s+)?[\w:]+(?:<[^()]*>)?\s*(?:[&*]+|\s+const)\s*$", re.DOTALL)


def parts(text):
    """The text between commas that stand in no brackets."""
    found, depth, begin = [], 0, 0
    for i, letter in enumerate(text):
        if letter in "([{<":
            depth += 1
        elif letter in ")]}>" and text[i - 1:i] != "-":
            depth -= 1
        elif letter == "," and depth == 0:
            found.append(text[begin:i])
            begin = i + 1
    return found + [text[begin:]]


def arguments(text, opened):
    """Text between a bracket and the one that closes it."""
    depth, i = 1, opened + 1
    while depth and i < len(text):
        depth += (text[i] == "(") - (text[i] == ")")
        i += 1
    return text[opened + 1:i - 1]


def long_signatures(text):
    """Names of functions declared or defined with too many parameters."""
    code = COMMENT_OR_TEXT.sub(" ", text)
    for bracket in re.finditer(r"\(", code):
        name = NAME.search(code, max(0, bracket.start() - 60), bracket.start())
        if not name or RETURNED.search(code[max(0, name.start() - 20):name.start()]):
            continue
        if name[1].isupper():  # a macro, whose arguments are no parameters
            continue
        each = parts(arguments(code, bracket.start()))
        if len(each) > MOST_PARAMETERS and all(PARAMETER.match(part) or WITHOUT_NAME.match(part) for part in each):
            yield name[1]


def found_in(*folders):
    return {"%s: %s" % (path.relative_to(ROOT), name) for path in sources(*folders) for name in long_signatures(path.read_text())}


def test_functions_take_few_parameters():
    found = found_in("include", "src")
    assert not found, "give these a struct with a name:\n" + "\n".join(sorted(found))


def test_the_rule_sees_long_signatures():
    assert list(long_signatures("void f(int a, int b, int c, int d, int e, int f);")) == ["f"]
    assert list(long_signatures("void A::f(const B& a, std::vector<C, D>* b, double c = 1, E* d, F e[3], G f) {")) == ["f"]
    assert list(long_signatures("bool (*test)(const V* a, const E* b, R in, double c, T* d, int* e);")) == ["test"]
    assert not list(long_signatures("void f(int a, int b, int c, int d, const std::map<int, int>& e);"))
    assert not list(long_signatures("g(a, b, c, d, e, f); h(1, 2, x.y, 3 * z, 4, 5);"))
