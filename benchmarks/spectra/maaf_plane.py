#!/usr/bin/python3
"""What maaf_flatland.py asks, of images and lights with two axes.

usage: maaf_plane.py RESULTS.json

Rectangles at random angles and slopes, samples of the light in squares of strata, filters that are products over both axes
(the axes of the light are those of the image). Needs python3-numpy.
"""

import sys

try:
    import numpy as np
except ImportError:
    sys.exit("maaf_plane: error: numpy: not installed: apt install python3-numpy")

import fit_maaf
import maaf_filters as filters
import maaf_flatland as flatland
import results_file

PIXELS = 64
MARGIN = 64
OCCLUDERS = 8
SCENES = 24
REALISATIONS = 2
SPP = (9, 16, 64)
TRUTH = 64          # samples along each axis
SEEDS = {"chosen_on": 43, "reported_on": 44}
NODES = 12          # of the polynomials along each axis
ROWS = 16           # of the image that are sampled at once
CONSTANTS = {
    "aaf": [0.125, 1.0 / 6.0, 0.2, 0.25, 1.0 / 3.3, 0.35, 0.4, 0.45, 0.5, 0.6],
    "extrapolated": [0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0],
    "gradients": [0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8],
    "two_slope": [0.05, 0.1, 0.15, 0.2, 0.25, 0.35, 0.5],
    "maaf": [1.5, 2.0, 2.5, 3.0],
}
# Of filters that go by slopes that samples tell: slow, since no two pixels have the same filter.
SCENES_MEASURED = 12
SPP_MEASURED = (9, 16, 64)
REACH = 24
MEASURED = {"aaf": [1.0 / 6.0, 0.2, 0.25, 1.0 / 3.3, 0.35, 0.4], "extrapolated": [0.3, 0.4, 0.5, 0.6, 0.7],
            "two_slope": [0.05, 0.1, 0.15, 0.2, 0.25]}
REFITTED = {2: (0.001,), 3: (0.0, 0.001, 0.01), 4: (0.001, 0.01)}  # pairs, and noise terms of the fit


def random_scene(random):
    """s_min sigma is 2 to 8 pixels; rectangles hide where their own coordinates of x + s y are within their sides."""
    s_min = 2.0 ** random.uniform(1.0, 3.0)
    ratio = 2.0 ** random.uniform(0.0, 3.0)
    slopes = s_min * ratio ** np.concatenate([[0.0, 1.0], random.uniform(0.0, 1.0, OCCLUDERS - 2)])
    middle = random.uniform(-0.5 * MARGIN, PIXELS + 0.5 * MARGIN, (OCCLUDERS, 2))
    middle[:2] = random.uniform(0.0, PIXELS, (2, 2))
    return {"s_min": s_min, "s_max": s_min * ratio, "slopes": slopes, "middle": middle,
            "angle": random.uniform(0.0, np.pi, OCCLUDERS), "half": 0.5 * 2.0 ** random.uniform(2.0, 6.5, (OCCLUDERS, 2))}


def visible(scene, x1, x2, y1, y2):
    out = np.ones(np.broadcast(x1, x2, y1, y2).shape, dtype=bool)
    for s, middle, angle, half in zip(scene["slopes"], scene["middle"], scene["angle"], scene["half"]):
        u, v = x1 + s * y1 - middle[0], x2 + s * y2 - middle[1]
        c, z = np.cos(angle), np.sin(angle)
        out &= (np.abs(c * u + z * v) > half[0]) | (np.abs(c * v - z * u) > half[1])
    return out


def exact(scene):
    """By TRUTH^2 samples: the integral has no closed form."""
    y = flatland.place((np.arange(TRUTH) + 0.5) / TRUTH)
    x = np.arange(PIXELS, dtype=float)
    return np.array([visible(scene, x[:, None, None], row, y[:, None], y).mean(axis=(1, 2)) for row in x])


