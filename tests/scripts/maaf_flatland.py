"""maaf_flatland.py FOLDER: tests of the filters of benchmarks/spectra, which is FOLDER."""

import json
import os
import sys
import unittest

import numpy as np

FOLDER = sys.argv.pop(1)
sys.path.insert(0, FOLDER)

import fit_maaf
import maaf_filters as filters
import maaf_flatland as flatland
import maaf_plane as plane
import maaf_spectra as spectra
import weights_header

SLOPES = [(3.0, 3.0), (3.0, 5.0), (2.0, 16.0)]


def transform(kernel, omega_x, omega_y, spread_x, spread_y):
    """What a filter makes of a wave exp(i (omega_x x + omega_y y)) at 0, over the whole plane."""
    d = np.linspace(-spread_x, spread_x, 1601)[:, None]
    y = np.linspace(-spread_y, spread_y, 801)
    values = kernel.weight(d, y) * np.cos(omega_x * d + omega_y * y)
    return values.sum() * (d[1, 0] - d[0, 0]) * (y[1] - y[0])


def scene_of(slopes, a, b):
    slopes = np.array(slopes, dtype=float)
    return {"s_min": slopes.min(), "s_max": slopes.max(), "slopes": slopes, "a": np.array(a, float), "b": np.array(b, float)}


def kernels(s_min, s_max):
    scene = {"s_min": s_min, "s_max": s_max}
    yield "aaf", filters.aaf(s_min, 0.3)
    yield "extrapolated", filters.extrapolated(s_min, 0.6)
    yield "two_slope", filters.two_slope(s_min, s_max, 0.25)
    for pairs in fit_maaf.PAIRS:
        yield f"printed {pairs}", flatland.maaf_printed(scene, pairs, 2.0)
        yield f"refitted {pairs}", flatland.maaf_refitted(scene, pairs, 2.0, fit_maaf.table(pairs))


