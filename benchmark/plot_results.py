#!/usr/bin/python3
"""Draws what scripts/benchmark wrote: benchmark_contacts.png, benchmark_peers.png, benchmark_scaling.png, benchmark_scenes.png, soak.png.

Usage: plot_results.py FOLDER_OF_TABLES FOLDER_OF_PICTURES     a picture whose table is missing is left out in words
"""
import csv
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

OURS, FRESH, LIMIT, OTHERS = "#1f5fa8", "#7fb0e0", "#2e8b57", "#b0b0b0"
STAGES = (("broad_phase", "#c9c9c9"), ("narrow_phase", "#1f5fa8"), ("reduction", "#7fb0e0"), ("solve", "#e0883a"), ("others", "#8a8a8a"))
OTHER_STAGES = ("sample_commands", "motor_torque", "step_guard", "sensors", "report")
SCENES = {"hubo_on_1M": "Hubo on 1 M", "hubo_on_100k": "Hubo on 100 k", "hubo_on_1M_points": "Hubo on 1 M points", "cube_on_1M": "cube on 1 M",
          "mug_on_fractal_500k": "mug on 0.5 M", "mug_beside_mug": "mug beside mug"}
SOAKS = {"soak_ten_cubes": "ten cubes of 12 triangles, stacked", "soak_humanoid": "a humanoid on a scan"}
PEERS = {"ode_opcode": ("ODE OPCODE: crossing triangles only", "#c0504d"), "bullet_gimpact": ("Bullet GImpact: pairs within margins", "#9b7bb8"),
         "fcl_distance": ("FCL: one closest pair", "#d9a441"), "fcl_collide": ("FCL: crossing triangles only", "#8c8c5a")}

plt.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "grid.color": "#e6e6e6",
                     "axes.axisbelow": True, "legend.frameon": False, "figure.dpi": 110, "savefig.bbox": "tight"})


class Row(dict):
    """A row of a table: its name by parts, its figures as numbers."""

    def __init__(self, fields):
        super(Row, self).__init__()
        self.parts = fields["name"].split("/iterations")[0].split("/")
        self.update((key, float(value)) for key, value in fields.items() if is_number(value))


def is_number(text):
    try:
        float(text)
        return True
    except (TypeError, ValueError):
        return False


def rows(folder, name):
    """Of a table, or None: rows that a benchmark could not measure are left out."""
    path = folder / (name + ".csv")
    if not path.exists():
        print("plot_results: %s is not there" % path.name)
        return None
    lines = path.read_text().splitlines()
    begin = next((i for i, line in enumerate(lines) if line.startswith("name,")), len(lines))  # Google Benchmark's own words go before
    return [Row(fields) for fields in csv.DictReader(lines[begin:]) if fields["error_occurred"] != "true"]


def plain_rows(path):
    """Of a table without names, [] where it is missing."""
    if not path.exists():
        print("plot_results: %s is not there" % path.name)
        return []
    with path.open() as table:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(table)]


def label_bars(axes, bars, texts):
    for bar, text in zip(bars, texts):
        axes.annotate(text, (bar.get_width(), bar.get_y() + bar.get_height() / 2), xytext=(3, 0), textcoords="offset points", va="center", fontsize=7.5)


def bars_by_scene(axes, scenes, series):
    """Horizontal bars side by side. series: (name, colour, values, texts)."""
    height = 0.8 / len(series)
    for i, (name, colour, values, texts) in enumerate(series):
        bars = axes.barh([k + (i - (len(series) - 1) / 2) * height for k in range(len(scenes))], values, 0.92 * height, color=colour, label=name)
        label_bars(axes, bars, texts)
    axes.set_yticks(range(len(scenes)))
    axes.set_yticklabels(scenes)
    axes.invert_yaxis()
    axes.set_xscale("log")
    axes.grid(axis="y", visible=False)


def us(value):
    return "%.3g us" % value if value < 1000 else "%.3g ms" % (1e-3 * value)


def draw_contacts(folder):
    table = rows(folder, "contacts")
    if not table:
        return None
    figure, axes = plt.subplots(figsize=(8, 5.2))
    series = [("plain tree in double, triangle pairs", OTHERS, "plain_us", "plain_over_mean", "%s = %.3g x"),
              ("without memory", FRESH, "fresh_us", None, "%s"),
              ("with memory", OURS, "mean_us", None, "%s"),
              ("kernels alone on the known pairs", LIMIT, "kernel_us", "mean_over_kernel", "%s = 1/%.3g")]
    shown = []
    for name, colour, key, ratio, text in series:
        texts = [text % ((us(row[key]), row[ratio]) if ratio else us(row[key])) for row in table]
        shown.append((name, colour, [row[key] for row in table], texts))
    bars_by_scene(axes, [SCENES.get(row.parts[1], row.parts[1]) for row in table], shown)
    axes.set_xlabel("processor time per step [us], mean; ratios to contact generation with memory")
    axes.set_title("Contacts of moving bodies: between a plain tree and the kernels alone", loc="left")
    axes.margins(x=0.24)
    axes.legend(loc="upper center", bbox_to_anchor=(0.45, -0.1), ncol=2)
    return figure


