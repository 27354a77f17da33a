"""CASA's tclean, as misfit does it."""

import inspect
import logging
import numbers
import os
import re
from pathlib import Path

import numpy as np

from . import _program

_log = logging.getLogger("misfit")

# Parameters that change nothing here, with tclean's defaults and why.
_UNNEEDED = {
    "wprojplanes": (1, "w is exact with all gridders but 'standard', whatever their number"),
    "aterm": (True, "it is of gridder='awproject', which is not offered"),
    "psterm": (False, "it is of gridder='awproject', which is not offered"),
    "wbawp": (True, "mosaics have each frequency's own beam"),
    "conjbeams": (False, "mosaics have each frequency's own beam, and so the Taylor terms of the sky alone"),
    "cfcache": ("", "convolution functions are not kept"),
    "computepastep": (360.0, "it is of gridder='awproject', which is not offered"),
    "rotatepastep": (360.0, "it is of gridder='awproject', which is not offered"),
    "pointingoffsetsigdev": ([], "it is of gridder='awproject', which is not offered"),
    "parallel": (False, "all cores share a run in any case"),
    "verbose": (False, "how masks grew stands in the report, under misfit, cycle by cycle"),
}
_told = set()  # what was said once

# Likewise those of mosaics, with other gridders.
_UNNEEDED_ALONE = {
    "vptable": ("", "primary beams are chosen by telescope, or by beam"),
    "mosweight": (True, "it is of gridder='mosaic'"),
    "normtype": ("flatnoise", "it is of gridder='mosaic'"),
}

# Parameters that can have one value so far, with what else they might be.
_SINGLE = {
    "projection": ("SIN", "other projections are not made"),
    "outlierfile": ("", "one field is imaged at a time"),
    "interactive": (False, "misfit.clean_cycles() is CLEAN by hand"),
}

_GRIDDERS = {"standard": "standard", "ft": "standard", "gridft": "standard", "wproject": "wide", "widefield": "wide",
             "wprojectft": "wide", "auto": "auto", "mosaic": "mosaic", "mosaicft": "mosaic", "ftmosaic": "mosaic"}
_NOT_OFFERED = ("awproject", "awprojectft", "awp2", "awphpg")
_WEIGHTINGS = ("natural", "uniform", "superuniform", "briggs", "briggsbwtaper", "briggsabs")
_DECONVOLVERS = ("hogbom", "clark", "multiscale", "mtmfs")
_TEXTS = ("projection", "specmode", "outframe", "veltype", "interpolation", "gridder", "normtype", "deconvolver", "weighting",
          "usemask", "savemodel", "outformat", "outlierfile", "vptable", "cfcache")
_SELECTION = ("field", "spw", "timerange", "uvrange", "antenna", "scan", "observation", "intent")
_COLUMNS = {"corrected": "auto", "data": "data", "observed": "data", "model": "model"}


def _refuse(name, value, expected):
    raise ValueError(f"{name}={value!r}: expected {expected}")


def _is_list(value):
    return isinstance(value, (list, tuple, np.ndarray))


def _items(value):
    return list(value) if _is_list(value) else [value]


def _number(value):
    return f"{float(value):.17g}"


def _real(p, name):
    """A parameter that is a number, as text."""
    try:
        return _number(p[name])
    except (TypeError, ValueError):
        _refuse(name, p[name], "a number")


def _quantity(name, value, unit="", frame=None, doppler=None):
    """
    A number, a text, or a dictionary as casatools' quanta.quantity() and measures make it; of measures, in this frame, or of this
    kind of velocity. Numbers get `unit`, in texts too.
    """
    if isinstance(value, dict):
        refer = value.get("refer", frame)
        if refer != frame and refer != doppler:
            measure = f"a measure in {frame}, as outframe says" if frame else "a quantity without a frame"
            _refuse(name, value, measure + (f", or {doppler} velocity, as veltype says" if doppler else ""))
        quantity = value.get("m0", value)
        try:
            return _number(quantity["value"]) + (quantity.get("unit", unit) + "")
        except (AttributeError, KeyError, TypeError, ValueError):
            _refuse(name, value, "a quantity with a number as its 'value' and a text as its 'unit'")
    if isinstance(value, numbers.Real) and not isinstance(value, bool):
        return _number(value) + unit
    if not isinstance(value, str):
        _refuse(name, value, "a number, text or quantity")
    try:
        return _number(value) + unit
    except ValueError:
        return value


def _ellipse(name, values, unit):
    """One to three values as the program takes them: two sizes and a position angle."""
    parts = [one for one in _items(values) if one is not None and one != ""]
    return ",".join(_quantity(name, one, "deg" if index == 2 else unit) for index, one in enumerate(parts))


