"""Scenes of the paper's figures that need no data [Hauser 2013, Figs. 1 and 4 to 7], with what is asked of each. Lengths in m."""
import itertools
import math
import pathlib
import sys

try:
    import numpy
except ImportError:
    sys.exit("%s: needs numpy; install python3-numpy" % pathlib.Path(sys.argv[0]).name)

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from scene_runs import simulate  # noqa: E402
from shared_data import SOURCE_DIR  # noqa: E402

MESHES = SOURCE_DIR / "meshes"
WIDTH = 0.0025     # boundary layers of what moves; 0 of what stands
SIDE = 0.1         # of a cube
GAP = 0.01         # between cubes at the start
PITCH = 0.05       # between the teeth of a comb
TEETH = (5, 4)
OVERHANG = 0.001   # of Fig. 4: how far the cube reaches over the step, less than its depth in the layer
DEPTH = 0.0015


def cube(name, x, z, **more):
    return dict({"name": name, "uri": "package://blem_sim/meshes/cube_10cm.stl", "mass": 1.0, "pose": {"xyz": [x, 0, z], "rpy": [0, 0, 0]}}, **more)


def scene(objects, environments, **more):
    return dict({"time_step": 0.001, "contact": {"boundary_width": WIDTH, "friction": 0.5}, "environments": environments, "robots": [],
                 "objects": objects}, **more)


def stack(count):
    """Fig. 1: cubes of 192 triangles, 1 cm apart, above a ground of 128."""
    ground = [{"name": "ground", "uri": "package://blem_sim/meshes/ground_2m.stl"}]
    return scene([cube("cube_%d" % (k + 1), 0, SIDE / 2 + GAP + k * (SIDE + GAP)) for k in range(count)], ground)


def package():
    return ["--package", "blem_sim=%s" % SOURCE_DIR]


def stacked(count, duration, short):
    """Fig. 1: how far each cube's height is from theory once it rests, and how far it moves from then on."""
    def case(folder, options):
        length = min(duration, short) if options.short else duration
        report, rows = simulate(folder, stack(count), length, 10, package(), lambda column: column.endswith("_z") or column.endswith("_x"))
        rest = [row for row in rows if float(row["time"]) >= 1.0]
        columns = [name for name in rest[0] if name != "time"]
        moved = max(abs(float(row[name]) - float(rest[0][name])) for row in rest for name in columns)
        heights = [report["bodies"]["cube_%d::link" % (k + 1)]["xyz"][2] for k in range(count)]
        off = max(abs(z - (SIDE / 2 + WIDTH + k * (SIDE + 2 * WIDTH))) for k, z in enumerate(heights))
        text = "after %.0f s heights off theory by %.1e mm at most; from 1 s on moved by %.1e mm; worst %.2f of layer" % (
            length, 1e3 * off, 1e3 * moved, report["max_penetration"]["of_layer"])
        return report, (text, off < 1e-4 and moved < 1e-5 and not report["status"]["CONTACT_UNRELIABLE"])
    return case


def corner():
    """Fig. 4: a cube whose lower edge reaches a little over the upper edge of a step, deeper in the layer than it reaches over it."""
    step = dict(cube("step", -SIDE, SIDE / 2), boundary_width=0.0)
    step.pop("mass")
    fallen = cube("cube", -OVERHANG, 1.5 * SIDE + WIDTH - DEPTH, friction=0.0)
    step["pose"] = {"xyz": [-SIDE, 0, SIDE / 2], "rpy": [0, 0, 0]}
    return scene([fallen], [step], gravity=[0, 0, 0])


def corner_case(folder, options):
    """Without weight and friction only contact normals move the cube, and they are vertical if it goes up and not sideways."""
    report, _ = simulate(folder, corner(), 0.05, 0, package())
    body = report["bodies"]["cube::link"]
    aside, up = math.hypot(*body["linear_velocity"][:2]), body["linear_velocity"][2]
    lifted = body["xyz"][2] - (1.5 * SIDE + WIDTH - DEPTH)
    text = "%.1f mm deep, %.1f mm over the edge: lifted by %.3f mm, %.1e m/s sideways, %.3f m/s up; %.1f contacts found a step" % (
        1e3 * report["max_penetration"]["depth_m"], 1e3 * OVERHANG, 1e3 * lifted, aside, up, report["contacts"]["raw_mean"])
    ok = aside < 1e-3 * up and lifted > 1e-4 and abs(report["max_penetration"]["depth_m"] - DEPTH) < 1e-6
    return report, (text, ok and not report["status"]["CONTACT_UNRELIABLE"])


