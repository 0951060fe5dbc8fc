#!/usr/bin/python3
"""Plots the results of benchmarks/multiple_effects and benchmarks/motion.

usage: plot_multiple_effects.py RESULTS.json [FOLDER]     PNG files, into the current folder by default

Needs python3-matplotlib.
"""

import sys

from plot_common import TITLES, finish_axes, label_axis, overhead_row, plot_overhead, plt, run, save

RAY_TICKS = [25, 50, 100, 200, 400, 800, 1600]
ERROR = "rmse_corrected"
STYLES = {
    "default": ("#1f3fa8", "*", "-", "default"),
    "published": ("#c02bc0", "o", "-", "as published"),
    "no_factoring": ("#6aa84f", "D", "-", "never factored"),
    "uniform_counts": ("#d9a400", "^", "-", "equal counts"),
    "fixed_blur": ("#d33b2f", "v", "-", "one blur for the image"),
    "stratified": ("0.25", "", "--", "unfiltered, stratified"),
    "sobol": ("0.25", "", ":", "unfiltered, Owen-Sobol"),
}


def plot_error_curves(scene, program, folder):
    """Fig. 5.12f: RMS error against rays a pixel, of all variants and of unfiltered images."""
    figure, axes = plt.subplots(figsize=(7, 5))
    curves = scene["curves"] + scene["settings"][0]["baselines"]
    for curve in curves:
        colour, marker, line, label = STYLES[curve["name"]]
        points = sorted((p["rays"], p[ERROR]) for p in curve["points"] if p["rays"] and p[ERROR])
        axes.plot([p[0] for p in points], [p[1] for p in points], color=colour, marker=marker, markersize=5,
                  linestyle=line, linewidth=1.2, label=label)
    finish_axes(axes, scene["name"], "rays a pixel")
    label_axis(axes, RAY_TICKS)
    axes.legend(fontsize=8)
    save(figure, folder, f"{program}_{scene['name']}_error.png")


def plot_savings(scenes, program, folder):
    """Rays saved at equal error, by scene and setting, beside the goal."""
    rows = [(s, data) for s in scenes for data in s["settings"] if "baselines" in data]
    figure, axes = plt.subplots(figsize=(8, 1.4 + 0.45 * len(rows)))
    for index, (name, colour) in enumerate((("stratified", "#1f3fa8"), ("sobol", "#8c8c8c"))):
        saved = [next(b["rays_saved"] for b in data["baselines"] if b["name"] == name) for _, data in rows]
        places = [place + 0.38 * (index - 0.5) for place in range(len(rows))]
        axes.barh(places, [s["median"] or 0 for s in saved], height=0.36, color=colour, label=f"against {name}")
    for value in {s["rays_saved_goal"] for s in scenes if s["rays_saved_goal"]}:
        axes.axvline(value, color="#d33b2f", linewidth=0.8, linestyle="--")
    axes.axvline(1, color="black", linewidth=0.8)
    axes.set_yticks(range(len(rows)))
    axes.set_yticklabels([f"{s['name']}, {TITLES[d['setting']]}" for s, d in rows], fontsize=8)
    axes.invert_yaxis()
    axes.set_xlabel("rays of unfiltered images at equal RMS error, over the method's")
    axes.grid(True, axis="x", linewidth=0.3)
    axes.legend(fontsize=8)
    save(figure, folder, f"{program}_savings.png")


def plot_overheads(scenes, program, folder):
    """Ours; the thesis' fraction is in the label."""
    rows, labels = [], []
    for scene in scenes:
        paper = (scene["paper"] or {}).get("overhead_fraction")
        beside = f" (thesis: {100 * paper:.1f} %)" if paper else ""
        for data in scene["settings"]:
            if "timing" in data:
                rows.append(overhead_row(data["timing"]))
                labels.append(f"{scene['name']}, {TITLES[data['setting']]}{beside}")
    if rows:
        plot_overhead(rows, labels, folder, f"{program}_overhead.png")


def plot(results, folder):
    program, scenes = results["benchmark"], results["scenes"]
    measured = [s for s in scenes if s["curves"]]
    for scene in measured:
        plot_error_curves(scene, program, folder)
    if measured:
        plot_savings(measured, program, folder)
    plot_overheads(scenes, program, folder)


if __name__ == "__main__":
    sys.exit(run(sys.argv[1:], "multiple_effects", __doc__, plot, also=("motion",)))
