#!/usr/bin/python3
"""Spectra of soft shadows in flatland, and how AAF, sheared filters and MAAF cover them: Fig. 4, Tables 1 and 2, Fig. 6 of MAAF.

usage: maaf_spectra.py RESULTS.json [FOLDER]     and PNG files, into the folder if there is one

A scene of occluders between two depths, its visibility over receiver and light, the energy of its spectrum in the double
wedge; coverage (15) and accuracy (14) of filters, recomputed from the definitions, beside what the paper prints. Needs
python3-numpy, and python3-matplotlib for pictures.
"""

import os
import sys

try:
    import numpy as np
except ImportError:
    sys.exit("maaf_spectra: error: numpy: not installed: apt install python3-numpy")

import maaf_filters as filters
import results_file

SEED = 19
OMEGA = 2.0                     # the light's bandwidth, 2 / sigma
RECEIVER = 12.0                 # distance from the light, in its deviations
NEAR, FAR = 4.0, 7.5            # of occluders from the light: slopes 2 to 0.6
OCCLUDERS = 14
SPAN_X, SPAN_Y = 64.0, 64.0     # of the grid over which the spectrum is taken
GRID = 1024
WINDOW = 9.0                    # deviation, of both windows
RESOLUTION = 1.0 / WINDOW       # of the spectrum, radians a unit
WEDGES = 50
DRAWS = 4000                    # of wedges, for the mean and the spread of what fifty give
COMPONENTS = (1, 3, 5, 7, 9, 11, 15, 25, 75, 125)
PAPER = {
    "table 1": {"aaf": 0.097, "sheared": 0.5, "maaf 3": 0.197, "maaf 5": 0.275, "maaf 7": 0.401, "maaf 25": 0.677,
                "maaf 75": 0.876, "maaf 125": 0.943},
    "coverage": {"average": [0.088, 0.199, 0.173, 0.256, 0.316], "0.5 0.8": [0.079, 0.168, 0.122, 0.174, 0.218],
                 "1.5 2": [0.047, 0.134, 0.090, 0.156, 0.210], "0.7 2.2": [0.172, 0.216, 0.245, 0.315, 0.383]},
    "accuracy": {"average": [0.662, 0.731, 0.748, 0.799, 0.827], "0.5 0.8": [0.585, 0.826, 0.833, 0.903, 0.933],
                 "1.5 2": [0.639, 0.686, 0.761, 0.811, 0.842], "0.7 2.2": [0.616, 0.742, 0.734, 0.793, 0.824]},
}
SHAPES = {"0.5 0.8": (0.5, 0.8), "1.5 2": (1.5, 2.0), "0.7 2.2": (0.7, 2.2)}
NAMES = ("aaf", "sheared", "maaf 3", "maaf 5", "maaf 7")
# Besides: sheared with half of the width that (4) prints, and MAAF without the weights (10).
OTHERS = ("sheared, half", "maaf 3, equal", "maaf 5, equal", "maaf 7, equal")


# The scene of Fig. 4

def slope(distance):
    """d1 / d2 - 1"""
    return RECEIVER / distance - 1.0


def random_scene(random, apart):
    """Segments at depths between NEAR and FAR, one of them at each. They hide x + s y from a to b, since the ray from y on the light to
    x is at x d2 / d1 + y (1 - d2 / d1). `apart`: each in a strip of x of its own, so that few shadows meet."""
    depth = np.concatenate([[NEAR, FAR], random.uniform(NEAR, FAR, OCCLUDERS - 2)])
    width = random.uniform(0.4, 2.4, OCCLUDERS)
    if apart:
        middle = (np.arange(OCCLUDERS) + 0.5) / OCCLUDERS * SPAN_X - 0.5 * SPAN_X
        random.shuffle(middle)
    else:
        middle = random.uniform(-0.3 * SPAN_X, 0.3 * SPAN_X, OCCLUDERS)
    return {"depth": depth, "s": slope(depth), "a": middle - 0.5 * width, "b": middle + 0.5 * width}


def visibility(scene):
    """f(x, y) over the grid, rows are y: the visible share of each cell along x, by eight points."""
    sub = 8
    x = (np.arange(GRID * sub) + 0.5) / (GRID * sub) * SPAN_X - 0.5 * SPAN_X
    out = np.empty((GRID, GRID))
    for row, y in enumerate(over_y()):
        f = np.ones(len(x), dtype=bool)
        for s, a, b in zip(scene["s"], scene["a"], scene["b"]):
            f &= (x + s * y <= a) | (x + s * y >= b)
        out[row] = f.reshape(GRID, sub).mean(axis=1)
    return out


