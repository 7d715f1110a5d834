#!/usr/bin/python3
"""A page of the documentation as Doxygen reads it: headings have labels PAGE-ANCHOR, links to headings name them, links to files that are no pages are plain code.

Usage: scripts/support/page_for_doxygen.py FILE.md   run by Doxygen in the repository's folder
"""
import pathlib
import re
import sys

from markdown import ELSEWHERE, headings, prose

CODE_OR_LINK = re.compile(r"(?P<code>(?P<ticks>`+)(?!`).*?(?<!`)(?P=ticks)(?!`))|(?<!!)\[(?P<text>[^\]]*)\]\((?P<target>[^)\s]+)\)")


def link(text, target, page):
    path, _, anchor = target.partition("#")
    if ELSEWHERE.match(target) or (path.endswith(".md") and not anchor):
        return "[%s](%s)" % (text, target)
    if anchor:
        return "[%s](@ref %s-%s)" % (text, pathlib.PurePath(path or page).stem, anchor)
    return text if text.startswith("`") else "%s (`%s`)" % (text, path)


def for_doxygen(text, page):
    lines = text.splitlines()
    for number, anchor in headings(text):
        if not lines[number - 1].startswith("# "):  # the page's own title
            lines[number - 1] += " {#%s-%s}" % (pathlib.PurePath(page).stem, anchor)
    for number, line in list(prose("\n".join(lines))):
        lines[number - 1] = CODE_OR_LINK.sub(lambda found: found[0] if found["code"] else link(found["text"], found["target"], page), line)
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.stdout.write(for_doxygen(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8"), sys.argv[1]))
