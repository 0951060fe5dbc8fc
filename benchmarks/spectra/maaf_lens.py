#!/usr/bin/python3
"""Which filter of sparse samples errs least where a lens and an area light blur together, in flatland.

usage: maaf_lens.py RESULTS.json

What maaf_flatland.py asks, of f(x, y, u): x in pixels, y on the light in its standard deviations, u on the lens in its radii. An
occluder hides from a to b of x + r u + s y, r in pixels a radius and s in pixels a sigma. Equation numbers are those of
maaf_filters.py's paper, of whose (22) to (24) these are the components. The lens is uniform, or a Gaussian cut at 2 deviations.

All filters know the lens in standard deviations of its own, v = u * cut, and so rho = r / cut: those of the light and of the lens
then are alike. With q = (rho, s) a filter is a weight w(d, v, y), and of a wave of frequency Omega along x + rho v + s y it makes

    W = int w exp(i Omega (d + rho v + s y)),   which is to be the profiles' own transforms, of the lens at rho Omega and of
                                                the light at s Omega, at all q from (rho_min, s_min) to (rho_max, s_max).

- AAF: both profiles times G(d; c b), b^2 = s_min^2 + rho_min^2: the narrowest blur that is there.
- Gradients: a neighbour's value less half of what its own gradient makes of the way. h' is the mean of f (alpha q_y + beta q_v),
  q the scores, wherever alpha s + beta rho = 1; the noise is least at (beta, alpha) = q / |q|^2. The light's score alone has
  alpha = 1/s, beta = 0.
- Joint Gaussian: with a unit vector n of the (v, y) plane, z = n . (v, y), and covariances of d and z

      var z = 1 + e,   cov = -e (b0 + b1) / 2,   var d = e b0 b1,      b0 = n . q_min, b1 = n . q_max,

  what lies across n as it is, the variance of d + rho v + s y is

      |q|^2 + (n . q)^2 e - (n . q) e (b0 + b1) + e b0 b1 = |q|^2 + e (n . q - b0) (n . q - b1),

  so that edges of all q on two lines across n are as they should be, with the light alone (n = (0, 1)) those of s_min and s_max
  whatever their lens. Along n = q_min / |q_min| b0 is AAF's b. The weight is both profiles times the joint Gaussian over those
  of n's plane without it, so that a uniform lens stays uniform. With rho = 0 this is maaf_filters.two_slope.
- MAAF: a bank of (22), its weights those of (10), or by least squares to the true response to edges, for each scene.

Random scenes: a lens blurs less than half of what the light does in a third of them, more than twice in another. Samples are
stratified in squares over both, errors are those of maaf_flatland.py. Needs python3-numpy.
"""

import collections
import sys

try:
    import numpy as np
except ImportError:
    sys.exit("maaf_lens: error: numpy: not installed: apt install python3-numpy")

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
NODES = 20           # of the polynomial along n by which the joint Gaussian is applied
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
NOISES = (0.001, 0.01, 0.03)  # of the fit of weights
FIT_SLOPES, FIT_RADII, FIT_WAVES = 7, 4, 64

# rho_min / s_min of the uniform lens.
BINS = {"lens below half of the light": lambda ratio: ratio < 0.5,
        "half to twice": lambda ratio: (ratio >= 0.5) & (ratio < 2.0),
        "lens above twice the light": lambda ratio: ratio >= 2.0}


# Lenses

class Lens:
    """A profile over the lens, in its standard deviations v up to `cut`, where it ends; `slope` is how steep its score is."""

    def __init__(self, cut, slope):
        self.cut = cut
        self.slope = slope
        at = np.linspace(-cut, cut, 4097 if slope > 0.0 else 2)
        below = np.concatenate([[0.0], np.cumsum(self.profile(0.5 * (at[1:] + at[:-1])))])
        self.table = (below / below[-1], at)
        self.node, weights = np.polynomial.legendre.leggauss(40)
        self.node = cut * self.node
        weights = weights * self.profile(self.node)
        self.share = weights / weights.sum()
        self.steps = (1.0 - slope * self.share @ self.node**2) / (self.share @ self.node**8)

    def profile(self, v):
        return np.exp(-0.5 * self.slope * v**2)

    def place(self, share):
        """The v below which that share of the lens is."""
        return np.interp(share, *self.table)

    def score(self, v):
        """As maaf_filters.score: what is steep stands for the steps at the ends. Of a uniform lens it is v^7 alone."""
        return self.slope * v + self.steps * v**7


