#!/usr/bin/python3
"""Checks the bandwidths of environment light, (6.13), (6.17) and (6.19), in flatland.

usage: environment_spectra.py RESULTS.json [FOLDER]     and PNG files, into the folder if there is one

A receiver of constant curvature under light from infinity and one occluder that ends at an angle: its shading along x
is integrated from the definitions, and the angular frequency below which 99 % of its energy lies is compared with what
the formulas predict. The cases of Fig. 6.5 and of appendix E, and random ones. Needs python3-numpy, and
python3-matplotlib for pictures.
"""

import os
import sys

try:
    import numpy as np
except ImportError:
    sys.exit("environment_spectra: error: numpy: not installed: apt install python3-numpy")

import results_file

SHARE = 0.99
RANDOM_CASES = 200
SEED = 6


def spectrum(values, step):
    """Angular frequencies in radians a unit, and the energy at each, of a function that ends within the samples."""
    count = 1 << int(np.ceil(np.log2(8 * len(values))))
    energy = np.abs(np.fft.rfft(values, count)) ** 2
    energy[0] *= 0.5  # the half of a spectrum whose other half is its mirror image
    return 2.0 * np.pi * np.fft.rfftfreq(count, step), energy


def bandwidth(values, step):
    """The angular frequency below which SHARE of the energy lies."""
    frequencies, energy = spectrum(values, step)
    return float(frequencies[np.searchsorted(np.cumsum(energy), SHARE * energy.sum())])


def bandwidth_of(function):
    angles = np.linspace(-40.0, 40.0, 160001)
    return bandwidth(function(angles), angles[1] - angles[0])


def clamped_cosine(angle):
    return np.where(np.abs(angle) < np.pi / 2.0, np.cos(angle), 0.0)


def gaussian_sinusoid(deviation, frequency):
    return lambda angle: np.exp(-0.5 * (angle / deviation) ** 2) * np.cos(frequency * angle)


def lobe(exponent):
    """Phong's; nothing behind the mirrored direction's horizon."""
    return lambda angle: clamped_cosine(angle) ** exponent


def reflected(case, x):
    """Shading at x: (6.10), or (6.14) with the occluder, by the occluder's exact angle, the first line of (6.7)."""
    angle = np.linspace(-np.pi / 2.0, np.pi / 2.0, 2001)
    step = angle[1] - angle[0]
    kappa, z, occluder = case["kappa"], case["z"], case["occluder"]
    edge = np.arctan2(z * np.tan(occluder) - x, z)[:, None] - kappa * x[:, None]
    # The cell that holds the edge counts in part.
    visible = np.clip((edge - angle) / step + 0.5, 0.0, 1.0)
    shading = case["light"](angle + kappa * x[:, None]) * visible * np.cos(angle)
    if case["lobe"] is not None:
        shading *= case["lobe"](angle - kappa * x[:, None])
    return np.sum(shading, axis=1) * step


def predictions(case, b_f):
    """Of (6.13) and (6.17) with B_f = 1, as printed, and as it is; of (6.19); and of the corrected rule, 6 |kappa| +
    cos^2/z (1 + B_e), glossy 2 B_rho more in both."""
    kappa, b_e, gloss = case["kappa"], case["b_e"], 2.0 * case["b_rho"]
    edge = np.cos(case["occluder"]) ** 2 / case["z"]
    return {
        "printed": kappa * (1.0 + gloss) + edge * (1.0 + gloss + b_e),
        "true_b_f": kappa * (b_f + gloss) + edge * (b_f + gloss + b_e),
        "flt": (2.0 * kappa + 1.0 / case["z"]) * (case["b_rho"] if case["lobe"] is not None else 1.0),
        "corrected": (6.0 + gloss) * kappa + edge * (1.0 + gloss + b_e),
    }


def case_of(name, kappa, z, occluder, deviation, frequency, exponent=None):
    light = gaussian_sinusoid(deviation, frequency)
    of_lobe = lobe(exponent) if exponent is not None else None
    return {"name": name, "kappa": kappa, "z": z, "occluder": occluder, "exponent": exponent, "light": light,
            "lobe": of_lobe, "b_e": bandwidth_of(light), "b_rho": bandwidth_of(of_lobe) if of_lobe else 0.0}


def measure(case, b_f):
    # The light is nought beyond eight deviations, which 45 units of x reach at the least curvature that is drawn.
    reach = 16.0 / case["kappa"]
    x = np.linspace(-reach, reach, 3001)
    shading = reflected(case, x)
    out = {key: case[key] for key in ("name", "kappa", "z", "occluder", "exponent", "b_e", "b_rho")}
    out["true"] = bandwidth(shading, x[1] - x[0])
    out["predicted"] = {name: float(value) for name, value in predictions(case, b_f).items()}
    return out, x, shading