def over_x():
    return (np.arange(GRID) + 0.5) / GRID * SPAN_X - 0.5 * SPAN_X


def over_y():
    return (np.arange(GRID) + 0.5) / GRID * SPAN_Y - 0.5 * SPAN_Y


def spectrum(f):
    """Energy of f less its mean, under Gaussian windows, and the angular frequencies along x (columns) and y (rows), ascending."""
    window = filters.profile(over_y() / WINDOW)[:, None] * filters.profile(over_x() / WINDOW)
    energy = np.abs(np.fft.fftshift(np.fft.fft2((f - (f * window).sum() / window.sum()) * window))) ** 2
    return (np.fft.fftshift(2.0 * np.pi * np.fft.fftfreq(GRID, SPAN_X / GRID)),
            np.fft.fftshift(2.0 * np.pi * np.fft.fftfreq(GRID, SPAN_Y / GRID)), energy)


def in_wedge(omega_x, omega_y, s_min, s_max, slack):
    """Within the double wedge, or no more than `slack` from it, along x."""
    side = np.where(omega_y == 0.0, np.abs(omega_x), np.sign(omega_y) * omega_x)
    return (side >= np.abs(omega_y) / s_max - slack) & (side <= np.abs(omega_y) / s_min + slack)


def wedge_check(scene):
    """Shares of energy within three deviations of the windows' own spectrum of the wedge: of all, and of what the light lets through;
    and the share of the plane that this is."""
    omega_x, omega_y, energy = spectrum(visibility(scene))
    s_min, s_max = scene["s"].min(), scene["s"].max()
    # A line of slope s is as wide along x as both windows make it.
    slack = 3.0 * RESOLUTION / np.sqrt(2.0) * np.sqrt(1.0 + 1.0 / s_min**2)
    x, y = omega_x[None], omega_y[:, None]
    inside = in_wedge(x, y, s_min, s_max, slack)
    light = np.exp(-(y**2))  # the square of the light's transform
    # Around the origin all slopes meet: no energy there tells anything.
    counted = x**2 + y**2 > (6.0 * RESOLUTION) ** 2
    band = counted & (np.abs(y) < OMEGA) & (np.abs(x) < OMEGA / s_min)
    return {"share": float((energy * inside * counted).sum() / (energy * counted).sum()),
            "share_through_light": float((energy * light * inside * counted).sum() / (energy * light * counted).sum()),
            "share_of_box": float((energy * inside * band).sum() / (energy * band).sum()),
            "area_of_box": float((inside & band).sum() / band.sum())}


def measured_slopes():
    """Of scenes of one depth: d2, the slope that it should have, and the slope of the spectrum's main axis."""
    random = np.random.default_rng(SEED)
    out = []
    for depth in (NEAR, 5.0, 6.0, FAR):
        scene = random_scene(random, True)
        scene["s"] = np.full(OCCLUDERS, slope(depth))
        omega_x, omega_y, energy = spectrum(visibility(scene))
        x, y = np.meshgrid(omega_x, omega_y)
        near = (x**2 + y**2 < 16.0) & (x**2 + y**2 > (6.0 * RESOLUTION) ** 2)
        moments = np.array([[(energy * a * b * near).sum() for a in (x, y)] for b in (x, y)])
        axis = np.linalg.eigh(moments)[1][:, 1]
        out.append({"distance": depth, "slope": float(slope(depth)), "measured": float(axis[1] / axis[0])})
    return out


# Coverage and accuracy

def box_coverage(name, s_min, s_max, printed=False):
    """(16) to (18), with the area of the axis-aligned box that it has, 4 Omega^2 / s_min; printed: 4 (Omega / s_min)^2."""
    wedge = 1.0 / s_min - 1.0 / s_max
    if name == "sheared":
        return 0.5 + 0.0 * wedge
    pairs = (components_of(name) + 1) // 2
    centre = 1.0 / s_min**2 if printed else 1.0 / s_min
    boxes = centre + pairs * (pairs - 1.0) * wedge + (pairs - 1.0) * (1.0 / s_min + 1.0 / s_max)
    return wedge * (pairs - 0.5) ** 2 / boxes


def components_of(name):
    return 1 if name == "aaf" else int(name.split(",")[0].split()[1])


def weights(name, bank, s_min):
    return np.ones(bank.pairs) if name.endswith("equal") else bank.weights_printed(s_min, OMEGA)