class Samples:
    """As maaf_flatland.Samples: means of products of polynomials along both axes, in frequency; axes are degree 1, degree 2, x2, x1."""

    def __init__(self, scene, spp, random):
        side = int(round(spp**0.5))
        size = PIXELS + 2 * MARGIN
        x = np.arange(-MARGIN, PIXELS + MARGIN, dtype=float)
        taken, seen = (np.empty((NODES, NODES, size, size)) for _ in range(2))
        strata = np.arange(side)
        for first in range(0, size, ROWS):
            shape = (ROWS, size, side, side)
            y1 = flatland.place((strata + random.uniform(size=shape)) / side).reshape(ROWS, size, spp)
            y2 = flatland.place((strata[:, None] + random.uniform(size=shape)) / side).reshape(ROWS, size, spp)
            f = visible(scene, x[:, None], x[first:first + ROWS, None, None], y1, y2)
            over_1 = np.swapaxes(flatland.polynomials(y1, NODES), 2, 3) / spp
            over_2 = flatland.polynomials(y2, NODES)
            rows = slice(first, first + ROWS)
            taken[:, :, rows] = np.moveaxis(over_1 @ over_2, (2, 3), (0, 1))
            seen[:, :, rows] = np.moveaxis((over_1 * f[:, :, None]) @ over_2, (2, 3), (0, 1))
        self.size = size
        self.mean = seen[0, 0, MARGIN:-MARGIN, MARGIN:-MARGIN].copy()
        self.taken, self.seen = np.fft.rfft2(taken), np.fft.rfft2(seen)

    def filtered(self, terms):
        """By a sum of (factor, kernel): each a product of the kernel along both axes."""
        seen, taken = 0.0, 0.0
        for factor, kernel in terms:
            reach = min(int(np.ceil(kernel.reach)), MARGIN)
            d = np.arange(-reach, reach + 1)
            rows = flatland.expansion(kernel, d.astype(float), NODES)
            over = np.zeros((len(rows), self.size))
            over[:, -d] = rows
            over_1, over_2 = np.fft.rfft(over), np.fft.fft(over)
            count = len(rows)
            for k in range(count):
                # Along x1 the term's factor is over_1[k]; along x2 all of them are added up.
                seen = seen + factor * over_1[k] * np.einsum("ly,lyx->yx", over_2, self.seen[k, :count])
                taken = taken + factor * over_1[k] * np.einsum("ly,lyx->yx", over_2, self.taken[k, :count])
        size = (self.size, self.size)
        image = np.fft.irfft2(seen, size) / np.fft.irfft2(taken, size)
        return image[MARGIN:-MARGIN, MARGIN:-MARGIN]


def extrapolated_round(scene, c):
    """2 G - G of Gaussians of both axes, which is no product."""
    return [(2.0, filters.aaf(scene["s_min"], c)), (-1.0, filters.aaf(scene["s_min"], np.sqrt(2.0) * c))]


def candidates():
    """Name: list of (constant, terms of scene)."""
    out = {"none": [(0.0, None)]}
    for k_mu in (6.0, 4.0, 3.3):
        out[f"aaf k mu {k_mu:g}"] = [(1.0 / k_mu, lambda s, c=1.0 / k_mu: [(1.0, filters.aaf(s["s_min"], c))])]
    out["aaf"] = [(c, lambda s, c=c: [(1.0, filters.aaf(s["s_min"], c))]) for c in CONSTANTS["aaf"]]
    out["extrapolated, product"] = [(c, lambda s, c=c: [(1.0, filters.extrapolated(s["s_min"], c))])
                                    for c in CONSTANTS["extrapolated"]]
    out["extrapolated, round"] = [(c, lambda s, c=c: extrapolated_round(s, c)) for c in CONSTANTS["extrapolated"]]
    out["gradients"] = [(c, lambda s, c=c: [(1.0, filters.gradients(s["s_min"], c))]) for c in CONSTANTS["gradients"]]
    out["two_slope"] = [(c, lambda s, c=c: [(1.0, filters.two_slope(s["s_min"], s["s_max"], c))])
                        for c in CONSTANTS["two_slope"]]
    for pairs, noises in REFITTED.items():
        name = f"maaf {2 * pairs - 1}"
        out[f"{name} printed, 2"] = [(2.0, lambda s, n=pairs: [(1.0, flatland.maaf_printed(s, n, 2.0))])]
        for noise in noises:
            fitted = {o: fit_maaf.table(pairs, o, noise) for o in CONSTANTS["maaf"]}
            out[f"{name} refitted, noise {noise:g}"] = [
                (o, lambda s, n=pairs, o=o, t=fitted[o]: [(1.0, flatland.maaf_refitted(s, n, o, t))])
                for o in CONSTANTS["maaf"]]
    return out


