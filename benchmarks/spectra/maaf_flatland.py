#!/usr/bin/python3
"""Which filter of sparse samples of a soft shadow errs least, in flatland: AAF, its extrapolation, MAAF, sheared.

usage: maaf_flatland.py RESULTS.json [FOLDER]     and PNG files, into the folder if there is one

Random scenes of occluders at slopes between s_min and s_max; stratified samples of the light at every pixel, filtered, against
the exact integral. Errors are split: bias is what is left of the mean over realisations, noise what differs between them.
Each filter's constant is the best of one set of scenes, its errors those of another. Needs python3-numpy, and
python3-matplotlib for pictures.
"""

import json
import math
import os
import sys

try:
    import numpy as np
except ImportError:
    sys.exit("maaf_flatland: error: numpy: not installed: apt install python3-numpy")

import fit_maaf
import maaf_filters as filters

PIXELS = 256        # that are judged
MARGIN = 192        # on both sides, for filters to gather from
OCCLUDERS = 8
SCENES = 120        # of each set
REALISATIONS = 8
SPP = (9, 16, 64)
SEEDS = {"chosen_on": 41, "reported_on": 42}
NODES = 24          # of the polynomial in y by which filters that depend on it are applied
CONSTANTS = {
    "aaf": [0.1, 0.125, 1.0 / 6.0, 0.2, 0.25, 1.0 / 3.3, 0.35, 0.4, 0.5, 0.6],
    "extrapolated": [0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8],
    "two_slope": [0.025, 0.05, 0.1, 0.15, 0.2, 0.25, 0.35, 0.5, 0.7, 1.0],
    "maaf": [1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0],     # Omega_max sigma; the paper's is 2
}
NOISES = (0.0, 0.001, 0.01, 0.03)  # of the fit of weights


# Light

def light_cdf(y):
    """Share of the light below y."""
    total = math.erf(filters.CUT / math.sqrt(2.0))
    return np.clip(0.5 + 0.5 * ERF(np.clip(y, -filters.CUT, filters.CUT) / math.sqrt(2.0)) / total, 0.0, 1.0)


ERF = np.vectorize(math.erf, otypes=[float])
TABLE_Y = np.linspace(-filters.CUT, filters.CUT, 4097)
TABLE_SHARE = light_cdf(TABLE_Y)


def place(share):
    """The y below which that share of the light is."""
    return np.interp(share, TABLE_SHARE, TABLE_Y)


# Scenes

def random_scene(random):
    """Slopes in pixels a sigma: s_min sigma is 2 to 16 pixels wide, s_max / s_min 1 to 8. The first occluder has s_min, the second
    s_max, others lie between. Each hides from `a` to `b` of x + s y."""
    s_min = 2.0 ** random.uniform(1.0, 4.0)
    ratio = 2.0 ** random.uniform(0.0, 3.0)
    slopes = s_min * ratio ** np.concatenate([[0.0, 1.0], random.uniform(0.0, 1.0, OCCLUDERS - 2)])
    wide = 2.0 ** random.uniform(2.0, 7.0, OCCLUDERS)
    middle = random.uniform(-MARGIN, PIXELS + MARGIN, OCCLUDERS)
    # Those that bound the wedge cast their shadows where it is judged.
    middle[:2] = random.uniform(0.0, PIXELS, 2)
    return {"s_min": s_min, "s_max": s_min * ratio, "slopes": slopes, "a": middle - 0.5 * wide, "b": middle + 0.5 * wide}


def visible(scene, x, y):
    out = np.ones(np.broadcast(x, y).shape, dtype=bool)
    for s, a, b in zip(scene["slopes"], scene["a"], scene["b"]):
        at = x + s * y
        out &= (at <= a) | (at >= b)
    return out


def exact(scene, x):
    """The share of the light that each x sees: the union of what occluders hide, end by end."""
    low = light_cdf((scene["a"] - x[:, None]) / scene["slopes"])
    high = light_cdf((scene["b"] - x[:, None]) / scene["slopes"])
    order = np.argsort(low, axis=1)
    low, high = np.take_along_axis(low, order, 1), np.take_along_axis(high, order, 1)
    hidden, end = np.zeros(len(x)), np.zeros(len(x))
    for k in range(low.shape[1]):
        hidden += np.maximum(high[:, k] - np.maximum(low[:, k], end), 0.0)
        end = np.maximum(end, high[:, k])
    return 1.0 - hidden


# Filtering

