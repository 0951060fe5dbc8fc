#!/usr/bin/python3
"""Which filter of sparse samples errs least where a lens and an area light blur together, in flatland.

usage: maaf_lens.py RESULTS.json

What maaf_flatland.py asks, of f(x, y, u): x in pixels, y on the light in its standard deviations, u on the lens in its radii. An
occluder hides from a to b of x + r u + s y, r in pixels a radius and s in pixels a sigma. Equation numbers are those of
maaf_filters.py's paper, of whose (22) to (24) these are the components. The lens is uniform, or a Gaussian cut at 2 deviations.

The filters are those of lens_filters.py. Random scenes: a lens blurs less than half of what the light does in a third of them,
more than twice in another. Samples are stratified in squares over both, errors are those of maaf_flatland.py. Needs
python3-numpy.
"""

import sys

try:
    import numpy as np
except ImportError:
    sys.exit("maaf_lens: error: numpy: not installed: apt install python3-numpy")

import lens_filters
import maaf_filters as filters
import maaf_flatland as flatland
import results_file

PIXELS, MARGIN = flatland.PIXELS, flatland.MARGIN
OCCLUDERS = 8
SCENES = 120         # of each set, a third in each bin
REALISATIONS = 4
SPP = (4, 16, 64)    # 4: two strata along each dimension, as many as 16 have over a light and a lens of two axes each
SPP_OF_AAF = (256,)  # of AAF alone, for what its samples are worth
SEEDS = {"chosen_on": 61, "reported_on": 62}
TRUTH = 64           # points of the lens
CONSTANTS = {
    "aaf": [0.1, 0.125, 0.15, 0.177, 0.2, 0.25, 0.3, 0.35, 0.4, 0.5, 0.6, 0.7, 0.8],
    "aaf max": [0.1, 0.125, 0.15, 0.177, 0.2, 0.25, 0.3, 0.35, 0.4, 0.5, 0.6, 0.7, 0.8],
    "extrapolated": [0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5, 0.55, 0.6, 0.65, 0.7, 0.8, 0.9, 1.0, 1.15],
    "gradients": [0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.5, 0.6, 0.7, 0.85, 1.0],
    "joint": [0.0125, 0.025, 0.05, 0.1, 0.15, 0.2, 0.25, 0.35, 0.5, 0.7, 1.0, 1.4],
    "maaf": [0.7, 1.0, 1.25, 1.5, 2.0, 3.0, 4.0],  # Omega_max sigma; the paper's is 2
}
PUBLISHED = 0.177    # of chapter 5: exp(-16 d^2 Omega^2), Omega = 1 over the larger blur
PAIRS = (2, 3, 4)

# rho_min / s_min of the uniform lens.
BINS = {"lens below half of the light": lambda ratio: ratio < 0.5,
        "half to twice": lambda ratio: (ratio >= 0.5) & (ratio < 2.0),
        "lens above twice the light": lambda ratio: ratio >= 2.0}


def wedge_of(scene, lens):
    return lens_filters.Wedge(scene["r_min"] / lens.cut, scene["r_max"] / lens.cut, scene["s_min"], scene["s_max"])


# Scenes

def random_scene(random, label):
    """s_min sigma is 2 to 16 pixels wide, s_max / s_min 1 to 8, r_min 1 to 16 pixels, r_max / r_min 1 to 4, as that bin has them.
    The first occluder has the least of both, the second the greatest, others lie between."""
    while True:
        s_min, r_min = 2.0 ** random.uniform(1.0, 4.0), 2.0 ** random.uniform(0.0, 4.0)
        if BINS[label](r_min / lens_filters.LENSES["uniform"].cut / s_min):
            break
    ratio, of_r = 2.0 ** random.uniform(0.0, 3.0), 2.0 ** random.uniform(0.0, 2.0)
    slopes = s_min * ratio ** np.concatenate([[0.0, 1.0], random.uniform(0.0, 1.0, OCCLUDERS - 2)])
    radii = r_min * of_r ** np.concatenate([[0.0, 1.0], random.uniform(0.0, 1.0, OCCLUDERS - 2)])
    wide = 2.0 ** random.uniform(2.0, 7.0, OCCLUDERS)
    middle = random.uniform(-MARGIN, PIXELS + MARGIN, OCCLUDERS)
    middle[:2] = random.uniform(0.0, PIXELS, 2)
    return {"s_min": s_min, "s_max": s_min * ratio, "r_min": r_min, "r_max": r_min * of_r, "slopes": slopes, "radii": radii,
            "a": middle - 0.5 * wide, "b": middle + 0.5 * wide}