def _channel(value):
    """The number of a channel, or None for something else."""
    if isinstance(value, str):
        value = value.strip()
        return int(value) if value.lstrip("-").isdigit() else None
    if isinstance(value, numbers.Real) and not isinstance(value, bool) and float(value).is_integer():
        return int(value)
    return None


def _direction(name, value):
    """A direction or field, or "" where none is given."""
    if _is_list(value) and len(value) == 0:
        return ""
    if isinstance(value, bool) or not isinstance(value, (str, os.PathLike, numbers.Integral)):
        _refuse(name, value, "a text such as 'J2000 12h30m49.4s +12d23m28s', or the number of a field")
    return value


def _whole(name, value):
    if isinstance(value, str) and re.fullmatch(r"\s*[-+]?\d+\s*", value):
        return value.strip()
    if not isinstance(value, numbers.Real) or isinstance(value, bool) or not float(value).is_integer():
        _refuse(name, value, "a whole number")
    return _number(value)


def _tell_once(level, sentence):
    if sentence not in _told:
        _told.add(sentence)
        _log.log(level, "%s", sentence)


class _Words:
    """The command line, option by option."""

    def __init__(self):
        self.words = ["image"]

    def give(self, option, *values):
        self.words += ["--" + option, *(str(value) for value in values)]

    def flag(self, option, wanted):
        if wanted:
            self.words.append("--" + option)


def _check_types(p):
    for name, usual in defaults().items():
        value = p[name]
        if isinstance(usual, bool):
            if not isinstance(value, (bool, np.bool_)) and not (isinstance(value, numbers.Integral) and value in (0, 1)):
                _refuse(name, value, "True or False")
        elif name in _TEXTS and not isinstance(value, str):
            _refuse(name, value, "a text")


def _tell_unneeded(p, unneeded):
    for name, (usual, why) in unneeded.items():
        if _items(p[name]) != _items(usual):
            _tell_once(logging.INFO, f"{name}={p[name]!r} changes nothing: {why}")


def _check_simple(p):
    for name, (only, why) in _SINGLE.items():
        if p[name] != only:
            _refuse(name, p[name], f"{only!r}: {why}")
    _tell_unneeded(p, _UNNEEDED)
    if p["facets"] != 1:
        if _GRIDDERS.get(p["gridder"]) == "standard":
            _refuse("facets", p["facets"], "1, or gridder='wproject', which has w exactly")
        _tell_once(logging.INFO, f"facets={p['facets']!r} changes nothing: w is exact without")
    if p["psfcutoff"] != 0.35:
        _tell_once(logging.WARNING, f"psfcutoff={p['psfcutoff']!r} changes nothing: beams are fitted to the whole main lobe")


def _give_data(words, p):
    sets = _paths("vis", p["vis"])
    if not sets:
        _refuse("vis", p["vis"], "a MeasurementSet, or several")
    words.give("vis", *sets)
    for name in _SELECTION if p["selectdata"] else ("field", "spw"):
        values = ["" if one is None else str(one) for one in _items(p[name])]
        if any(values):
            words.give(name, *values)
    column = p["datacolumn"]
    if not isinstance(column, str) or not column:
        _refuse("datacolumn", column, "one of " + ", ".join(map(repr, _COLUMNS)) + ", or a column's name")
    words.give("datacolumn", _COLUMNS.get(column, column))


def _give_image(words, p):
    sides, cells = _items(p["imsize"]), [side for side in _items(p["cell"]) if side != ""]
    if not sides:
        _refuse("imsize", p["imsize"], "a width, or width and height")
    words.give("imsize", *(_whole("imsize", side) for side in sides))
    words.give("cell", *(_quantity("cell", side, "arcsec") for side in cells or ["1arcsec"]))
    centre = _direction("phasecenter", p["phasecenter"])
    if centre != "":
        words.give("phasecenter", centre)
    stokes = p["stokes"]
    if not isinstance(stokes, str):
        _refuse("stokes", stokes, "a text such as 'IQUV'")
    words.give("stokes", stokes)


def _spectral(name, value, frame, veltype):
    if isinstance(value, numbers.Real):
        _refuse(name, value, "a whole number of channels, a frequency such as '1.4GHz' or a velocity such as '20km/s'")
    return _quantity(name, value, "", frame, veltype.upper())


def _velocities(veltype):
    """CASA's names of velocities; by ratio, beta and gamma no axis of a cube is even."""
    known = {"radio": "radio", "optical": "optical", "z": "optical"}
    if veltype.lower() not in known:
        _refuse("veltype", veltype, "'radio', 'optical' or 'z'")
    return known[veltype.lower()]