class Filters(unittest.TestCase):
    def test_bank_is_what_9_says(self):
        for s_min, s_max in SLOPES:
            for pairs in (1, 2, 3, 4):
                kernel = flatland.maaf_printed({"s_min": s_min, "s_max": s_max}, pairs, spectra.OMEGA)
                for x, y in ((0.0, 0.0), (0.3 / s_min, 0.4), (-0.5 / s_min, 0.7), (1.0 / s_min, 1.6)):
                    wanted = spectra.response(f"maaf {2 * pairs - 1}" if pairs > 1 else "aaf", s_min, s_max, x, y)
                    got = transform(kernel, x, y, 2.0 * kernel.reach, 12.0 * pairs)
                    self.assertAlmostEqual(got, wanted, delta=1e-4)

    def test_one_component_is_aaf(self):
        """(2) and (3): a Gaussian of Omega_max / s_min by one of Omega_max."""
        kernel = filters.maaf(1, 3.0, 8.0, [1.0], 2.0)
        d, y = np.linspace(-5.0, 5.0, 41)[:, None], np.linspace(-2.0, 2.0, 21)
        self.assertLess(np.abs(kernel.weight(d, y) - filters.gaussian(d, 1.5) * filters.gaussian(y, 0.5)).max(), 1e-12)

    def test_weights_of_light_make_its_transform(self):
        omega = np.linspace(0.0, 1.2, 13)
        for pairs, apart in ((3, 0.06), (4, 0.045)):
            bank = filters.Components(pairs, 1.0, 2.0)

            def off(weights):
                made = sum(mu * np.exp(-0.5 * ((omega - side * c) / w) ** 2)
                           for mu, c, w in zip(weights, bank.centre_y, bank.extent_y)
                           for side in ((1.0, -1.0) if c > 0.0 else (1.0,)))
                return np.abs(made / made[0] - np.exp(-0.5 * omega**2)).max()

            self.assertLess(off(bank.weights_of_light()), apart)
            # Those printed are of a light twice as wide in frequency.
            self.assertGreater(off(bank.weights_printed(1.0)), 0.2)

    def test_symmetry(self):
        d, y = np.linspace(-9.0, 9.0, 37)[:, None], np.linspace(-2.0, 2.0, 17)
        for s_min, s_max in SLOPES:
            for name, kernel in kernels(s_min, s_max):
                self.assertLess(np.abs(kernel.weight(d, y) - kernel.weight(-d, -y)).max(), 1e-12, name)

    def test_extrapolated_response(self):
        kernel = filters.extrapolated(4.0, 0.5)
        total = transform(kernel, 0.0, 0.0, 24.0, 8.0)
        for omega in (0.05, 0.2, 0.5):
            a = 0.5 * (2.0 * omega) ** 2
            self.assertAlmostEqual(transform(kernel, omega, 0.0, 24.0, 8.0) / total, 2.0 * np.exp(-a) - np.exp(-2.0 * a), delta=1e-3)

    def test_two_slope_keeps_both_slopes(self):
        """The variance of d + s y is s^2 at both, and less than it between them by no more than e (s_max - s_min)^2 / 4."""
        d, y = np.linspace(-40.0, 40.0, 2001)[:, None], np.linspace(-8.0, 8.0, 801)
        for s_min, s_max in SLOPES:
            w = filters.two_slope(s_min, s_max, 0.25).weight(d, y)
            for s in (s_min, s_max, 0.5 * (s_min + s_max)):
                variance = (w * (d + s * y) ** 2).sum() / w.sum() / s**2
                if s in (s_min, s_max):
                    self.assertAlmostEqual(variance, 1.0, delta=1e-3)
                else:
                    self.assertTrue(0.9 < variance <= 1.001, variance)

    def test_second_order_is_near_the_joint_gaussian(self):
        """What both make of waves of the slope that both are sheared along: nothing but the light, to (beta Omega / s)^6 / 48."""
        kept, filters.CUT = filters.CUT, 6.0  # an end of the profile is no part of this
        try:
            for c in (0.3, 0.5):
                kernel = filters.second_order(3.0, 3.0, c)
                joint = filters.two_slope(3.0, 3.0, c**2)
                first = filters.gradients(3.0, c)
                for omega_y in (0.5, 1.0, 1.5):
                    def response(k):
                        return transform(k, omega_y / 3.0, omega_y, 12.0, 6.0) / transform(k, 0.0, 0.0, 12.0, 6.0)

                    light = np.exp(-0.5 * omega_y**2)
                    self.assertAlmostEqual(response(joint), light, delta=1e-3)
                    off = response(kernel) / light - 1.0
                    self.assertAlmostEqual(off, -((c * omega_y) ** 6) / 48.0, delta=3e-4 + 0.25 * (c * omega_y) ** 6 / 48.0)
                    self.assertLess(abs(off), abs(response(first) / light - 1.0) + 3e-4)
        finally:
            filters.CUT = kept

    def test_second_order_goes_between_both_slopes(self):
        for s_min, s_max in SLOPES:
            kernel = filters.second_order(s_min, s_max, 0.4)
            ratio = s_max / s_min
            between = min(2.0 * ratio / (1.0 + ratio), 0.6 * ratio / (ratio - 1.0)) if ratio > 1.0 else 1.0
            self.assertAlmostEqual(kernel.reach, 3.0 * 0.4 * s_min * between)

    def test_polynomials_and_convolutions_are_the_sum_over_samples(self):
        scene = scene_of([3.0, 9.0, 5.0], [40.0, 90.0, 180.0], [60.0, 130.0, 200.0])
        samples = flatland.Samples(scene, 4, 1, np.random.default_rng(1))
        random = np.random.default_rng(1)
        x = np.arange(-flatland.MARGIN, flatland.PIXELS + flatland.MARGIN, dtype=float)
        y = flatland.place((np.arange(4) + random.uniform(size=(len(x), 4))) / 4)
        f = flatland.visible(scene, x[:, None], y)
        for name, kernel in kernels(3.0, 9.0):
            image = samples.filtered(kernel)
            reach = min(int(np.ceil(kernel.reach)), flatland.MARGIN)
            d = np.arange(-reach, reach + 1)
            for pixel in (50, 110):
                at = pixel + flatland.MARGIN + d
                w = kernel.weight(d[:, None].astype(float), y[at]) / filters.profile(y[at])
                self.assertAlmostEqual(image[0, pixel], (w * f[at]).sum() / w.sum(), delta=1e-6, msg=name)

    def test_constant_in_constant_out(self):
        open_, closed = scene_of([4.0, 12.0], [1e6, 2e6], [1.1e6, 2.1e6]), scene_of([4.0, 12.0], [-1e6, -1e6], [1e6, 1e6])
        for scene, value in ((open_, 1.0), (closed, 0.0)):
            samples = flatland.Samples(scene, 9, 1, np.random.default_rng(2))
            for name, kernel in kernels(4.0, 12.0):
                self.assertLess(np.abs(samples.filtered(kernel) - value).max(), 1e-9, name)

    def test_filtered_sparse_samples_against_the_integral(self):
        """One seed's scenes: the extrapolation and the sheared filter err less than AAF of the thesis's width, that less than none; and
        the phase of the wrong sign errs more than twice as much."""
        random = np.random.default_rng(3)
        errors = {}
        for _ in range(12):
            scene = flatland.random_scene(random)
            truth = flatland.exact(scene, np.arange(flatland.PIXELS, dtype=float))
            samples = flatland.Samples(scene, 9, 2, random)
            mirrored = filters.two_slope(scene["s_min"], scene["s_max"], 0.25)
            weight = mirrored.weight
            mirrored.weight = lambda d, y, w=weight: w(-d, y)
            images = {"none": samples.mean[:, flatland.MARGIN:-flatland.MARGIN], "mirrored": samples.filtered(mirrored),
                      "thesis": samples.filtered(filters.aaf(scene["s_min"], 1.0 / 6.0)),
                      "extrapolated": samples.filtered(filters.extrapolated(scene["s_min"], 0.65)),
                      "two_slope": samples.filtered(filters.two_slope(scene["s_min"], scene["s_max"], 0.25))}
            for name, image in images.items():
                errors.setdefault(name, []).append(np.mean((image - truth) ** 2))
        rms = {name: float(np.sqrt(np.mean(values))) for name, values in errors.items()}
        self.assertLess(rms["thesis"], rms["none"])
        self.assertLess(rms["extrapolated"], rms["thesis"])
        self.assertLess(rms["two_slope"], rms["thesis"])
        self.assertGreater(rms["mirrored"], 2.0 * rms["two_slope"])


