"""CLEAN of visibilities in arrays."""

from typing import NamedTuple, Optional, Tuple

import numpy as np

from . import _arrays, _misfit


class CleanResult(NamedTuple):
    """
    What `clean` makes: arrays of float64, (npix_x, npix_y), NaN beyond the horizon.

    image
        Restored: the model convolved with the beam, and the residual, in Jy/beam.
    residual
        In Jy/beam.
    model
        In Jy/pixel.
    psf
        The point spread function, 1 at the pixel (npix_x // 2, npix_y // 2).
    mask
        Made from the residuals where `usemask` is "auto", else None.
    beam
        Full widths at half maximum of major and minor axis and the position angle, from the axis of x towards that of y, in
        radians.
    report
        iterations, major_cycles, stop_code and stop_reason (tclean's), peak_residual_jy, rms_jy, model_flux_jy, expected_error
        (of the dirty image, RMS over its RMS), samples_used, samples_outside_grid, sum_of_weights.
    """

    image: np.ndarray
    residual: np.ndarray
    model: np.ndarray
    psf: np.ndarray
    mask: Optional[np.ndarray]
    beam: Tuple[float, float, float]
    report: dict


def clean(
    *,
    uvw,
    freq,
    vis,
    wgt=None,
    mask=None,
    npix_x,
    npix_y,
    pixsize_x,
    pixsize_y,
    center_x=0.0,
    center_y=0.0,
    epsilon=1e-6,
    niter=1000,
    gain=0.1,
    threshold=0.0,
    nsigma=0.0,
    deconvolver="hogbom",
    scales=(0,),
    smallscalebias=0.0,
    cyclefactor=1.0,
    minpsffraction=0.05,
    maxpsffraction=0.8,
    cycleniter=-1,
    nmajor=-1,
    clean_mask=None,
    usemask="user",
    startmodel=None,
    do_wgridding=True,
    flip_u=False,
    flip_v=False,
    flip_w=False,
    sigma_min=1.1,
    sigma_max=2.6,
    nthreads=1,
    kernel="least-misfit",
    kernel_width=0,
):
    """
    Image visibilities and CLEAN the image (Cotton–Schwab: major cycles subtract the model from the visibilities).

    Coordinates, weights, masks, pixels and accuracy are those of `vis2dirty`, but for what is said here; CLEAN's parameters have
    the names and meaning of CASA's tclean. The dirty image is divided by the sum of the weights, not by n.

    Parameters
    ----------
    uvw : array of float64, (rows, 3)
        Baselines in metres. Samples beyond 1/(2 pixel) are left out and counted.
    freq : array of float64, (channels,)
        Frequencies in Hz.
    vis : array of complex64 or complex128, (rows, channels)
        Visibilities in Jy; CLEAN takes them in single precision.
    wgt : array of float32 or float64 as `vis` is, (rows, channels), optional
        Weights, 0 or more. They are used as they are: `weighting` is the caller's.
    mask : array of uint8 or bool, (rows, channels), optional
        Where it is 0 samples are left out, as flagged ones are to be.
    npix_x, npix_y : int
        Pixels of the images.
    pixsize_x, pixsize_y : float
        Size of a pixel in radians, one for both: pixels are square.
    center_x, center_y : float
        The middle pixel's x and y, in radians.
    epsilon : float
        Accuracy of images and of predicted visibilities.
    niter : int
        Components to find at most; 0 makes the dirty image.
    gain : float
        Part of a peak that a component takes.
    threshold : float
        Peak of the residual in Jy/beam at which to stop.
    nsigma : float
        The same in units of the residual's robust noise; 0: none.
    deconvolver : str
        "hogbom", "clark" or "multiscale".
    scales : sequence of float
        Of multiscale, in pixels as tclean means them; 0 is a point.
    smallscalebias : float
        By which part the largest scale counts less than points.
    cyclefactor, minpsffraction, maxpsffraction : float
        A minor cycle goes down to the peak × largest sidelobe × `cyclefactor`, that fraction clamped to the other two.
    cycleniter, nmajor : int
        Components of a minor cycle, and major cycles, at most; −1: any number.
    clean_mask : array, (npix_x, npix_y), optional
        Components lie only where it is neither 0 nor NaN.
    usemask : str
        "user": `clean_mask` or everywhere; "auto": made from the residuals, as tclean's auto-multithresh.
    startmodel : array, (npix_x, npix_y), optional
        Model of points that CLEAN begins with, in Jy/pixel.
    do_wgridding : bool
        Whether the w term counts.
    flip_u, flip_v, flip_w : bool
        Whether that coordinate is multiplied by −1.
    sigma_min, sigma_max : float
        Bounds of FFT size over image size.
    nthreads : int
        Threads; 0 for all.
    kernel : str or Kernel
        The gridding function: one of `kernel_names()`, or a kernel.
    kernel_width : int
        Its width in cells; 0: as narrow as `epsilon` allows.

    Returns
    -------
    CleanResult

    Raises
    ------
    TypeError, ValueError
        As `vis2dirty` does.
    RuntimeError
        Where no sample can be used, or no beam fits the point spread function.
    """
    vis = _arrays.table(vis, "vis", (np.complex64, np.complex128))
    real = np.float32 if vis.dtype == np.complex64 else np.float64
    uvw, freq = _arrays.coordinates(uvw, freq)
    shape = (npix_x, npix_y)
    if usemask not in ("user", "auto"):
        raise ValueError(f"usemask {usemask!r}, expected 'user' or 'auto'")
    if usemask == "auto" and clean_mask is not None:
        raise ValueError("a clean_mask beside usemask 'auto', expected one of them")
    options = dict(
        npix_x=npix_x, npix_y=npix_y, pixsize_x=pixsize_x, pixsize_y=pixsize_y, center_x=center_x, center_y=center_y,
        epsilon=epsilon, in_double=False, divide_by_n=False, do_wgridding=do_wgridding, flip_u=flip_u, flip_v=flip_v,
        flip_w=flip_w, sigma_min=sigma_min, sigma_max=sigma_max, nthreads=nthreads, kernel=kernel, kernel_width=kernel_width,
        niter=niter, gain=gain, threshold=threshold, nsigma=nsigma, deconvolver=deconvolver, scales=list(scales),
        smallscalebias=smallscalebias, cyclefactor=cyclefactor, minpsffraction=minpsffraction, maxpsffraction=maxpsffraction,
        cycleniter=cycleniter, nmajor=nmajor, automask=usemask == "auto",
    )
    images = (_arrays.image(clean_mask, "clean_mask", shape), _arrays.image(startmodel, "startmodel", shape))
    made = _misfit.clean(uvw, freq, _arrays.mask_table(mask), vis, _arrays.optional_table(wgt, "wgt", (real,)), images, options)
    return CleanResult(mask=made.pop("mask", None), **made)