def _frame(p):
    """In which start and width are; the data's own is undefined."""
    specmode, frame = p["specmode"], p["outframe"]
    if specmode == "cube":
        return frame or "LSRK"
    if frame.upper() not in ("", "LSRK") + (("REST", "SOURCE") if specmode == "cubesource" else ()):
        _refuse("outframe", frame, f"none with specmode={specmode!r}, whose planes have the frequencies "
                                   f"{'of the source at rest' if specmode == 'cubesource' else 'that the data have'}")
    return "REST" if specmode == "cubesource" else ""


def _give_spectrum(words, p):
    specmode = p["specmode"]
    if specmode not in ("mfs", "cube", "cubedata", "cubesource"):
        _refuse("specmode", specmode, "'mfs', 'cube', 'cubedata' or 'cubesource'")
    veltype = _velocities(p["veltype"])
    restfreq = [one for one in _items(p["restfreq"]) if one != ""]
    if restfreq:
        words.give("restfreq", _quantity("restfreq", restfreq[0], "Hz"))
    if specmode == "mfs":
        if p["outframe"] not in ("", "LSRK"):
            _tell_once(logging.WARNING, f"outframe={p['outframe']!r} changes nothing of specmode='mfs': headers have the data's frame")
        return
    words.give("specmode", specmode)
    words.give("nchan", _whole("nchan", p["nchan"]))
    frame = _frame(p)
    velocities = False
    for name, channels in (("start", "{}chan"), ("width", "{}")):  # a channel of the whole window
        value = p[name]
        if _channel(value) is not None:
            words.give(name, channels.format(_channel(value)))
        elif value != "":
            text = _spectral(name, value, frame, p["veltype"])
            velocities = velocities or text.strip().endswith("/s")
            words.give(name, text)
    if specmode == "cube":
        words.give("outframe", frame)
    if velocities:
        words.give("veltype", veltype)
    words.give("interpolation", p["interpolation"])
    if not p["perchanweightdensity"] and p["weighting"] != "natural":
        words.give("perchanweightdensity", "false")


def _give_weights(words, p):
    weighting = p["weighting"]
    if weighting not in _WEIGHTINGS:
        _refuse("weighting", weighting, "one of " + ", ".join(map(repr, _WEIGHTINGS)))
    words.give("weighting", weighting)
    if weighting.startswith("briggs"):
        words.give("robust", _real(p, "robust"))
    if weighting == "briggsabs":
        words.give("noise", _quantity("noise", p["noise"], "Jy"))
    if p["npixels"]:
        words.give("npixels", p["npixels"])
    taper = _ellipse("uvtaper", p["uvtaper"], "lambda")
    if taper:
        words.give("uvtaper", taper)


def _give_gridder(words, p):
    gridder = p["gridder"]
    if gridder in _NOT_OFFERED:
        _refuse("gridder", gridder, "'mosaic', which has the beam of each antenna at each frequency")
    if gridder not in _GRIDDERS:
        _refuse("gridder", gridder, "'standard', 'wproject', 'widefield' or 'mosaic'")
    words.give("gridder", _GRIDDERS[gridder])
    if _GRIDDERS[gridder] in ("mosaic", "auto"):
        _give_mosaic(words, p)
        return
    _tell_unneeded(p, _UNNEEDED_ALONE)
    if p["usepointing"]:
        _refuse("usepointing", p["usepointing"], "gridder='mosaic' beside it")
    if _direction("psfphasecenter", p["psfphasecenter"]) != "":
        _refuse("psfphasecenter", p["psfphasecenter"], "gridder='mosaic' beside it")


def _give_mosaic(words, p):
    if p["normtype"] not in ("flatnoise", "flatsky"):
        _refuse("normtype", p["normtype"], "'flatnoise' or 'flatsky'")
    words.give("normtype", p["normtype"])
    centre = _direction("psfphasecenter", p["psfphasecenter"])
    if centre != "":
        words.give("psfphasecenter", centre)
    words.flag("usepointing", p["usepointing"])
    if p["vptable"]:
        _refuse("vptable", p["vptable"], "'', as the beams of mosaics are chosen by telescope, or by beam")
    if not p["mosweight"] and p["weighting"] == "natural":
        _tell_once(logging.INFO, f"mosweight={p['mosweight']!r} changes nothing: natural weights do not follow from density")
    elif not p["mosweight"]:
        words.give("mosweight", "false")