def random_cases():
    """Curvatures, occluders and lights; every second one with a lobe."""
    random = np.random.default_rng(SEED)
    for number in range(RANDOM_CASES):
        exponent = float(2.0 ** random.uniform(2.0, 7.0)) if number % 2 else None
        yield case_of(f"random_{number}", float(2.0 ** random.uniform(-2.0, 2.0)), float(2.0 ** random.uniform(-2.0, 3.0)),
                      float(random.uniform(-1.2, 1.2)), float(random.uniform(0.5, 2.0)), float(random.uniform(0.0, 8.0)),
                      exponent)


def summary(cases):
    """How often each formula is below the true bandwidth, and by what factor it is above in the median."""
    ratios = {name: np.array([case["predicted"][name] / case["true"] for case in cases])
              for name in cases[0]["predicted"]}
    return {name: {"too_small_share": float(np.mean(ratio < 1.0)), "median_ratio": float(np.median(ratio)),
                   "least_ratio": float(ratio.min())} for name, ratio in ratios.items()}


def plot(named, diffuse, glossy, folder):
    plt = results_file.pyplot("environment_spectra")
    os.makedirs(folder, exist_ok=True)
    figure, panels = plt.subplots(2, 2, figsize=(10, 8))
    panels = panels.flatten()
    for axes, (case, x, shading) in zip(panels, named):
        frequencies, energy = spectrum(shading, x[1] - x[0])
        axes.semilogy(frequencies, energy / energy.max(), color="0.2")
        axes.axvline(case["true"], color="#1f3fa8", label=f"99 %: {case['true']:.2f}")
        for name, colour in (("printed", "#d33b2f"), ("flt", "#d9a400"), ("corrected", "#6aa84f")):
            axes.axvline(case["predicted"][name], color=colour, linestyle="--",
                         label=f"{name}: {case['predicted'][name]:.2f}")
        axes.set_xlim(0.0, 1.2 * max(max(case["predicted"].values()), case["true"]))
        axes.set_ylim(1e-8, 2.0)
        axes.set_title(case["name"], fontsize=10)
        axes.set_xlabel("radians a unit of x")
        axes.legend(fontsize=8)
    for cases, colour, label in ((diffuse, "#1f3fa8", "matt"), (glossy, "#d33b2f", "glossy")):
        panels[3].loglog([c["true"] for c in cases], [c["predicted"]["printed"] for c in cases], ".", color=colour,
                         label=label)
    panels[3].loglog([0.1, 100.0], [0.1, 100.0], color="0.5", linewidth=0.8)
    panels[3].set_title("random cases: printed over true bandwidth", fontsize=10)
    panels[3].set_xlabel("true")
    panels[3].set_ylabel("(6.13), (6.17)")
    panels[3].legend(fontsize=8)
    figure.tight_layout()
    path = os.path.join(folder, "environment_spectra.png")
    figure.savefig(path, dpi=130)
    print(path)


def main(arguments):
    if len(arguments) not in (1, 2) or arguments[0].startswith("-"):
        print(__doc__.strip(), file=sys.stderr)
        return 2
    b_f = bandwidth_of(clamped_cosine)
    figures = [case_of("Fig. 6.5", 0.5, 2.0, 0.0, 1.5, 1.93),
               case_of("appendix E, exponent 32", 0.5, 2.0, np.pi / 4.0, 1.5, 2.93, 32.0),
               case_of("appendix E, B_rho 3.5", 0.5, 2.0, np.pi / 4.0, 1.5, 2.93, 3.4)]
    named = [measure(case, b_f) for case in figures]
    cases = [measure(case, b_f)[0] for case in random_cases()]
    diffuse = [case for case in cases if case["exponent"] is None]
    glossy = [case for case in cases if case["exponent"] is not None]
    results = {"benchmark": "environment_spectra", "share": SHARE, "b_f": b_f, "cases": [case for case, _, _ in named],
               "random": {"seed": SEED, "matt": summary(diffuse), "glossy": summary(glossy)}}
    results_file.write("environment_spectra", arguments[0], results)
    for case in results["cases"]:
        print(case["name"], f"true {case['true']:.2f}", *(f"{n} {v:.2f}" for n, v in case["predicted"].items()))
    for kind in ("matt", "glossy"):
        for name, row in results["random"][kind].items():
            print(f"{kind}, {name}: too small in {100 * row['too_small_share']:.0f} %, median ratio "
                  f"{row['median_ratio']:.2f}, least {row['least_ratio']:.2f}")
    if len(arguments) > 1:
        plot(named, diffuse, glossy, arguments[1])
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
