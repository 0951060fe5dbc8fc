"""What the plots of benchmarks that measure errors share."""

import json
import os
import sys

try:
    import matplotlib
except ImportError:
    sys.exit("plot: error: matplotlib: not installed: apt install python3-matplotlib")

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.ticker import FuncFormatter, NullFormatter  # noqa: E402

# Colours after Fig. 3.6c of the thesis, told apart by marker too.
CURVES = {
    ("NAS", "UF"): ("#c02bc0", "o"),
    ("AS", "UF"): ("#2aa198", "s"),
    ("NAS", "NAF"): ("#d33b2f", "v"),
    ("AS", "NAF"): ("#d9a400", "^"),
    ("NAS", "AF"): ("#6aa84f", "D"),
    ("AS", "AF"): ("#1f3fa8", "*"),
}
TITLES = {"default": "default", "published": "as published"}
OVERHEAD_PARTS = [("widths_and_counts", "widths and counts", "#4c78a8"), ("filter", "filter", "#f58518"),
                  ("composite", "composite", "#54a24b")]


def points_of(points, error="rmse"):
    """Samples and errors of points, by ascending samples."""
    pairs = sorted((p["spp"], p[error]) for p in points if p["spp"] and p[error])
    return [p[0] for p in pairs], [p[1] for p in pairs]


def finish_axes(axes, title, x_label, y_label="RMS error (linear radiance)"):
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_title(title, fontsize=10)
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    axes.grid(True, which="both", linewidth=0.3, alpha=0.6)


def label_axis(axes, ticks):
    """Plain numbers at the ticks of a logarithmic x axis, and nowhere else."""
    axes.set_xticks(ticks)
    axes.xaxis.set_major_formatter(FuncFormatter(lambda v, _: f"{v:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())


def plot_curves(axes, curves, baselines, error="rmse"):
    """Curves of the method's variants, and the unfiltered baselines."""
    for curve in curves:
        colour, marker = CURVES[(curve["sampling"], curve["filter"])]
        label = f"{curve['sampling']}, {curve['filter']}"
        if curve["fixed_width_pixels"]:
            label += f" ({curve['fixed_width_pixels']:.2g} px)"
        axes.plot(*points_of(curve["points"], error), color=colour, marker=marker, markersize=5, linewidth=1.3,
                  label=label)
    for baseline, style in zip(baselines, ("--", ":", "-.")):
        label = f"unfiltered: {baseline['name'].replace('_', ' ')}"
        axes.plot(*points_of(baseline["points"], error), color="0.35", linestyle=style, linewidth=1.0, label=label)


def overhead_row(timing):
    """The parts of a frame's overhead, as percentages of the frame."""
    total = timing["total"]["median"]
    return [100 * timing[name]["median"] / total for name, _, _ in OVERHEAD_PARTS]


def paper_overhead_row(paper):
    return [100 * paper[name] / paper["total"] for name in ("widths_and_counts", "filter")] + [0.0]


def plot_overhead(rows, labels, folder, name):
    """Analysis, filter and composite as percentages of the frame, a bar a row."""
    figure, axes = plt.subplots(figsize=(8, 1.2 + 0.28 * len(rows)))
    left = [0.0] * len(rows)
    for column, (_, label, colour) in enumerate(OVERHEAD_PARTS):
        widths = [row[column] for row in rows]
        axes.barh(range(len(rows)), widths, left=left, color=colour, label=label)
        left = [a + b for a, b in zip(left, widths)]
    axes.set_yticks(range(len(rows)))
    axes.set_yticklabels(labels, fontsize=8)
    axes.invert_yaxis()
    axes.set_xlabel("overhead, % of the frame's device time")
    axes.grid(True, axis="x", linewidth=0.3)
    axes.legend(fontsize=8)
    save(figure, folder, name)


def save(figure, folder, name):
    path = os.path.join(folder, name)
    figure.tight_layout()
    figure.savefig(path, dpi=130)
    plt.close(figure)
    print(path)


def run(arguments, benchmark, usage, plot, also=()):
    """Reads a benchmark's result file, or one of those of `also`, and calls plot(results, folder). Returns the exit
    status."""
    program = f"plot_{benchmark}"
    if len(arguments) not in (1, 2) or arguments[0].startswith("-"):
        print(usage.strip(), file=sys.stderr)
        return 2
    try:
        with open(arguments[0], encoding="utf-8") as file:
            results = json.load(file)
    except (OSError, ValueError) as error:
        print(f"{program}: error: {arguments[0]}: {error}: name a result file", file=sys.stderr)
        return 1
    if results.get("benchmark") not in (benchmark, *also):
        names = " or ".join((benchmark, *also))
        print(f"{program}: error: {arguments[0]}: not of {names}: name its result file", file=sys.stderr)
        return 1
    folder = arguments[1] if len(arguments) > 1 else "."
    os.makedirs(folder, exist_ok=True)
    plot(results, folder)
    return 0
