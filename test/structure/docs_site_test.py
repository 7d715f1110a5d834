"""The docs site: pages become what Doxygen understands, and the whole site is built without a warning."""
import pathlib
import shutil
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts" / "support"))
from page_for_doxygen import for_doxygen  # noqa: E402


def test_headings_and_links_of_a_page_have_labels():
    page = ("# Page\n## A `b`, c\n[d](#a-b-c) [e](other.md#two) [f](other.md) [g](https://example.org/x#y) ![h](h.png) [i](../i.yaml)\n"
            "`[j](#j)` [`k`](../k.h)\n```\n## l\n[m](#m)\n```\n")
    assert for_doxygen(page, "docs/page.md") == (
        "# Page\n## A `b`, c {#page-a-b-c}\n[d](@ref page-a-b-c) [e](@ref other-two) [f](other.md) [g](https://example.org/x#y) ![h](h.png) i (`../i.yaml`)\n"
        "`[j](#j)` `k`\n```\n## l\n[m](#m)\n```\n")


@pytest.mark.skipif(not shutil.which("doxygen"), reason="doxygen is not installed")
def test_the_site_is_built_without_a_warning(tmp_path):
    made = subprocess.run([str(ROOT / "scripts" / "docs"), str(tmp_path)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
    assert made.returncode == 0, made.stderr
    assert made.stdout.strip() == str(tmp_path / "html" / "index.html")
    assert "A humanoid on a scanned floor" in (tmp_path / "html" / "index.html").read_text(encoding="utf-8")
    assert (tmp_path / "html" / "md_docs_contacts.html").exists()
    assert (tmp_path / "html" / "classblem__sim_1_1sim_1_1Simulator.html").exists()


def test_arguments_that_are_none_are_refused():
    for arguments in (["--nothing"], ["one", "two"]):
        made = subprocess.run([str(ROOT / "scripts" / "docs")] + arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
        assert made.returncode == 2 and made.stderr.startswith("usage: scripts/docs"), made.stderr
