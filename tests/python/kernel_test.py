"""Laws of misfit.kernel() and of what it returns."""

import doctest
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

import misfit

WIDTHS = {"nearest": 1, "linear": 2, "sinc": 8, "gaussian": 8, "gaussian-sinc": 8}  # of families that have one only

# Origin: the project's file of reference values for least-misfit functions, by an independent solver in 130-digit arithmetic:
# (width, x0), E, largest l, h at x = 0, x0/4, x0/2, 3 x0/4, x0, and C(u) at u = W (100 j + 37)/4000 for j = 0, 5, 10, 15, 19.
REFERENCE = [
    ((7, 0.25), 1.454393338898045e-14, 2.9049029083679486e-13,
     [1.0, 1.059953767606033, 1.2638550670918656, 1.7019219783445798, 2.606615217559959],
     [0.44762409630962374, 0.26101131802159283, 0.05361370678250659, 0.0024858734659389, 1.3588424945683145e-05]),
    ((4, 0.4), 1.266583628838586e-05, 0.0002126688215375257,
     [1.0, 1.103431859423259, 1.4951853677934686, 2.563887105209391, 5.969294733436609],
     [0.5343467107619514, 0.42293109794532213, 0.21160003926331616, 0.0568081329106352, 0.006145047572940095]),
]


def all_kernels():
    """One of each family, of odd and even widths where it has both."""
    for name in misfit.kernel_names() + ["spheroidal-exact-0.3"]:
        for width in [WIDTHS[name]] if name in WIDTHS else [5, 6]:
            yield misfit.kernel(name, width, 0.3)


def horner(kernel, t):
    """The taps at t by the definition of `coefficients`."""
    value = 0
    for row in kernel.coefficients[::-1]:
        value = value * np.asarray(t)[..., np.newaxis] + row
    return value


def response(kernel, x):
    """Sum_r C(s_r - t) exp(2 pi i (s_r - t) x) as [x][t], at the nodes t of a Gauss-Legendre rule with the weights returned."""
    node, weight = np.polynomial.legendre.leggauss(60)
    t = node / 2
    s = np.arange(kernel.width) - (kernel.width - 1) / 2
    u = s - t[:, np.newaxis]
    return np.einsum("tr,xtr->xt", horner(kernel, t), np.exp(2j * np.pi * u * x[:, np.newaxis, np.newaxis])), weight / 2


def correction_and_map_error(kernel, x):
    """h and l by their definitions: c(x) is the mean of the response over t, sum_n c(x - n)**2 that of its square."""
    seen, weight = response(kernel, x)
    h = seen.real @ weight / (np.abs(seen) ** 2 @ weight)
    return h, np.abs(1 - h[:, np.newaxis] * seen) ** 2 @ weight


