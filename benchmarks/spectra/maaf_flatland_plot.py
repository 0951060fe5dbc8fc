#!/usr/bin/python3
"""Draws what maaf_flatland.py found, and filtered edges.

usage: maaf_flatland_plot.py RESULTS.json FOLDER     the folder gets maaf_flatland.png

Needs python3-numpy and python3-matplotlib.
"""

import json
import os
import sys

try:
    import numpy as np
except ImportError:
    sys.exit("maaf_flatland_plot: error: numpy: not installed: apt install python3-numpy")

import fit_maaf
import maaf_filters as filters
import maaf_flatland as flatland
import results_file

FAMILIES = (("aaf", "#d33b2f", "AAF"), ("extrapolated", "#1f3fa8", "extrapolated"), ("two_slope", "#6aa84f", "sheared, two slopes"))


def edge(s):
    """A scene of one edge of slope s, with the judged pixels' middle in its shadow's."""
    middle = 0.5 * flatland.PIXELS
    return {"slopes": np.array([s]), "a": np.array([-1e6]), "b": np.array([middle])}


def edge_filters(s_min, s_max):
    """What the picture of edges shows; constants are those that err least at 9 samples a pixel."""
    scene = {"s_min": s_min, "s_max": s_max}
    return (("AAF, k mu 6", "#f0a8a0", filters.aaf(s_min, 1.0 / 6.0)), ("AAF, 0.4", "#d33b2f", filters.aaf(s_min, 0.4)),
            ("extrapolated, 0.65", "#1f3fa8", filters.extrapolated(s_min, 0.65)),
            ("sheared, two slopes, 0.25", "#6aa84f", filters.two_slope(s_min, s_max, 0.25)),
            ("MAAF 5, printed", "0.6", flatland.maaf_printed(scene, 3, 2.0)),
            ("MAAF 5, refitted", "#d9a400", flatland.maaf_refitted(scene, 3, fit_maaf.BANDWIDTH, fit_maaf.table(3))))


def plot(results, folder):
    plt = results_file.pyplot("maaf_flatland_plot")
    os.makedirs(folder, exist_ok=True)
    figure, panels = plt.subplots(2, 3, figsize=(14, 8))
    for axes, spp in zip(panels[0], flatland.SPP):
        rows = results["line"][str(spp)]
        for name, colour, label in FAMILIES:
            sweep = rows[name]["sweep"]
            constants = [row["constant"] for row in sweep]
            for part, style in (("rms", "-"), ("bias", ":"), ("noise", "--")):
                axes.plot(constants, [row[part] for row in sweep], style, color=colour, linewidth=1.6 if part == "rms" else 0.8,
                          label=label if part == "rms" else None)
        axes.axhline(rows["maaf 5 refitted, noise 0.001"]["rms"], color="#d9a400", label="MAAF 5, refitted, at its best")
        axes.set_title(f"{spp} samples: RMS error; bias dotted, noise dashed", fontsize=10)
        axes.set_xlabel("constant")
        axes.set_ylim(0.0, 1.3 * rows["aaf k mu 6"]["rms"])
        axes.legend(fontsize=7)
    s_min, s_max = 12.0, 48.0
    x = np.arange(flatland.PIXELS, dtype=float)
    for axes, s in zip(panels[1], (12.0, 24.0, 48.0)):
        scene = edge(s)
        truth = flatland.exact(scene, x)
        samples = flatland.Samples(scene, 400, 1, np.random.default_rng(1))
        for label, colour, kernel in edge_filters(s_min, s_max):
            axes.plot(x - 0.5 * flatland.PIXELS, samples.filtered(kernel)[0] - truth, color=colour, label=label)
        axes.set_title(f"filtered edge less true one, slope {s / s_min:g} s_min of 1 to 4", fontsize=10)
        axes.set_xlabel("pixels; sigma s_min is 12")
        axes.set_ylim(-0.12, 0.12)
    panels[1, 0].legend(fontsize=7)
    figure.tight_layout()
    path = os.path.join(folder, "maaf_flatland.png")
    figure.savefig(path, dpi=110)
    print(path)


def main(arguments):
    if len(arguments) != 2 or arguments[0].startswith("-"):
        print(__doc__.strip(), file=sys.stderr)
        return 2
    try:
        with open(arguments[0], encoding="utf-8") as file:
            results = json.load(file)
    except (OSError, ValueError) as error:
        sys.exit(f"maaf_flatland_plot: error: {arguments[0]}: {error}: name a file that maaf_flatland.py wrote")
    plot(results, arguments[1])
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
