"""Images from visibilities in arrays, and back."""

import numbers
import warnings

import numpy as np

from . import _arrays, _misfit

SINGLE_FROM = 1e-6  # no less is asked of single precision


class AccuracyWarning(UserWarning):
    """An image may err by more than `epsilon` of itself, since its data nearly cancel."""


def _options(epsilon, single, double_precision_accumulation, **others):
    """Return the options of a transform in the precision of its data."""
    if not isinstance(epsilon, numbers.Real):
        raise TypeError(f"epsilon is {epsilon!r}, expected a number")
    if single and 0 < epsilon < SINGLE_FROM:
        raise ValueError(f"epsilon {epsilon:g} of single-precision data, expected {SINGLE_FROM:g} or more, or data in double precision")
    return dict(epsilon=epsilon, in_double=not single or double_precision_accumulation, **others)


IN_PYTHON = {"--kernel-width": "kernel_width", "--padding": "sigma_min and sigma_max", "accuracy": "epsilon",
             "paddings from": "sigma_min and sigma_max"}


def _planned(uvw, freq, mask, options):
    """Return the transform; where it cannot be planned, with the names of keywords in what is said."""
    try:
        return _misfit.Transform(uvw, freq, mask, options)
    except ValueError as error:
        message = str(error)
    for name, keyword in IN_PYTHON.items():
        message = message.replace(name, keyword)
    raise ValueError(message)


def _print_plan(transform):
    print("gridding, with v along x and u along y:")
    for item, decision, because in transform.plan():
        print(f"{item}: {decision} ({because})")


def _image_size(npix_x, npix_y, dirty):
    """Return the image's size: what is given, or that of the array for the result."""
    if dirty is None:
        return npix_x, npix_y
    if not isinstance(dirty, np.ndarray) or dirty.ndim != 2:
        raise TypeError(f"dirty is {_arrays.describe(dirty)}, expected an array with two axes")
    for name, npix, size in (("npix_x", npix_x, dirty.shape[0]), ("npix_y", npix_y, dirty.shape[1])):
        if npix not in (0, size):
            raise ValueError(f"{name} is {npix}, expected {size}, which dirty has, or 0")
    return dirty.shape


def vis2dirty(
    *,
    uvw,
    freq,
    vis,
    wgt=None,
    mask=None,
    npix_x=0,
    npix_y=0,
    pixsize_x,
    pixsize_y,
    center_x=0.0,
    center_y=0.0,
    epsilon,
    do_wgridding=False,
    flip_u=False,
    flip_v=False,
    flip_w=False,
    divide_by_n=True,
    sigma_min=1.1,
    sigma_max=2.6,
    nthreads=1,
    verbosity=0,
    double_precision_accumulation=False,
    dirty=None,
    kernel="least-misfit",
    kernel_width=0,
):
    """
    Make a dirty image of visibilities, with the keywords of ducc0.wgridder.

    The image is I(x, y) = Σ wgt Re[vis exp(+2πi(ux + vy − w(n−1)))] / n, with u, v, w = uvw freq / c and n = √(1 − x² − y²): not
    divided by the sum of the weights. Pixel [i, j] lies at x = center_x + (i − npix_x // 2) pixsize_x, and y in the same way.

    Parameters
    ----------
    uvw : array of float64, (rows, 3)
        Baselines in metres.
    freq : array of float64, (channels,)
        Frequencies in Hz.
    vis : array of complex64 or complex128, (rows, channels)
        Visibilities. They are read where they lie where rows and channels follow each other in this order and weights are none or
        single ones of 0 or more, else copied some millions at a time.
        Single-precision ones give a single-precision image.
    wgt : array of float32 or float64 as `vis` is, (rows, channels), optional
        Weights, by which visibilities are multiplied.
    mask : array of uint8 or bool, (rows, channels), optional
        Where it is 0 samples are left out, whatever they hold.
    npix_x, npix_y : int
        Pixels of the image, 1 or more, even or odd; 0 where `dirty` is given.
    pixsize_x, pixsize_y : float
        Sizes of a pixel in radians, as direction cosines at the phase centre.
    center_x, center_y : float
        The middle pixel's x and y, in radians.
    epsilon : float
        Accuracy: the root mean square of image minus exact image, over that of the exact image, where the data's phases are
        random; at least 1e-6 for complex64.
    do_wgridding : bool
        Whether the w term counts; otherwise w is taken as 0, and n as 1.
    flip_u, flip_v, flip_w : bool
        Whether that coordinate is multiplied by −1.
    divide_by_n : bool
        Whether pixels are divided by n.
    sigma_min, sigma_max : float
        Bounds of FFT size over image size, from which padding is chosen; FFTs of the next size that is quick may exceed them a little.
    nthreads : int
        Threads; 0 for all. The result has the same bits for any number.
    verbosity : int
        1 prints the plan: every decision with its reason.
    double_precision_accumulation : bool
        Whether single-precision data are gridded in double precision.
    dirty : array of float32 or float64 as `vis` is, (npix_x, npix_y), optional
        Where the image is written to.
    kernel : str or Kernel
        The gridding function: one of `kernel_names()`, or a kernel.
    kernel_width : int
        Its width in cells; 0: as narrow as `epsilon` allows.

    Returns
    -------
    array of float32 or float64, (npix_x, npix_y)
        The image, `dirty` where that was given. Pixels beyond the horizon are 0.

    Warns
    -----
    AccuracyWarning
        Where data cancel, so that the image is weaker than random phases make it and `epsilon` may not be kept.

    Raises
    ------
    TypeError
        For arrays of another type.
    ValueError
        For shapes that do not agree, values that are not finite, and an `epsilon` that cannot be reached.

    Notes
    -----
    Ctrl-C ends it, with what it had written left as it is, and other Python threads run meanwhile. `dirty2vis` with the same coordinates, masks and
    options is its adjoint up to rounding. `allow_nshift` and `gpu` of ducc0 are not here: the one speeds w planes up, which facets do.
    """
    vis = _arrays.table(vis, "vis", (np.complex64, np.complex128))
    single = vis.dtype == np.complex64
    real = np.float32 if single else np.float64
    npix_x, npix_y = _image_size(npix_x, npix_y, dirty)
    if dirty is not None:
        _arrays.result(dirty, "dirty", real, (npix_x, npix_y))
    uvw, freq = _arrays.coordinates(uvw, freq)
    wgt = _arrays.optional_table(wgt, "wgt", (real,))
    options = _options(
        epsilon, single, double_precision_accumulation,
        npix_x=npix_x, npix_y=npix_y, pixsize_x=pixsize_x, pixsize_y=pixsize_y, center_x=center_x, center_y=center_y,
        do_wgridding=do_wgridding, flip_u=flip_u, flip_v=flip_v, flip_w=flip_w, divide_by_n=divide_by_n,
        sigma_min=sigma_min, sigma_max=sigma_max, nthreads=nthreads, kernel=kernel, kernel_width=kernel_width,
    )
    transform = _planned(uvw, freq, _arrays.mask_table(mask), options)
    if verbosity > 0:
        _print_plan(transform)
    image, expected_error = transform.vis2dirty(vis, wgt, dirty)
    if expected_error > epsilon:
        warnings.warn(f"the data nearly cancel: the image may err by {expected_error:.2g} of itself, epsilon is {epsilon:g}",
                      AccuracyWarning, stacklevel=2)
    return image


