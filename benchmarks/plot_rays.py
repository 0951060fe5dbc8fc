#!/usr/bin/python3
"""Plots the results of benchmarks/rays.

usage: plot_rays.py RESULTS.json [FOLDER]     PNG files, into the current folder by default

Needs python3-matplotlib.
"""

import sys

from plot_common import plt, run, save

OURS = ["#1f3fa8", "#6a8be0", "#12265f", "#4a66b8"]
THEIRS = ["#8c8c8c", "#b8860b", "#c9c9c9", "#d33b2f", "#e9a23b", "#e3c9a0", "#6b6b6b", "#a05a2c", "#d9a0a0"]
TITLES = {"primary": "primary", "area_shadow": "area shadow", "ambient": "ambient", "diffuse": "diffuse bounce"}
GROWTH_COLUMNS = [("embree single", "#8c8c8c", "o"), ("embree packets high", "#d33b2f", "s")]


def plot_throughput(scene, folder):
    """Mrays/s of every column, one panel a class; bars span the quartiles."""
    classes = scene["classes"]
    figure, panels = plt.subplots(1, len(classes), figsize=(3.4 * len(classes), 4.4), sharey=True, squeeze=False)
    for axes, rays in zip(panels[0], classes):
        ours = iter(OURS)
        theirs = iter(THEIRS)
        for place, column in enumerate(rays["contenders"]):
            rate = column["mrays_s"]
            error = [[rate["median"] - rate["q1"]], [rate["q3"] - rate["median"]]]
            colour = next(ours, OURS[-1]) if column["ours"] else next(theirs, THEIRS[-1])
            edge = "black" if column["name"] == rays["chosen"] else "none"
            axes.barh(place, rate["median"], xerr=error, color=colour, edgecolor=edge, linewidth=1.2,
                      error_kw={"linewidth": 0.8})
        axes.set_yticks(range(len(rays["contenders"])))
        axes.set_yticklabels([c["name"] for c in rays["contenders"]], fontsize=8)
        axes.set_title(TITLES.get(rays["name"], rays["name"]), fontsize=10)
        axes.set_xlabel("Mrays/s")
        axes.grid(True, axis="x", linewidth=0.3)
    panels[0][0].invert_yaxis()
    figure.suptitle(f"{scene['name']}, {scene['triangles']} triangles (framed: what the renderer uses)", fontsize=10)
    save(figure, folder, f"rays_{scene['name']}.png")


def plot_growth(growth, folder):
    """Nanoseconds a ray against triangles."""
    names = list(growth[0]["classes"])
    figure, panels = plt.subplots(1, len(names), figsize=(5.6 * len(names), 4.4), squeeze=False)
    for axes, name in zip(panels[0], names):
        chosen = "wedge packets"
        for column, colour, marker in [(chosen, "#1f3fa8", "*")] + GROWTH_COLUMNS:
            points = [(p["triangles"], p["classes"][name]["ns_per_ray"][column]) for p in growth]
            axes.plot([n for n, _ in points], [t["median"] for _, t in points], color=colour, marker=marker,
                      markersize=5, linewidth=1.3, label=column)
            axes.fill_between([n for n, _ in points], [t["q1"] for _, t in points], [t["q3"] for _, t in points],
                              color=colour, alpha=0.2, linewidth=0)
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_title(TITLES.get(name, name), fontsize=10)
        axes.set_xlabel("triangles")
        axes.set_ylabel("nanoseconds a ray")
        axes.grid(True, which="both", linewidth=0.3, alpha=0.6)
        axes.legend(fontsize=8)
    save(figure, folder, "rays_growth.png")


def plot_ratios(scenes, folder):
    """What the renderer uses over Embree's columns that the goals are about."""
    columns = ["embree single", "embree packets high"]
    rows = [(s["name"], c) for s in scenes for c in s["classes"]]
    figure, axes = plt.subplots(figsize=(8, 1.4 + 0.34 * len(rows)))
    for index, (column, colour) in enumerate(zip(columns, ("#8c8c8c", "#d33b2f"))):
        ratios = [next(x["ours_over_this"] for x in c["contenders"] if x["name"] == column) for _, c in rows]
        places = [place + 0.38 * (index - 0.5) for place in range(len(rows))]
        error = [[r["median"] - r["q1"] for r in ratios], [r["q3"] - r["median"] for r in ratios]]
        axes.barh(places, [r["median"] for r in ratios], height=0.36, xerr=error, color=colour, label=f"over {column}",
                  error_kw={"linewidth": 0.8})
    axes.axvline(1, color="black", linewidth=0.8)
    axes.set_yticks(range(len(rows)))
    axes.set_yticklabels([f"{name}, {TITLES.get(c['name'], c['name'])}" for name, c in rows], fontsize=8)
    axes.invert_yaxis()
    axes.set_xlabel("our rays a second over Embree's")
    axes.grid(True, axis="x", linewidth=0.3)
    axes.legend(fontsize=8)
    save(figure, folder, "rays_ratios.png")


def plot(results, folder):
    scenes = [s for s in results["scenes"] if s["classes"]]
    for scene in scenes:
        plot_throughput(scene, folder)
    if scenes:
        plot_ratios(scenes, folder)
    if len(results["growth"]) > 1:
        plot_growth(results["growth"], folder)


if __name__ == "__main__":
    sys.exit(run(sys.argv[1:], "rays", __doc__, plot))