def _give_deconvolver(words, p):
    deconvolver = p["deconvolver"]
    if deconvolver not in _DECONVOLVERS:
        _refuse("deconvolver", deconvolver, "one of " + ", ".join(map(repr, _DECONVOLVERS)))
    try:
        scales = [float(scale) for scale in _items(() if p["scales"] is None else p["scales"])]
    except (TypeError, ValueError):
        _refuse("scales", p["scales"], "a list of numbers, in pixels")
    terms = deconvolver == "mtmfs"
    if terms and _whole("nterms", p["nterms"]) == "1":
        _refuse("nterms", p["nterms"], "2 or 3, or deconvolver='hogbom' or 'multiscale', whose images have no .tt0 in their names")
    multiscale = deconvolver == "multiscale" or (terms and any(scales))
    words.give("deconvolver", "multiscale" if multiscale else "hogbom" if terms else deconvolver)
    if multiscale:
        words.give("scales", ",".join(_number(scale) for scale in scales or [0.0]))
        words.give("smallscalebias", _real(p, "smallscalebias"))
    if terms:
        words.give("nterms", p["nterms"])
    if p["reffreq"] != "":
        if not terms:
            _refuse("reffreq", p["reffreq"], "deconvolver='mtmfs' beside it")
        words.give("reffreq", _quantity("reffreq", p["reffreq"], "Hz"))


def _give_clean(words, p):
    words.give("niter", _whole("niter", p["niter"]))
    words.give("threshold", _quantity("threshold", p["threshold"], "Jy"))
    for name in ("gain", "nsigma", "cyclefactor", "minpsffraction", "maxpsffraction"):
        words.give(name, _real(p, name))
    words.give("cycleniter", _whole("cycleniter", p["cycleniter"]))
    words.give("nmajor", _whole("nmajor", p["nmajor"]))
    _give_deconvolver(words, p)
    usemask = p["usemask"]
    if usemask not in ("user", "pb", "auto-multithresh"):
        _refuse("usemask", usemask, "'user', 'pb' or 'auto-multithresh'")
    if not p["restoration"]:
        _tell_once(logging.INFO, "restoration=False changes nothing: restored images come with every model")
    beam = "common" if list(_items(p["restoringbeam"])) == ["common"] else _ellipse("restoringbeam", p["restoringbeam"], "arcsec")
    savemodel = p["savemodel"]
    if savemodel not in ("none", "modelcolumn"):
        _refuse("savemodel", savemodel, "'none' or 'modelcolumn'")
    if not p["cleans"]:
        if savemodel != "none":
            _refuse("savemodel", savemodel, "niter above 0, or a model to begin with")
        return
    if beam:
        words.give("restoringbeam", beam)
    words.give("savemodel", savemodel)
    if p["masks"]:
        words.give("mask", *p["masks"])
    if float(_real(p, "pbmask")):
        words.give("pbmask", _real(p, "pbmask"))
    if usemask == "pb":
        words.give("usemask", usemask)
    if usemask == "auto-multithresh" and float(p["niter"]):
        words.give("usemask", usemask)
        for name in ("sidelobethreshold", "noisethreshold", "lownoisethreshold", "negativethreshold", "smoothfactor",
                     "minbeamfrac", "cutthreshold", "minpercentchange"):
            words.give(name, _real(p, name))
        words.give("growiterations", _whole("growiterations", p["growiterations"]))
        for name in ("dogrowprune", "fastnoise"):
            words.give(name, "true" if p[name] else "false")


def _last_change(path):
    """Of a file, or of those in a folder: pixels of CASA images change without it."""
    return max(os.path.getmtime(one) for one in (path, *Path(path).glob("*")))


def _existing(imagename, kind, terms):
    """The images of a kind that there are, in Taylor terms' order, of CASA images and FITS files the newer; None where there are
    none."""
    names = [f"{imagename}.{kind}.tt{term}" for term in range(terms)] if terms > 1 else [f"{imagename}.{kind}"]
    found = [max((path for path in (name, name + ".fits") if Path(path).exists()), key=_last_change, default=None)
             for name in names]
    if all(path is None for path in found):
        return None
    if None in found:
        raise ValueError(f"{names[found.index(None)]} is not there: expected it beside "
                         f"{next(path for path in found if path is not None)}, or restart=False")
    return found


def _name_beside(imagename):
    """The first of imagename, imagename_1, … of which there are no images."""
    name, number = imagename, 0
    while any(Path(name + "." + kind + end).exists() for kind in ("psf", "psf.tt0", "residual", "image")
              for end in ("", ".fits")):
        number += 1
        name = f"{imagename}_{number}"
    return name


def _paths(name, value):
    try:
        paths = [os.fspath(one) for one in _items(value) if one is not None and one != ""]
        if all(isinstance(path, str) and path.isprintable() for path in paths):
            return paths
    except TypeError:
        pass
    _refuse(name, value, "a name, or several")


