#!/usr/bin/python3
"""Which filter of sparse samples of a soft shadow errs least, in flatland: AAF, its extrapolation, MAAF, sheared.

usage: maaf_flatland.py RESULTS.json     which maaf_flatland_plot.py draws

Random scenes of occluders at slopes between s_min and s_max; stratified samples of the light at every pixel, filtered, against
the exact integral. Errors are split: bias is what is left of the mean over realisations, noise what differs between them.
Each filter's constant is the best of one set of scenes, its errors those of another. Needs python3-numpy.
"""

import math
import sys

try:
    import numpy as np
except ImportError:
    sys.exit("maaf_flatland: error: numpy: not installed: apt install python3-numpy")

import fit_maaf
import maaf_filters as filters
import results_file

PIXELS = 256        # that are judged
MARGIN = 192        # on both sides, for filters to gather from
OCCLUDERS = 8
SCENES = 120        # of each set
REALISATIONS = 8
SCENES_MEASURED = 60  # of filters that go by slopes that samples tell
REALISATIONS_MEASURED = 2
FIRST = 9           # samples that tell them
SPP = (9, 16, 64)
SEEDS = {"chosen_on": 41, "reported_on": 42}
NODES = 24          # of the polynomial in y by which filters that depend on it are applied
CONSTANTS = {
    "aaf": [0.1, 0.125, 1.0 / 6.0, 0.2, 0.25, 1.0 / 3.3, 0.35, 0.4, 0.5, 0.6],
    "extrapolated": [0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8],
    "gradients": [0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8],
    "two_slope": [0.0125, 0.025, 0.05, 0.1, 0.15, 0.2, 0.25, 0.35, 0.5, 0.7, 1.0],
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

def polynomials(y, count=NODES):
    """Chebyshev's, of degrees below `count`, over the light; the last axis is the degree."""
    t = y / filters.CUT
    out = np.empty(y.shape + (count,))
    out[..., 0] = 1.0
    out[..., 1] = t
    for k in range(2, count):
        out[..., k] = 2.0 * t * out[..., k - 1] - out[..., k - 2]
    return out


def expansion(kernel, d, count=NODES):
    """Of kernel.weight / profile in those polynomials, at each d: one row where it does not depend on y."""
    if kernel.of_light:
        return (kernel.weight(d, 0.0) / filters.profile(0.0))[None]
    angles = np.pi * (np.arange(count) + 0.5) / count
    y = filters.CUT * np.cos(angles)
    values = kernel.weight(d[None], y[:, None]) / filters.profile(y)[:, None]
    out = 2.0 / count * np.cos(np.arange(count)[:, None] * angles) @ values
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
    out["gradients"] = [(c, lambda s, c=c: filters.gradients(s["s_min"], c)) for c in CONSTANTS["gradients"]]
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
    """Of a mean square, to the four digits that tell something. Bias may come out below nought where noise hides it."""
    return float(f"{np.sqrt(max(x, 0.0)):.4g}")


def summary(errors):
    total, bias, noise = errors.mean(axis=0)
    return {"rms": root(total), "bias": root(bias), "noise": root(noise)}


# RMS errors are also given over scenes of some widths and of some ratios.
BINS = {"all": lambda s, r: s > 0.0, "s_min sigma 2 to 4 px": lambda s, r: s < 4.0,
        "4 to 8": lambda s, r: (s >= 4.0) & (s < 8.0), "8 to 16": lambda s, r: s >= 8.0,
        "s_max / s_min 1 to 2": lambda s, r: r < 2.0, "2 to 4": lambda s, r: (r >= 2.0) & (r < 4.0),
        "4 to 8 times": lambda s, r: r >= 4.0}


def best_of(entries, chosen_on, reported_on):
    """The constant that errs least over the scenes it is chosen on, and the errors over others."""
    means = [float(errors[:, 0].mean()) for errors in chosen_on]
    best = int(np.argmin(means))
    return {"constant": entries[best][0], **summary(reported_on[best]), "rms_where_chosen": root(means[best]),
            "sweep": [{"constant": c, **summary(errors)} for (c, _), errors in zip(entries, reported_on)]}


def add_saved(results, thesis="aaf k mu 6"):
    """How many times the samples AAF needs for the same error, at its best constant for each count ("saved"), and with the thesis's
    ("saved_thesis", where it is among them): between the counts that are measured by straight lines in logarithms, none beyond."""
    counts = np.log([float(spp) for spp in results])
    for key, name in (("saved", "aaf"), ("saved_thesis", thesis)):
        if any(name not in rows for rows in results.values()):
            continue
        errors = np.log([rows[name]["rms"] for rows in results.values()])
        for spp, rows in results.items():
            for row in rows.values():
                at = np.log(row["rms"])
                row[key] = None
                if errors[-1] <= at <= errors[0]:
                    row[key] = float(f"{np.exp(np.interp(-at, -errors, counts)) / float(spp):.3g}")


TITLE = "{} samples a pixel: RMS error, bias, noise, constant; samples of AAF over its own, of the best and of the thesis's"


def line_of(name, row):
    saved = " ".join("-" if row.get(key) is None else f"{row[key]:.2f}" for key in ("saved", "saved_thesis"))
    return f"  {name:28s} {row['rms']:.4f} {row['bias']:.4f} {row['noise']:.4f}  {row['constant']:.3f}  {saved}"


def compare(spp, lists):
    """Filters that know the scene's slopes."""
    chosen_on, _ = measure_set(SEEDS["chosen_on"], spp, lists)
    reported_on, shapes = measure_set(SEEDS["reported_on"], spp, lists)
    out = {}
    for name, entries in lists.items():
        row = best_of(entries, [chosen_on[name, k] for k in range(len(entries))],
                      [reported_on[name, k] for k in range(len(entries))])
        errors = reported_on[name, [c for c, _ in entries].index(row["constant"])]
        row["by"] = {label: summary(errors[of(shapes[:, 0], shapes[:, 1])])["rms"] for label, of in BINS.items()}
        out[name] = row
    return out


# Slopes that samples tell

def measured_slopes(scene, x, y):
    """(s_min, s_max) of each pixel from its first nine samples, as a renderer has them: of each hidden one the slope of the occluder
    nearest to the receiver, which is the smallest; s_min as the least of three pixels, then both as means over three of their
    logarithms; pixels that see all of the light take the mean with Gaussian weights of 6 pixels. Nought where nothing is near."""
    at = x[:, None, None] + scene["slopes"] * y[:, :FIRST, None]
    slopes = np.where((at > scene["a"]) & (at < scene["b"]), scene["slopes"], np.inf).min(axis=2)
    hidden = np.isfinite(slopes).any(axis=1)
    least = np.where(hidden, np.min(slopes, axis=1), np.inf)
    most = np.where(hidden, np.max(np.where(np.isfinite(slopes), slopes, 0.0), axis=1), 0.0)
    least = np.minimum(least, np.minimum(np.roll(least, 1), np.roll(least, -1)))
    out = []
    distances = np.arange(-18, 19)
    for values in (least, most):
        logs = np.where(hidden, np.log(np.where(hidden, values, 1.0)), 0.0)
        three = np.convolve(logs, np.ones(3), "same") / np.maximum(np.convolve(hidden, np.ones(3), "same"), 1.0)
        weights = np.exp(-0.5 * (distances / 6.0) ** 2)
        total = np.convolve(hidden, weights, "same")
        spread = np.convolve(np.where(hidden, three, 0.0), weights, "same") / np.maximum(total, 1e-30)
        out.append(np.where(hidden, np.exp(three), np.where(total > 1e-12, np.exp(spread), 0.0)))
    return out[0], np.maximum(out[0], out[1])


def gathered(f, y, slopes, exponent, reach):
    """An image by a filter whose weight depends on both pixels' slopes: exp(exponent(d, y, s_min, s_max)); pairs have the least s_min
    and the greatest s_max of both. Where there are none, a pixel keeps its own mean."""
    s_min, s_max = slopes
    middle = slice(MARGIN, -MARGIN)
    seen, taken = np.zeros(PIXELS), np.zeros(PIXELS)
    for d in range(-reach, reach + 1):
        other = slice(MARGIN + d, MARGIN + d + PIXELS)
        low, high = np.minimum(s_min[middle], s_min[other]), np.maximum(s_max[middle], s_max[other])
        usable = low > 0.0
        w = np.exp(exponent(float(d), y[other], np.where(usable, low, 1.0)[:, None], np.where(usable, high, 1.0)[:, None]))
        w = np.broadcast_to(w * usable[:, None], y[other].shape)
        seen += (w * f[other]).sum(axis=1)
        taken += w.sum(axis=1)
    return np.where(taken > 0.0, seen / np.where(taken > 0.0, taken, 1.0), f[middle].mean(axis=1))


def gaussian_pair(c):
    """Exponents of weights, of d, y, s_min, s_max."""
    return lambda d, y, s_min, s_max: -0.5 * (d / (c * s_min)) ** 2


def two_slope_pair(c):
    def exponent(d, y, s_min, s_max):
        e = c * np.minimum(1.0, 0.8 * s_min * s_max / np.maximum((s_max - s_min) ** 2, 1e-9))
        var_y, cov, var_d = 1.0 + e, -0.5 * e * (s_min + s_max), e * s_min * s_max
        det = var_y * var_d - cov**2
        # As filters.two_slope's, over the light's profile.
        return (0.5 - 0.5 * var_d / det) * y**2 + cov * d / det * y - 0.5 * var_y * d**2 / det
    return exponent


def widest_two_slope(slopes, c):
    s_min, s_max = slopes
    bound = np.minimum(1.0, 0.8 * s_min * s_max / np.maximum((s_max - s_min) ** 2, 1e-9))
    return float(np.sqrt(np.max(c * bound * s_min * s_max)))


def measured_set(seed, spp):
    """As measure_set, of filters that go by measured slopes."""
    errors = {}
    random_scenes = np.random.default_rng(seed)
    random = np.random.default_rng([seed, spp])
    x = np.arange(-MARGIN, PIXELS + MARGIN, dtype=float)
    for _ in range(SCENES_MEASURED):
        scene = random_scene(random_scenes)
        truth = exact(scene, x[MARGIN:-MARGIN])
        images = {}
        for _ in range(REALISATIONS_MEASURED):
            y = place((np.arange(spp) + random.uniform(size=(len(x), spp))) / spp)
            f = visible(scene, x[:, None], y)
            # The first pass's nine are strata of their own among them.
            first = place((np.arange(FIRST) + random.uniform(size=(len(x), FIRST))) / FIRST) if spp > FIRST else y
            slopes = measured_slopes(scene, x, first)
            widest = float(slopes[0].max())

            def image(exponent, reach):
                return gathered(f, y, slopes, exponent, min(int(np.ceil(reach)), MARGIN))

            def one_mean(c):
                return gathered(f.mean(axis=1)[:, None], np.zeros((len(x), 1)), slopes, gaussian_pair(c),
                                min(int(np.ceil(3.0 * c * widest)), MARGIN))

            for k, c in enumerate(CONSTANTS["aaf"]):
                images.setdefault(("aaf", k), []).append(one_mean(c))
            for k, c in enumerate(CONSTANTS["extrapolated"]):
                images.setdefault(("extrapolated", k), []).append(2.0 * one_mean(c) - one_mean(np.sqrt(2.0) * c))
            for k, c in enumerate(CONSTANTS["two_slope"]):
                images.setdefault(("two_slope", k), []).append(image(two_slope_pair(c), 3.0 * widest_two_slope(slopes, c)))
        for key, values in images.items():
            errors.setdefault(key, []).append(split(np.array(values), truth))
    return {key: np.array(value) for key, value in errors.items()}


def compare_measured(spp):
    chosen_on, reported_on = (measured_set(SEEDS[which], spp) for which in ("chosen_on", "reported_on"))
    out = {}
    for name in ("aaf", "extrapolated", "two_slope"):
        entries = [(c, None) for c in CONSTANTS[name]]
        out[name] = best_of(entries, [chosen_on[name, k] for k in range(len(entries))],
                            [reported_on[name, k] for k in range(len(entries))])
    return out


def main(arguments):
    if len(arguments) != 1 or arguments[0].startswith("-"):
        print(__doc__.strip(), file=sys.stderr)
        return 2
    lists = candidates(tables())
    results = {"benchmark": "maaf_flatland", "scenes": SCENES, "realisations": REALISATIONS, "scenes_measured": SCENES_MEASURED,
               "realisations_measured": REALISATIONS_MEASURED, "seeds": SEEDS,
               "cut": filters.CUT, "line": {}, "measured": {}}
    for spp in SPP:
        results["line"][str(spp)] = compare(spp, lists)
        results["measured"][str(spp)] = compare_measured(spp)
    for part, heading in (("line", "Slopes known"), ("measured", "Slopes of nine samples")):
        add_saved(results[part])
        print(heading)
        for spp, rows in results[part].items():
            print(TITLE.format(spp))
            for name, row in rows.items():
                print(line_of(name, row))
    results_file.write("maaf_flatland", arguments[0], results)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
