"""docs/python.md: its code runs, and prints what the page says."""
import contextlib
import io
import pathlib
import re

PAGE = pathlib.Path(__file__).resolve().parents[2] / "docs" / "python.md"


def test_code_of_the_page_prints_what_it_says(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"^```(\w*)\n(.*?)^```$", PAGE.read_text(), re.MULTILINE | re.DOTALL)
    code = "\n".join(text for language, text in blocks if language == "python")
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(code, str(PAGE), "exec"), {})
    assert printed.getvalue() == "".join(text for language, text in blocks if not language)


def test_page_names_all_there_is():
    import blem_sim
    text = PAGE.read_text()
    for name in dir(blem_sim.Simulator):
        assert name.startswith("_") or re.search(r"`%s\b" % name, text), name
