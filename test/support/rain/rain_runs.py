"""Rain of balls on every mesh, scan and cloud of the shared data, by soak_rain: rows, and whether all was as it must be."""
import csv
import json
import math
import subprocess

import rain.file_counts as file_counts
from shared_data import shared_data

KINDS = (".stl", ".ply", ".pcd", ".off", ".obj", ".dae")
BROKEN = ("count_too_big.stl", "truncated.stl", "empty.off", "index_out_of_range.off")  # of data/pathological: nothing to fall on
COLUMNS = "%-64s %9s %5s %6s %8s %8s %9s %7s  %s"


def files():
    return sorted(path for path in shared_data().rglob("*") if path.suffix.lower() in KINDS)


def listed_boxes():
    """File -> extents [m] as the data's index has them, to three digits."""
    with open(shared_data("index.csv")) as rows:
        return {row["file"]: [float(x) for x in (row["bbox_min"] + " " + row["bbox_max"]).split()] for row in csv.DictReader(rows) if row["bbox_min"]}


def faults(path, row, boxes):
    """In words; empty if all is well."""
    relative = str(path.relative_to(shared_data()))
    if "refused" in row:
        broken = path.name in BROKEN and "\n" not in row["refused"]
        return [] if broken else ["refused: " + row["refused"]]
    found = ["must be refused"] if path.name in BROKEN else []
    triangles, points = file_counts.count(path)
    told = [row[kind] for kind in ("degenerate", "duplicate", "nonfinite", "invalid")]
    if triangles and row["triangles"] + sum(told) != triangles or not triangles and row["points"] + row["nonfinite"] + row["welded"] != points:
        found.append("the file has %d triangles, %d points; told of %d, %d and %s left out" % (triangles, points, row["triangles"], row["points"], told))
    box = boxes.get(relative)
    if box and not all(math.isclose(a, b, rel_tol=5e-3, abs_tol=2e-5 + 1e-3 * abs(a)) for a, b in zip(row["extents"], box)):
        found.append("extents %s, listed %s" % (row["extents"], box))
    if "balls" in row and not row["finite"]:
        found.append("not finite")
    if row.get("crossed"):
        found.append("%d balls went through, %d unsaid: first %s" % (row["crossed"], row["untold"], row["first_crossing"]))
    if "balls" in row and not row["touched"] and max(triangles, points) > 36:
        found.append("nothing was hit")
    return found


def print_row(path, row, found):
    name = str(path.relative_to(shared_data()))
    name = name if len(name) <= 64 else "..." + name[-61:]
    size = row.get("triangles") or row.get("points", "-")
    figures = [row.get(key, "-") for key in ("balls", "touched", "crossed", "unreliable_steps", "max_of_layer", "processor_s")]
    print(COLUMNS % (name, size, *figures, "; ".join(found) or ("refused" if "refused" in row else "ok")), flush=True)


def rows_of(program, paths, seconds, jobs):
    """Row of each file, by path; a file that ends the program has none."""
    shares = [paths[j::jobs] for j in range(jobs)]
    running = [subprocess.Popen([program, str(seconds)] + [str(path) for path in share], stdout=subprocess.PIPE, text=True) for share in shares if share]
    texts = [job.communicate()[0] for job in running]
    return {row["file"]: row for text in texts for row in map(json.loads, text.splitlines())}


def rain(program, seconds, jobs):
    """Whether all held."""
    paths, boxes = files(), listed_boxes()
    rows = rows_of(program, paths, seconds, jobs)
    print(COLUMNS % ("file", "elements", "balls", "touch", "crossed", "unrel.", "of layer", "CPU s", "result"))
    failed = 0
    for path in paths:
        row = rows.get(str(path), {})
        found = faults(path, row, boxes) if row else ["the program ended"]
        failed += bool(found)
        print_row(path, row, found)
    print("%d files, %d balls, %d touched, %d went through, %d refused; failed: %d" % (
        len(paths), *(sum(row.get(key, 0) for row in rows.values()) for key in ("balls", "touched", "crossed")),
        sum("refused" in row for row in rows.values()), failed))
    return not failed
