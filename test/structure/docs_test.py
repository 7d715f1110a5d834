"""Documentation: relative links, images and anchors lead somewhere, files that are named exist, and table cells stay short enough to be read in a table."""
import pathlib
import re
import sys
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts" / "support"))
from markdown import ELSEWHERE, headings, links, prose  # noqa: E402

PAGES = [ROOT / "README.md"] + sorted((ROOT / "docs").rglob("*.md"))
# Pages whose tables are read from top to bottom; one that does not exist is left out.
SHORT_CELLS = ["docs/decisions.md", "docs/reduction.md", "docs/tour.md", "docs/validation.md", "docs/solver.md", "docs/contacts.md",
               "docs/architecture.md", "README.md"] + [
    str(page.relative_to(ROOT)) for folder in ("validation", "solver") for page in sorted((ROOT / "docs" / folder).glob("*.md"))]
MOST_WORDS = 40

SPAN = re.compile(r"`([^`]+)`")
FILE = re.compile(r"(?<![\w./])((?:(?:include|src|test|benchmark|scripts)/[\w/.]*)?\w+\.(?:h|cpp|py))\b")


def anchors(text):
    return {anchor for _, anchor in headings(text)}


def wrong_link(page, target, root=ROOT):
    """Why a link of a page leads nowhere, or None."""
    if ELSEWHERE.match(target):
        return None
    path, _, anchor = urllib.parse.unquote(target).partition("#")
    if path.startswith("/"):
        return "is no relative path"
    file = (page.parent / path).resolve() if path else page.resolve()
    if root.resolve() not in [file] + list(file.parents):
        return "leads out of the repository"
    if not file.exists():
        return "does not exist"
    if anchor and file.suffix == ".md" and anchor not in anchors(file.read_text()):
        return "has no such heading"
    return None


def missing_files(text, names):
    """(number of the line, file) of C++ and Python files that code spans name and the repository does not have. @param names of all its files"""
    for number, line in prose(text):
        for span in SPAN.findall(line):
            for file in FILE.findall(span):
                if not (ROOT / file).exists() and ("/" in file or file not in names):
                    yield number, file


def long_cells(text):
    """(number of the line, words) of table cells with too many words."""
    for number, line in prose(text):
        if not line.lstrip().startswith("|"):
            continue
        for cell in re.split(r"(?<!\\)\|", line.strip().strip("|")):
            words = len(cell.split())
            if words > MOST_WORDS:
                yield number, words


def test_links_lead_somewhere():
    wrong = []
    for page in PAGES:
        for number, target in links(page.read_text()):
            reason = wrong_link(page, target)
            if reason:
                wrong.append("%s:%d: %s %s" % (page.relative_to(ROOT), number, target, reason))
    assert not wrong, "\n".join(wrong)


def test_named_files_are_there():
    names = {path.name for top in ("include", "src", "test", "benchmark", "scripts") for path in (ROOT / top).rglob("*")}
    wrong = ["%s:%d: there is no %s" % (page.relative_to(ROOT), number, file)
             for page in PAGES for number, file in missing_files(page.read_text(), names)]
    assert not wrong, "\n".join(wrong)


def test_table_cells_are_short():
    pages = [ROOT / name for name in SHORT_CELLS if (ROOT / name).exists()]
    wrong = ["%s:%d: a cell of %d words, %d at most" % (page.relative_to(ROOT), number, words, MOST_WORDS)
             for page in pages for number, words in long_cells(page.read_text())]
    assert not wrong, "\n".join(wrong)


def test_the_rules_see_what_is_wrong(tmp_path):
    page, other = tmp_path / "page.md", tmp_path / "other.md"
    page.write_text("# First\n## A `name_b`: [c](other.md), d!\n## First\n```\n# no heading\n[x](nowhere.md)\n```\n`[x](nowhere.md)`\n"
                    "![picture](missing.png) [b](other.md#two) <img src='missing.svg'>\n[e]: other.md#three\n")
    other.write_text("# Two\n")
    assert anchors(page.read_text()) == {"first", "a-name_b-c-d", "first-1"}
    assert [target for _, target in links(page.read_text())] == ["other.md", "missing.png", "other.md#two", "missing.svg", "other.md#three"]
    for target in ("missing.png", "other.md#three", "#second", "../outside.md", "/other.md"):
        assert wrong_link(page, target, tmp_path), target
    for target in ("other.md", "other.md#two", "#first-1", "https://example.org/x#y", "mailto:a@example.org"):
        assert wrong_link(page, target, tmp_path) is None, target
    assert [file for _, file in missing_files("`src/nowhere.cpp`, `nothing.h`, `other.h` nothing.py\n", {"other.h"})] == ["src/nowhere.cpp", "nothing.h"]
    long_row = "| a | %s |" % " ".join(["word"] * (MOST_WORDS + 1))
    assert list(long_cells("| b | c |\n|---|---|\n%s\n" % long_row)) == [(3, MOST_WORDS + 1)]
    assert not list(long_cells("```\n%s\n```\n" % long_row))
