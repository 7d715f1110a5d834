"""Fig. 7 of [Hauser 2013]: what contact generation and response take, against the number of contacts, of plates of ever finer triangles."""
import pathlib
import sys

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from scene_runs import simulate  # noqa: E402
from method_scenes import WIDTH, scene, write_off  # noqa: E402

PLATE = 0.2        # [m] side of a plate, and twice that of the ground below it
NOISE = 0.0002     # [m] deviation of both from flat, as of a scanned surface
CELLS = (1, 2, 4, 8, 16, 32, 64)
STAGES = {"narrow_phase": "contact generation", "reduction": "reduction", "solve": "contact response"}


def noisy_plate(cells, side, seed):
    """Triangles of a square of cells x cells squares whose corners are off the plane z = 0 by noise."""
    heights = numpy.random.RandomState(seed).normal(0, NOISE, (cells + 1, cells + 1))
    corner = [[(side * (i / cells - 0.5), side * (j / cells - 0.5), heights[i, j]) for j in range(cells + 1)] for i in range(cells + 1)]
    squares = [(i, j) for i in range(cells) for j in range(cells)]
    return numpy.array([t for i, j in squares for t in ((corner[i][j], corner[i + 1][j], corner[i + 1][j + 1]),
                                                        (corner[i][j], corner[i + 1][j + 1], corner[i][j + 1]))])


def plates(folder, cells):
    """A plate of 1 kg that is pushed over the ground, so that its contacts do not stay what they were."""
    write_off(folder / ("plate_%d.off" % cells), noisy_plate(cells, PLATE, 1))
    write_off(folder / ("ground_%d.off" % cells), noisy_plate(2 * cells, 2 * PLATE, 2))
    plate = {"name": "plate", "uri": str(folder / ("plate_%d.off" % cells)), "mass": 1.0, "com": [0, 0, 0], "inertia": [0.0034, 0, 0, 0.0034, 0, 0.0067],
             "pose": {"xyz": [0, 0, 0.0035], "rpy": [0, 0, 0.3]}, "linear_velocity": [0.5, 0, 0], "friction": 0.05}
    return scene([plate], [{"name": "ground", "uri": str(folder / ("ground_%d.off" % cells))}], file_roots=[str(folder)])


def timing_case(folder, options):
    """Times are told, not judged: it holds if the contacts grow tenfold, are reduced to 20, and every mesh stays in its layer."""
    points, report, crossed = [], None, 0
    for cells in CELLS:
        report, _ = simulate(folder, plates(folder.resolve(), cells), 0.05 if options.short else 0.2, 0)
        mean = {stage: 1e3 * report["profile_ms"][stage]["mean"] for stage in STAGES}
        points.append((report["contacts"]["raw_mean"], report["contacts"]["reduced_max"], mean))
        crossed += report["status"]["CONTACT_UNRELIABLE"]
    plot(points, folder / "timing.png")
    first, last = points[0], points[-1]
    text = "%.0f to %.0f contacts found, %d kept at most: generation %.0f to %.0f us, reduction %.0f to %.0f us, response %.0f to %.0f us a step" % (
        first[0], last[0], max(kept for _, kept, _ in points), *[m[stage] for stage in STAGES for m in (first[2], last[2])])
    return report, (text, last[0] > 10 * first[0] and max(kept for _, kept, _ in points) <= 20 and not crossed)


def plot(points, path):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(figsize=(6.4, 4.8))
    for stage, label in STAGES.items():
        axes.loglog([found for found, *_ in points], [mean[stage] for *_, mean in points], "o-", label=label)
    axes.set_xlabel("contacts found a step")
    axes.set_ylabel("mean time of a step [us]")
    axes.legend()
    axes.grid(True, which="both", alpha=0.3)
    figure.tight_layout()
    figure.savefig(str(path), dpi=100)
    pyplot.close(figure)