def dirty2vis(
    *,
    uvw,
    freq,
    dirty,
    wgt=None,
    mask=None,
    pixsize_x,
    pixsize_y,
    center_x=0.0,
    center_y=0.0,
    epsilon,
    do_wgridding=False,
    flip_u=False,
    flip_v=False,
    flip_w=False,
    divide_by_n=True,
    sigma_min=1.1,
    sigma_max=2.6,
    nthreads=1,
    verbosity=0,
    double_precision_accumulation=False,
    vis=None,
    kernel="least-misfit",
    kernel_width=0,
):
    """
    Predict the visibilities of an image, with the keywords of ducc0.wgridder.

    They are wgt Σ I(x, y) / n exp(−2πi(ux + vy − w(n−1))); `vis2dirty` says where pixels lie, and has what is not said here.

    Parameters
    ----------
    uvw : array of float64, (rows, 3)
        Baselines in metres.
    freq : array of float64, (channels,)
        Frequencies in Hz.
    dirty : array of float32 or float64, (npix_x, npix_y)
        The image. Pixels beyond the horizon are not looked at.
    wgt : array of the type of `dirty`, (rows, channels), optional
        What the visibilities are multiplied by.
    mask : array of uint8 or bool, (rows, channels), optional
        Where it is 0 nothing is predicted: the visibilities are 0.
    pixsize_x, pixsize_y, center_x, center_y : float
        Pixels' sizes and the middle pixel's place, in radians.
    epsilon : float
        Accuracy: the root mean square of visibilities minus exact ones, over that of the exact ones, where pixels or phases are
        random; at least 1e-6 for float32.
    do_wgridding, flip_u, flip_v, flip_w, divide_by_n : bool
        As in `vis2dirty`.
    sigma_min, sigma_max : float
        As in `vis2dirty`.
    nthreads, verbosity : int
        As in `vis2dirty`.
    double_precision_accumulation : bool
        Whether a single-precision image is transformed in double precision.
    vis : array of complex64 or complex128 as `dirty` is, (rows, channels), optional
        Where the visibilities are written to.
    kernel : str or Kernel
        As in `vis2dirty`.
    kernel_width : int
        As in `vis2dirty`.

    Returns
    -------
    array of complex64 or complex128, (rows, channels)
        The visibilities, `vis` where that was given.

    Raises
    ------
    TypeError, ValueError
        As `vis2dirty` does.
    """
    dirty = _arrays.table(dirty, "dirty", (np.float32, np.float64))
    single = dirty.dtype == np.float32
    uvw, freq = _arrays.coordinates(uvw, freq)
    wgt = _arrays.optional_table(wgt, "wgt", (dirty.dtype,))
    vis = _arrays.result(vis, "vis", np.complex64 if single else np.complex128, (len(uvw), len(freq)))
    if wgt is not None and np.may_share_memory(vis, wgt):
        raise ValueError("vis and wgt share memory, expected arrays of their own")
    options = _options(
        epsilon, single, double_precision_accumulation,
        npix_x=dirty.shape[0], npix_y=dirty.shape[1], pixsize_x=pixsize_x, pixsize_y=pixsize_y,
        center_x=center_x, center_y=center_y, do_wgridding=do_wgridding, flip_u=flip_u, flip_v=flip_v, flip_w=flip_w,
        divide_by_n=divide_by_n, sigma_min=sigma_min, sigma_max=sigma_max, nthreads=nthreads, kernel=kernel,
        kernel_width=kernel_width,
    )
    transform = _planned(uvw, freq, _arrays.mask_table(mask), options)
    if verbosity > 0:
        _print_plan(transform)
    transform.dirty2vis(dirty, wgt, vis)
    return vis
