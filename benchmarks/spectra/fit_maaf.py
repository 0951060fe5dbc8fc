#!/usr/bin/python3
"""Fits the weights of MAAF's components to the true response to a shadow's edge, over s_max / s_min.

usage: fit_maaf.py TABLE.json

For each ratio the weights, one for component 0 and two for each pair (its cosines and its sines), minimise

    mean over slopes s of the integral over t of (filtered edge(t; s) - edge(t; s))^2    +  NOISE * energy of the filter

over slopes from s_min to s_max, t in units of sigma s_min, with the weights' sum over a field of ones held at 1. An edge
of slope s is H(t + s y); what it should be is its integral over the light. Needs python3-numpy.
"""

import functools
import sys

try:
    import numpy as np
except ImportError:
    sys.exit("fit_maaf: error: numpy: not installed: apt install python3-numpy")

import maaf_filters
import results_file

RATIOS = [2.0 ** (0.25 * k) for k in range(13)]
SLOPES = 17
PAIRS = (2, 3, 4)
BANDWIDTH = 2.0  # of the light, (6): Omega_max = 2 / sigma
NOISE = 0.001


def nodes():
    """Midpoints over the light, and the step between them."""
    count = 160
    step = 2.0 * maaf_filters.CUT / count
    return -maaf_filters.CUT + (np.arange(count) + 0.5) * step, step


def true_edge(t, s):
    """The integral over the light of H(t + s y)."""
    y, _ = nodes()
    light = maaf_filters.profile(y)
    below = np.concatenate([[0.0], np.cumsum(light)]) / light.sum()
    edges = np.linspace(-maaf_filters.CUT, maaf_filters.CUT, len(below))
    return 1.0 - np.interp(-t / s, edges, below)


@functools.lru_cache(maxsize=None)
def responses(pairs, ratio, bandwidth):
    """Of each term of the bank: its values at t for every slope (terms x slopes * t), what it makes of a field of ones, and
    the matrix of the filters' energy."""
    terms = maaf_filters.Components(pairs, 1.0, ratio, bandwidth).basis()
    y, step_y = nodes()
    reach = 3.0 * max(deviation for _, _, deviation in terms)
    d = np.linspace(-reach, reach, 4001)
    step_d = d[1] - d[0]
    light = maaf_filters.profile(y)
    light /= light.sum() * step_y
    slopes = np.geomspace(1.0, ratio, SLOPES)
    spans = [np.linspace(-1.0, 1.0, 241) * (reach + maaf_filters.CUT * s) for s in slopes]
    rows, ones = [], []
    over_d, over_y = [], []
    for of_d, of_y, _ in terms:
        values = of_d(d) * step_d
        over_d.append(values)
        over_y.append(of_y(y))
        below = np.concatenate([[0.0], np.cumsum(values)])
        ends = np.concatenate([d - 0.5 * step_d, [d[-1] + 0.5 * step_d]])
        row = []
        for s, t in zip(slopes, spans):
            # H(t + d + s y): all d above -(t + s y).
            above = below[-1] - np.interp(-(t[:, None] + s * y), ends, below)
            row.append(above @ of_y(y) * step_y * np.sqrt(t[1] - t[0]))
        rows.append(np.concatenate(row))
        ones.append(values.sum() * of_y(y).sum() * step_y)
    target = np.concatenate([true_edge(t, s) * np.sqrt(t[1] - t[0]) for s, t in zip(slopes, spans)])
    over_d, over_y = np.array(over_d), np.array(over_y)
    energy = (over_d @ over_d.T / step_d) * ((over_y / light) @ over_y.T * step_y)
    return np.array(rows), np.array(ones), target, energy


def fit(pairs, ratio, bandwidth=BANDWIDTH, noise=NOISE):
    """Weights, and the rest: the root of the mean over slopes of the integral of the squared difference."""
    rows, ones, target, energy = responses(pairs, ratio, bandwidth)
    count = len(ones)
    # Of least squares with one linear constraint, by its multiplier.
    system = np.zeros((count + 1, count + 1))
    system[:count, :count] = rows @ rows.T / SLOPES + noise * energy
    system[:count, count] = system[count, :count] = ones
    weights = np.linalg.lstsq(system, np.concatenate([rows @ target / SLOPES, [1.0]]), rcond=1e-12)[0][:count]
    rest = weights @ rows - target
    return weights, float(np.sqrt(rest @ rest / SLOPES)), float(weights @ energy @ weights)


def table(pairs, bandwidth=BANDWIDTH, noise=NOISE):
    return np.array([fit(pairs, ratio, bandwidth, noise)[0] for ratio in RATIOS])


def look_up(rows, ratio):
    """Weights at a ratio: linear in its logarithm, those of the ends beyond them."""
    at = np.clip(np.log2(max(ratio, 1.0)) * 4.0, 0.0, len(RATIOS) - 1.0)
    below = min(int(at), len(RATIOS) - 2)
    return rows[below] + (at - below) * (rows[below + 1] - rows[below])


def main(arguments):
    if len(arguments) != 1 or arguments[0].startswith("-"):
        print(__doc__.strip(), file=sys.stderr)
        return 2
    out = {"bandwidth": BANDWIDTH, "noise": NOISE, "cut": maaf_filters.CUT, "tables": {}}
    for pairs in PAIRS:
        rows = []
        for ratio in RATIOS:
            weights, rest, energy = fit(pairs, ratio)
            rows.append({"ratio": ratio, "weights": [float(w) for w in weights], "rest": rest, "energy": energy})
            print(f"{2 * pairs - 1} components, s_max / s_min {ratio:.3f}: rest {rest:.4f}, energy {energy:.3f}, weights",
                  *(f"{w:.4f}" for w in weights))
        out["tables"][str(2 * pairs - 1)] = rows
    results_file.write("fit_maaf", arguments[0], out)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