def _flux_jy(value):
    """A threshold in Jy, as the program has taken it."""
    text = _quantity("threshold", value, "Jy").strip()
    number = re.match(r"[-+.\deE]*\d[.]?", text)[0]
    return float(number) * {"mJy": 1e-3, "uJy": 1e-6, "nJy": 1e-9, "kJy": 1e3}.get(text[len(number):].strip(), 1.0)


def _settle_beginning(p):
    """
    What CLEAN begins with: the model and mask given, or those that runs of the same imagename left. Adds to the parameters
    `models`, `masks` and `cleans`, and changes imagename where that is to lie beside.
    """
    p["imagename"] = imagename = "".join(_paths("imagename", p["imagename"])[:1])
    if not imagename:
        _refuse("imagename", imagename, "a name for images to begin with")
    terms = int(_whole("nterms", p["nterms"])) if p["deconvolver"] == "mtmfs" else 1
    start, masks = _paths("startmodel", p["startmodel"]), _paths("mask", p["mask"])
    if not p["restart"]:
        for name in ("calcpsf", "calcres"):
            if not p[name]:
                _refuse(name, p[name], "True beside restart=False, which begins beside all images that there are")
        p["imagename"] = _name_beside(imagename)
    else:
        model, mask = _existing(imagename, "model", terms), _existing(imagename, "mask", 1)
        other = _existing(imagename, "model", 1 if terms > 1 else 2)
        if model is None and other is not None:
            _refuse("deconvolver", p["deconvolver"], f"that of {other[0]}, which restart=True goes on from; or another imagename")
        if model is not None and start:
            _refuse("startmodel", p["startmodel"], f"none, as {model[0]} is what restart=True begins with; or restart=False")
        if model is not None:
            start = model
            _log.info("CLEAN goes on from %s", ", ".join(model))
        if mask is not None and not masks and p["usemask"] == "user":
            masks = mask
            _log.info("CLEAN keeps to %s", mask[0])
    p.update(models=start, masks=masks, cleans=bool(float(_real(p, "niter")) or start))


def _words_of(p):
    _check_types(p)
    _check_simple(p)
    _settle_beginning(p)
    return _program_words(p)


def _program_words(p):
    words = _Words()
    for give in (_give_data, _give_image, _give_spectrum, _give_weights, _give_gridder, _give_clean):
        give(words, p)
    words.give("imagename", p["imagename"])
    if p["models"]:
        words.give("startmodel", *p["models"])
    limit = float(_real(p, "pblimit"))
    if not -1 < limit < 1:
        _refuse("pblimit", limit, "a number between -1 and 1, such as 0.2")
    words.flag("pbcor", p["pbcor"])
    words.give("pblimit", _number(limit or 1e-6))
    words.give("products", "tclean")
    for name in ("calcpsf", "calcres"):
        if not p[name]:
            words.give(name, "false")
    words.give("outformat", p["outformat"])
    for name in ("beam", "accuracy", "threads", "memory", "verify"):
        if p[name] is not None:
            words.give(name, p[name])
    words.flag("dry-run", p["dryrun"])
    return words.words


def words_of_cycle(p, nmajor, mask):
    """The command line of one more major cycle of clean_cycles(), which begins the first and goes on with --restart."""
    return _program_words({**p, "nmajor": nmajor, "models": [], "masks": [mask] if mask else [], "cleans": True})


# Global stop codes from the one that matters most: what ended a cube is what ended the plane that it says most of.
_STOPS_FIRST = (3, 5, 6, 1, 9, 4, 8, 2, 7)
_STOP_TEXT = {
    1: "Reached the iteration limit.",
    2: "Reached threshold.",
    3: "Force stop.",
    4: "No change in peak residual across two major cycles.",
    5: "Peak residual increased by more than 3 times from the previous major cycle.",
    6: "Peak residual increased by more than 3 times from the minimum reached.",
    7: "Zero mask.",
    8: "Reached n-sigma threshold.",
    9: "Reached the major cycle limit.",
}
_MINOR_STOPS = {"reached its depth": 2, "found as many components as allowed": 1, "its peak grew threefold": 4}


def _minor_stop(ended):
    return next((code for text, code in _MINOR_STOPS.items() if ended.startswith(text)), 5)