LIGHT = Lens(filters.CUT, 1.0)
LENSES = {"uniform": Lens(np.sqrt(3.0), 0.0), "gaussian": LIGHT}

Wedge = collections.namedtuple("Wedge", "rho_min rho_max s_min s_max")


def blur(wedge):
    return float(np.hypot(wedge.rho_min, wedge.s_min))


def wedge_of(scene, lens):
    return Wedge(scene["r_min"] / lens.cut, scene["r_max"] / lens.cut, scene["s_min"], scene["s_max"])


# Scenes

def random_scene(random, label):
    """s_min sigma is 2 to 16 pixels wide, s_max / s_min 1 to 8, r_min 1 to 16 pixels, r_max / r_min 1 to 4, as that bin has them.
    The first occluder has the least of both, the second the greatest, others lie between."""
    while True:
        s_min, r_min = 2.0 ** random.uniform(1.0, 4.0), 2.0 ** random.uniform(0.0, 4.0)
        if BINS[label](r_min / LENSES["uniform"].cut / s_min):
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


# Filtering

class Kernel:
    """A filter that is a sum of products: rows(d), functions x d, times values(v, y), functions x samples, which are over both
    profiles. `key` names the values, so that samples keep their means."""

    def __init__(self, key, values, rows, reach):
        self.key = key
        self.values = values
        self.rows = rows
        self.reach = reach

    def weight(self, d, v, y):
        """Of one v and y, over both profiles."""
        return self.values(np.array([v]), np.array([y]))[:, 0] @ self.rows(d)


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


# Filters

def one(v, y):
    return np.ones((1,) + np.broadcast(v, y).shape)


def aaf(beta):
    return Kernel("one", one, lambda d: filters.gaussian(d, beta)[None], 3.0 * beta)


def aaf_published(wedge, lens, c):
    """Chapter 5's: the larger one of the light's blur, s a sigma, and the lens', r a radius."""
    return aaf(c * max(wedge.s_min, wedge.rho_min * lens.cut))


def extrapolated(beta):
    wider = np.sqrt(2.0) * beta
    return Kernel("one", one, lambda d: (2.0 * filters.gaussian(d, beta) - filters.gaussian(d, wider))[None], 3.0 * wider)


def gradients(beta, of_lens, of_light, lens):
    """AAF's filter of values less half of the gradient that is the mean of f (of_lens q_v + of_light q_y)."""
    def values(v, y):
        return np.array([np.ones(np.broadcast(v, y).shape), of_lens * lens.score(v) + of_light * LIGHT.score(y)])

    return Kernel(("scores", of_lens, of_light), values,
                  lambda d: filters.gaussian(d, beta) * np.array([np.ones(len(d)), -0.5 * d]), 3.0 * beta)


def both_scores(wedge, lens, c):
    b = blur(wedge)
    return gradients(c * b, wedge.rho_min / b**2, wedge.s_min / b**2, lens)


def light_score(wedge, lens, c):
    return gradients(c * blur(wedge), 0.0, 1.0 / wedge.s_min, lens)


def light_score_share(wedge, lens, c):
    """What of both scores' gradient the light's has."""
    b = blur(wedge)
    return gradients(c * b, 0.0, wedge.s_min / b**2, lens)


