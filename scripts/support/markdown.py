"""Markdown as GitHub reads it: prose without fenced code, links, anchors of headings."""
import re

FENCE = re.compile(r"^\s*(```+|~~~+)")
CODE = re.compile(r"(`+)(?!`).*?(?<!`)\1(?!`)")
# [text](target "title"), images too; <img src="target">, <a href="target">; [name]: target
INLINE = re.compile(r"\]\(\s*<?([^)\s>]+)>?(?:\s+(?:\"[^\"]*\"|'[^']*'))?\s*\)")
HTML = re.compile(r"<(?:img|a)\b[^>]*?\b(?:src|href)\s*=\s*[\"']([^\"']+)[\"']", re.IGNORECASE)
DEFINITION = re.compile(r"^\s{0,3}\[[^\]]+\]:\s*<?([^\s>]+)>?")
HEADING = re.compile(r"^\s{0,3}#{1,6}\s+(.*?)(?:\s+#+)?\s*$")
ELSEWHERE = re.compile(r"^(?:[a-z][a-z0-9+.-]*:|//)", re.IGNORECASE)


def prose(text):
    """(number, line) of all lines outside fenced code."""
    fence = None
    for number, line in enumerate(text.splitlines(), 1):
        match = FENCE.match(line)
        if match and fence is None:
            fence = match[1]
        elif fence is not None:
            if match and match[1].startswith(fence) and not line.strip().strip(fence[0]):
                fence = None
        else:
            yield number, line


def links(text):
    """(number of the line, target) of all links and images outside code."""
    for number, line in prose(text):
        line = CODE.sub("", line)
        for pattern in (INLINE, HTML, DEFINITION):
            for target in pattern.findall(line):
                yield number, target


def headings(text):
    """(number of the line, anchor) of a page's headings, as GitHub makes them: small letters, hyphens for spaces, no punctuation, numbers for repetitions."""
    repeated = {}
    for number, line in prose(text):
        heading = HEADING.match(line)
        if not heading:
            continue
        words = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading[1])
        anchor = re.sub(r"[^\w\- ]", "", words.strip().lower()).replace(" ", "-")
        count = repeated.get(anchor, 0)
        repeated[anchor] = count + 1
        yield number, "%s-%d" % (anchor, count) if count else anchor
