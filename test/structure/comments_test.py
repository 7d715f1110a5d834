"""Comments begin with a noun that the glossary or the field knows, not with a clause or an inverted question."""
import re

from source_files import ROOT, sources

# "Whether" is how predicates begin.
CLAUSE = re.compile(r"(?:What|Who|Whom|Whose|How|Which|Where|Did|Does|Do|Is|Are|Can|May|Would|Has|Have|Of)\b(?![^.]*,)")
FIRST = re.compile(r"^\s*(?:/\*\*|///<?|//)\s*(?P<text>\S.*)$")


def first_lines(path):
    """(number, text) of the first line of every comment that stands on lines of its own."""
    inside = False
    for number, line in enumerate(path.read_text().splitlines(), 1):
        match = FIRST.match(line)
        if match and not inside:
            yield number, match["text"]
        inside = bool(match) and line.lstrip().startswith("//")


def test_comments_begin_with_their_subject():
    bad = ["%s:%d: %s" % (path.relative_to(ROOT), number, text)
           for path in sources("benchmark", "include", "src", "test") for number, text in first_lines(path) if CLAUSE.match(text)]
    assert not bad, "comments whose subject is a clause or that ask:\n" + "\n".join(bad)
