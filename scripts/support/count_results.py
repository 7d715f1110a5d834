#!/usr/bin/python3
"""Counts the JUnit results below a folder, names what failed, and ends in "N passed, N failed[, N skipped]".

Exits 1 if anything failed or nothing passed.
"""
import pathlib
import sys
import xml.etree.ElementTree as ElementTree


def outcome(case):
    """'failed', 'skipped' or 'passed' of one <testcase>."""
    if case.find("failure") is not None or case.find("error") is not None:
        return "failed"
    if case.find("skipped") is not None or case.get("status") == "notrun" or case.get("result") == "skipped":
        return "skipped"
    return "passed"


def main():
    counts = {"passed": 0, "failed": 0, "skipped": 0}
    for path in sorted(pathlib.Path(sys.argv[1]).rglob("*.xml")):
        if "rosunit" in path.parts:
            continue
        try:
            cases = list(ElementTree.parse(path).getroot().iter("testcase"))
        except ElementTree.ParseError as error:  # of a program that was stopped
            counts["failed"] += 1
            print("FAILED %s: results are not whole: %s" % (path.stem, error))
            continue
        for case in cases:
            result = outcome(case)
            counts[result] += 1
            if result == "failed":
                print("FAILED %s: %s.%s" % (path.stem, case.get("classname", ""), case.get("name")))
    skipped = ", %d skipped" % counts["skipped"] if counts["skipped"] else ""
    print("%d passed, %d failed%s" % (counts["passed"], counts["failed"], skipped))
    return 1 if counts["failed"] or not counts["passed"] else 0


if __name__ == "__main__":
    sys.exit(main())