def polynomials(y):
    """Chebyshev's, of degrees below NODES, over the light; the last axis is the degree."""
    t = y / filters.CUT
    out = np.empty(y.shape + (NODES,))
    out[..., 0] = 1.0
    out[..., 1] = t
    for k in range(2, NODES):
        out[..., k] = 2.0 * t * out[..., k - 1] - out[..., k - 2]
    return out


def expansion(kernel, d):
    """Of kernel.weight / profile in those polynomials, at each d: one row where it does not depend on y."""
    if kernel.of_light:
        return (kernel.weight(d, 0.0) / filters.profile(0.0))[None]
    angles = np.pi * (np.arange(NODES) + 0.5) / NODES
    y = filters.CUT * np.cos(angles)
    values = kernel.weight(d[None], y[:, None]) / filters.profile(y)[:, None]
    out = 2.0 / NODES * np.cos(np.arange(NODES)[:, None] * angles) @ values
    out[0] *= 0.5
    return out


class Samples:
    """What filters need of a scene's samples: at each pixel the means of polynomials over all of them, and over the visible ones."""

    def __init__(self, scene, spp, realisations, random):
        x = np.arange(-MARGIN, PIXELS + MARGIN, dtype=float)
        shape = (realisations, len(x), spp)
        y = place((np.arange(spp) + random.uniform(size=shape)) / spp)
        f = visible(scene, x[:, None], y)
        basis = polynomials(y)
        taken = np.einsum("rxnk->rkx", basis) / spp
        seen = np.einsum("rxnk,rxn->rkx", basis, f.astype(float)) / spp
        self.taken, self.seen = np.fft.rfft(taken), np.fft.rfft(seen)
        self.count = len(x)
        self.mean = seen[:, 0]

    def filtered(self, kernel):
        """Images, realisations x PIXELS. Filters wrap around within the margins."""
        reach = min(int(np.ceil(kernel.reach)), MARGIN)
        d = np.arange(-reach, reach + 1)
        rows = expansion(kernel, d.astype(float))
        over = np.zeros((len(rows), self.count))
        over[:, -d] = rows  # h(x) = sum over d of w(d) f(x + d): a convolution with w mirrored
        over = np.fft.rfft(over)
        seen = np.fft.irfft(np.einsum("kf,rkf->rf", over, self.seen[:, :len(rows)]), self.count)
        taken = np.fft.irfft(np.einsum("kf,rkf->rf", over, self.taken[:, :len(rows)]), self.count)
        return (seen / taken)[:, MARGIN:-MARGIN]


# Filters by name

def tables():
    return {(pairs, omega, noise): fit_maaf.table(pairs, omega, noise)
            for pairs in fit_maaf.PAIRS for omega in CONSTANTS["maaf"] for noise in NOISES}


def maaf_printed(scene, pairs, omega):
    weights = filters.Components(pairs, scene["s_min"], scene["s_max"], omega).weights_printed(scene["s_min"], omega)
    return filters.maaf(pairs, scene["s_min"], scene["s_max"], filters.both(weights), omega)


def maaf_of_light(scene, pairs, omega):
    weights = filters.Components(pairs, scene["s_min"], scene["s_max"], omega).weights_of_light()
    return filters.maaf(pairs, scene["s_min"], scene["s_max"], filters.both(weights), omega)


def maaf_refitted(scene, pairs, omega, rows):
    weights = fit_maaf.look_up(rows, scene["s_max"] / scene["s_min"])
    return filters.maaf(pairs, scene["s_min"], scene["s_max"], weights, omega)


def candidates(fitted):
    """Name: list of (constant, kernel of scene)."""
    out = {"none": [(0.0, None)]}
    for k_mu in (6.0, 4.0, 3.3):
        out[f"aaf k mu {k_mu:g}"] = [(1.0 / k_mu, lambda s, c=1.0 / k_mu: filters.aaf(s["s_min"], c))]
    out["aaf"] = [(c, lambda s, c=c: filters.aaf(s["s_min"], c)) for c in CONSTANTS["aaf"]]
    out["extrapolated"] = [(c, lambda s, c=c: filters.extrapolated(s["s_min"], c)) for c in CONSTANTS["extrapolated"]]
    out["two_slope 0.25"] = [(0.25, lambda s: filters.two_slope(s["s_min"], s["s_max"], 0.25))]
    out["two_slope"] = [(c, lambda s, c=c: filters.two_slope(s["s_min"], s["s_max"], c)) for c in CONSTANTS["two_slope"]]
    for pairs in fit_maaf.PAIRS:
        name = f"maaf {2 * pairs - 1}"
        out[f"{name} printed, 2"] = [(2.0, lambda s, n=pairs: maaf_printed(s, n, 2.0))]
        out[f"{name} printed"] = [(o, lambda s, n=pairs, o=o: maaf_printed(s, n, o)) for o in CONSTANTS["maaf"]]
        # At least as wide as the light: Omega_max / (2 N - 1) < 1 / sigma.
        out[f"{name} of light"] = [(o, lambda s, n=pairs, o=o: maaf_of_light(s, n, o)) for o in CONSTANTS["maaf"]
                                   if o / (2 * pairs - 1) < 0.95]
        for noise in NOISES:
            out[f"{name} refitted, noise {noise:g}"] = [
                (o, lambda s, n=pairs, o=o, t=fitted[pairs, o, noise]: maaf_refitted(s, n, o, t))
                for o in CONSTANTS["maaf"]]
    return out