def joint(wedge, lens, n, c):
    """The joint Gaussian along the unit vector n = (n_v, n_y)."""
    b0 = n[0] * wedge.rho_min + n[1] * wedge.s_min
    b1 = n[0] * wedge.rho_max + n[1] * wedge.s_max
    spread = (b1 - b0) ** 2
    e = c * min(1.0, 0.8 * b0 * b1 / spread) if spread > 0.0 else c
    var_z, cov, var_d = 1.0 + e, -0.5 * e * (b0 + b1), e * b0 * b1
    det = var_z * var_d - cov**2
    end = n[0] * lens.cut + n[1] * LIGHT.cut

    def values(v, y):
        t = (n[0] * v + n[1] * y) / end
        out = np.empty((NODES,) + t.shape)
        out[0], out[1] = 1.0, t
        for k in range(2, NODES):
            out[k] = 2.0 * t * out[k - 1] - out[k - 2]
        return out

    def rows(d):
        angles = np.pi * (np.arange(NODES) + 0.5) / NODES
        z = end * np.cos(angles)[:, None]
        ratio = np.exp(0.5 * z**2 - 0.5 * (var_d * z**2 - 2.0 * cov * d * z + var_z * d**2) / det)
        out = 2.0 / NODES * np.cos(np.arange(NODES)[:, None] * angles) @ ratio
        out[0] *= 0.5
        return out

    return Kernel(("along", *n), values, rows, 3.0 * np.sqrt(var_d))


def joint_both(wedge, lens, c):
    b = blur(wedge)
    return joint(wedge, lens, (wedge.rho_min / b, wedge.s_min / b), c)


def joint_light(wedge, lens, c):
    return joint(wedge, lens, (0.0, 1.0), c)


# Components

class Components(filters.Components):
    """The bank of (22), (24) derived anew: Omega_y is divided first, Omega_x = Omega_y / s and Omega_v = rho Omega_x follow.
    `smaller`: of both bands over x, omega / s_min and omega / rho_min, the smaller one, and a smaller one of Omega_y with it.
    `lens_first`: the same with Omega_v divided in the place of Omega_y, which the paper has not."""

    def __init__(self, pairs, wedge, omega=2.0, smaller=True, lens_first=False):
        if lens_first:
            wedge = Wedge(wedge.s_min, wedge.s_max, wedge.rho_min, wedge.rho_max)
        self.band = omega * min(1.0, wedge.s_min / max(wedge.rho_min, 1e-9)) if smaller else omega
        super().__init__(pairs, wedge.s_min, wedge.s_max, self.band)
        p = np.arange(pairs)
        count = 2.0 * pairs - 1.0
        inner = wedge.rho_min / wedge.s_max * (2.0 * p - 1.0) / count
        outer = wedge.rho_max / wedge.s_min * (2.0 * p + 1.0) / count
        self.centre_v = 0.5 * self.band * np.where(p > 0, inner + outer, 0.0)
        self.extent_v = 0.5 * self.band * np.where(p > 0, outer - inner, 2.0 * wedge.rho_max / wedge.s_min / count)
        if lens_first:
            self.centre_y, self.centre_v = self.centre_v, self.centre_y
            self.extent_y, self.extent_v = self.extent_v, self.extent_y

    def of_light(self, p, y):
        return filters.gaussian(y, 1.0 / self.extent_y[p])

    def of_lens(self, p, v, lens):
        """G(v; 1 / extent), over its integral over the lens: beyond it there are no samples, and a lens of no radius is none."""
        return np.exp(-0.5 * (self.extent_v[p] * v) ** 2) / (self.share_of_lens(p, lens) / lens.profile(0.0))

    def share_of_lens(self, p, lens):
        over = np.exp(-0.5 * (self.extent_v[p] * lens.node) ** 2) / lens.profile(lens.node)
        return lens.share @ over


