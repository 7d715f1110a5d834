"""C++ files of this project, and what they include."""
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)
INCLUDE_IN_QUOTES = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.MULTILINE)


def sources(*folders):
    """Paths of all headers and sources below folders of the project, in order."""
    for folder in folders:
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix in (".h", ".cpp"):
                yield path