# Errors

def split(images, truth):
    """Mean square error, and its parts: bias and noise. Bias is unbiased for what the realisations leave of noise in their mean."""
    error = images - truth
    total = float(np.mean(error**2))
    noise = float(np.mean(np.var(images, axis=0, ddof=1)))
    return total, total - noise, noise


def measure_set(seed, spp, lists):
    """For each (name, index of constant) an array of scenes x (total, bias, noise), and the scenes' s_min and ratio."""
    errors = {(name, k): [] for name, entries in lists.items() for k in range(len(entries))}
    shapes = []
    random_scenes = np.random.default_rng(seed)
    random = np.random.default_rng([seed, spp])
    for _ in range(SCENES):
        scene = random_scene(random_scenes)
        shapes.append((scene["s_min"], scene["s_max"] / scene["s_min"]))
        truth = exact(scene, np.arange(PIXELS, dtype=float))
        samples = Samples(scene, spp, REALISATIONS, random)
        for name, entries in lists.items():
            for k, (_, make) in enumerate(entries):
                images = samples.mean[:, MARGIN:-MARGIN] if make is None else samples.filtered(make(scene))
                errors[name, k].append(split(images, truth))
    return {key: np.array(value) for key, value in errors.items()}, np.array(shapes)


def root(x):
    return float(np.sqrt(max(x, 0.0)))


def summary(errors):
    total, bias, noise = errors.mean(axis=0)
    return {"rms": root(total), "bias": root(bias), "noise": root(noise)}


BINS = {"all": lambda s, r: s > 0.0, "s_min sigma 2 to 4 px": lambda s, r: s < 4.0,
        "4 to 8": lambda s, r: (s >= 4.0) & (s < 8.0), "8 to 16": lambda s, r: s >= 8.0,
        "s_max / s_min 1 to 2": lambda s, r: r < 2.0, "2 to 4": lambda s, r: (r >= 2.0) & (r < 4.0),
        "4 to 8 times": lambda s, r: r >= 4.0}


def compare(spp, lists):
    """Each filter with the constant that errs least over the scenes it is chosen on, and its errors over others."""
    chosen_on, _ = measure_set(SEEDS["chosen_on"], spp, lists)
    reported_on, shapes = measure_set(SEEDS["reported_on"], spp, lists)
    out = {}
    for name, entries in lists.items():
        means = [float(chosen_on[name, k][:, 0].mean()) for k in range(len(entries))]
        best = int(np.argmin(means))
        errors = reported_on[name, best]
        out[name] = {"constant": entries[best][0], **summary(errors),
                     "rms_where_chosen": root(means[best]),
                     "by": {label: summary(errors[of(shapes[:, 0], shapes[:, 1])]) for label, of in BINS.items()},
                     "sweep": [{"constant": c, **summary(reported_on[name, k])} for k, (c, _) in enumerate(entries)]}
    return out


def main(arguments):
    if len(arguments) not in (1, 2) or arguments[0].startswith("-"):
        print(__doc__.strip(), file=sys.stderr)
        return 2
    lists = candidates(tables())
    results = {"benchmark": "maaf_flatland", "scenes": SCENES, "realisations": REALISATIONS, "seeds": SEEDS,
               "cut": filters.CUT, "line": {}}
    for spp in SPP:
        results["line"][str(spp)] = compare(spp, lists)
        print(f"{spp} samples a pixel: RMS error, bias, noise, constant")
        for name, row in results["line"][str(spp)].items():
            print(f"  {name:28s} {row['rms']:.4f} {row['bias']:.4f} {row['noise']:.4f}  {row['constant']:.3f}")
    try:
        with open(arguments[0], "w", encoding="utf-8") as file:
            json.dump(results, file, indent=1)
            file.write("\n")
    except OSError as error:
        print(f"maaf_flatland: error: {arguments[0]}: {error}: name a file that can be written", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
