"""The paper's figures [Hauser 2013]: what each says, which cases check it, which scene is drawn, and which data it needs."""
import collections
import json
import math
import pathlib
import shutil
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import method_scenes as method  # noqa: E402
from contact_timing import plates, timing_case  # noqa: E402
from drawing import cannot_draw, draw  # noqa: E402
from paper_cases import CASES, WHOLE_ASKED, measure, on_its_own  # noqa: E402
from paper_scenes import PICTURES  # noqa: E402
from shared_data import shared_data  # noqa: E402

# title; says: the paper; cases: {name: (asked, run)}; needs: files of the shared data; drawn: function of a folder that gives
# (scene, time [s], camera); plot: file that a case leaves and that is the picture; robot: of the world, below robots/klampt.
Figure = collections.namedtuple("Figure", "title says cases needs drawn plot robot")
APART = method.WIDTH - method.DEPTH
CROSSED = -0.0005  # [m]
COMBS_VIEW = "0.35,-0.45,0.22,0,0,0"


def of_paper(title, says, cases, picture, needs, robot, plot=None, more=None):
    def drawn(folder):
        make, time, camera = PICTURES[picture]
        return make(), time, camera
    chosen = {name: CASES[name] for name in cases}
    chosen.update(more or {})
    return Figure(title, says, chosen, ["robots/klampt/" + robot] + ["worlds/%s.yaml" % world for world in needs], drawn, plot, robot)


def of_method(title, says, cases, make, time, camera, plot=None):
    return Figure(title, says, cases, [], lambda folder: ((make(folder), None), time, camera), plot, None)


STACKED = "heights within 0.1 mm of theory, no jitter (0.01 mm)"
FIGURES = {
    1: of_method("stack of triangulated cubes, 1 cm apart", "no perceptible jitter over minutes; ten cubes within 0.1 mm of theory for 10 minutes", {
        "three_cubes": (STACKED, method.stacked(3, 180.0, 2.0)), "ten_cubes": (STACKED, method.stacked(10, 600.0, 2.0))},
                 lambda folder: method.stack(3), 2.0, "0.55,-0.75,0.4,0,0,0.15"),
    2: of_paper("Hubo and a scanned stepladder of a million triangles", "climbs stably on a mesh of a million triangles with holes",
                ["hubo_stepladder", "hubo_stepladder_climb", "hubo_stepladder_1m_climb"],
                "stepladder", ["paper_hubo_stepladder_150k", "paper_hubo_stepladder_1m"], "huboplus",
                more={"hubo_stepladder_1m": (WHOLE_ASKED, on_its_own("paper_hubo_stepladder_1m", 10.0))}),
    3: of_paper("a gripper picks up a mug of one layer", "layers of 2.5 mm let it be picked up reliably", ["gripper_mug"], "gripper_mug",
                ["paper_gripper_mug"], "tx90pr2"),
    4: of_method("contacts at a corner", "local features push sideways, the layers' closest points up", {
        "corner": ("goes up, and sideways by less than a thousandth of that", method.corner_case)},
                 lambda folder: method.corner(), 0.001, "0.12,-0.5,0.2,-0.05,0,0.1"),
    5: of_method("a contact for each pair of simplices in reach", "contacts for all pairs closer than the layers' sum", {
        "combs": ("as many as brute force finds: 20 pairs of edges, four pairs of triangles each", method.combs_case)},
                 lambda folder: method.combs(folder.resolve(), APART)[0], 0.001, COMBS_VIEW),
    6: of_method("boundary-layer regime and crossing", "unambiguous while meshes are apart, less robust once they cross", {
        "in_the_layer": ("within the layer, never CONTACT_UNRELIABLE", method.regime_case(APART, False)),
        "crossed": ("beyond the layer, says CONTACT_UNRELIABLE, and comes apart", method.regime_case(CROSSED, True))},
                 lambda folder: method.combs(folder.resolve(), CROSSED)[0], 0.001, COMBS_VIEW),
    7: of_method("time against the number of contacts", "mean 10 ms generation, 2 ms clustering, 25 ms response", {
        "timing": ("contacts grow tenfold, 20 kept at most, none crosses; times stated", timing_case)},
                 lambda folder: plates(folder.resolve(), 16), 0.1, None, plot="timing.png"),
    8: of_paper("Hubo on a ladder", "climbs it dynamically (motion not published)", ["hubo_ladder", "hubo_ladder_fall", "hubo_ladder_climb"],
                "ladder", ["hubo_ladder"], "huboplus"),
    9: of_paper("foot forces while Hubo shifts onto its left foot", "simulation close to theory", ["hubo_sway", "hubo_sway_servo_i"], "sway",
                ["hubo_plane"], "huboplus", plot="forces.png"),
    10: of_paper("Atlas on hands and feet on fractal terrain", "the same pose after three minutes", ["atlas_fractal", "atlas_fractal_servo_i"],
                 "atlas_fractal", ["paper_atlas_fractal"], "atlas"),
    11: of_paper("a gripper picks up a block of 12 triangles", "lifts, shakes and places it", ["gripper_block", "gripper_block_edge"],
                 "gripper_block", ["paper_gripper_block"], "tx90pr2"),
    12: of_paper("18 mugs are stirred in a tray", "no interpenetrations throughout", ["tray18"], "tray18", ["paper_tray18"], "tx90pr2"),
    13: of_paper("Hubo and a scanned chair", "sits down by grasping the armrests, a scan with holes (motion not published)",
                 ["hubo_chair", "hubo_chair_floor", "hubo_chair_sits"], "chair_sits", ["paper_hubo_chair_150k"], "huboplus"),
}


def missing(number):
    """What of the shared data a figure needs and is not here, in words; empty if all is."""
    lacking = [need for need in FIGURES[number].needs if shared_data(need) is None]
    return "it needs %s of the shared data (set BLEM_SIM_SHARED_DATA to their folder)" % ", ".join(lacking) if lacking else ""


def clean(value):
    """Numbers that JSON has: one that is not finite becomes its name."""
    return str(value) if isinstance(value, float) and not math.isfinite(value) else value


def reach(number, folder, options):
    """Runs a figure's cases and draws it, all in a folder. Returns rows of (case, asked, measured, ok), and a remark on the picture."""
    figure, rows, reports = FIGURES[number], [], {}
    options.plot = folder / figure.plot if figure.plot else None
    for name, (asked, case) in figure.cases.items():
        (folder / name).mkdir(parents=True, exist_ok=True)
        report, measured, ok = measure(case, folder / name, options)
        rows.append((name, asked, measured, ok))
        reports[name] = report
    numbers = {"figure": number, "title": figure.title, "paper": figure.says, "short": options.short,
               "cases": [dict(zip(("case", "asked", "measured", "ok"), map(clean, row))) for row in rows]}
    (folder / "numbers.json").write_text(json.dumps(numbers, indent=1) + "\n")
    (folder / "report.json").write_text(json.dumps(reports, indent=1) + "\n")
    return rows, picture(figure, folder)


def picture(figure, folder):
    """Draws figure and scene into picture.png, and scene.png where the picture is a plot. Returns what is left out, in words."""
    scene, time, camera = figure.drawn(folder)
    plots = [path for path in (list(folder.glob(figure.plot)) + list(folder.glob("*/" + figure.plot)) if figure.plot else [])]
    for path in plots[:1]:
        shutil.copyfile(str(path), str(folder / "picture.png"))
    if cannot_draw():
        return "no picture of the scene: " + cannot_draw()
    draw(folder, scene, time, camera, folder / ("scene.png" if plots else "picture.png"), method.package())
    return ""