def maaf(bank, weights, lens, as_printed=False):
    """Weights are 2 pairs - 1: of component 0, of the cosines and of the sines of 1, ... `as_printed`: G(v) normalised over all
    v, not over the lens."""
    weights = np.array(weights, dtype=float)
    if as_printed:
        factors = np.array([bank.extent_v[p] * bank.share_of_lens(p, lens) for p in range(bank.pairs)])
        weights = weights * filters.both(factors / max(factors[0], 1e-30))

    def values(v, y):
        out = []
        for p in range(bank.pairs):
            of_both = bank.of_light(p, y) / filters.profile(y) * bank.of_lens(p, v, lens) / lens.profile(v)
            phase = bank.centre_y[p] * y + bank.centre_v[p] * v
            out += [of_both] if p == 0 else [np.cos(phase) * of_both, np.sin(phase) * of_both]
        return np.array(out)

    def rows(d):
        out = []
        for p in range(bank.pairs):
            of_d = filters.gaussian(d, 1.0 / bank.extent_x[p])
            phase = bank.centre_x[p] * d
            out += [of_d] if p == 0 else [2.0 * np.cos(phase) * of_d, -2.0 * np.sin(phase) * of_d]
        return weights[:, None] * np.array(out)

    return Kernel(("maaf", bank.pairs, *bank.centre_x, *bank.centre_y, *bank.centre_v), values, rows, 3.0 / bank.extent_x.min())


def maaf_printed(wedge, lens, pairs, omega, smaller=True, as_printed=False):
    """(10) has no factor of the lens; Omega_max in it is that of the bank."""
    bank = Components(pairs, wedge, omega, smaller)
    return maaf(bank, filters.both(bank.weights_printed(wedge.s_min, bank.band)), lens, as_printed)


def fit(bank, wedge, lens, noises=NOISES):
    """Weights by least squares, a list of one array for each of `noises`. As fit_maaf.fit: they minimise the mean over q of

        int (filtered edge - edge)^2 dt / b  +  noise * b * energy,

    the weights' sum over a field of ones held at 1. By Parseval's theorem, with W the terms' and T the profiles' own transform,
    the first is int (sum of weights (W - W(0) T))^2 / Omega^2 dOmega / pi / b: an edge's is that of a wave over i Omega."""
    b = blur(wedge)
    slopes, radii = (np.geomspace(max(low, 1e-9), max(high, 1e-9), count) for low, high, count in
                     ((wedge.s_min, wedge.s_max, FIT_SLOPES), (wedge.rho_min, wedge.rho_max, FIT_RADII)))
    end = max(float((bank.centre_x + 3.0 * bank.extent_x).max()), 6.0 / b)
    step = end / FIT_WAVES
    omega = np.concatenate([[0.0], (np.arange(FIT_WAVES) + 0.5) * step])

    def transform(node, share, ratio, frequency):
        return np.cos(frequency[..., None] * node) @ (share * ratio)

    true = (transform(LIGHT.node, LIGHT.share, 1.0, slopes[:, None] * omega)[:, None]
            * transform(lens.node, lens.share, 1.0, radii[:, None] * omega)[None])
    rows, over_d, over_both = [], [], []
    d = np.linspace(-1.0, 1.0, 1201) * 4.0 / bank.extent_x.min()
    y, v = LIGHT.node, lens.node
    for p in range(bank.pairs):
        ratio_y = bank.of_light(p, y) / filters.profile(y)
        ratio_v = bank.of_lens(p, v, lens) / lens.profile(v)
        # Where the phase turns with the wave and against it.
        with_it, against = (
            transform(y, LIGHT.share, ratio_y, bank.centre_y[p] - side * slopes[:, None] * omega)[:, None]
            * transform(v, lens.share, ratio_v, bank.centre_v[p] - side * radii[:, None] * omega)[None] for side in (1.0, -1.0))
        near, far = (np.exp(-0.5 * ((omega - side * bank.centre_x[p]) / bank.extent_x[p]) ** 2) for side in (1.0, -1.0))
        of_d = filters.gaussian(d, 1.0 / bank.extent_x[p])
        phase = bank.centre_y[p] * y[:, None] + bank.centre_v[p] * v
        of_both = ratio_y[:, None] * ratio_v
        if p == 0:
            rows.append(near * with_it)
            over_d.append(of_d)
            over_both.append(of_both)
            continue
        rows += [0.5 * (near + far) * (with_it + against), 0.5 * (near - far) * (with_it - against)]
        over_d += [2.0 * np.cos(bank.centre_x[p] * d) * of_d, -2.0 * np.sin(bank.centre_x[p] * d) * of_d]
        over_both += [np.cos(phase) * of_both, np.sin(phase) * of_both]
    rows, over_d, over_both = np.array(rows), np.array(over_d), np.array(over_both)
    ones = rows[:, 0, 0, 0]
    off = (rows - ones[:, None, None, None] * true)[..., 1:] / omega[1:]
    off = off.reshape(len(rows), -1)
    first = off @ off.T * (step / np.pi / (FIT_SLOPES * FIT_RADII * b))
    energy = (over_d @ over_d.T * (d[1] - d[0])) * np.einsum("jyv,kyv,y,v->jk", over_both, over_both, LIGHT.share, lens.share,
                                                           optimize=True)
    count = len(rows)
    out = []
    for noise in noises:
        system = np.zeros((count + 1, count + 1))
        system[:count, :count] = first + noise * b * energy
        system[:count, count] = system[count, :count] = ones
        out.append(np.linalg.lstsq(system, np.append(np.zeros(count), 1.0), rcond=1e-12)[0][:count])
    return out


