"""Laws of misfit.clean()."""

import unittest

import numpy as np
from direct_sums import SPEED_OF_LIGHT

import misfit

PIXEL, SIZE = 1e-5, (96, 110)
FLUXES = {(60, 40): 1.0, (30, 70): 0.5, (48, 55): -0.2}  # Jy by pixel


def data(single=False):
    """Visibilities of the points in FLUXES, exact."""
    random = np.random.default_rng(2)
    uvw = random.normal(size=(1500, 3)) * np.array([1.0, 0.6, 3.0]) * 0.1 * SPEED_OF_LIGHT / (PIXEL * 1e9)
    freq = np.array([1e9, 1.1e9])
    vis = 0
    for (i, j), flux in FLUXES.items():
        x, y = (i - SIZE[0] // 2) * PIXEL, (j - SIZE[1] // 2) * PIXEL
        nm1 = np.sqrt(1 - x * x - y * y) - 1
        vis = vis + flux * np.exp(-2j * np.pi / SPEED_OF_LIGHT * np.outer(uvw @ [x, y, -nm1], freq))
    return dict(uvw=uvw, freq=freq, vis=vis.astype(np.complex64 if single else np.complex128))


def cleaned(**changes):
    options = dict(data(), npix_x=SIZE[0], npix_y=SIZE[1], pixsize_x=PIXEL, pixsize_y=PIXEL, niter=2000, threshold=1e-3)
    options.update(changes)
    return misfit.clean(**options)


class Clean(unittest.TestCase):
    def test_finds_points_and_their_fluxes(self):
        for changes in ({}, {"nthreads": 2, **data(single=True)}, {"deconvolver": "clark"},
                        {"deconvolver": "multiscale", "scales": (0, 5)}):
            result = cleaned(**changes)
            with self.subTest(changes=list(changes)):
                self.assertEqual(result.report["stop_code"], 2)
                self.assertLessEqual(np.abs(result.residual).max(), 1.02e-3)
                for pixel, flux in FLUXES.items():
                    self.assertAlmostEqual(result.image[pixel], flux, delta=4e-3)
                self.assertAlmostEqual(result.model.sum(), sum(FLUXES.values()), delta=1e-2)

    def test_images_have_their_shape_and_the_psf_its_peak(self):
        result = cleaned(niter=10)
        for image in (result.image, result.residual, result.model, result.psf):
            self.assertEqual(image.shape, SIZE)
        self.assertAlmostEqual(result.psf[SIZE[0] // 2, SIZE[1] // 2], 1, delta=1e-6)
        self.assertEqual(result.report["iterations"], 10)
        self.assertEqual(result.report["stop_code"], 1)
        self.assertIsNone(result.mask)

    def test_the_beam_lies_as_the_psf_does(self):
        major, minor, angle = cleaned(niter=1).beam
        self.assertGreater(major, 1.3 * minor)  # u reaches farther than v: the beam is longest along y
        self.assertAlmostEqual(abs(angle), np.pi / 2, delta=0.1)

    def test_components_keep_to_the_mask(self):
        mask = np.zeros(SIZE, bool)
        mask[55:65, 35:45] = True
        result = cleaned(clean_mask=mask, niter=100)
        self.assertFalse(result.model[~mask].any())
        self.assertTrue(result.model[mask].any())

    def test_a_mask_is_made_where_it_is_asked_for(self):
        result = cleaned(usemask="auto")
        self.assertEqual(result.mask.shape, SIZE)
        self.assertEqual(result.mask[60, 40], 1)

    def test_goes_on_from_a_start_model(self):
        start = np.zeros(SIZE)
        for pixel, flux in FLUXES.items():
            start[pixel] = flux
        result = cleaned(startmodel=start)
        self.assertEqual(result.report["iterations"], 0)
        self.assertTrue((result.model == start).all())

    def test_without_components_the_residual_is_the_dirty_image(self):
        result = cleaned(niter=0)
        dirty = misfit.vis2dirty(**data(), npix_x=SIZE[0], npix_y=SIZE[1], pixsize_x=PIXEL, pixsize_y=PIXEL, epsilon=1e-7,
                                 do_wgridding=True, divide_by_n=False)
        difference = result.residual - dirty / result.report["sum_of_weights"]
        self.assertLessEqual(np.linalg.norm(difference), 1.2e-6 * np.linalg.norm(result.residual))

    def test_refusals_say_why(self):
        for message, changes in (
            ("expected square ones", {"pixsize_x": 2 * PIXEL}),
            ("usemask 'no'", {"usemask": "no"}),
            ("clean_mask has the shape (3, 3), expected (96, 110)", {"clean_mask": np.ones((3, 3))}),
            ("weights of 0 or more", {"wgt": -np.ones((1500, 2))}),
            ("no-such", {"deconvolver": "no-such"}),
            ("niter -1: expected 0 or more", {"niter": -1}),
            ("gain 5: expected more than 0 and at most 1", {"gain": 5.0}),
            ("threshold nan: expected 0 or more", {"threshold": np.nan}),
            ("maxpsffraction 0.01: expected at most 1, and at least minpsffraction, 0.05", {"maxpsffraction": 0.01}),
            ("cycleniter 0", {"cycleniter": 0}),
            ("expected multiscale", {"scales": (0, 5)}),
            ("expected 0 to 96", {"deconvolver": "multiscale", "scales": (0, 1e9)}),
            ("startmodel is not finite", {"startmodel": np.full(SIZE, np.nan)}),
        ):
            with self.subTest(message), self.assertRaises(ValueError) as raised:
                cleaned(**changes)
            self.assertIn(message, str(raised.exception))
        with self.assertRaisesRegex(TypeError, "clean_mask is 'circle.*', expected an array.*misfit image --mask"):
            cleaned(clean_mask="circle [[50pix, 50pix], 5pix]")
        with self.assertRaisesRegex(RuntimeError, "visibilit.*expected at least one"):
            cleaned(mask=np.zeros((1500, 2), np.uint8))


if __name__ == "__main__":
    unittest.main()
