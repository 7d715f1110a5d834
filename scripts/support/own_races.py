#!/usr/bin/python3
"""Reports of the thread sanitizer that are of this project's own code.

Usage: own_races.py FOLDER ROOT
FOLDER: the sanitizer's report files; ROOT: the project, whose path stands in the frames of its files.
Prints each kind of own report once, then how many there are and how many of others' libraries; exits with 1 if there are own ones.

Libraries that are not compiled with the sanitizer, such as roscpp, hand memory from thread to thread by atomics that it does not see, and
lock mutexes in an order of their own. A report is own if each of its stacks, from the access upwards, meets a file of the project
before it meets such a library.
"""
import pathlib
import re
import sys

FRAME = re.compile(r"\s+#\d+ (.*)")
ORIGIN = re.compile(r" created |Location is|Hint:")
# Of the sanitizer, of libc and of the project's own operator new.
RUNTIME = re.compile(r"libtsan|libstdc\+\+|libc\.so|sanitizer|operator (new|delete)")


def stacks(report):
    """Frames of each access or lock that a report is about, top first: list of lists of str."""
    found = []
    for block in report.split("\n\n"):
        lines = block.splitlines()
        frames = [match.group(1) for match in map(FRAME.match, lines) if match]
        heads = [line for line in lines if line.strip() and not FRAME.match(line)]
        if frames and not (heads and ORIGIN.search(heads[-1])):
            found.append(frames)
    return found


def is_own(frames, root):
    """Whether a stack meets a file of the project before another's library."""
    for frame in frames:
        if RUNTIME.search(frame):
            continue
        if root in frame.rsplit(" (", 1)[0]:
            return True
        if "blem_sim" not in frame.rsplit("(", 1)[-1]:
            return False
    return False


def main(folder, root):
    own, others = {}, 0
    for path in sorted(pathlib.Path(folder).iterdir()):
        for report in path.read_text(errors="replace").split("=================="):
            if "WARNING: ThreadSanitizer" not in report:
                continue
            found = stacks(report)
            if found and all(is_own(frames, root) for frames in found):
                own.setdefault(tuple(frames[0] for frames in found), report)
            else:
                others += 1
    for report in own.values():
        print(report)
    print(f"{len(own)} own races, {others} reports of libraries without the sanitizer")
    return 1 if own else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