def visible(scene, lens, x, v, y):
    out = np.ones(np.broadcast(x, v, y).shape, dtype=bool)
    for r, s, a, b in zip(scene["radii"], scene["slopes"], scene["a"], scene["b"]):
        at = x + r / lens.cut * v + s * y
        out &= (at <= a) | (at >= b)
    return out


def exact(scene, lens, x):
    """The mean over points of the lens of what each sees of the light, in closed form."""
    out = np.zeros(len(x))
    for v in lens.place((np.arange(TRUTH) + 0.5) / TRUTH):
        shift = scene["radii"] / lens.cut * v
        out += flatland.exact({"slopes": scene["slopes"], "a": scene["a"] - shift, "b": scene["b"] - shift}, x)
    return out / TRUTH


class Samples:
    """Stratified over lens and light together, in squares of strata."""

    def __init__(self, scene, lens, spp, realisations, random):
        x = np.arange(-MARGIN, PIXELS + MARGIN, dtype=float)
        side = int(round(spp**0.5))
        shape, flat = (realisations, len(x), side, side), (realisations, len(x), spp)
        strata = np.arange(side)
        self.v = lens.place((strata[:, None] + random.uniform(size=shape)) / side).reshape(flat)
        self.y = flatland.place((strata + random.uniform(size=shape)) / side).reshape(flat)
        self.f = visible(scene, lens, x[:, None], self.v, self.y).astype(float)
        self.count = len(x)
        self.mean = self.f.mean(axis=2)
        self.kept = {}

    def means(self, kernel):
        """Of what the kernel multiplies, over all samples and over the visible ones: functions x realisations x frequencies."""
        if kernel.key not in self.kept:
            values = kernel.values(self.v, self.y)
            taken, seen = values.mean(axis=3), (values * self.f).mean(axis=3)
            self.kept[kernel.key] = np.fft.rfft(taken), np.fft.rfft(seen)
        return self.kept[kernel.key]

    def filtered(self, kernel):
        """Images, realisations x PIXELS. Filters wrap around within the margins."""
        reach = min(int(np.ceil(kernel.reach)), MARGIN)
        d = np.arange(-reach, reach + 1)
        rows = kernel.rows(d.astype(float))
        over = np.zeros((len(rows), self.count))
        over[:, -d] = rows
        over = np.fft.rfft(over)
        taken, seen = (np.fft.irfft((over[:, None] * means).sum(axis=0), self.count) for means in self.means(kernel))
        return (seen / taken)[:, MARGIN:-MARGIN]


# Filters by name

def candidates(wedge, lens, only_aaf=False):
    """Name: list of (constant, kernel)."""
    out = {"none": [(0.0, None)],
           "aaf published": [(PUBLISHED, lens_filters.aaf_published(wedge, lens, PUBLISHED))],
           "aaf max": [(c, lens_filters.aaf_published(wedge, lens, c)) for c in CONSTANTS["aaf max"]],
           "aaf": [(c, lens_filters.aaf(c * lens_filters.blur(wedge))) for c in CONSTANTS["aaf"]]}
    if only_aaf:
        return out
    out["extrapolated"] = [(c, lens_filters.extrapolated(c * lens_filters.blur(wedge))) for c in CONSTANTS["extrapolated"]]
    for name, make in (("gradients, both", lens_filters.both_scores), ("gradients, light", lens_filters.light_score),
                       ("gradients, light's share", lens_filters.light_score_share)):
        out[name] = [(c, make(wedge, lens, c)) for c in CONSTANTS["gradients"]]
    out["joint, both"] = [(c, lens_filters.joint_both(wedge, lens, c)) for c in CONSTANTS["joint"]]
    out["joint, light"] = [(c, lens_filters.joint_light(wedge, lens, c)) for c in CONSTANTS["joint"]]
    for pairs in PAIRS:
        name = f"maaf {2 * pairs - 1}"
        out[f"{name} printed, 2"] = [(2.0, lens_filters.maaf_printed(wedge, lens, pairs, 2.0))]
        out[f"{name} printed"] = [(o, lens_filters.maaf_printed(wedge, lens, pairs, o)) for o in CONSTANTS["maaf"]]
        if pairs == 3:
            out[f"{name} printed, 2, whole band"] = [(2.0, lens_filters.maaf_printed(wedge, lens, pairs, 2.0, smaller=False))]
            out[f"{name} printed, 2, lens not cut"] = [(2.0, lens_filters.maaf_printed(wedge, lens, pairs, 2.0, as_printed=True))]
        # As printed, and with what blurs more divided first.
        for kind, lens_first in (("refitted", False), ("wider first", wedge.rho_min > wedge.s_min)):
            if kind == "wider first" and pairs != 3:
                continue
            for noise in lens_filters.NOISES:
                out[f"{name} {kind}, noise {noise:g}"] = []
            for o in CONSTANTS["maaf"]:
                bank = lens_filters.Components(pairs, wedge, o, lens_first=lens_first)
                for noise, weights in zip(lens_filters.NOISES, lens_filters.fit(bank, wedge, lens)):
                    out[f"{name} {kind}, noise {noise:g}"].append((o, lens_filters.maaf(bank, weights, lens)))
    return out