# Filters by name

def candidates(wedge, lens, only_aaf=False):
    """Name: list of (constant, kernel)."""
    out = {"none": [(0.0, None)],
           "aaf published": [(PUBLISHED, aaf_published(wedge, lens, PUBLISHED))],
           "aaf max": [(c, aaf_published(wedge, lens, c)) for c in CONSTANTS["aaf max"]],
           "aaf": [(c, aaf(c * blur(wedge))) for c in CONSTANTS["aaf"]]}
    if only_aaf:
        return out
    out["extrapolated"] = [(c, extrapolated(c * blur(wedge))) for c in CONSTANTS["extrapolated"]]
    for name, make in (("gradients, both", both_scores), ("gradients, light", light_score),
                       ("gradients, light's share", light_score_share)):
        out[name] = [(c, make(wedge, lens, c)) for c in CONSTANTS["gradients"]]
    out["joint, both"] = [(c, joint_both(wedge, lens, c)) for c in CONSTANTS["joint"]]
    out["joint, light"] = [(c, joint_light(wedge, lens, c)) for c in CONSTANTS["joint"]]
    for pairs in PAIRS:
        name = f"maaf {2 * pairs - 1}"
        out[f"{name} printed, 2"] = [(2.0, maaf_printed(wedge, lens, pairs, 2.0))]
        out[f"{name} printed"] = [(o, maaf_printed(wedge, lens, pairs, o)) for o in CONSTANTS["maaf"]]
        if pairs == 3:
            out[f"{name} printed, 2, whole band"] = [(2.0, maaf_printed(wedge, lens, pairs, 2.0, smaller=False))]
            out[f"{name} printed, 2, lens not cut"] = [(2.0, maaf_printed(wedge, lens, pairs, 2.0, as_printed=True))]
        # As printed, and with what blurs more divided first.
        for kind, lens_first in (("refitted", False), ("wider first", wedge.rho_min > wedge.s_min)):
            if kind == "wider first" and pairs != 3:
                continue
            for noise in NOISES:
                out[f"{name} {kind}, noise {noise:g}"] = []
            for o in CONSTANTS["maaf"]:
                bank = Components(pairs, wedge, o, lens_first=lens_first)
                for noise, weights in zip(NOISES, fit(bank, wedge, lens)):
                    out[f"{name} {kind}, noise {noise:g}"].append((o, maaf(bank, weights, lens)))
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
               "lenses": {name: compare(lens) for name, lens in LENSES.items()}}
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
