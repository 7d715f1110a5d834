"""docs/troubleshooting.md: every heading is a message that some source prints."""
import re

from source_files import ROOT, sources

PAGE = ROOT / "docs" / "troubleshooting.md"
SPLIT_LITERAL = re.compile(r'"\s*\n?\s*"')
PLACEHOLDER = re.compile(r"\{[^{}\"]*\}|%[-+.0-9l]*[sdufge]")


def printed():
    """All string literals of the sources, neighbours joined, one text per file."""
    return [SPLIT_LITERAL.sub("", path.read_text()) for path in sources("include", "src")]


def headings():
    return re.findall(r"^## (.+)$", PAGE.read_text(), re.MULTILINE)


def is_printed(heading, texts):
    """Whether one file has the heading, its `...` standing for a placeholder."""
    return any(heading in PLACEHOLDER.sub("...", text) for text in texts)


def test_headings_are_messages():
    texts = printed()
    unknown = [heading for heading in headings() if not is_printed(heading, texts)]
    assert not unknown, "\n".join(unknown)
    assert len(headings()) > 25


def test_the_rule_sees_a_message_that_nobody_prints():
    assert not is_printed("the moon is not below a folder", printed())
    assert is_printed("bodies that touch or are jointed gained energy out of nothing", printed())