def measure_set(seed, lists):
    """As maaf_flatland.measure_set, for each count of samples."""
    errors = {(spp, name, k): [] for spp in SPP for name, entries in lists.items() for k in range(len(entries))}
    random_scenes = np.random.default_rng(seed)
    random = np.random.default_rng([seed, 1])
    for _ in range(SCENES):
        scene = random_scene(random_scenes)
        truth = exact(scene)
        for spp in SPP:
            images = {}
            for _ in range(REALISATIONS):
                samples = Samples(scene, spp, random)
                for name, entries in lists.items():
                    for k, (_, make) in enumerate(entries):
                        images.setdefault((spp, name, k), []).append(
                            samples.mean if make is None else samples.filtered(make(scene)))
            for key, values in images.items():
                errors[key].append(flatland.split(np.array(values), truth))
    return {key: np.array(value) for key, value in errors.items()}


# Slopes that samples tell

def around(values, weights):
    """Sums with weights of an odd number of neighbours along both axes; nothing beyond the borders."""
    for axis in (0, 1):
        values = np.apply_along_axis(np.convolve, axis, values, weights, "same")
    return values


def measured_slopes(scene, x1, x2, y1, y2):
    """As maaf_flatland.measured_slopes, over 3 x 3 pixels and round Gaussian weights."""
    slopes = np.full(y1.shape, np.inf)
    for k, s in enumerate(scene["slopes"]):
        one = {key: scene[key][k:k + 1] for key in ("slopes", "middle", "angle", "half")}
        slopes = np.where(visible(one, x1, x2, y1, y2), slopes, np.minimum(slopes, s))
    hidden = np.isfinite(slopes).any(axis=2)
    least, most = slopes.min(axis=2), np.where(np.isfinite(slopes), slopes, 0.0).max(axis=2)
    for axis in (0, 1):
        least = np.minimum(least, np.minimum(np.roll(least, 1, axis), np.roll(least, -1, axis)))
    weights = np.exp(-0.5 * (np.arange(-18, 19) / 6.0) ** 2)
    total = around(hidden.astype(float), weights)
    near = np.maximum(around(hidden.astype(float), np.ones(3)), 1.0)
    out = []
    for values in (least, most):
        logs = np.where(hidden, np.log(np.where(hidden, values, 1.0)), 0.0)
        three = np.where(hidden, around(logs, np.ones(3)) / near, 0.0)
        spread = around(three, weights) / np.maximum(total, 1e-30)
        out.append(np.where(hidden, np.exp(three), np.where(total > 1e-12, np.exp(spread), 0.0)))
    return out[0], np.maximum(out[0], out[1])


def gathered(f, y1, y2, slopes, exponent, reach):
    """As maaf_flatland.gathered. The exponent is a sum over both axes: exponent(d, y, s_min, s_max) of each."""
    # In single precision, which is several times as fast.
    (s_min, s_max), y1, y2 = [a.astype(np.float32) for a in slopes], y1.astype(np.float32), y2.astype(np.float32)
    inner, one = slice(MARGIN, -MARGIN), np.float32(1.0)
    seen, taken = np.zeros((PIXELS, PIXELS)), np.zeros((PIXELS, PIXELS))
    for d2 in range(-reach, reach + 1):
        for d1 in range(-reach, reach + 1):
            if d1**2 + d2**2 > reach**2:
                continue
            other = (slice(MARGIN + d2, MARGIN + d2 + PIXELS), slice(MARGIN + d1, MARGIN + d1 + PIXELS))
            low, high = np.minimum(s_min[inner, inner], s_min[other]), np.maximum(s_max[inner, inner], s_max[other])
            usable = (low > 0.0)[:, :, None]
            low, high = np.where(usable, low[:, :, None], one), np.where(usable, high[:, :, None], one)
            w = np.exp(exponent(np.float32(d1), y1[other], low, high) + exponent(np.float32(d2), y2[other], low, high)) * usable
            seen += (w * f[other]).sum(axis=2)
            taken += np.broadcast_to(w, f[other].shape).sum(axis=2)
    return np.where(taken > 0.0, seen / np.where(taken > 0.0, taken, 1.0), f[inner, inner].mean(axis=2))