class Values(unittest.TestCase):
    def test_taps_are_the_polynomials(self):
        t = np.linspace(-0.5, 0.5, 31)
        for kernel in all_kernels():
            with self.subTest(kernel=kernel):
                self.assertEqual(kernel.degree, len(kernel.coefficients) - 1)
                np.testing.assert_allclose(kernel.taps(t), horner(kernel, t), rtol=0, atol=1e-15)

    def test_the_function_is_that_of_the_taps(self):
        t = np.linspace(-0.49, 0.49, 25)
        for kernel in all_kernels():
            s = np.arange(kernel.width) - (kernel.width - 1) / 2
            with self.subTest(kernel=kernel):  # u = s - t has lost the last digits of t
                np.testing.assert_allclose(kernel(s - t[:, np.newaxis]), kernel.taps(t), rtol=0, atol=1e-14)

    def test_the_function_is_even(self):
        u = np.linspace(0, 5, 1001)
        for kernel in all_kernels():
            np.testing.assert_array_equal(kernel(-u), kernel(u))

    def test_between_cells_the_function_is_the_mean_of_both_sides(self):
        for kernel in all_kernels():
            left, right = kernel.taps(-0.5), kernel.taps(0.5)
            edges = np.arange(1, kernel.width) - kernel.width / 2
            np.testing.assert_array_equal(kernel(edges), (left[:-1] + right[1:]) / 2)
            self.assertEqual(kernel(kernel.width / 2), left[-1])  # the limit from inside
            self.assertEqual(kernel(np.nextafter(kernel.width / 2, 9)), 0)

    def test_correction_and_map_error_keep_to_their_definitions(self):
        x = np.linspace(-0.45, 0.45, 19)
        for kernel in all_kernels():
            h, error = correction_and_map_error(kernel, x)
            with self.subTest(kernel=kernel):
                rounding = 5e-15 * kernel.width * np.abs(h)  # of h times a sum of W terms, and of their phases
                np.testing.assert_array_less(np.abs(kernel.correction(x) / h - 1), 1e-13)
                np.testing.assert_array_less(np.abs(np.sqrt(kernel.map_error(x)) - np.sqrt(error)), rounding)

    def test_mean_and_largest_error_are_those_of_the_map_error(self):
        node, weight = np.polynomial.legendre.leggauss(48)
        for kernel in all_kernels():
            inside = kernel.map_error(kernel.x0 * (node + 1) / 2)
            with self.subTest(kernel=kernel):
                self.assertAlmostEqual(inside @ weight / 2 / kernel.mean_error, 1, delta=1e-9)
                self.assertLessEqual(inside.max(), kernel.max_error * (1 + 1e-9))
                self.assertGreaterEqual(kernel.max_error * (1 + 1e-9), kernel.map_error(kernel.x0))

    def test_blocks_leave_no_seams(self):
        kernel = misfit.kernel()
        x = np.linspace(-0.25, 0.25, 1003)
        np.testing.assert_allclose(kernel.correction(x), [kernel.correction(at) for at in x], rtol=1e-14)

    def test_least_misfit_functions_equal_an_independent_solution(self):
        for (width, x0), mean, largest, h, values in REFERENCE:
            kernel = misfit.kernel("least-misfit", width, x0)
            u = width * (100 * np.array([0, 5, 10, 15, 19]) + 37) / 4000
            self.assertAlmostEqual(kernel.mean_error / mean, 1, delta=1e-6)  # what polynomials may cost is 1e-7
            self.assertAlmostEqual(kernel.max_error / largest, 1, delta=1e-4)
            np.testing.assert_allclose(kernel.correction(x0 * np.arange(5) / 4), h, rtol=1e-9)
            np.testing.assert_allclose(kernel(u), values, rtol=0, atol=1e-9)


class Arrays(unittest.TestCase):
    kernel = misfit.kernel(width=6)
    functions = [kernel, kernel.correction, kernel.map_error]

    def test_results_have_the_shape_of_the_argument(self):
        for shape in [(), (1,), (2, 3), (2, 0, 4)]:
            for function in self.functions:
                self.assertEqual(np.shape(function(np.full(shape, 0.1))), shape)
            self.assertEqual(self.kernel.taps(np.full(shape, 0.1)).shape, shape + (6,))

    def test_a_number_gives_a_number(self):
        for function in self.functions:
            for number in [0.1, 0, np.float32(0.1), np.array(0.1)]:
                self.assertIsInstance(function(number), float)

    def test_all_real_types_give_doubles(self):
        for dtype in [np.float64, np.float32, np.int32, ">f8"]:
            for function in self.functions + [self.kernel.taps]:
                result = function(np.array([0, 0.25]).astype(dtype))
                np.testing.assert_array_equal(result, function([0, float(np.array(0.25).astype(dtype))]))
                self.assertEqual(result.dtype, np.float64)

    def test_strides_do_not_matter(self):
        x = np.linspace(-0.4, 0.4, 60).reshape(5, 12)
        for function in self.functions + [self.kernel.taps]:
            for view in [x.T, x[::-1, ::3], np.asfortranarray(x), np.broadcast_to(x[0], (3, 12))]:
                np.testing.assert_array_equal(function(view), function(view.copy(order="C")))

    def test_coefficients_are_the_numbers_themselves_and_outlive_the_kernel(self):
        kernel = misfit.kernel(width=5)
        view = kernel.coefficients
        self.assertTrue(np.shares_memory(view, kernel.coefficients))
        before = view.copy()
        del kernel
        np.testing.assert_array_equal(view, before)
        with self.assertRaisesRegex(ValueError, "read-only"):
            view[0, 0] = 1

    def test_a_kernel_does_not_change(self):
        for name in ["name", "width", "x0", "mean_error", "max_error", "degree", "coefficients"]:
            with self.assertRaises(AttributeError):
                setattr(self.kernel, name, getattr(self.kernel, name))


