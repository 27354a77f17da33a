# usage: read_images.py NAME…
# Prints, as JSON, what astropy reads of each NAME.fits and python-casacore of the CASA image NAME, in the same words.
import json
import math
import sys

import numpy
from astropy.io import fits
from astropy.wcs import WCS
from casacore.images import image


def places(channels, stokes, height, width):
    """Corners, middle and phase centre of the first and last plane: [channel, Stokes, row, column]."""
    rows, columns = (0, height - 1, (height - 1) // 2, height // 2), (0, width - 1, (width - 1) // 2, width // 2)
    planes = {(0, 0), (channels - 1, stokes - 1)}
    return [[c, s, row, column] for c, s in sorted(planes) for row in rows for column in columns]


def listed(pixels):
    return [None if math.isnan(value) else float(value) for value in pixels.ravel()]


def read_fits(path):
    with fits.open(path) as file:
        file.verify("exception")
        header, pixels = file[0].header, file[0].data  # [Stokes][channel][row][column]
        at = places(pixels.shape[1], pixels.shape[0], *pixels.shape[2:])
        world = WCS(header).all_pix2world([[column, row, c, s] for c, s, row, column in at], 0)
        beams = [[float(row[name]) for name in ("BMAJ", "BMIN", "BPA")] for row in file["BEAMS"].data]
        return {
            "at": at, "world": world.tolist(), "pixels": listed(pixels), "beams": beams,
            "unit": header["BUNIT"], "telescope": header["TELESCOP"], "observer": header["OBSERVER"],
            "object": header["OBJECT"], "mjd": header["MJD-OBS"], "rest_hz": header["RESTFRQ"],
            "frame": header["RADESYS"], "spectral_frame": header["SPECSYS"], "asked": header["ERRASKED"],
            "measured": header["ERRMEAS"],
            "history": "".join(header["HISTORY"])}


def read_casa(path):
    file = image(path)
    pixels = file.getdata()  # [channel][Stokes][row][column]
    at = places(*pixels.shape)
    world = []
    for place in at:
        hz, stokes, dec, ra = file.toworld(place)
        world.append([math.degrees(ra) % 360, math.degrees(dec), hz, stokes])
    about, coordinates = file.info(), file.coordinates().dict()
    beams = about["imageinfo"]["perplanebeams"]
    rows = [beams[f"*{i}"] for i in range(beams["nChannels"] * beams["nStokes"])]
    pixels = numpy.where(file.getmask(), numpy.nan, pixels)  # numpy's masks are true where there is no value
    return {
        "at": at, "world": world, "pixels": listed(pixels.transpose(1, 0, 2, 3)),
        "beams": [[row[name]["value"] for name in ("major", "minor", "positionangle")] for row in rows],
        "unit": file.unit(), "telescope": coordinates["telescope"], "observer": coordinates["observer"],
        "object": about["imageinfo"]["objectname"], "mjd": coordinates["obsdate"]["m0"]["value"],
        "rest_hz": file.coordinates()["spectral"].get_restfrequency(),
        "frame": file.coordinates()["direction"].get_frame(), "spectral_frame": file.coordinates()["spectral"].get_frame(),
        "asked": file.miscinfo()["ERRASKED"],
        "measured": file.miscinfo()["ERRMEAS"], "history": "".join(file.history())}


json.dump([{"fits": read_fits(name + ".fits"), "casa": read_casa(name)} for name in sys.argv[1:]], sys.stdout)