def samples_of(scene, spp, random, x):
    side = int(round(spp**0.5))
    shape = (len(x), len(x), side, side)
    strata = np.arange(side)
    y1 = flatland.place((strata + random.uniform(size=shape)) / side).reshape(len(x), len(x), spp)
    y2 = flatland.place((strata[:, None] + random.uniform(size=shape)) / side).reshape(len(x), len(x), spp)
    return visible(scene, x[:, None], x[:, None, None], y1, y2), y1, y2


def measured_set(seed):
    """As measure_set, of filters that go by measured slopes."""
    errors = {}
    random_scenes = np.random.default_rng(seed)
    random = np.random.default_rng([seed, 2])
    x = np.arange(-MARGIN, PIXELS + MARGIN, dtype=float)
    nothing = np.zeros((len(x), len(x), 1))
    for _ in range(SCENES_MEASURED):
        scene = random_scene(random_scenes)
        truth = exact(scene)
        for spp in SPP_MEASURED:
            images = {}
            for _ in range(REALISATIONS):
                f, y1, y2 = samples_of(scene, spp, random, x)
                _, first_1, first_2 = (f, y1, y2) if spp == flatland.FIRST else samples_of(scene, flatland.FIRST, random, x)
                slopes = measured_slopes(scene, x[:, None], x[:, None, None], first_1, first_2)
                means = f.mean(axis=2)[:, :, None]

                def one_mean(c):
                    reach = min(int(np.ceil(3.0 * c * slopes[0].max())), REACH)
                    return gathered(means, nothing, nothing, slopes, flatland.gaussian_pair(c), reach)

                for k, c in enumerate(MEASURED["aaf"]):
                    images.setdefault((spp, "aaf", k), []).append(one_mean(c))
                for k, c in enumerate(MEASURED["extrapolated"]):
                    images.setdefault((spp, "extrapolated", k), []).append(2.0 * one_mean(c) - one_mean(np.sqrt(2.0) * c))
                for k, c in enumerate(MEASURED["two_slope"]):
                    reach = min(int(np.ceil(3.0 * flatland.widest_two_slope(slopes, c))), REACH)
                    images.setdefault((spp, "two_slope", k), []).append(
                        gathered(f, y1, y2, slopes, flatland.two_slope_pair(c), reach))
            for key, values in images.items():
                errors.setdefault(key, []).append(flatland.split(np.array(values), truth))
    return {key: np.array(value) for key, value in errors.items()}


def all_best(spp, lists, chosen_on, reported_on):
    return {name: flatland.best_of(entries, [chosen_on[spp, name, k] for k in range(len(entries))],
                                   [reported_on[spp, name, k] for k in range(len(entries))])
            for name, entries in lists.items()}


def main(arguments):
    if len(arguments) != 1 or arguments[0].startswith("-"):
        print(__doc__.strip(), file=sys.stderr)
        return 2
    lists = candidates()
    chosen_on, reported_on = (measure_set(SEEDS[which], lists) for which in ("chosen_on", "reported_on"))
    results = {"benchmark": "maaf_plane", "scenes": SCENES, "realisations": REALISATIONS, "scenes_measured": SCENES_MEASURED,
               "seeds": SEEDS, "plane": {str(spp): all_best(spp, lists, chosen_on, reported_on) for spp in SPP}}
    chosen_on, reported_on = (measured_set(SEEDS[which]) for which in ("chosen_on", "reported_on"))
    lists = {name: [(c, None) for c in constants] for name, constants in MEASURED.items()}
    results["measured"] = {str(spp): all_best(spp, lists, chosen_on, reported_on) for spp in SPP_MEASURED}
    for part, heading in (("plane", "Slopes known"), ("measured", "Slopes of nine samples")):
        flatland.add_saved(results[part])
        print(heading)
        for spp, rows in results[part].items():
            print(flatland.TITLE.format(spp))
            for name, row in rows.items():
                print(flatland.line_of(name, row))
    results_file.write("maaf_plane", arguments[0], results)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
