"""Laws of misfit.vis2dirty() and misfit.dirty2vis()."""

import itertools
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import warnings

import numpy as np
from direct_sums import Scene, relative_error

import misfit

# As wide as the tests of DUCC's wgridder: fields of view in degrees, sizes from 2 x 2, odd ones, single rows and channels.
FIELDS = (0.001, 0.1, 1, 10, 20)
SIZES = ((2, 2), (2, 64), (3, 5), (18, 2), (32, 31), (66, 40), (101, 50))
SAMPLES = ((1, 1), (2, 5), (27, 1), (100, 7))
EPSILONS = (1e-1, 1e-2, 1e-3, 3e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12)


def cases(part):
    """One of `part` of all combinations, in turn: every value of every parameter occurs, in changing company."""
    everything = itertools.product(FIELDS, SIZES, SAMPLES, EPSILONS, (False, True), (False, True))
    for i, (fov, size, samples, epsilon, do_wgridding, single) in enumerate(everything):
        if i % part == 0 and (epsilon >= 1e-6 or not single):
            yield i // part, epsilon, Scene(fov, size, *samples, single, do_wgridding, seed=i)


class Definition(unittest.TestCase):
    def test_images_equal_direct_sums_to_epsilon(self):
        for i, epsilon, scene in cases(79):
            wgt, mask = (scene.wgt if i % 2 else None), (scene.mask if i % 3 == 0 else None)
            truth = scene.image(wgt, mask)
            if not truth.any():
                continue  # all masked
            with self.subTest(case=i, epsilon=epsilon, size=scene.size):
                image = misfit.vis2dirty(**scene.image_options(epsilon, wgt=wgt, mask=mask, nthreads=1 + i // 2 % 2))
                self.assertEqual(image.dtype, scene.wgt.dtype)
                self.assertLessEqual(relative_error(image, truth), epsilon)

    def test_visibilities_equal_direct_sums_to_epsilon(self):
        for i, epsilon, scene in cases(79):
            wgt, mask = (scene.wgt if i % 2 else None), (scene.mask if i % 3 == 0 else None)
            truth = scene.visibilities(wgt, mask)
            if not truth.any():
                continue
            with self.subTest(case=i, epsilon=epsilon, size=scene.size):
                vis = misfit.dirty2vis(**scene.options(epsilon, dirty=scene.dirty, wgt=wgt, mask=mask, nthreads=1 + i // 2 % 2))
                self.assertEqual(vis.dtype, scene.vis.dtype)
                self.assertLessEqual(relative_error(vis, truth), epsilon)

    def test_so_they_do_where_gridding_is_cheaper_than_direct_sums(self):
        for fov, do_wgridding in itertools.product((0.1, 20), (False, True)):
            scene = Scene(fov, (80, 61), 1500, 2, do_wgridding=do_wgridding)
            image_truth, vis_truth = scene.image(), scene.visibilities()
            for epsilon in (1e-3, 1e-6, 1e-10):
                with self.subTest(fov=fov, epsilon=epsilon, do_wgridding=do_wgridding):
                    image = misfit.vis2dirty(**scene.image_options(epsilon))
                    self.assertLessEqual(relative_error(image, image_truth), epsilon)
                    vis = misfit.dirty2vis(**scene.options(epsilon, dirty=scene.dirty))
                    self.assertLessEqual(relative_error(vis, vis_truth), epsilon)

    def test_centers_flips_and_n_mean_what_they_say(self):
        for divide_by_n in (False, True):
            scene = Scene(30, (40, 33), 50, 2, center=(0.2, -0.3))
            image = misfit.vis2dirty(**scene.image_options(1e-9, divide_by_n=divide_by_n))
            self.assertLessEqual(relative_error(image, scene.image(divide_by_n=divide_by_n)), 1e-9)
            vis = misfit.dirty2vis(**scene.options(1e-9, dirty=scene.dirty, divide_by_n=divide_by_n))
            self.assertLessEqual(relative_error(vis, scene.visibilities(divide_by_n=divide_by_n)), 1e-9)
        for axis, flip in enumerate(("flip_u", "flip_v", "flip_w")):
            scene = Scene(30, (40, 33), 50, 2)
            image = misfit.vis2dirty(**scene.image_options(1e-9, **{flip: True}))
            scene.uvw[:, axis] *= -1
            self.assertLessEqual(relative_error(image, scene.image()), 1e-9)

    def test_pixels_beyond_the_horizon_are_0_and_not_looked_at(self):
        scene = Scene(170, (40, 40), 50, 2)
        truth = scene.image()
        self.assertGreater(np.sum(truth == 0), 40)
        image = misfit.vis2dirty(**scene.image_options(1e-6))
        self.assertLessEqual(relative_error(image, truth), 1e-6)
        self.assertTrue((image[truth == 0] == 0).all())
        scene.dirty[truth == 0] = np.nan
        vis = misfit.dirty2vis(**scene.options(1e-6, dirty=scene.dirty))
        scene.dirty[truth == 0] = 0
        self.assertLessEqual(relative_error(vis, scene.visibilities()), 1e-6)

    def test_an_image_beyond_the_horizon_is_empty(self):
        scene = Scene(1, (10, 8), 50, 2, center=(1.2, 0.9))
        self.assertFalse(misfit.vis2dirty(**scene.image_options(1e-6)).any())
        self.assertFalse(misfit.dirty2vis(**scene.options(1e-6, dirty=scene.dirty)).any())

    def test_without_w_there_is_no_horizon(self):
        scene = Scene(170, (40, 40), 50, 2, do_wgridding=False)
        self.assertLessEqual(relative_error(misfit.vis2dirty(**scene.image_options(1e-6)), scene.image()), 1e-6)


class Adjointness(unittest.TestCase):
    def test_holds_to_rounding(self):
        for i, epsilon, scene in cases(79):
            single = scene.dirty.dtype == np.float32
            options = dict(wgt=scene.wgt, mask=scene.mask, nthreads=1 + i // 2 % 2)
            image = misfit.vis2dirty(**scene.image_options(epsilon, **options)).astype(np.float64)
            vis = misfit.dirty2vis(**scene.options(epsilon, dirty=scene.dirty, **options)).astype(np.complex128)
            of_images = np.vdot(image, scene.dirty)
            of_visibilities = np.vdot(vis, scene.vis).real
            unit = 2.0**-24 if single else 2.0**-53
            # Products of norms hold both; some hundred roundings of values and of phases of up to 100 turns, which small paddings,
            # whose corrections are large at the borders, multiply by up to ten.
            size = np.linalg.norm(image) * np.linalg.norm(scene.dirty) + np.linalg.norm(vis) * np.linalg.norm(scene.vis)
            with self.subTest(case=i, epsilon=epsilon, size=scene.size):
                self.assertLessEqual(abs(of_images - of_visibilities), 10000 * unit * size)


class Arrays(unittest.TestCase):
    def test_other_strides_and_threads_change_no_bit(self):
        scene = Scene(3, (70, 60), 2000, 3)
        options = scene.image_options(1e-5)
        image = misfit.vis2dirty(**options)
        options.update(vis=np.asfortranarray(scene.vis), uvw=scene.uvw[:, ::-1].copy()[:, ::-1], nthreads=2)
        self.assertTrue((misfit.vis2dirty(**options) == image).all())

    def test_results_go_where_they_are_asked_for(self):
        scene = Scene(3, (20, 30), 50, 3)
        into = np.full((40, 60), 7.0)[::2, ::2]
        options = scene.image_options(1e-5, dirty=into)
        options["npix_x"] = 0
        self.assertIs(misfit.vis2dirty(**options), into)
        self.assertTrue((into == misfit.vis2dirty(**scene.image_options(1e-5))).all())
        vis = np.empty((3, 50), np.complex128).T
        options = scene.options(1e-5, dirty=scene.dirty)
        self.assertIs(misfit.dirty2vis(**options, vis=vis), vis)
        self.assertTrue((vis == misfit.dirty2vis(**options)).all())

    def test_masks_of_bools_and_integers_are_one(self):
        scene = Scene(3, (20, 30), 50, 3)
        scene.vis[~scene.mask] = np.nan
        a, b = (misfit.vis2dirty(**scene.image_options(1e-5, mask=m)) for m in (scene.mask, scene.mask.astype(np.uint8)))
        self.assertTrue((a == b).all())

    def test_what_masked_rows_hold_changes_no_bit(self):
        scene = Scene(3, (20, 30), 50, 3)
        scene.mask[7] = False
        image = misfit.vis2dirty(**scene.image_options(1e-5, mask=scene.mask))
        for other in (np.nan, 1e30, 1e308):
            scene.uvw[7] = other
            self.assertTrue((misfit.vis2dirty(**scene.image_options(1e-5, mask=scene.mask)) == image).all())

    def test_an_image_outlives_what_made_it(self):
        scene = Scene(3, (200, 300), 50, 3)
        image = misfit.vis2dirty(**scene.image_options(1e-5))
        copy = image.copy()
        for _ in range(5):
            misfit.vis2dirty(**scene.image_options(1e-5))
        self.assertTrue((image == copy).all())

    def test_a_kernel_can_be_chosen(self):
        scene = Scene(3, (100, 90), 600, 2, do_wgridding=False)
        truth = scene.image()
        for kernel in ("kaiser-bessel", misfit.kernel("least-misfit", 9, 0.4)):
            image = misfit.vis2dirty(**scene.image_options(1e-5, kernel=kernel))
            self.assertLessEqual(relative_error(image, truth), 1e-5)

    def test_single_precision_can_accumulate_in_double(self):
        scene = Scene(3, (100, 90), 600, 2, single=True)
        single, double = (misfit.vis2dirty(**scene.image_options(1e-4, double_precision_accumulation=d)) for d in (False, True))
        self.assertEqual(double.dtype, np.float32)
        self.assertTrue((single != double).any())
        self.assertLessEqual(relative_error(double, scene.image()), 1e-4)


class Refusals(unittest.TestCase):
    def refused(self, error, message, **changes):
        scene = Scene(3, (20, 30), 50, 3, single=changes.pop("single", False))
        options = scene.image_options(1e-5)
        options.update(changes)
        with self.assertRaises(error) as raised:
            misfit.vis2dirty(**options)
        self.assertIn(message, str(raised.exception))

    def test_name_the_thing_the_value_and_what_was_expected(self):
        zeros = np.zeros((50, 3))
        self.refused(TypeError, "vis has the type float64, expected complex64 or complex128", vis=zeros)
        self.refused(TypeError, "wgt has the type float32, expected float64", wgt=zeros.astype(np.float32))
        self.refused(ValueError, "vis has the shape (3, 50), expected (50, 3)", vis=zeros.T + 0j)
        self.refused(ValueError, "vis has 1 axes, expected 2", vis=zeros[0] + 0j)
        self.refused(ValueError, "uvw has the shape (50, 2), expected (rows, 3)", uvw=zeros[:, :2])
        self.refused(ValueError, "freq[1] is -1", freq=[1e9, -1, 1e9])
        self.refused(ValueError, "uvw[0] is not finite", uvw=np.full((50, 3), np.inf))
        self.refused(ValueError, "vis or wgt is not finite", vis=np.full((50, 3), np.nan + 0j))
        self.refused(ValueError, "an image of 0 x 30 pixels, expected 1 to 65536", npix_x=0)
        self.refused(ValueError, "pixsize_x -1 rad, expected more than 0", pixsize_x=-1.0)
        self.refused(ValueError, "epsilon 1e-07 of single-precision data, expected 1e-06 or more", single=True, epsilon=1e-7)
        self.refused(ValueError, "epsilon 1e-20 is out of reach", epsilon=1e-20)
        for epsilon in (0, 2.0, np.nan, -1e-3):
            self.refused(ValueError, "expected it above 0 and below 1", epsilon=epsilon)
        self.refused(TypeError, "epsilon is 'x', expected a number", epsilon="x")
        self.refused(ValueError, "sigma_max 2.6", kernel=misfit.kernel(width=7, x0=0.1))
        self.refused(TypeError, "dirty is of type list, expected an array with two axes", dirty=[[1.0]])
        self.refused(ValueError, "sigma_min and sigma_max 2 to 1.5", sigma_min=2.0, sigma_max=1.5)
        self.refused(ValueError, "npix_x is 20, expected 21", dirty=np.zeros((21, 30)))
        self.refused(TypeError, "dirty is an array of type float32, expected an array of type float64",
                     dirty=np.zeros((20, 30), np.float32))
        self.refused(ValueError, "phases of u and v reach", uvw=np.full((50, 3), [1e12, 0, 0]))
        self.refused(TypeError, "vis is a masked array", vis=np.ma.masked_array(zeros + 0j))
        self.refused(ValueError, "no-kernel", kernel="no-kernel")
        self.refused(TypeError, "kernel is of type int", kernel=3)
        self.refused(TypeError, "nthreads", nthreads="two")

    def test_of_models_that_are_not_finite(self):
        scene = Scene(3, (20, 30), 50, 3)
        scene.dirty[3, 4] = np.nan
        with self.assertRaisesRegex(ValueError, "dirty is not finite"):
            misfit.dirty2vis(**scene.options(1e-5, dirty=scene.dirty))

    def test_of_weights_that_are_not_finite(self):
        scene = Scene(3, (20, 30), 50, 3)
        scene.wgt[3, 1] = np.inf
        with self.assertRaisesRegex(ValueError, "wgt is not finite"):
            misfit.dirty2vis(**scene.options(1e-5, dirty=scene.dirty, wgt=scene.wgt))

    def test_data_that_cancel_are_warned_of(self):
        scene = Scene(0.01, (64, 64), 200, 1)
        scene.uvw[1::2] = scene.uvw[::2] * (1 + 1e-6)
        scene.vis[1::2] = -scene.vis[::2]
        with self.assertWarns(misfit.AccuracyWarning):
            misfit.vis2dirty(**scene.image_options(1e-4, kernel_width=5))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            misfit.vis2dirty(**Scene(0.01, (64, 64), 200, 1).image_options(1e-4, kernel_width=5))


class Interrupts(unittest.TestCase):
    def interrupted(self, call):
        """What a program says that is interrupted half a second after `call` begins, which would take minutes."""
        code = f"""
import numpy as np, misfit, time
random = np.random.default_rng(1)
data = dict(uvw=random.random((100000, 3)) * 1e4, freq=np.linspace(1e9, 2e9, 50), npix_x=2000, npix_y=2000, pixsize_x=1e-4, pixsize_y=1e-4)
into = np.full((2000, 2000), np.nan)
print("ready", flush=True)
try:
    {call}
except KeyboardInterrupt:
    print("interrupted, untouched" if np.isnan(into).all() else "interrupted too late")
"""
        environment = dict(os.environ)
        with tempfile.TemporaryDirectory() as cache:
            environment["MISFIT_CACHE"] = cache
            program = subprocess.Popen([sys.executable, "-c", code], env=environment, stdout=subprocess.PIPE,
                                       stderr=subprocess.PIPE, text=True)
            self.assertEqual(program.stdout.readline(), "ready\n")
            time.sleep(0.5)
            program.send_signal(signal.SIGINT)
            said, complaint = program.communicate(timeout=100)
        self.assertEqual(complaint, "")
        return said

    def test_ctrl_c_ends_a_transform(self):
        said = self.interrupted(
            "[misfit.vis2dirty(**data, vis=np.ones((100000, 50), complex), epsilon=1e-10, do_wgridding=True, dirty=into)]")
        self.assertEqual(said, "interrupted, untouched\n")

    def test_ctrl_c_ends_the_search_for_a_kernel(self):
        said = self.interrupted(
            "[misfit.vis2dirty(**data, vis=np.ones((100000, 50), complex), epsilon=1e-9, dirty=into, kernel='minimax', kernel_width=18)]")
        self.assertEqual(said, "interrupted, untouched\n")

    def test_ctrl_c_ends_clean(self):
        said = self.interrupted(
            "misfit.clean(**data, vis=random.normal(size=(100000, 50)) + 0j, niter=10**9, gain=1e-5, deconvolver='clark', nthreads=2)")
        self.assertEqual(said, "interrupted, untouched\n")


if __name__ == "__main__":
    unittest.main()