def response(name, s_min, s_max, x, y, scale=1.0):
    """The filter in frequency, as (2), (4) and (9) have it, with every Gaussian's deviation times `scale`."""
    omega = OMEGA
    if name == "aaf":
        return np.exp(-0.5 * (x * s_min / (omega * scale)) ** 2 - 0.5 * (y / (omega * scale)) ** 2)
    if name.startswith("sheared"):
        # (4) has the whole width of the parallelogram where the others have half of theirs.
        wide = omega * (1.0 / s_min - 1.0 / s_max) * (0.5 if name == "sheared, half" else 1.0)
        middle = 0.5 * y * (1.0 / s_min + 1.0 / s_max)
        return np.exp(-0.5 * ((x - middle) / (wide * scale)) ** 2 - 0.5 * (y / (omega * scale)) ** 2)
    bank = filters.Components((components_of(name) + 1) // 2, s_min, s_max, omega)
    out = 0.0
    for p, mu in enumerate(weights(name, bank, s_min)):
        for side in (1.0,) if p == 0 else (1.0, -1.0):
            out = out + mu * np.exp(-0.5 * ((x - side * bank.centre_x[p]) / (bank.extent_x[p] * scale)) ** 2
                                    - 0.5 * ((y - side * bank.centre_y[p]) / (bank.extent_y[p] * scale)) ** 2)
    return out


def gaussian_measures(name, s_min, s_max, scale=1.0):
    """Coverage and accuracy by midpoints over the wedge; the filter's whole integral is that of its Gaussians. And accuracy
    against what the integral over the light needs, exp(-Omega_y^2 / 2), in the place of 1, of the filter divided by its value at 0."""
    count = 120
    y = (np.arange(count) + 0.5) / count * OMEGA
    part = (np.arange(count) + 0.5) / count
    low, high = 1.0 / s_max, 1.0 / s_min
    x = y[:, None] * (low + (high - low) * part)
    measure = np.broadcast_to(y[:, None] * (high - low), x.shape)  # of x at each y; the same constant in all integrals
    values = response(name, s_min, s_max, x, y[:, None], scale)
    cell = OMEGA / count / count
    inside = 2.0 * (values * measure).sum() * cell
    wanted = np.exp(-0.5 * y[:, None] ** 2)
    normalised = values / response(name, s_min, s_max, 0.0, 0.0, scale)
    return (float(inside / whole(name, s_min, s_max, scale)),
            float(1.0 - np.sqrt(((values - 1.0) ** 2 * measure).sum() / measure.sum())),
            float(1.0 - np.sqrt(((normalised - wanted) ** 2 * measure).sum() / (wanted**2 * measure).sum())))


def whole(name, s_min, s_max, scale):
    """The integral of response over the plane."""
    if name == "aaf":
        return 2.0 * np.pi * scale**2 * OMEGA**2 / s_min
    if name.startswith("sheared"):
        wide = OMEGA * (1.0 / s_min - 1.0 / s_max) * (0.5 if name == "sheared, half" else 1.0)
        return 2.0 * np.pi * scale**2 * wide * OMEGA
    bank = filters.Components((components_of(name) + 1) // 2, s_min, s_max, OMEGA)
    areas = weights(name, bank, s_min) * bank.extent_x * bank.extent_y
    return 2.0 * np.pi * scale**2 * (areas[0] + 2.0 * areas[1:].sum())


def random_wedges(random, count, way):
    """0 < s_min < s_max < 10: two numbers in order, or the second between the first and 10. The paper does not say which."""
    first, second = random.uniform(0.0, 10.0, (2, count))
    if way == "ordered":
        return np.minimum(first, second), np.maximum(first, second)
    return first, first + (10.0 - first) * random.uniform(size=count)


def averages():
    """Over fifty wedges, drawn in both ways: the mean that is expected, and how far one draw of fifty is from it."""
    out = {}
    for way in ("ordered", "second above first"):
        s_min, s_max = random_wedges(np.random.default_rng(SEED), DRAWS, way)
        rows = {}
        names = ["aaf", "sheared"] + [f"maaf {n}" for n in COMPONENTS if n > 1]
        rows["boxes"] = {name: spread(box_coverage(name, s_min, s_max)) for name in names}
        rows["boxes_printed"] = {name: spread(box_coverage(name, s_min, s_max, True)) for name in names}
        # Gaussians' measures are those of the ratio alone: tabulate, and look up.
        ratios = np.linspace(0.005, 0.995, 100)
        for label, scale in (("gaussians", 1.0), ("gaussians_half", 0.5)):
            rows[label] = {}
            for name in NAMES + OTHERS + tuple(f"maaf {n}" for n in COMPONENTS if 7 < n <= 25):
                table = np.array([gaussian_measures(name, ratio, 1.0, scale) for ratio in ratios])
                rows[label][name] = {what: spread(np.interp(s_min / s_max, ratios, table[:, k]))
                                     for k, what in enumerate(("coverage", "accuracy", "accuracy_of_light"))}
        out[way] = rows
    return out


def spread(values):
    return {"mean": float(np.mean(values)), "of_fifty": float(np.std(values) / np.sqrt(WEDGES))}


def shapes():
    return {label: {str(scale): {name: dict(zip(("coverage", "accuracy", "accuracy_of_light"),
                                                gaussian_measures(name, s_min, s_max, scale)))
                                 for name in NAMES + OTHERS}
                    for scale in (1.0, 0.5)}
            for label, (s_min, s_max) in SHAPES.items()}


# Pictures

def outlines(name, s_min, s_max):
    """Of the boxes or the parallelogram: lists of corners."""
    if name == "sheared":
        low, high, wide = OMEGA / s_max, OMEGA / s_min, 0.5 * OMEGA * (1.0 / s_min - 1.0 / s_max)
        middle = 0.5 * (low + high)
        return [[(middle - wide, OMEGA), (middle + wide, OMEGA), (wide - middle, -OMEGA), (-middle - wide, -OMEGA)]]
    bank = filters.Components((components_of(name) + 1) // 2, s_min, s_max, OMEGA)
    out = []
    for p in range(bank.pairs):
        for side in (1.0,) if p == 0 else (1.0, -1.0):
            x, y = side * bank.centre_x[p], side * bank.centre_y[p]
            u, v = bank.extent_x[p], bank.extent_y[p]
            out.append([(x - u, y - v), (x + u, y - v), (x + u, y + v), (x - u, y + v)])
    return out


def save(figure, folder, name):
    figure.tight_layout()
    path = os.path.join(folder, name)
    figure.savefig(path, dpi=110)
    print(path)


def plot_scene(plt, scene, folder):
    s_min, s_max = scene["s"].min(), scene["s"].max()
    f = visibility(scene)
    omega_x, omega_y, energy = spectrum(f)
    figure, panels = plt.subplots(2, 4, figsize=(16, 8))
    panels = panels.flatten()
    axes = panels[0]
    axes.plot([-2.0, 2.0], [0.0, 0.0], color="#d9a400", linewidth=4, label="light")
    axes.plot([-16.0, 16.0], [RECEIVER, RECEIVER], color="0.3", linewidth=2, label="receiver")
    for depth, a, b in zip(scene["depth"], scene["a"], scene["b"]):
        # x + s y is d1 / d2 times the place at depth d2.
        axes.plot([a * depth / RECEIVER, b * depth / RECEIVER], [depth, depth], color="#1f3fa8", linewidth=2)
    axes.set_xlim(-16.0, 16.0)
    axes.invert_yaxis()
    axes.set_ylabel("distance from the light")
    axes.set_title("scene", fontsize=10)
    axes.legend(fontsize=8)
    panels[1].imshow(f, origin="lower", extent=(-SPAN_X / 2, SPAN_X / 2, -SPAN_Y / 2, SPAN_Y / 2), cmap="gray", aspect="auto")
    panels[1].set_xlim(-16.0, 16.0)
    panels[1].set_ylim(-4.0, 4.0)
    panels[1].set_title("visibility f(x, y)", fontsize=10)
    panels[1].set_xlabel("x")
    panels[1].set_ylabel("y")
    for axes, name in zip(panels[2:], ("", "aaf", "sheared", "maaf 3", "maaf 5", "maaf 7")):
        axes.pcolormesh(omega_x, omega_y, np.log10(energy / energy.max() + 1e-12), cmap="gray", vmin=-6.0, vmax=0.0,
                        shading="nearest", rasterized=True)
        axes.set_xlim(-1.3 * OMEGA / s_min, 1.3 * OMEGA / s_min)
        axes.set_ylim(-1.6 * OMEGA, 1.6 * OMEGA)
        for s in (s_min, s_max):
            axes.plot([-9.0, 9.0], [-9.0 * s, 9.0 * s], color="#d9a400", linewidth=0.8)
        axes.axhline(OMEGA, color="#d9a400", linewidth=0.8, linestyle=":")
        axes.axhline(-OMEGA, color="#d9a400", linewidth=0.8, linestyle=":")
        axes.set_title(name or "its spectrum, log10 from 0 to -6; wedge", fontsize=10)
        axes.set_xlabel("Omega_x")
        axes.set_ylabel("Omega_y")
        if name:
            for corners in outlines(name, s_min, s_max):
                axes.fill(*zip(*corners), facecolor="none", edgecolor="#d33b2f", linewidth=1.0)
            x, y = np.meshgrid(np.linspace(-6.0, 6.0, 301), np.linspace(-4.0, 4.0, 301))
            values = response(name, s_min, s_max, x, y)
            axes.contour(x, y, values / values.max(), levels=[0.25, 0.5, 0.75], colors="#6ad0ff", linewidths=0.8)
    save(figure, folder, "maaf_spectra.png")


def plot_measures(plt, results, folder):
    """Fig. 6, and the averages beside the paper's."""
    rows = results["averages"]["ordered"]
    figure, panels = plt.subplots(1, 2, figsize=(11, 4.2))
    counts = [n for n in COMPONENTS if 1 < n <= 25]
    for axes, what, title in ((panels[0], "coverage", "coverage (15)"), (panels[1], "accuracy", "accuracy (14)")):
        values = [rows["gaussians"][f"maaf {n}"][what]["mean"] for n in counts]
        axes.plot(counts, values, "o-", color="#1f3fa8", label="MAAF, weights (10)")
        equal = (3, 5, 7)
        axes.plot(equal, [rows["gaussians"][f"maaf {n}, equal"][what]["mean"] for n in equal], "s-", color="#6aa84f",
                  label="MAAF, weights 1")
        if what == "coverage":
            axes.plot(counts, [rows["boxes"][f"maaf {n}"]["mean"] for n in counts], "o:", color="0.5", label="MAAF, boxes")
        axes.axhline(rows["gaussians"]["aaf"][what]["mean"], color="#d33b2f", label="AAF")
        axes.axhline(rows["gaussians"]["sheared"][what]["mean"], color="#d9a400", label="sheared (4)")
        axes.plot(equal, PAPER[what]["average"][2:], "kx", label="MAAF, printed in Table 2")
        axes.plot([1.0, 1.0], PAPER[what]["average"][:2], "k+", label="AAF, sheared, printed")
        axes.set_title(title + ", mean over random wedges", fontsize=10)
        axes.set_xlabel("components")
        axes.set_ylim(0.0, 1.0)
        axes.legend(fontsize=7)
    save(figure, folder, "maaf_coverage.png")


def main(arguments):
    if len(arguments) not in (1, 2) or arguments[0].startswith("-"):
        print(__doc__.strip(), file=sys.stderr)
        return 2
    plt = results_file.pyplot("maaf_spectra") if len(arguments) > 1 else None
    random = np.random.default_rng(SEED)
    apart, together = random_scene(random, True), random_scene(random, False)
    results = {"benchmark": "maaf_spectra", "seed": SEED, "slopes": measured_slopes(),
               "wedge": {"apart": wedge_check(apart), "together": wedge_check(together)},
               "averages": averages(), "shapes": shapes(), "paper": PAPER}
    results_file.write("maaf_spectra", arguments[0], results)
    for row in results["slopes"]:
        print(f"one depth, {row['distance']:g} from the light: slope {row['slope']:.3f}, of the spectrum {row['measured']:.3f}")
    for kind, row in results["wedge"].items():
        print(f"occluders {kind}: {100 * row['share']:.1f} % of the energy in the wedge, {100 * row['share_through_light']:.1f} % of what "
              f"the light lets through; of the axis-aligned box {100 * row['share_of_box']:.1f} % on {100 * row['area_of_box']:.0f} % of its area")
    for way, rows in results["averages"].items():
        print(f"wedges {way}: coverage of boxes, with the printed area, the paper's")
        for name, value in PAPER["table 1"].items():
            print(f"  {name:10s} {rows['boxes'][name]['mean']:.3f} +- {rows['boxes'][name]['of_fifty']:.3f}  "
                  f"{rows['boxes_printed'][name]['mean']:.3f}  {value:.3f}")
        print("  of Gaussians: coverage, accuracy, accuracy against the light's transform; with half their deviations")
        for name in NAMES + OTHERS:
            cells = [f"{rows[kind][name][what]['mean']:.3f}" for kind in ("gaussians", "gaussians_half")
                     for what in ("coverage", "accuracy", "accuracy_of_light")]
            print(f"  {name:14s}", *cells)
    for label, rows in results["shapes"].items():
        print(f"s_min, s_max {label}: coverage, accuracy; the paper's")
        for k, name in enumerate(NAMES):
            print(f"  {name:14s} {rows['1.0'][name]['coverage']:.3f} {rows['1.0'][name]['accuracy']:.3f}  "
                  f"{PAPER['coverage'][label][k]:.3f} {PAPER['accuracy'][label][k]:.3f}")
    if plt:
        os.makedirs(arguments[1], exist_ok=True)
        plot_scene(plt, apart, arguments[1])
        plot_measures(plt, results, arguments[1])
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