def draw_peers(folder):
    table = rows(folder, "peers")
    if not table:
        return None
    scenes = list(dict.fromkeys(row.parts[1] for row in table))
    figure, axes = plt.subplots(figsize=(8, 5.2))
    series = []
    first = {scene: next(row for row in table if row.parts[1] == scene) for scene in scenes}
    for name, colour, key in (("all contacts, with memory", OURS, "mean_us"), ("all contacts, without", FRESH, "fresh_us")):
        series.append((name, colour, [first[scene][key] for scene in scenes],
                       ["%s, %.0f contacts" % (us(first[scene][key]), first[scene]["contacts"]) for scene in scenes]))
    for peer, (name, colour) in PEERS.items():
        found = {row.parts[1]: row for row in table if row.parts[2] == peer}
        if found:
            series.append((name, colour, [found[scene]["real_time"] if scene in found else float("nan") for scene in scenes],
                           ["%s, %.0f" % (us(found[scene]["real_time"]), found[scene]["found"]) if scene in found else "" for scene in scenes]))
    bars_by_scene(axes, [SCENES.get(scene, scene) for scene in scenes], series)
    axes.set_xlabel("processor time per step [us], mean; behind it how many were found")
    axes.set_title("Other engines' mesh queries: each computes something else", loc="left")
    axes.margins(x=0.2)
    axes.legend(loc="upper center", bbox_to_anchor=(0.45, -0.1), ncol=2)
    return figure


def curve(axes, table, names, key, label, **style):
    chosen = [row for row in table if row.parts[1:1 + len(names)] == names and key in row and row[key] == row[key]]
    if chosen:
        axes.plot([row["size"] for row in chosen], [row[key] for row in chosen], label=label, **style)
    return chosen


def draw_scaling(folder):
    table = rows(folder, "scaling")
    if not table:
        return None
    figure, ((triangles, contacts), (bodies, threads)) = plt.subplots(2, 2, figsize=(10, 7.2))
    for scene, colour in (("hubo", OURS), ("cube", "#e0883a")):
        curve(triangles, table, ["triangles", scene], "over_first", "%s, with memory" % scene.capitalize(), color=colour, marker="o")
        curve(triangles, table, ["triangles", scene], "fresh_over_first", "%s, without" % scene.capitalize(), color=colour, marker="o", mfc="white",
              ls="--")
    triangles.axhline(1.5, color="#c0504d", lw=1, ls=":")
    triangles.annotate("asked: less than 1.5", (1e3, 1.5), xytext=(0, 4), textcoords="offset points", color="#c0504d", fontsize=8)
    triangles.set(xscale="log", ylim=(0, 1.8), xlabel="triangles of the environment, same footprint", ylabel="time over the smallest one's",
                  title="Contact generation")
    for axes in (contacts, bodies):
        axes.set(xscale="log", yscale="log")
    found = [row for row in table if row.parts[1] == "contacts"]
    for key, label, style in (("real_time", "generation, with memory", {"color": OURS}), ("fresh_us", "generation, without", {"color": FRESH}),
                              ("reduction_us", "reduction to 20", {"color": "#e0883a"})):
        contacts.plot([row["contacts"] for row in found], [row[key] for row in found], marker="o", label=label, **style)
    proportional(contacts, found, "contacts", "real_time")
    contacts.set(xlabel="raw contacts of one pair of bodies", ylabel="processor time per step [us]", title="Contacts")
    found = [row for row in table if row.parts[1] == "bodies"]
    for key, label, colour in (("real_time", "whole step", "#404040"), ("solve_us", "solve", "#e0883a"), ("narrow_phase_us", "narrow phase", OURS),
                               ("reduction_us", "reduction", FRESH)):
        bodies.plot([row["size"] for row in found], [row[key] for row in found], marker="o", color=colour, label=label)
    proportional(bodies, found, "size", "real_time")
    bodies.set(xlabel="cubes on a plane", ylabel="time per step [us]", title="Bodies, whole step")
    found = [row for row in table if row.parts[1] == "threads"]
    stacked(threads, ["%d" % row["size"] for row in found], found, "real_time")
    threads.set(xlabel="threads, 40 stacks of three cubes", ylabel="wall time per step [us]", title="Threads")
    threads.grid(axis="x", visible=False)
    threads.set_xlim(-0.5, len(found) + 0.1)  # room for the legend
    for axes in (triangles, contacts, bodies):
        axes.legend(fontsize=8)
    threads.legend(*(part[::-1] for part in threads.get_legend_handles_labels()), fontsize=8, loc="center right")
    figure.tight_layout()
    return figure