class Truth(unittest.TestCase):
    def test_exact_is_what_dense_samples_give(self):
        scene = flatland.random_scene(np.random.default_rng(4))
        x = np.arange(flatland.PIXELS, dtype=float)
        y = flatland.place((np.arange(3000) + 0.5) / 3000)
        self.assertLess(np.abs(flatland.visible(scene, x[:, None], y).mean(axis=1) - flatland.exact(scene, x)).max(), 2e-3)

    def test_plane_truth_has_the_samples_axes(self):
        scene = plane.random_scene(np.random.default_rng(5))
        truth = plane.exact(scene)
        mean = plane.Samples(scene, 64, np.random.default_rng(6)).mean
        self.assertLess(np.sqrt(np.mean((mean - truth) ** 2)), 0.03)


class Samples(unittest.TestCase):
    def test_samples_for_the_same_error(self):
        """Errors of AAF that fall as 1 / samples: half of the error is twice the samples, and nothing is guessed beyond the ends."""
        results = {str(spp): {"aaf": {"rms": 1.0 / spp}, "half": {"rms": 0.5 / spp}, "twice": {"rms": 2.0 / spp}} for spp in (9, 16, 64)}
        flatland.add_saved(results)
        self.assertEqual([rows["aaf"]["saved"] for rows in results.values()], [1.0, 1.0, 1.0])
        self.assertEqual([rows["half"]["saved"] for rows in results.values()], [2.0, 2.0, None])
        self.assertEqual([rows["twice"]["saved"] for rows in results.values()], [None, None, 0.5])
        self.assertNotIn("saved_thesis", results["9"]["aaf"])

    def test_measured_slopes_are_the_occluders(self):
        scene = scene_of([5.0, 20.0], [60.0, 150.0], [100.0, 200.0])
        x = np.arange(-flatland.MARGIN, flatland.PIXELS + flatland.MARGIN, dtype=float)
        y = flatland.place((np.arange(9) + 0.5) / 9) * np.ones((len(x), 1))
        low, high = flatland.measured_slopes(scene, x, y)
        for pixel, s in ((80, 5.0), (175, 20.0)):
            self.assertAlmostEqual(low[pixel + flatland.MARGIN], s, delta=1e-9)
            self.assertAlmostEqual(high[pixel + flatland.MARGIN], s, delta=1e-9)
        self.assertEqual(low[0], 0.0)


