"""maaf_lens.py FOLDER: tests of the filters of a lens and a light together of benchmarks/spectra, which is FOLDER."""

import sys
import unittest

import numpy as np

FOLDER = sys.argv.pop(1)
sys.path.insert(0, FOLDER)

import lens_filters
import maaf_filters as filters
import maaf_flatland as flatland
import maaf_lens as combined

WEDGES = [lens_filters.Wedge(1.5, 1.5, 3.0, 3.0), lens_filters.Wedge(4.0, 9.0, 3.0, 5.0), lens_filters.Wedge(0.6, 2.0, 2.0, 16.0)]
# A lens of no radius, and slopes of the light.
PINHOLES = [lens_filters.Wedge(0.0, 0.0, 3.0, 3.0), lens_filters.Wedge(0.0, 0.0, 3.0, 5.0), lens_filters.Wedge(0.0, 0.0, 2.0, 16.0)]
PLACES = [(0.0, 0.0), (0.7, -0.4), (-1.6, 1.1), (1.2, 1.9)]  # of v and y


def scene_of(radii, slopes, a, b):
    radii, slopes = np.array(radii, dtype=float), np.array(slopes, dtype=float)
    return {"r_min": radii.min(), "r_max": radii.max(), "s_min": slopes.min(), "s_max": slopes.max(), "radii": radii,
            "slopes": slopes, "a": np.array(a, float), "b": np.array(b, float)}


def kernels(wedge, lens):
    yield "aaf", lens_filters.aaf(0.3 * lens_filters.blur(wedge))
    yield "published", lens_filters.aaf_published(wedge, lens, combined.PUBLISHED)
    yield "extrapolated", lens_filters.extrapolated(0.6 * lens_filters.blur(wedge))
    for name, make in (("both", lens_filters.both_scores), ("light", lens_filters.light_score), ("share", lens_filters.light_score_share),
                       ("joint", lens_filters.joint_both), ("joint light", lens_filters.joint_light)):
        yield name, make(wedge, lens, 0.3)
    for pairs in combined.PAIRS:
        yield f"printed {pairs}", lens_filters.maaf_printed(wedge, lens, pairs, 2.0)
        yield f"not cut {pairs}", lens_filters.maaf_printed(wedge, lens, pairs, 2.0, as_printed=True)
        for lens_first in (False, True):
            bank = lens_filters.Components(pairs, wedge, 2.0, lens_first=lens_first)
            yield f"refitted {pairs}, {lens_first}", lens_filters.maaf(bank, lens_filters.fit(bank, wedge, lens)[0], lens)


def mirrored(kernel):
    return lens_filters.Kernel(("mirrored", kernel.key), kernel.values, lambda d: kernel.rows(-d), kernel.reach)


def response(kernel, lens, rho, s, omega):
    """What a filter makes of the wave exp(i omega (x + rho v + s y)), by sums over all d and nodes of both profiles."""
    d = np.linspace(-4.0 / 3.0 * kernel.reach, 4.0 / 3.0 * kernel.reach, 2001)
    v, y = (x.ravel() for x in np.meshgrid(lens.node, lens_filters.LIGHT.node))
    weights = np.outer(lens_filters.LIGHT.share, lens.share).ravel()
    by_sample = (kernel.values(v, y) * weights) @ np.exp(1j * omega * (rho * v + s * y))
    by_d = kernel.rows(d) @ np.exp(1j * omega * d) * (d[1] - d[0])
    return (by_sample @ by_d).real


