"""Filters of a double wedge in flatland: axis-aligned (AAF), its extrapolation, sheared, and multiple axis-aligned (MAAF).

Equation numbers are those of L. Wu, L.-Q. Yan, A. Kuznetsov, R. Ramamoorthi, "Multiple Axis-Aligned Filters for Rendering
of Combined Distribution Effects" (2017); docs/maaf.md says where formulas are others than those printed.

The light has a Gaussian profile of standard deviation 1, cut at CUT. Visibility is f(x, y), y on the light in the direction
of x, and an occluder of slope s makes it a function of x + s y. A filter is a weight w(d, y) of the sample at y of the
pixel at d from the filtered one. It stands in the place of the light's profile, and its scale does not matter, since
filters divide by the sum of weights.
"""

import numpy as np

CUT = 2.0
APART = 0.6  # as WEDGE_APART of kernels/analysis/two_slopes.cl


def profile(y):
    """The light's, to a factor."""
    return np.exp(-0.5 * y**2)


def gaussian(u, deviation):
    return np.exp(-0.5 * (u / deviation) ** 2) / (np.sqrt(2.0 * np.pi) * deviation)


class Components:
    """The bank of (6) to (8): 2 pairs - 1 components for slopes s_min to s_max and a light of bandwidth omega. Arrays are over
    p = 0 .. pairs - 1; the component -p is the mirror image of p."""

    def __init__(self, pairs, s_min, s_max, omega=2.0):
        p = np.arange(pairs)
        count = 2.0 * pairs - 1.0
        inner = (2.0 * p - 1.0) / (count * s_max)
        outer = (2.0 * p + 1.0) / (count * s_min)
        self.pairs = pairs
        self.centre_x = 0.5 * omega * np.where(p > 0, inner + outer, 0.0)
        self.centre_y = omega * 2.0 * p / count
        # (8) would count what is between the wedges twice at p = 0: there it is the plain axis-aligned extent.
        self.extent_x = 0.5 * omega * np.where(p > 0, outer - inner, 2.0 / (count * s_min))
        self.extent_y = np.full(pairs, omega / count)

    def weights_printed(self, s_min, omega=2.0):
        """(10)"""
        return np.exp(-0.5 * (self.centre_x * s_min / omega) ** 2 - 0.5 * (self.centre_y / omega) ** 2)

    def weights_of_light(self):
        """Those with which the components' sum over Omega_y has the light's own deviation, 1. None for one component."""
        return np.exp(-0.5 * self.centre_y**2 / (1.0 - self.extent_y**2))

    def basis(self):
        """What weights multiply, in the primal domain: (13), the two products of each pair apart. A list of
        (function of d, function of y, deviation over d): component 0, then cosines and sines of 1, of 2, ..."""
        terms = []
        for p in range(self.pairs):
            c_x, c_y = self.centre_x[p], self.centre_y[p]
            d_x, d_y = 1.0 / self.extent_x[p], 1.0 / self.extent_y[p]
            if p == 0:
                terms.append((lambda d, a=d_x: gaussian(d, a), lambda y, b=d_y: gaussian(y, b), d_x))
                continue
            terms.append((lambda d, a=d_x, c=c_x: 2.0 * np.cos(c * d) * gaussian(d, a),
                          lambda y, b=d_y, c=c_y: np.cos(c * y) * gaussian(y, b), d_x))
            terms.append((lambda d, a=d_x, c=c_x: -2.0 * np.sin(c * d) * gaussian(d, a),
                          lambda y, b=d_y, c=c_y: np.sin(c * y) * gaussian(y, b), d_x))
        return terms


def both(weights):
    """One weight a component, as one each for its cosines and its sines."""
    return np.concatenate([weights[:1], np.repeat(weights[1:], 2)])


class Kernel:
    """A filter: weight(d, y) of arrays that broadcast, no more than `reach` away. `of_light`: the weight is the light's profile
    times a function of d alone."""

    def __init__(self, weight, reach, of_light=False):
        self.weight = weight
        self.reach = reach
        self.of_light = of_light


