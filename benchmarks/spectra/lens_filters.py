"""Filters of sparse samples for a lens and an area light together, in flatland: what maaf_lens.py compares.

Equation numbers are those of maaf_filters.py's paper. The lens is uniform, or a Gaussian cut at 2 deviations.

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
"""

import collections

import numpy as np

import maaf_filters as filters

NODES = 20           # of the polynomial along n by which the joint Gaussian is applied
NOISES = (0.001, 0.01, 0.03)  # of the fit of weights
FIT_SLOPES, FIT_RADII, FIT_WAVES = 7, 4, 64


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
