#!/usr/bin/python3
"""Plots the results of benchmarks/soft_shadows.

usage: plot_soft_shadows.py RESULTS.json [FOLDER]     PNG files, into the current folder by default

Needs python3-matplotlib.
"""

import json
import os
import sys

try:
    import matplotlib
except ImportError:
    sys.exit("plot_soft_shadows: error: matplotlib: not installed: apt install python3-matplotlib")

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
SAMPLE_TICKS = [9, 16, 28, 64, 160, 400, 1000]


def points_of(points):
    """Samples and errors of points, by ascending samples."""
    pairs = sorted((p["spp"], p["rmse"]) for p in points if p["spp"] and p["rmse"])
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


def reference_noise(scene, setting):
    integrand = "shading apart" if setting == "published" else "true integral"
    return next((r["noise"] for r in scene["references"] if r["integrand"] == integrand), None)


def plot_error_curves(scene, folder):
    """Fig. 3.6c: the six ablations and the unfiltered baselines, one panel a setting."""
    figure, panels = plt.subplots(1, 2, figsize=(11, 4.6), sharey=True)
    for axes, setting in zip(panels, ("default", "published")):
        data = scene["settings"][setting]
        for curve in (c for c in scene["curves"] if c["setting"] == setting):
            colour, marker = CURVES[(curve["sampling"], curve["filter"])]
            label = f"{curve['sampling']}, {curve['filter']}"
            if curve["fixed_width_pixels"]:
                label += f" ({curve['fixed_width_pixels']:.2g} px)"
            axes.plot(*points_of(curve["points"]), color=colour, marker=marker, markersize=5, linewidth=1.3, label=label)
        for baseline, style in zip(data["baselines"], ("--", ":", "-.")):
            label = f"unfiltered: {baseline['name'].replace('_', ' ')}"
            axes.plot(*points_of(baseline["points"]), color="0.35", linestyle=style, linewidth=1.0, label=label)
        noise = reference_noise(scene, setting)
        if noise:
            axes.axhline(noise, color="0.6", linewidth=0.8, label="noise of the reference")
        finish_axes(axes, f"{scene['name']}, {TITLES[setting]}", "mean samples a pixel")
        label_axis(axes, SAMPLE_TICKS)
        axes.legend(fontsize=7)
    save(figure, folder, f"soft_shadows_{scene['name']}_error.png")


def plot_convergence(scenes, folder):
    """Error against mu, everything adaptive."""
    figure, panels = plt.subplots(1, 2, figsize=(11, 4.2))
    for axes, setting in zip(panels, ("default", "published")):
        for index, scene in enumerate(scenes):
            line = scene["settings"][setting]["convergence"]
            axes.plot([p["mu"] for p in line], [p["rmse"] for p in line], marker="o", markersize=4, color=f"C{index}",
                      label=scene["name"])
            noise = reference_noise(scene, setting)
            if noise:
                axes.axhline(noise, color=f"C{index}", linewidth=0.7, linestyle=":")
        finish_axes(axes, f"{TITLES[setting]} (dotted: noise of the reference)", "mu")
        label_axis(axes, sorted({p["mu"] for s in scenes for p in s["settings"][setting]["convergence"]}))
        axes.legend(fontsize=7)
    save(figure, folder, "soft_shadows_mu.png")


def plot_overhead(scenes, folder):
    """Analysis, filter and composite as percentages of the frame, ours beside the thesis'."""
    parts = [("widths_and_counts", "widths and counts", "#4c78a8"), ("filter", "filter", "#f58518"),
             ("composite", "composite", "#54a24b")]
    rows, labels = [], []
    for scene in scenes:
        for setting in ("default", "published"):
            timing = scene["settings"][setting]["timing"]
            total = timing["total"]["median"]
            rows.append([100 * timing[name]["median"] / total for name, _, _ in parts])
            labels.append(f"{scene['name']}, {TITLES[setting]}: {timing['overhead']['median']:.1f} ms")
        if scene["paper"]:
            paper = scene["paper"]
            rows.append([100 * paper[name] / paper["total"] for name in ("widths_and_counts", "filter")] + [0.0])
            labels.append(f"thesis: {paper['overhead']:.1f} ms")
    figure, axes = plt.subplots(figsize=(8, 1.2 + 0.28 * len(rows)))
    left = [0.0] * len(rows)
    for column, (_, label, colour) in enumerate(parts):
        widths = [row[column] for row in rows]
        axes.barh(range(len(rows)), widths, left=left, color=colour, label=label)
        left = [a + b for a, b in zip(left, widths)]
    axes.set_yticks(range(len(rows)))
    axes.set_yticklabels(labels, fontsize=8)
    axes.invert_yaxis()
    axes.set_xlabel("overhead, % of the frame's device time")
    axes.grid(True, axis="x", linewidth=0.3)
    axes.legend(fontsize=8)
    save(figure, folder, "soft_shadows_overhead.png")


def save(figure, folder, name):
    path = os.path.join(folder, name)
    figure.tight_layout()
    figure.savefig(path, dpi=130)
    plt.close(figure)
    print(path)


def main(arguments):
    if len(arguments) not in (1, 2) or arguments[0].startswith("-"):
        print(__doc__.strip(), file=sys.stderr)
        return 2
    try:
        with open(arguments[0], encoding="utf-8") as file:
            results = json.load(file)
    except (OSError, ValueError) as error:
        print(f"plot_soft_shadows: error: {arguments[0]}: {error}: name a result file", file=sys.stderr)
        return 1
    if results.get("benchmark") != "soft_shadows":
        print(f"plot_soft_shadows: error: {arguments[0]}: not of soft_shadows: name its result file", file=sys.stderr)
        return 1
    folder = arguments[1] if len(arguments) > 1 else "."
    os.makedirs(folder, exist_ok=True)
    scenes = results["scenes"]
    for scene in (s for s in scenes if s["curves"]):
        plot_error_curves(scene, folder)
    measured = [s for s in scenes if "convergence" in s["settings"]["default"]]
    if measured:
        plot_convergence(measured, folder)
    plot_overhead(scenes, folder)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
