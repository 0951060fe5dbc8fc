#!/usr/bin/python3
"""Plots the results of benchmarks/indirect.

usage: plot_indirect.py RESULTS.json [FOLDER]     PNG files, into the current folder by default

Needs python3-matplotlib.
"""

import sys

from plot_common import TITLES, finish_axes, label_axis, overhead_row, paper_overhead_row, plot_curves, plot_overhead, \
    plt, run, save

SAMPLE_TICKS = [16, 28, 64, 128, 256, 512, 1024]
ERROR = "rmse_corrected"


def with_bounces(name, bounces):
    if bounces == 0:
        return f"{name}, ambient occlusion"
    return name if bounces == 1 else f"{name}, {bounces} bounces"


def plot_error_curves(scene, folder):
    """Fig. 4.10: filter alone, adaptive counts and filter, and path tracing, one panel a setting."""
    figure, panels = plt.subplots(1, 2, figsize=(11, 4.6), sharey=True)
    for axes, setting in zip(panels, ("default", "published")):
        data = next(s for s in scene["settings"] if s["setting"] == setting and s["bounces"] == 1)
        filtered = [c for c in scene["curves"] if c["setting"] == setting and c["filter"] != "UF"]
        plot_curves(axes, filtered, data["baselines"], ERROR)
        finish_axes(axes, f"{scene['name']}, {TITLES[setting]}", "mean samples a pixel",
                    "RMS error of indirect light (linear)")
        label_axis(axes, SAMPLE_TICKS)
        axes.legend(fontsize=7)
    save(figure, folder, f"indirect_{scene['name']}_error.png")


def plot_savings(scenes, folder):
    """Samples saved at equal error, by scene and bounces, beside the thesis' and the goals."""
    rows = [(s, data) for s in scenes for data in s["settings"] if "baselines" in data]
    figure, axes = plt.subplots(figsize=(8, 1.4 + 0.4 * len(rows)))
    for index, (name, colour) in enumerate((("stratified", "#1f3fa8"), ("sobol", "#8c8c8c"))):
        saved = [next(b["samples_saved"] for b in data["baselines"] if b["name"] == name) for _, data in rows]
        values = [s["median"] or 0 for s in saved]
        places = [place + 0.38 * (index - 0.5) for place in range(len(rows))]
        axes.barh(places, values, height=0.36, color=colour, label=f"against {name}")
    axes.axvline(1, color="black", linewidth=0.8)
    axes.set_yticks(range(len(rows)))
    axes.set_yticklabels([f"{with_bounces(s['name'], d['bounces'])}, {TITLES[d['setting']]}" for s, d in rows],
                         fontsize=8)
    axes.invert_yaxis()
    axes.set_xlabel("samples of path tracing at equal RMS error, over the method's")
    axes.grid(True, axis="x", linewidth=0.3)
    axes.legend(fontsize=8)
    save(figure, folder, "indirect_savings.png")


def plot_overheads(scenes, folder):
    """Ours beside the thesis'."""
    rows, labels = [], []
    for scene in scenes:
        for data in scene["settings"]:
            name = with_bounces(scene["name"], data["bounces"])
            rows.append(overhead_row(data["timing"]))
            labels.append(f"{name}, {TITLES[data['setting']]}: {data['timing']['overhead']['median']:.0f} ms")
            if data["paper"] and data["setting"] == "published":
                rows.append(paper_overhead_row(data["paper"]))
                labels.append(f"thesis: {data['paper']['overhead']:.0f} ms")
    plot_overhead(rows, labels, folder, "indirect_overhead.png")


def plot(results, folder):
    scenes = results["scenes"]
    for scene in (s for s in scenes if s["curves"]):
        plot_error_curves(scene, folder)
    if any("baselines" in data for s in scenes for data in s["settings"]):
        plot_savings(scenes, folder)
    plot_overheads(scenes, folder)


if __name__ == "__main__":
    sys.exit(run(sys.argv[1:], "indirect", __doc__, plot))
