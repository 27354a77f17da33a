#pragma once

/// The texts of help() for misfit.Kernel. Python takes a first line that is a signature for the signature.
namespace misfit::python::text {

inline constexpr const char* kernel =
    R"(A gridding function C(u) and what follows from it; `misfit.kernel` and `misfit.read_kernel` return one.

It spreads a visibility over W cells of a grid per axis. The image that the FFT makes of the grid is multiplied by the
correction h(x) h(y), and differs from the direct Fourier transform by the map error, which is smallest for this h.

u is in cells of the grid. x is a pixel's offset from the phase centre over the size of the FFT, so that an image, which keeps
the part 2 x0 of what the FFT makes, has |x| <= x0 < 1/2. Errors are squares of relative errors of a one-dimensional
transform: two axes add theirs.)";

inline constexpr const char* name = "str: of the catalogue, see `misfit.kernel_names`.";
inline constexpr const char* width = "int: W, cells that a visibility touches per axis.";
inline constexpr const char* x0 = "float: image size / (2 FFT size), which the function was made for; 1 / (2 padding).";
inline constexpr const char* mean_error = "float: E, the mean of map_error(x) over |x| <= x0.";
inline constexpr const char* max_error = "float: the largest map_error(x) over |x| <= x0.";
inline constexpr const char* degree = "int: of the polynomials that the function is stored as.";

inline constexpr const char* coefficients = R"(numpy.ndarray of float, shape (degree + 1, W), read-only: one polynomial a cell.

C(s_r - t) = sum_d coefficients[d, r] t**d for t in [-1/2, 1/2] and s_r = r - (W - 1)/2. No copy is made.)";

inline constexpr const char* call = R"(__call__(self, u)
--

C(u), the gridding function.

Parameters
----------
u : array_like of float
    Distances from the visibility in cells, of any shape.

Returns
-------
float or numpy.ndarray of float
    Of the shape of `u`; 0 where |u| > W/2. Between two cells, where C may jump, the mean of both sides.)";

inline constexpr const char* taps = R"(taps(self, t)
--

The W values that C takes on the grid around a visibility.

Parameters
----------
t : array_like of float
    Where the visibility is in its cell, in cells from the middle: -1/2 to 1/2, of any shape.

Returns
-------
numpy.ndarray of float, shape t.shape + (W,)
    C(s_r - t) for r = 0 ... W - 1, with s_r = r - (W - 1)/2.

Raises
------
ValueError
    For a `t` that is outside, or not a number.)";

inline constexpr const char* correction = R"(correction(self, x)
--

h(x), the correction that makes the map error smallest.

h(x) = c(x) / sum_n c(x - n)**2, where c(x) is the Fourier transform of C (Ye, Gull, Tan & Nikolic 2020, MNRAS 491, 1146).

Parameters
----------
x : array_like of float
    Offsets from the phase centre in sizes of the FFT, -1/2 to 1/2, of any shape.

Returns
-------
float or numpy.ndarray of float
    Of the shape of `x`. The image is multiplied by h(x) h(y).

Raises
------
ValueError
    For an `x` that is outside, or not a number.)";

inline constexpr const char* map_error = R"(map_error(self, x)
--

l(x), the squared difference to the direct transform, relative to it, along one axis.

The mean over the positions of a visibility in its cell, t in [-1/2, 1/2], of
|1 - h(x) sum_r C(s_r - t) exp(2 pi i (s_r - t) x)|**2 (Ye, Gull, Tan & Nikolic 2020, MNRAS 491, 1146).

Parameters
----------
x : array_like of float
    Offsets from the phase centre in sizes of the FFT, -1/2 to 1/2, of any shape.

Returns
-------
float or numpy.ndarray of float
    Of the shape of `x`.

Raises
------
ValueError
    For an `x` that is outside, or not a number.)";

inline constexpr const char* write = R"(write(self, path, sampling=128, interpolation=3)
--

Write the function as a kernel-table file (FITS), which `misfit image --kernel` and other imagers read.

Parameters
----------
path : str or os.PathLike
    The file, which appears under its name only when complete; one that is there is replaced.
sampling : int
    Rows a cell of the lookup table CONVFUNC, 1 to 1048576.
interpolation : int
    Degree of the polynomial through rows next to each other that a host is to look it up with, 0 to 3.

Raises
------
ValueError
    For a `sampling` or `interpolation` that is outside.
OSError
    Where the file cannot be written.)";

}  // namespace misfit::python::text