def _summary_of_plane(log, full):
    """tclean's lists, over the sets of minor cycles of one plane."""
    cycles = log[1:]
    before = [log[cycle["from"]] for cycle in cycles]
    done = [float(cycle["iterations"] - start["iterations"]) for cycle, start in zip(cycles, before)]
    summary = {
        "iterDone": done,
        "peakRes": [cycle["peak_residual_jy"] for cycle in cycles],
        "modelFlux": [cycle["model_flux_jy"] for cycle in cycles],
        "cycleThresh": [cycle["cycle_threshold_jy"] for cycle in cycles],
    }
    if full:
        summary.update({
            "startPeakRes": [start["peak_residual_jy"] for start in before],
            "startModelFlux": [start["model_flux_jy"] for start in before],
            "startPeakResNM": [start["peak_anywhere_jy"] for start in before],
            "peakResNM": [cycle["peak_anywhere_jy"] for cycle in cycles],
            "masksum": [start["mask_pixels"] for start in before],
            "stopCode": [float(_minor_stop(cycle["ended"])) for cycle in cycles],
        })
    return summary


def _count_through(planes, totals):
    """Counts iterations plane after plane, in one set of minor cycles after the other."""
    for summary in planes:
        summary["cycleStartIters"] = [float(total) for total in totals[:len(summary["iterDone"])]]
        summary["startIterDone"] = []
    for cycle, done in enumerate(totals):
        for summary in planes:
            if cycle < len(summary["iterDone"]):
                summary["startIterDone"].append(float(done))
                done += summary["iterDone"][cycle]


def dictionary(report, p):
    """What tclean returns, from the report of a run."""
    planes = report["planes"] or [{"plane": 0, "stokes": report["stokes"]}]
    logs = {
        plane["plane"]: {index: stokes["clean"]["major_cycles_log"] for index, stokes in enumerate(plane["stokes"])
                         if stokes["clean"]}
        for plane in planes
    }
    minor = {number: {index: _summary_of_plane(log, p["fullsummary"]) for index, log in of.items()}
             for number, of in logs.items()}
    all_minor = [summary for of in minor.values() for summary in of.values()]
    major = 1 + max((len(summary["iterDone"]) for summary in all_minor), default=0)
    totals = [sum(sum(summary["iterDone"][:cycle]) for summary in all_minor) for cycle in range(major)]
    if p["fullsummary"]:
        _count_through(all_minor, totals)
    cleans = [stokes["clean"] for plane in planes for stokes in plane["stokes"] if stokes["clean"]]
    codes = {clean["stop_code"] for clean in cleans}
    code = next((code for code in _STOPS_FIRST if code in codes), 1)
    if code == 1 and len(cleans) > 1 and float(p["niter"]):
        _log.warning("niter=%s was reached: it is of each of %d planes and Stokes parameters, not of all together", p["niter"],
                     len(cleans))
    thresholds = [summary["cycleThresh"][-1] for summary in all_minor if summary["cycleThresh"]]
    return {
        "cleanstate": "running",
        "cyclefactor": float(p["cyclefactor"]),
        "cycleiterdone": 0,
        "cycleniter": int(float(p["cycleniter"])),
        "cyclethreshold": max(thresholds, default=0.0),
        "interactiveiterdone": 0,
        "interactivemode": False,
        "interactiveniter": 0,
        "interactivethreshold": 0.0,
        "iterdone": int(totals[-1]),
        "loopgain": float(p["gain"]),
        "maxpsffraction": float(p["maxpsffraction"]),
        "maxpsfsidelobe": max((clean["max_sidelobe"] or 0.0 for clean in cleans), default=0.0),
        "minpsffraction": float(p["minpsffraction"]),
        "niter": int(float(p["niter"])),
        "nmajordone": major,
        "nsigma": float(p["nsigma"]),
        "stopcode": code,
        "stopDescription": _STOP_TEXT[code],
        "summarymajor": np.array(totals, dtype=int),
        "summaryminor": {0: minor},
        "threshold": _flux_jy(p["threshold"]),
        "misfit": report,
    }


