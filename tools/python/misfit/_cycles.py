"""CLEAN by hand: a major cycle at a time, within masks that are drawn between."""

import os

import numpy as np

from . import _program, _tclean


def _fits():
    try:
        from astropy.io import fits
    except ImportError:
        raise ImportError("clean_cycles() reads and writes images by astropy, which is not there (package python3-astropy)") from None
    return fits


class CleanCycle:
    """
    CLEAN between two major cycles.

    Attributes
    ----------
    number : int
        Major cycles so far.
    residual : array of float64, (planes of frequency, Stokes parameters, height, width)
        In Jy/beam; of nterms that of the first term.
    mask : array of the same shape, or None
        Where the next cycle finds components: where it is neither 0 nor NaN; None: everywhere. To be set.
    noise : float
        Robust noise of the residual of the first plane, in Jy/beam.
    result : dict
        What `tclean` would return now.
    """

    __slots__ = ("number", "residual", "mask", "noise", "result")

    def __init__(self, number, residual, mask, result):
        self.number, self.residual, self.mask, self.result = number, residual, mask, result
        self.noise = result["misfit"]["noise"]["measured_jy"]


def _given_mask(mask, shape):
    mask = np.broadcast_to(np.asarray(mask, dtype=np.float32), shape)
    return np.where(np.isfinite(mask) & (mask != 0), np.float32(1), np.float32(0))


def clean_cycles(vis, **parameters):
    """
    CLEAN a major cycle at a time: look at the residual, draw a mask, go on.

    Yields before the first major cycle and after each, and ends where CLEAN does. Whoever leaves the loop earlier has the images
    of the cycles until then. Every cycle is a run of its own, which makes the dirty image and the PSF anew.

    Parameters
    ----------
    vis : path or list of paths
        MeasurementSets.
    parameters : various
        Those of `tclean`, but for `mask`, `nmajor`, `restart`, `calcpsf`, `calcres` and `dryrun`: CLEAN begins anew, and images
        are FITS files where `outformat` is not "both". `niter` is that of all cycles together.

    Yields
    ------
    CleanCycle
        Whose `mask` the next cycle keeps to.

    Raises
    ------
    ValueError, RuntimeError, KeyboardInterrupt
        As `tclean` does; ValueError also where there is a model of that imagename.
    ImportError
        Without astropy.
    """
    fits = _fits()
    for name in ("mask", "nmajor", "restart", "calcpsf", "calcres", "dryrun"):
        if name in parameters:
            raise ValueError(f"{name}={parameters[name]!r}: expected none, as clean_cycles() decides it")
    parameters.setdefault("outformat", "fits")
    if parameters["outformat"] == "casa":
        raise ValueError("outformat='casa': expected 'fits' or 'both', of which clean_cycles() reads the residual")
    p = {**_tclean.defaults(), "vis": vis, **parameters}
    first = _tclean.tclean(vis, **{**parameters, "niter": 0})
    name = os.fspath(p["imagename"])
    end = ".tt0" if p["deconvolver"] == "mtmfs" else ""
    if first["misfit"]["clean"] is not None:
        raise ValueError(f"imagename={name!r}: expected one without a model, as CLEAN begins anew")

    def residual():
        pixels = fits.getdata(f"{name}.residual{end}.fits").astype(float)
        return pixels if pixels.ndim == 4 else pixels.reshape((1,) * (4 - pixels.ndim) + pixels.shape)

    cycle, kept = CleanCycle(0, residual(), None, first), None
    yield cycle
    while True:
        before, mask = cycle.result["misfit"]["clean"], None
        drawn = None if cycle.mask is None else _given_mask(cycle.mask, cycle.residual.shape)
        same = (drawn is None) == (kept is None) and np.array_equal(drawn, kept)
        if drawn is not None:
            mask = f"{name}.drawn.fits"
            header = fits.getheader(f"{name}.residual{end}.fits")
            header["BUNIT"] = ""
            fits.writeto(mask, drawn, header, overwrite=True)
        # With another mask the program counts major cycles anew.
        words = _tclean.words_of_cycle(p, 1 + (before["major_cycles"] if before is not None and same else 0), mask)
        with _program.turn.taken():
            report, said = _program.run(words if before is None else [*words, "--restart"])
        _program.tell_all(said)
        cycle, kept = CleanCycle(cycle.number + 1, residual(), cycle.mask, _tclean.dictionary(report, p)), drawn
        yield cycle
        if report["clean"]["stop_code"] != 9:  # that of its one major cycle
            return