def proportional(axes, found, x, y):
    last = found[-1]
    axes.plot([row[x] for row in found], [last[y] * row[x] / last[x] for row in found], color="#c9c9c9", lw=1, ls="--", label="proportional")


def stacked(axes, labels, table, total):
    """Stages of whole steps on top of each other; what no stage says is the others'."""
    base = [0.0] * len(table)
    for stage, colour in STAGES:
        if stage == "others":
            values = [max(0.0, row[total] - below) for row, below in zip(table, base)]
        elif stage + "_us" in table[0]:
            values = [row[stage + "_us"] for row in table]
        else:
            continue
        axes.bar(labels, values, 0.5, bottom=base, color=colour, label=stage.replace("_", " "))
        base = [below + value for below, value in zip(base, values)]


def draw_scenes(folder):
    table = rows(folder, "scenes")
    if not table:
        return None
    table = [row for row in table if not row.parts[-1].startswith("threads")]
    figure, (factors, stages) = plt.subplots(1, 2, figsize=(10, 0.55 * len(table) + 1.6), sharey=True)
    labels = ["/".join(row.parts[1:]).replace("_", " ") for row in table]
    values = [row["real_time_factor"] for row in table]
    bars = factors.barh(labels, values, 0.6, color=[OURS if value >= 1 else "#c0504d" for value in values])
    label_bars(factors, bars, ["%.3g" % value for value in values])
    factors.axvline(1, color="#404040", lw=1)
    factors.set(xscale="log", xlim=(0.01, 30), xlabel="real-time factor, one thread (1: as fast as the world)")
    factors.invert_yaxis()
    for row, label in zip(table, labels):
        base, used = 0.0, 0.0
        whole = sum(row.get(stage + "_us", 0.0) for stage in [name for name, _ in STAGES] + list(OTHER_STAGES))
        for stage, colour in STAGES:
            part = sum(row.get(name + "_us", 0.0) for name in OTHER_STAGES) if stage == "others" else row.get(stage + "_us", 0.0)
            used = 100 * part / whole
            stages.barh(label, used, 0.6, left=base, color=colour, label=stage.replace("_", " ") if row is table[0] else None)
            base += used
    stages.set(xlabel="where a step's time goes [%]")
    for axes in (factors, stages):
        axes.grid(axis="y", visible=False)
    stages.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16), ncol=5, fontsize=8, columnspacing=1, handlelength=1.2)
    figure.suptitle("Whole scenes, steps of 1 ms", x=0.02, ha="left")
    figure.tight_layout()
    return figure


def draw_soak(folder):
    """Memory, cost of a step and energy over the hours of soak_hours, a column for each scene."""
    scenes = [(title, plain_rows(folder / (name + ".csv"))) for name, title in SOAKS.items()]
    if not all(table for _, table in scenes):
        return None
    figure, axes = plt.subplots(3, len(scenes), figsize=(10, 5.6), sharex="col")
    for column, (title, table) in zip(axes.T, scenes):
        hours = [row["time_s"] / 3600 for row in table]
        first = table[0]["energy_J"]
        for plot, values, label in zip(column, ([row["resident_kB"] / 1024 for row in table], [row["step_us"] for row in table],
                                                [row["energy_J"] - first for row in table]), ("resident [MB]", "a step [us]", "energy since [J]")):
            plot.plot(hours, values, color=OURS, lw=1)
            plot.set_ylabel(label)
        for plot in column[:2]:
            plot.set_ylim(0, None)
        column[0].set_title(title, fontsize=9)
        column[2].set_xlabel("simulated time [h]")
    figure.tight_layout()
    return figure


def main(tables, pictures):
    for name, draw in (("benchmark_contacts", draw_contacts), ("benchmark_peers", draw_peers), ("benchmark_scaling", draw_scaling),
                       ("benchmark_scenes", draw_scenes), ("soak", draw_soak)):
        figure = draw(tables)
        if figure is None:
            continue
        out = pictures / (name + ".png")
        figure.savefig(str(out), metadata={"Software": None})
        print("drawn: %s" % out.name)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
