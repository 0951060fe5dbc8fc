#!/usr/bin/python3
"""Plots the results of benchmarks/soft_shadows.

usage: plot_soft_shadows.py RESULTS.json [FOLDER]     PNG files, into the current folder by default

Needs python3-matplotlib.
"""

import sys

from plot_common import TITLES, finish_axes, label_axis, overhead_row, paper_overhead_row, plot_curves, plot_overhead, \
    plt, run, save

SAMPLE_TICKS = [9, 16, 28, 64, 160, 400, 1000]


def reference_noise(scene, setting):
    integrand = "shading apart" if setting == "published" else "true integral"
    return next((r["noise"] for r in scene["references"] if r["integrand"] == integrand), None)


def plot_error_curves(scene, folder):
    """Fig. 3.6c: the six ablations and the unfiltered baselines, one panel a setting."""
    figure, panels = plt.subplots(1, 2, figsize=(11, 4.6), sharey=True)
    for axes, setting in zip(panels, ("default", "published")):
        data = scene["settings"][setting]
        plot_curves(axes, [c for c in scene["curves"] if c["setting"] == setting], data["baselines"])
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


def plot_overheads(scenes, folder):
    """Ours beside the thesis'."""
    rows, labels = [], []
    for scene in scenes:
        for setting in ("default", "published"):
            timing = scene["settings"][setting]["timing"]
            rows.append(overhead_row(timing))
            labels.append(f"{scene['name']}, {TITLES[setting]}: {timing['overhead']['median']:.1f} ms")
        if scene["paper"]:
            rows.append(paper_overhead_row(scene["paper"]))
            labels.append(f"thesis: {scene['paper']['overhead']:.1f} ms")
    plot_overhead(rows, labels, folder, "soft_shadows_overhead.png")


def plot(results, folder):
    scenes = results["scenes"]
    for scene in (s for s in scenes if s["curves"]):
        plot_error_curves(scene, folder)
    measured = [s for s in scenes if "convergence" in s["settings"]["default"]]
    if measured:
        plot_convergence(measured, folder)
    plot_overheads(scenes, folder)


if __name__ == "__main__":
    sys.exit(run(sys.argv[1:], "soft_shadows", __doc__, plot))
