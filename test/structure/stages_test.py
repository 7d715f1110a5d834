"""A stage of the step has one name in the code, in the profile and in the documents."""
import re

from source_files import ROOT

TABLE_ROW = re.compile(r"^\| `?(\w+)`?[^|]*\|", re.MULTILINE)


def text(path):
    return (ROOT / path).read_text()


def stages_of_profile():
    """Names that reports and messages tell, in their order."""
    return re.findall(r'"(\w+)"', text("src/sim/step_report.cpp").split("STAGE_NAMES")[1])


def stages_of_enum():
    listed = re.search(r"enum class Stage \{([^}]*), COUNT \}", text("include/blem_sim/sim/step_report.h"))[1]
    return [name.strip().lower() for name in listed.split(",")]


def stages_of_document():
    """First column of the table; the node's publishing is timed by itself."""
    table = text("docs/architecture.md").split("## One step")[1].split("\n\nA step")[0]
    return [name for name in TABLE_ROW.findall(table) if name not in ("stage", "publish")]


def function_of(stage):
    first, *others = stage.split("_")
    return first + "".join(word.capitalize() for word in others)


def timed_stages(code):
    """Functions of the simulator that time a stage, and its name."""
    found = {}
    for body in re.split(r"^(?=\S.*Simulator::Impl::)", code, flags=re.MULTILINE)[1:]:
        timed = re.search(r"^  const StageTimer timer\(&report_\.profile, Stage::(\w+)\);", body, re.MULTILINE)
        if timed:
            found[re.search(r"Simulator::Impl::(\w+)\(", body)[1]] = timed[1].lower()
    return found


def test_profile_and_document_name_the_same_stages():
    assert stages_of_profile() == stages_of_enum()
    assert stages_of_profile() == stages_of_document()


def test_each_stage_is_a_function_of_its_name_that_the_step_calls():
    timed = timed_stages(text("src/sim/simulator_step.cpp") + text("src/sim/simulator_report.cpp"))
    step = text("src/sim/simulator_step.cpp").split("StepReport& Simulator::Impl::step() {")[1].split("\n}\n")[0]
    for stage in stages_of_enum():
        assert timed.get(function_of(stage)) == stage, "no function %s that is timed as %s" % (function_of(stage), stage)
        assert re.search(r"\b%s\(" % function_of(stage), step), "step() does not call %s" % function_of(stage)


def test_the_rule_sees_a_function_of_another_name():
    assert timed_stages("void Simulator::Impl::readSensors() {\n  const StageTimer timer(&report_.profile, Stage::SENSORS);\n}\n") == \
        {"readSensors": "sensors"}
    assert function_of("sample_commands") == "sampleCommands"