# Errors

def measure_set(seed, lens):
    """By count and (name, index of constant) arrays of scenes x (total, bias, noise); the scenes' bins; constants by name."""
    errors = {spp: {} for spp in SPP + SPP_OF_AAF}
    labels, constants = [], {}
    random_scenes = np.random.default_rng(seed)
    random = {spp: np.random.default_rng([seed, spp]) for spp in errors}
    for number in range(SCENES):
        labels.append(list(BINS)[number % len(BINS)])
        scene = random_scene(random_scenes, labels[-1])
        truth = exact(scene, lens, np.arange(PIXELS, dtype=float))
        lists = candidates(wedge_of(scene, lens), lens)
        constants = {name: [c for c, _ in entries] for name, entries in lists.items()}
        for spp in errors:
            samples = Samples(scene, lens, spp, REALISATIONS, random[spp])
            for name, entries in lists.items():
                if spp in SPP_OF_AAF and not (name == "none" or name.startswith("aaf")):
                    continue
                for k, (_, kernel) in enumerate(entries):
                    images = samples.mean[:, MARGIN:-MARGIN] if kernel is None else samples.filtered(kernel)
                    errors[spp].setdefault((name, k), []).append(flatland.split(images, truth))
    return {spp: {key: np.array(value) for key, value in of.items()} for spp, of in errors.items()}, np.array(labels), constants


def compare(lens):
    """Rows by count and name. `by` has the bins, `noise_share` what part of a mean square error is noise."""
    chosen_on, _, _ = measure_set(SEEDS["chosen_on"], lens)
    reported_on, labels, constants = measure_set(SEEDS["reported_on"], lens)
    out = {}
    for spp, errors in reported_on.items():
        out[str(spp)] = {}
        for name, values in constants.items():
            if (name, 0) not in errors:
                continue
            entries = [(c, None) for c in values]
            row = flatland.best_of(entries, [chosen_on[spp][name, k] for k in range(len(entries))],
                                   [errors[name, k] for k in range(len(entries))])
            best = errors[name, values.index(row["constant"])]
            row["sweep"] = {f"{part['constant']:.4g}": part["rms"] for part in row["sweep"]}
            row["by"] = {label: flatland.summary(best[labels == label]) for label in BINS}
            for part, of in ((row, best), *((row["by"][label], best[labels == label]) for label in BINS)):
                part["noise_share"] = float(f"{of[:, 2].mean() / of[:, 0].mean():.3g}")
            out[str(spp)][name] = row
    flatland.add_saved(out, "aaf published")
    for label in BINS:
        flatland.add_saved({spp: {name: row["by"][label] for name, row in rows.items()} for spp, rows in out.items()},
                           "aaf published")
    return out


def main(arguments):
    if len(arguments) != 1 or arguments[0].startswith("-"):
        print(__doc__.strip(), file=sys.stderr)
        return 2
    results = {"benchmark": "maaf_lens", "scenes": SCENES, "realisations": REALISATIONS, "seeds": SEEDS, "cut": filters.CUT,
               "lenses": {name: compare(lens) for name, lens in lens_filters.LENSES.items()}}
    for lens, by_count in results["lenses"].items():
        print(f"Lens: {lens}")
        for spp, rows in by_count.items():
            print(flatland.TITLE.format(spp) + "; RMS error in bins: " + ", ".join(BINS))
            for name, row in rows.items():
                print(flatland.line_of(name, row), *(f" {row['by'][label]['rms']:.4f}" for label in BINS))
    results_file.write("maaf_lens", arguments[0], results)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