def aaf(s_min, c):
    """(3) with beta = c sigma s_min; the thesis's c is 1 / (k mu) = 1/6."""
    beta = c * s_min
    return Kernel(lambda d, y: gaussian(d, beta) * profile(y), 3.0 * beta, True)


def extrapolated(s_min, c):
    """Richardson's: 2 F_beta - F_(sqrt2 beta), whose response 2 exp(-a) - exp(-2 a) has no term in a = (beta Omega)^2 / 2."""
    beta = c * s_min
    wider = np.sqrt(2.0) * beta
    return Kernel(lambda d, y: (2.0 * gaussian(d, beta) - gaussian(d, wider)) * profile(y), 3.0 * wider, True)


def score(y):
    """-l'/l of the light's profile. The steps of the cut profile have what is left of the first moment, 1: what rises steeply
    stands for them, as in the renderer (kernels/shared/light.h, scoreOf())."""
    at = np.linspace(-CUT, CUT, 20001)
    weights = profile(at) / profile(at).sum()
    return y + (1.0 - (weights * at**2).sum()) / (weights * at**8).sum() * y**7


def gradients(s_min, c):
    """AAF's filter of what neighbours see less half of what their own gradients make of the way: the first order of a shear along
    s_min. The gradient is the mean of f q over s_min, q the score."""
    beta = c * s_min
    return Kernel(lambda d, y: gaussian(d, beta) * profile(y) * (1.0 - 0.5 * d * score(y) / s_min), 3.0 * beta)


def two_slope(s_min, s_max, c):
    """A joint Gaussian of d and y that leaves edges of slope s_min and of slope s_max as they are:
    var(d + s y) = s^2 + e (s - s_min)(s - s_max), with e small enough for that to stay near s^2 between them."""
    spread = (s_max - s_min) ** 2
    e = c * min(1.0, 0.8 * s_min * s_max / spread) if spread > 0.0 else c
    var_y, cov, var_d = 1.0 + e, -0.5 * e * (s_min + s_max), e * s_min * s_max
    det = var_y * var_d - cov**2
    return Kernel(lambda d, y: np.exp(-0.5 * (var_d * y**2 - 2.0 * cov * d * y + var_y * d**2) / det),
                  3.0 * np.sqrt(var_d))


def second_score(y):
    """l''/l of the light's profile, cut as it is: y^2 less its mean, with the second moment 2 (momentsOf() of the renderer)."""
    at = np.linspace(-CUT, CUT, 20001)
    weights = profile(at) / profile(at).sum()
    square, fourth = (weights * at**2).sum(), (weights * at**4).sum()
    return 2.0 / (fourth - square**2) * (y**2 - square)


def second_order(s_min, s_max, c):
    """The renderer's filter of two slopes: the second order of a shear along their harmonic mean, z = d/s, with the factors 5/8
    and 1/8. Of a wave that makes z = i beta Omega they leave 1 - (beta Omega / s)^6 / 48."""
    ratio = s_max / s_min
    mean = 2.0 * ratio / (1.0 + ratio)
    beta = c * s_min * (min(mean, APART * ratio / (ratio - 1.0)) if ratio > 1.0 else 1.0)
    s = s_min * mean
    return Kernel(lambda d, y: gaussian(d, beta) * profile(y)
                  * (1.0 - 0.625 * d / s * score(y) + 0.125 * (d / s) ** 2 * second_score(y)), 3.0 * beta)


def maaf(pairs, s_min, s_max, weights, omega=2.0):
    """Weights are 2 pairs - 1: of component 0, of the cosines and of the sines of 1, ..."""
    terms = Components(pairs, s_min, s_max, omega).basis()

    def weight(d, y):
        return sum(a * of_d(d) * of_y(y) for a, (of_d, of_y, _) in zip(weights, terms))

    return Kernel(weight, 3.0 * max(deviation for _, _, deviation in terms))