def comb(teeth, length, along_x):
    """Triangles of a row of ridges, 4 cm high, with their crests at z = 0; the crests go along x or along y."""
    triangles = []
    for k in range(teeth):
        middle = (k - 0.5 * (teeth - 1)) * PITCH
        for side in (-0.02, 0.02):
            crest = [(-length / 2, middle, 0), (length / 2, middle, 0)]
            foot = [(x, y + side, -0.04) for x, y, _ in crest]
            for triangle in ((crest[0], crest[1], foot[1]), (crest[0], foot[1], foot[0])):
                triangles.append(triangle if along_x else tuple((y, x, z) for x, y, z in triangle))
    return numpy.array(triangles, dtype=float)


def write_off(path, triangles):
    corners = triangles.reshape(-1, 3)
    faces = ["3 %d %d %d" % (3 * k, 3 * k + 1, 3 * k + 2) for k in range(len(triangles))]
    lines = ["OFF", "%d %d 0" % (len(corners), len(faces))] + [" ".join("%.9g" % value for value in row) for row in corners]
    path.write_text("\n".join(lines + faces) + "\n")


def segment_distances(p, q, r, s):
    """Nearest points of the segments p q and r s, whose lines are not parallel."""
    u, v, w = q - p, s - r, p - r
    a, b, c, d, e = u @ u, u @ v, v @ v, u @ w, v @ w
    first = min(max((b * e - c * d) / (a * c - b * b), 0.0), 1.0) if a * c - b * b > 1e-12 else 0.0
    second = min(max((b * first + e) / c, 0.0), 1.0)
    first = min(max((b * second - d) / a, 0.0), 1.0)
    return p + first * u, r + second * v


def pairs_in_reach(a, b, reach):
    """Number of triangle pairs whose edges come within reach, and number of places where they do. By brute force.

    Combs that cross touch by their crests alone, so that edges tell the distance of each pair.
    """
    pairs, places = 0, set()
    for one, two in itertools.product(a, b):
        edges = itertools.product(range(3), range(3))
        nearest = min((segment_distances(one[i], one[i - 1], two[j], two[j - 1]) for i, j in edges), key=lambda ends: ends_apart(ends))
        if ends_apart(nearest) <= reach:
            pairs += 1
            places.add(tuple(numpy.round((nearest[0] + nearest[1]) / 2, 6)))
    return pairs, len(places)


def ends_apart(ends):
    return float(numpy.linalg.norm(ends[0] - ends[1]))


def combs(folder, apart):
    """Fig. 5: two combs across each other, crest to crest, apart [m], below 0 if they cross. Returns (scene, triangles of both)."""
    lower, upper = comb(TEETH[0], 0.3, True), comb(TEETH[1], 0.3, False)
    upper = upper * (1, 1, -1)
    write_off(folder / "lower.off", lower)
    write_off(folder / "upper.off", upper)
    config = scene([{"name": "upper", "uri": str(folder / "upper.off"), "mass": 1.0, "com": [0, 0, 0.02],
                     "inertia": [0.01, 0, 0, 0.01, 0, 0.01], "pose": {"xyz": [0, 0, apart], "rpy": [0, 0, 0]}}],
                   [{"name": "lower", "uri": str(folder / "lower.off")}], gravity=[0, 0, 0], file_roots=[str(folder)])
    return config, lower, upper + (0, 0, apart)


def combs_case(folder, options):
    """One step: a contact for each pair of edges in reach, as many as brute force finds."""
    config, lower, upper = combs(folder.resolve(), WIDTH - DEPTH)
    report, _ = simulate(folder, config, 0.001, 0)
    pairs, places = pairs_in_reach(lower, upper, WIDTH)
    found, depth = report["contacts"]["raw_mean"], report["max_penetration"]["depth_m"]
    text = "%d pairs of triangles in reach are %d pairs of edges: %.0f contacts, %.6f mm deep (%.6f by hand)" % (
        pairs, places, found, 1e3 * depth, 1e3 * DEPTH)
    return report, (text, found == places == TEETH[0] * TEETH[1] and pairs == 4 * places and abs(depth - DEPTH) < 1e-8)


def regime_case(apart, crosses):
    """Fig. 6: the first step of the combs, and half a second later. crosses: whether their meshes do."""
    def case(folder, options):
        config, *_ = combs(folder.resolve(), apart)
        first, _ = simulate(folder, config, 0.001, 0)
        report, _ = simulate(folder, config, 0.5, 0)
        told, later = first["status"]["CONTACT_UNRELIABLE"], report["status"]["CONTACT_UNRELIABLE"]
        out = report["bodies"]["upper::link"]["xyz"][2]
        text = "meshes %.2f mm apart: %.2f of layer, CONTACT_UNRELIABLE in %d of 1 step, in %d of 500; then %.3f mm apart" % (
            1e3 * apart, first["max_penetration"]["of_layer"], told, later, 1e3 * out)
        beyond = first["max_penetration"]["of_layer"] > 1
        ok = out > 0 and beyond == bool(told) == crosses and later < (500 if crosses else 1)
        return report, (text, ok)
    return case