class Errors(unittest.TestCase):
    def test_an_unknown_name_lists_the_known(self):
        with self.assertRaises(ValueError) as caught:
            misfit.kernel("best")
        for name in ['"best"'] + misfit.kernel_names():
            self.assertIn(name, str(caught.exception))

    def test_what_a_family_does_not_have_is_named(self):
        for arguments, message in [
            ({"width": 21}, "width 21, expected 1 to 20"),
            ({"width": 0}, "width 0, expected 1 to 20"),
            ({"name": "spheroidal", "width": 9}, "width 9, expected 4 to 8"),
            ({"x0": 0.5}, "x0 = 0.5, expected 0.01 to 0.49"),
            ({"x0": float("nan")}, "x0 = nan, expected"),
            ({"name": "spheroidal-exact-11"}, "spheroidal-exact-11"),
        ]:
            with self.assertRaisesRegex(ValueError, message):
                misfit.kernel(**arguments)

    def test_wrong_keywords_and_types_are_type_errors(self):
        with self.assertRaisesRegex(TypeError, "widht"):
            misfit.kernel(widht=7)
        kernel = misfit.kernel()
        for function in [lambda v: misfit.kernel(width=v), kernel, kernel.taps, kernel.correction, kernel.map_error]:
            for value in [1j, "wide", [[1], [1, 2]]]:
                with self.assertRaises(TypeError):
                    function(value)

    def test_places_outside_are_named(self):
        kernel = misfit.kernel()
        for function in [kernel.taps, kernel.correction, kernel.map_error]:
            for value, text in [(0.51, "0.51"), (-7, "-7"), (float("nan"), "nan"), (float("inf"), "inf")]:
                with self.assertRaisesRegex(ValueError, f" = {text} not in \\[-0.5, 0.5\\]"):
                    function([0, value])

    def test_the_function_is_0_beyond_its_width_and_unknown_where_u_is(self):
        np.testing.assert_array_equal(misfit.kernel()([3.6, -1e300, np.inf, -np.inf, np.nan]), [0, 0, 0, 0, np.nan])


class Files(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def assert_same(self, a, b):
        for name in ["name", "width", "x0", "mean_error", "max_error", "degree"]:
            self.assertEqual(getattr(a, name), getattr(b, name))
        np.testing.assert_array_equal(a.coefficients, b.coefficients)

    def test_a_kernel_comes_back_bit_for_bit(self):
        for path in [self.folder / "k.fits", str(self.folder / "l.fits")]:
            for kernel in [misfit.kernel(width=4, x0=0.4), misfit.kernel("gaussian", 8)]:
                kernel.write(path, sampling=16, interpolation=1)
                self.assert_same(misfit.read_kernel(path), kernel)

    def test_solved_kernels_are_kept(self):
        code = "import misfit; misfit.kernel(width=9, x0=0.31); print(misfit.kernel(width=9, x0=0.31).coefficients.sum().hex())"
        environment = dict(os.environ, MISFIT_CACHE=str(self.folder))
        outputs = [subprocess.check_output([sys.executable, "-c", code], env=environment) for _ in range(2)]
        self.assertEqual(outputs[0], outputs[1])
        self.assertEqual(len(list(self.folder.glob("least-misfit-w9-*.fits"))), 1)

    def test_files_that_cannot_be_used_are_os_errors(self):
        with self.assertRaisesRegex(FileNotFoundError, "absent.fits"):
            misfit.read_kernel(self.folder / "absent.fits")
        path = self.folder / "k.fits"
        misfit.kernel().write(path)
        whole = path.read_bytes()
        for content in [b"no FITS file", whole[:5000], whole.replace(b"X0      =", b"X1      =")]:
            path.write_bytes(content)
            with self.assertRaisesRegex(OSError, "k.fits"):
                misfit.read_kernel(path)
        with self.assertRaisesRegex(OSError, "no-folder"):
            misfit.kernel().write(self.folder / "no-folder" / "k.fits")
        for wrong in [{"sampling": 0}, {"interpolation": 4}]:
            with self.assertRaisesRegex(ValueError, "expected"):
                misfit.kernel().write(path, **wrong)


def load_tests(loader, tests, pattern):
    import misfit._kernels
    tests.addTests(doctest.DocTestSuite(misfit._kernels))
    return tests


if __name__ == "__main__":
    unittest.main()