class Bank(unittest.TestCase):
    def test_24_at_the_centre(self):
        """At p = 0 the box is the plain one: Omega_max s^u_max / (s^y_min (2 N - 1)) on either side of nought."""
        for wedge in WEDGES:
            for pairs in (1, 2, 3, 4):
                bank = lens_filters.Components(pairs, wedge, 2.0, smaller=False)
                self.assertEqual(bank.centre_v[0], 0.0)
                self.assertAlmostEqual(bank.extent_v[0], 2.0 * wedge.rho_max / (wedge.s_min * (2 * pairs - 1)))

    def test_boxes_hold_the_wedge(self):
        """All (Omega_x, Omega_y, Omega_v) of some rho and s are in the box that has their part of the divided axis; boxes are no
        larger than they must be: corners of the wedge lie on their faces."""
        random = np.random.default_rng(1)
        for wedge in WEDGES:
            for lens_first in (False, True):
                for pairs in (2, 3, 4):
                    bank = lens_filters.Components(pairs, wedge, 2.0, smaller=False, lens_first=lens_first)
                    first, other = (bank.centre_v, bank.centre_y) if lens_first else (bank.centre_y, bank.centre_v)
                    half, half_other = (bank.extent_v, bank.extent_y) if lens_first else (bank.extent_y, bank.extent_v)
                    near = np.zeros((pairs, 2))
                    for corner in range(2000):
                        rho = random.uniform(wedge.rho_min, wedge.rho_max) if corner > 3 else wedge[corner % 2]
                        s = random.uniform(wedge.s_min, wedge.s_max) if corner > 3 else wedge[2 + corner // 2]
                        divided, follows = (rho, s) if lens_first else (s, rho)
                        for p in range(pairs):
                            for part in (-1.0, 1.0, random.uniform(-1.0, 1.0)):
                                omega_x = (first[p] + part * half[p]) / divided
                                off = np.array([(omega_x - bank.centre_x[p]) / bank.extent_x[p],
                                                (omega_x * follows - other[p]) / half_other[p]])
                                self.assertLess(np.abs(off).max(), 1.0 + 1e-9)
                                near[p] = np.maximum(near[p], np.abs(off))
                    self.assertGreater(near.min(), 1.0 - 1e-9)

    def test_smaller_band(self):
        """Omega_x goes no farther than the lens' band, and the light's where that is the smaller one."""
        for wedge in WEDGES:
            bank = lens_filters.Components(3, wedge, 2.0)
            self.assertAlmostEqual(bank.centre_x[2] + bank.extent_x[2], 2.0 / max(wedge.s_min, wedge.rho_min))


class Filters(unittest.TestCase):
    def test_without_a_lens_they_are_those_of_maaf_filters(self):
        """Weights at any d, v and y, each over that at 0. Components do not have the profile of the lens."""
        for lens in lens_filters.LENSES.values():
            for wedge in PINHOLES:
                b = lens_filters.blur(wedge)
                pairs_of = [(lens_filters.aaf(0.3 * b), filters.aaf(wedge.s_min, 0.3), False),
                            (lens_filters.extrapolated(0.6 * b), filters.extrapolated(wedge.s_min, 0.6), False),
                            (lens_filters.both_scores(wedge, lens, 0.3), filters.gradients(wedge.s_min, 0.3), False),
                            (lens_filters.joint_both(wedge, lens, 0.25), filters.two_slope(wedge.s_min, wedge.s_max, 0.25), False)]
                scene = {"s_min": wedge.s_min, "s_max": wedge.s_max}
                for pairs in combined.PAIRS:
                    pairs_of.append((lens_filters.maaf_printed(wedge, lens, pairs, 2.0),
                                     flatland.maaf_printed(scene, pairs, 2.0), True))
                for kernel, wanted, all_over in pairs_of:
                    self.assertAlmostEqual(kernel.reach, wanted.reach)
                    d = np.linspace(-kernel.reach, kernel.reach, 41)
                    for v, y in PLACES:
                        got = kernel.weight(d, v, y) / kernel.weight(np.zeros(1), 0.0, 0.0)
                        got = got * lens.profile(v) if all_over else got
                        at = wanted.weight(d, y) / filters.profile(y) / wanted.weight(0.0, 0.0)
                        self.assertLess(np.abs(got - at).max(), 2e-4, kernel.key)

    def test_joint_gaussian_keeps_both_lines(self):
        """The variance of d + rho v + s y is |q|^2 at both ends of the wedge, with profiles that are not cut."""
        e = np.random.default_rng(2)
        kept, lens_filters.LIGHT.cut = lens_filters.LIGHT.cut, 7.0
        try:
            v, y = (x.ravel() for x in np.meshgrid(np.linspace(-7.0, 7.0, 141), np.linspace(-7.0, 7.0, 141)))
            light = np.exp(-0.5 * (v**2 + y**2))
            for wedge in WEDGES:
                b = lens_filters.blur(wedge)
                for n in ((wedge.rho_min / b, wedge.s_min / b), (0.0, 1.0)):
                    ends = [(wedge.rho_min, wedge.s_min), (wedge.rho_max, wedge.s_max)]
                    if n[0] == 0.0:  # whatever the lens
                        ends = [(e.uniform(0.0, 20.0), s) for _, s in ends]
                    kernel = joint_of_many_nodes(wedge, n)
                    d = np.linspace(-2.5 * kernel.reach, 2.5 * kernel.reach, 401)
                    rows, values = kernel.rows(d), kernel.values(v, y)
                    for rho, s in ends:
                        t = rho * v + s * y
                        total = (values * light).sum(axis=1) @ rows.sum(axis=1)
                        square = ((values * light) @ t**2) @ rows.sum(axis=1)
                        square += (values * light).sum(axis=1) @ (rows @ d**2)
                        cross = 2.0 * ((values * light) @ t) @ (rows @ d)
                        self.assertAlmostEqual((square + cross) / total / (rho**2 + s**2), 1.0, delta=2e-3)
        finally:
            lens_filters.LIGHT.cut = kept

    def test_gradients_tell_the_slope_of_a_ramp(self):
        """f = x + rho v + s y has the gradient 1: the mean of f q."""
        for lens in lens_filters.LENSES.values():
            v, y = lens.node, lens_filters.LIGHT.node
            for rho, s in ((3.0, 2.0), (0.5, 7.0)):
                of_lens = rho**2 * (lens.share * v) @ lens.score(v)
                of_light = s**2 * (lens_filters.LIGHT.share * y) @ lens_filters.LIGHT.score(y)
                self.assertAlmostEqual((of_lens + of_light) / (rho**2 + s**2), 1.0, delta=1e-6)

    def test_fit_has_the_filters_own_responses(self):
        """What is minimised, with responses summed up from the kernel itself: other weights nearby leave more of it."""
        lens = lens_filters.LENSES["uniform"]
        wedge = WEDGES[1]
        bank = lens_filters.Components(2, wedge, 2.0)
        weights = lens_filters.fit(bank, wedge, lens, (0.0,))[0]
        omega = (np.arange(lens_filters.FIT_WAVES) + 0.5) / lens_filters.FIT_WAVES * float((bank.centre_x + 3.0 * bank.extent_x).max())
        slopes = np.geomspace(wedge.s_min, wedge.s_max, lens_filters.FIT_SLOPES)
        radii = np.geomspace(wedge.rho_min, wedge.rho_max, lens_filters.FIT_RADII)

        def left(of):
            kernel = lens_filters.maaf(bank, of, lens)
            ones = response(kernel, lens, 0.0, 0.0, 0.0)
            out = 0.0
            for s in slopes[::3]:
                for rho in radii:
                    for w in omega[::4]:
                        true = np.cos(w * s * lens_filters.LIGHT.node) @ lens_filters.LIGHT.share
                        true *= np.cos(w * rho * lens.node) @ lens.share
                        out += ((response(kernel, lens, rho, s, w) / ones - true) / w) ** 2
            return out

        best = left(weights)
        for k in range(3):
            for factor in (0.8, 1.25):
                changed = weights.copy()
                changed[k] *= factor
                self.assertGreater(left(changed), 1.01 * best)

    def test_constant_in_constant_out(self):
        ends = ([3.0, 9.0], [4.0, 12.0])
        for lens in lens_filters.LENSES.values():
            for scene, value in ((scene_of(*ends, [1e6, 2e6], [1.1e6, 2.1e6]), 1.0),
                                 (scene_of(*ends, [-1e6, -1e6], [1e6, 1e6]), 0.0)):
                samples = combined.Samples(scene, lens, 16, 1, np.random.default_rng(3))
                for name, kernel in kernels(combined.wedge_of(scene, lens), lens):
                    self.assertLess(np.abs(samples.filtered(kernel) - value).max(), 1e-9, name)

    def test_convolutions_are_the_sum_over_samples(self):
        lens = lens_filters.LENSES["uniform"]
        scene = scene_of([2.0, 6.0, 3.0], [3.0, 9.0, 5.0], [40.0, 90.0, 180.0], [60.0, 130.0, 200.0])
        samples = combined.Samples(scene, lens, 4, 1, np.random.default_rng(4))
        for name, kernel in kernels(combined.wedge_of(scene, lens), lens):
            image = samples.filtered(kernel)
            reach = min(int(np.ceil(kernel.reach)), combined.MARGIN)
            for pixel in (50, 110):
                seen, taken = 0.0, 0.0
                for d in range(-reach, reach + 1):
                    at = pixel + combined.MARGIN + d
                    for v, y, f in zip(samples.v[0, at], samples.y[0, at], samples.f[0, at]):
                        w = kernel.weight(np.array([float(d)]), v, y)[0]
                        seen, taken = seen + w * f, taken + w
                self.assertAlmostEqual(image[0, pixel], seen / taken, delta=1e-6, msg=name)

    def test_filtered_sparse_samples_against_the_integral(self):
        """One seed's scenes: the sheared filters err less than chapter 5's, that less than none; and phases of the wrong sign err
        more than twice as much, of joint Gaussians and of components."""
        random = np.random.default_rng(5)
        lens = lens_filters.LENSES["gaussian"]
        errors = {}
        for number in range(12):
            scene = combined.random_scene(random, list(combined.BINS)[number % 3])
            wedge = combined.wedge_of(scene, lens)
            truth = combined.exact(scene, lens, np.arange(combined.PIXELS, dtype=float))
            samples = combined.Samples(scene, lens, 16, 2, random)
            bank = lens_filters.Components(3, wedge, 2.0)
            by_name = {"published": lens_filters.aaf_published(wedge, lens, combined.PUBLISHED),
                       "gradients": lens_filters.both_scores(wedge, lens, 0.5), "joint": lens_filters.joint_both(wedge, lens, 0.25),
                       "maaf": lens_filters.maaf(bank, lens_filters.fit(bank, wedge, lens)[1], lens)}
            images = {name: samples.filtered(kernel) for name, kernel in by_name.items()}
            images["none"] = samples.mean[:, combined.MARGIN:-combined.MARGIN]
            for name in ("joint", "maaf"):
                images[f"{name}, mirrored"] = samples.filtered(mirrored(by_name[name]))
            for name, image in images.items():
                errors.setdefault(name, []).append(np.mean((image - truth) ** 2))
        rms = {name: float(np.sqrt(np.mean(values))) for name, values in errors.items()}
        self.assertLess(rms["published"], rms["none"])
        self.assertLess(rms["gradients"], rms["published"])
        self.assertLess(rms["joint"], rms["published"])
        self.assertGreater(rms["joint, mirrored"], 2.0 * rms["joint"])
        self.assertGreater(rms["maaf, mirrored"], 2.0 * rms["maaf"])


def joint_of_many_nodes(wedge, n):
    """The joint Gaussian for profiles up to 7 deviations, where its polynomial takes more nodes."""
    kept, lens_filters.NODES = lens_filters.NODES, 160
    kernel = lens_filters.joint(wedge, lens_filters.LIGHT, n, 0.25)
    rows, values = kernel.rows, kernel.values
    lens_filters.NODES = kept

    def many(of):
        def run(*arguments):
            before, lens_filters.NODES = lens_filters.NODES, 160
            try:
                return of(*arguments)
            finally:
                lens_filters.NODES = before
        return run

    return lens_filters.Kernel(kernel.key, many(values), many(rows), kernel.reach)


class Truth(unittest.TestCase):
    def test_exact_is_what_dense_samples_give(self):
        for lens in lens_filters.LENSES.values():
            scene = combined.random_scene(np.random.default_rng(6), "lens above twice the light")
            x = np.arange(combined.PIXELS, dtype=float)
            places = (np.arange(300) + 0.5) / 300
            v, y = (z.ravel() for z in np.meshgrid(lens.place(places), flatland.place(places)))
            dense = np.array([combined.visible(scene, lens, at, v, y).mean() for at in x])
            self.assertLess(np.abs(dense - combined.exact(scene, lens, x)).max(), 4e-3)

    def test_scenes_are_in_their_bins(self):
        random = np.random.default_rng(7)
        for label, of in combined.BINS.items():
            for _ in range(20):
                wedge = combined.wedge_of(combined.random_scene(random, label), lens_filters.LENSES["uniform"])
                self.assertTrue(of(wedge.rho_min / wedge.s_min))


if __name__ == "__main__":
    unittest.main()