def tclean(
    vis,
    selectdata=True,
    field="",
    spw="",
    timerange="",
    uvrange="",
    antenna="",
    scan="",
    observation="",
    intent="",
    datacolumn="corrected",
    imagename="",
    imsize=(100,),
    cell="1arcsec",
    phasecenter="",
    stokes="I",
    projection="SIN",
    startmodel="",
    specmode="mfs",
    reffreq="",
    nchan=-1,
    start="",
    width="",
    outframe="LSRK",
    veltype="radio",
    restfreq=(),
    interpolation="linear",
    perchanweightdensity=True,
    gridder="standard",
    facets=1,
    psfphasecenter="",
    wprojplanes=1,
    vptable="",
    mosweight=True,
    aterm=True,
    psterm=False,
    wbawp=True,
    conjbeams=False,
    cfcache="",
    usepointing=False,
    computepastep=360.0,
    rotatepastep=360.0,
    pointingoffsetsigdev=(),
    pblimit=0.2,
    normtype="flatnoise",
    deconvolver="hogbom",
    scales=(),
    nterms=2,
    smallscalebias=0.0,
    restoration=True,
    restoringbeam=(),
    pbcor=False,
    outlierfile="",
    weighting="natural",
    robust=0.5,
    noise="1.0Jy",
    npixels=0,
    uvtaper=("",),
    niter=0,
    gain=0.1,
    threshold=0.0,
    nsigma=0.0,
    cycleniter=-1,
    cyclefactor=1.0,
    minpsffraction=0.05,
    maxpsffraction=0.8,
    interactive=False,
    nmajor=-1,
    fullsummary=False,
    usemask="user",
    mask="",
    pbmask=0.0,
    sidelobethreshold=3.0,
    noisethreshold=5.0,
    lownoisethreshold=1.5,
    negativethreshold=0.0,
    smoothfactor=1.0,
    minbeamfrac=0.3,
    cutthreshold=0.01,
    growiterations=75,
    dogrowprune=True,
    minpercentchange=-1.0,
    verbose=False,
    fastnoise=True,
    restart=True,
    savemodel="none",
    calcres=True,
    calcpsf=True,
    psfcutoff=0.35,
    parallel=False,
    *,
    beam=None,
    outformat="casa",
    accuracy=None,
    threads=None,
    memory=None,
    verify=None,
    dryrun=False,
):
    """
    Image and CLEAN MeasurementSets: a call of CASA's tclean, with misfit's own program in this process.

    Parameters have tclean's names, values and defaults, and CASA's documentation describes them at length. Those that misfit
    does not have yet are refused by name and value; those that change nothing here are taken, and told of once. What the run
    says goes to the logger "misfit".

    Images are CASA's, with its names: .psf, .residual, .model and .mask (of CLEAN), .image, .pb (where the antennas' beam is
    known), .image.pbcor, .sumwt and, of mosaics, .weight, or with .tt0, .tt1, … of nterms.

    Parameters
    ----------
    vis : path or list of paths
        MeasurementSets, of which one image is made.
    selectdata : bool
        Whether the selections from `timerange` to `intent` count.
    field, spw, timerange, uvrange, antenna, scan, observation, intent : str or list of str
        What is imaged, as CASA's tasks take it: for all sets, or for each.
    datacolumn : str
        "corrected" (or data where a set has none), "data" or "observed", "model", or a column's name.
    imagename : path
        What the names of images begin with.
    imsize : int or list of int
        Width, or width and height, in pixels.
    cell : str, number or list
        Size of a pixel, in arcsec without a unit; two must be equal.
    phasecenter : str or int
        Direction or field that the visibilities are shifted to; or "TRACKFIELD", a planet's name or an ephemeris' path: what the
        image moves along with.
    stokes : str
        Stokes parameters or hands, in any order; or "pseudoI".
    projection : str
        "SIN".
    startmodel : path or list of paths
        Model that CLEAN begins with, in Jy/pixel; one for each of nterms.
    specmode : str
        "mfs"; "cube", of planes in outframe; "cubedata", of the data's frequencies as they are; or "cubesource", in the rest
        frame of a planet or of an ephemeris' target.
    reffreq : str
        Reference frequency of Taylor terms.
    nchan : int
        Planes of a cube; -1: to the end of the data.
    start, width : str, int or quantity
        First plane and step: a channel, counted in the whole window, a frequency or a velocity.
    outframe, veltype : str
        Frame of the planes' frequencies, of "cube"; "radio", or "optical" or "z", in whose velocities planes are then even.
    restfreq : str or list of str
        Of the line; the first counts.
    interpolation : str
        "linear" or "nearest", between channels.
    perchanweightdensity : bool
        Whether each plane's weights follow from its own samples.
    gridder : str
        "standard" leaves w out, "wproject" and "widefield" have it exactly; "mosaic" makes one image of several pointings, in
        which antennas have their own beams at each frequency, and has w where it matters.
    facets : int
        Not needed.
    psfphasecenter : str or int
        Direction or field of the source that a mosaic's PSF is of; "": in the middle of the image, or where the nearest
        pointing is if no beam sees that.
    wprojplanes : int
        Not needed.
    vptable : str
        Not needed; with "mosaic" it must be "": beams are chosen by telescope, or by `beam`.
    mosweight : bool
        Whether weights of a mosaic follow from the density of each pointing's own samples, or from that of all together.
    aterm, psterm : bool
        Of "awproject", which is not offered.
    wbawp, conjbeams : bool
        Not needed: each frequency has its own beam, and so Taylor terms of mosaics are the sky's, without the beam's spectrum.
    cfcache : str
        Not needed.
    usepointing : bool
        Whether the antennas of a mosaic pointed where POINTING says, at the time of each row, in place of where FIELD does.
    computepastep, rotatepastep, pointingoffsetsigdev : various
        Of "awproject", which is not offered.
    pblimit : float
        Where the beam is lower .pb and .image.pbcor have no values; above 0 .residual and .image are masked there, too, but
        keep their values, and CLEAN finds no components of mosaics there.
    normtype : str
        Images of mosaics are: "flatnoise", the sky times .pb, or "flatsky", the sky, with more noise where beams see less.
    deconvolver : str
        "hogbom", "clark", "multiscale" or "mtmfs".
    scales : list of float
        Of multiscale and mtmfs, in pixels; none: points.
    nterms : int
        Taylor terms of mtmfs.
    smallscalebias : float
        The largest scale counts this part less than points.
    restoration : bool
        Not needed: restored images come with every model.
    restoringbeam : str or list of str
        Beam of restored images, or "common".
    pbcor : bool
        Whether .image.pbcor is made.
    outlierfile : str
        "": one field at a time.
    weighting : str
        "natural", "uniform", "superuniform", "briggs", "briggsbwtaper" or "briggsabs".
    robust : float
        Of Briggs' weights.
    noise : str
        Of briggsabs.
    npixels : int
        Of superuniform.
    uvtaper : list of str
        Taper: one to three values; in wavelengths without a unit.
    niter : int
        Components to find at most, in each plane of a cube and Stokes parameter; 0 makes the dirty image, or what a model leaves.
    gain : float
        Part of a peak that a component takes.
    threshold : str or number
        Peak of the residual to stop at, in Jy without a unit.
    nsigma : float
        The same in units of the noise.
    cycleniter : int
        Components of a minor cycle at most.
    cyclefactor, minpsffraction, maxpsffraction : float
        How deep minor cycles go.
    interactive : bool
        False.
    nmajor : int
        Major cycles at most.
    fullsummary : bool
        Whether summaryminor has cycleStartIters, startIterDone, startPeakRes, startModelFlux, startPeakResNM, peakResNM,
        masksum and stopCode too.
    usemask : str
        "user", "pb" or "auto-multithresh".
    mask : path, str or list
        Mask image, region file or region, or several, which all allow components.
    pbmask : float
        CLEAN finds components only where the primary beam is at least this, in whatever mask; at least `pblimit`, or 0.
    sidelobethreshold, noisethreshold, lownoisethreshold, negativethreshold, smoothfactor, minbeamfrac, cutthreshold : float
        Of auto-multithresh.
    growiterations, dogrowprune, minpercentchange, verbose, fastnoise : various
        Of auto-multithresh.
    restart : bool
        Whether CLEAN goes on from a .model of the same imagename, within its .mask where no other is given; else images are
        written beside, as imagename_1 and so on.
    savemodel : str
        "none" or "modelcolumn".
    calcres, calcpsf : bool
        False: .residual and .psf of the same imagename are taken, which must be those of these samples and weights; beside a
        .model the residual must be what that leaves. Of mosaics both are made again.
    psfcutoff : float
        Not needed.
    parallel : bool
        Not needed.
    beam : str, optional
        The antennas' primary beam in place of their telescope's, such as "gmrt", "airy:25:2.36" or the path of an image.
    outformat : str
        "casa", "fits" or "both".
    accuracy : float, optional
        Largest error of the whole image relative to the direct transform, RMS over RMS; 1e-6 where it is None.
    threads : int, optional
        Threads; all cores where it is None.
    memory : float, optional
        GiB that the run may take; half of the machine's where it is None.
    verify : int, optional
        Pixels and visibilities to compare with the direct transform.
    dryrun : bool
        Make nothing: return the plan.

    Returns
    -------
    dict
        As tclean's: stopcode, stopDescription, iterdone, nmajordone (the first residual included), summarymajor,
        summaryminor[field][channel][stokes][key], a list over sets of minor cycles, and others; peakRes is that of the residual
        which the next major cycle made. Under "misfit" stands the run's own report, as in <imagename>.report.json. Of a dry
        run: "plan" and what else is known before. The report's memory_gib_peak is that of the whole process, ever.

    Raises
    ------
    ValueError
        For a parameter that is wrong, or not taken.
    RuntimeError
        For data or files that cannot be used.
    KeyboardInterrupt
        After Ctrl-C. CLEAN ends with its major cycle, and writes its images before.
    """
    parameters = dict(locals())
    with _program.turn.taken():
        report, said = _program.run(_words_of(parameters))
    _program.tell_all(said)
    return report if dryrun else dictionary(report, parameters)


def defaults():
    """tclean's parameters that have one."""
    return {name: parameter.default for name, parameter in inspect.signature(tclean).parameters.items()
            if parameter.default is not inspect.Parameter.empty}