class Table(unittest.TestCase):
    def test_table_is_what_the_program_fits(self):
        with open(os.path.join(FOLDER, "maaf_weights.json"), encoding="utf-8") as file:
            table = json.load(file)
        self.assertEqual((table["bandwidth"], table["noise"]), (fit_maaf.BANDWIDTH, fit_maaf.NOISE))
        for components, rows in table["tables"].items():
            for row in (rows[0], rows[6], rows[-1]):
                weights, rest, _ = fit_maaf.fit((int(components) + 1) // 2, row["ratio"])
                self.assertAlmostEqual(rest, row["rest"], delta=1e-4)
                # Columns nearly depend on one another where slopes are one: weights to fewer digits than what they make.
                self.assertLess(np.abs(weights - row["weights"]).max(), 1e-3)

    def test_header_of_the_renderer_is_the_table(self):
        with open(os.path.join(FOLDER, "maaf_weights.json"), encoding="utf-8") as file:
            expected = weights_header.header(json.load(file)["tables"])
        with open(os.path.join(FOLDER, "..", "..", "kernels", "filter", "refitted_weights.h"), encoding="utf-8") as file:
            self.assertEqual(file.read(), expected)

    def test_refitted_edges_are_nearer_than_printed_ones(self):
        for pairs in fit_maaf.PAIRS:
            for ratio in (1.0, 2.0, 8.0):
                rows, ones, target, _ = fit_maaf.responses(pairs, ratio, fit_maaf.BANDWIDTH)
                printed = filters.both(filters.Components(pairs, 1.0, ratio).weights_printed(1.0))
                rest = printed @ rows / (printed @ ones) - target
                of_printed = float(np.sqrt(rest @ rest / fit_maaf.SLOPES))
                self.assertLess(fit_maaf.fit(pairs, ratio, noise=0.0)[1], 0.95 * of_printed)
                self.assertLess(fit_maaf.fit(pairs, ratio)[1], of_printed)


class Spectra(unittest.TestCase):
    def test_coverage_of_boxes_by_area(self):
        """Boxes hold the wedge, and coverage is its area over theirs."""
        random = np.random.default_rng(7)
        for s_min, s_max in ((0.5, 0.8), (0.7, 2.2)):
            omega = spectra.OMEGA
            wedge = omega**2 * (1.0 / s_min - 1.0 / s_max)
            for name in spectra.NAMES:
                boxes = spectra.outlines(name, s_min, s_max)
                # Shoelace.
                area = sum(abs(sum(p[0] * q[1] - q[0] * p[1] for p, q in zip(box, box[1:] + box[:1]))) / 2.0 for box in boxes)
                self.assertAlmostEqual(spectra.box_coverage(name, s_min, s_max), wedge / area, delta=1e-9, msg=name)
                if name == "sheared":
                    continue
                y = omega * np.sqrt(random.uniform(size=500))
                x = y * random.uniform(1.0 / s_max, 1.0 / s_min, 500)
                inside = np.zeros(500, dtype=bool)
                for box in boxes:
                    (left, low), (right, high) = box[0], box[2]
                    inside |= (x >= left - 1e-9) & (x <= right + 1e-9) & (y >= low - 1e-9) & (y <= high + 1e-9)
                self.assertTrue(inside.all(), name)

    def test_coverage_of_gaussians_by_random_points(self):
        s_min, s_max = 0.7, 2.2
        x, y = np.meshgrid(np.linspace(-25.0, 25.0, 1001), np.linspace(-12.0, 12.0, 481))
        cell = (x[0, 1] - x[0, 0]) * (y[1, 0] - y[0, 0])
        random = np.random.default_rng(8)
        in_y = spectra.OMEGA * np.sqrt(random.uniform(size=400000))
        in_x = in_y * random.uniform(1.0 / s_max, 1.0 / s_min, len(in_y))
        area = spectra.OMEGA**2 * (1.0 / s_min - 1.0 / s_max)
        for name in spectra.NAMES + spectra.OTHERS:
            whole = spectra.response(name, s_min, s_max, x, y).sum() * cell
            values = spectra.response(name, s_min, s_max, in_x, in_y)
            coverage, accuracy, _ = spectra.gaussian_measures(name, s_min, s_max)
            self.assertAlmostEqual(coverage, area * values.mean() / whole, delta=2e-3, msg=name)
            self.assertAlmostEqual(accuracy, 1.0 - np.sqrt(np.mean((values - 1.0) ** 2)), delta=2e-3, msg=name)

    def test_wedge_holds_its_lines_only(self):
        omega = np.array([-2.0, -0.5, 0.5, 2.0])
        for s, inside in ((0.6, False), (0.8, True), (2.0, True), (2.4, False)):
            self.assertTrue((spectra.in_wedge(omega / s, omega, 0.7, 2.2, 0.0) == inside).all())
            self.assertFalse(spectra.in_wedge(-omega / s, omega, 0.7, 2.2, 0.0).any())
        self.assertFalse(spectra.in_wedge(np.array([-1.0, 1.0]), np.array([0.0, 0.0]), 0.7, 2.2, 0.1).any())

    def test_spectra_lie_on_the_slopes(self):
        for row in spectra.measured_slopes()[:2]:
            self.assertAlmostEqual(row["measured"], row["slope"], delta=0.01)


if __name__ == "__main__":
    unittest.main()
