"""A comet near the Earth, with astropy's word for where it stands and how it moves: an image that moves along with it, and a
spectrum at rest in it."""

import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np

try:
    import astropy.units as u
    from astropy.coordinates import EarthLocation, SkyCoord
    from astropy.io import fits
    from astropy.time import Time
    from astropy.utils import iers
    from casacore import tables
    from casacore.measures import measures as make_measures

    measures = make_measures()

    iers.conf.auto_download = False
except ImportError:
    tables = None

PROGRAM = os.environ.get("MISFIT_PROGRAM", "misfit")
AU_M, LIGHT_M_S = 149597870700.0, 299792458.0
LINE_HZ, WIDTH_HZ = 1.4204e9, 40e3
RA, DEC = np.radians(50), np.radians(20)
VLA_M = (-1601185.4, -5041977.5, 3554875.9)
CHANNELS, CHANNEL_HZ = 96, 5e3
SEEN_HZ = LINE_HZ * (1 - 0.02 * AU_M / 86400 / LIGHT_M_S)  # of a comet that recedes by 0.02 AU/d


def run(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], check=True, capture_output=True, text=True).stdout


def in_j2000(directions):
    """From ICRS as casacore turns it, 0.02 arcsec from where astropy has FK5."""
    axes = np.array([measures.direction("icrs", *(f"{angle}rad" for angle in angles)) for angles in ((0, 0), (np.pi / 2, 0), (0, np.pi / 2))])
    turned = [measures.measure(axis, "j2000") for axis in axes]
    return directions @ np.array([unit(axis["m0"]["value"], axis["m1"]["value"]) for axis in turned])


def unit(ra, dec):
    return np.stack([np.cos(dec) * np.cos(ra), np.cos(dec) * np.sin(ra), np.sin(dec)], axis=-1)


class Comet:
    """0.5 arcsec a second over the sky, 0.05 AU away, and ever faster away. Times are MJD, UTC."""

    def __init__(self, middle):
        self.middle = middle

    def geocentric(self, mjd):
        days = mjd - self.middle
        return RA + np.radians(11) * days, DEC + np.radians(5) * days, 0.05 + 0 * days

    def recession(self, mjd):
        """AU/d from the middle of the Earth: it grows by 15 km/s in an hour."""
        return 0.02 + 0.2 * (mjd - self.middle)

    def observer(self, mjd):
        return EarthLocation.from_geocentric(*VLA_M, unit=u.m).get_gcrs_posvel(Time(mjd, format="mjd", scale="utc"))

    def seen(self, mjd):
        """Unit vectors from the telescope."""
        ra, dec, au = self.geocentric(mjd)
        away = unit(ra, dec) * au[:, None] * AU_M - self.observer(mjd)[0].xyz.to_value(u.m).T
        return away / np.linalg.norm(away, axis=1)[:, None]

    def recession_seen(self, mjd):
        """m/s from the telescope."""
        along = np.sum(self.observer(mjd)[1].xyz.to_value(u.m / u.s).T * self.seen(mjd), axis=1)
        return self.recession(mjd) * AU_M / 86400 - along

    def write(self, path):
        mjd = self.middle + np.arange(-48, 49) / 192  # places 7.5 minutes apart
        ra, dec, au = self.geocentric(mjd)
        columns = dict(MJD=mjd, RA=np.degrees(ra), DEC=np.degrees(dec), Rho=au, RadVel=self.recession(mjd))
        table = tables.table(path, tables.maketabdesc([tables.makescacoldesc(name, 0.0) for name in columns]), nrow=len(mjd),
                             ack=False)
        for name, values in columns.items():
            table.putcol(name, values)
        table.putkeywords(dict(MJD0=mjd[0] - 1 / 192, dMJD=1 / 192, GeoDist=0.0, GeoLong=0.0, GeoLat=0.0, NAME="comet",
                               posrefsys="ICRF/ICRS", obsloc="GEOCENTRIC"))
        table.close()


@unittest.skipIf(tables is None, "there is no python3-astropy or python3-casacore")
class Following(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        cls.set, cls.table = str(cls.folder / "comet.ms"), str(cls.folder / "comet.tab")
        run("simulate", "--output", cls.set, "--array", "vla-c", "--frequency", f"{SEEN_HZ - CHANNEL_HZ * CHANNELS / 2}Hz", "--channels",
            CHANNELS, "--channel-width", f"{CHANNEL_HZ}Hz", "--noise", "0mJy", "--hours", 0.5, "--interval", 90, "--ra",
            f"{RA}rad", "--dec", f"{DEC}rad", "--noncoplanar", "--quiet")
        with tables.table(cls.set, readonly=False, ack=False) as main:
            time = main.getcol("TIME") / 86400
            cls.comet = Comet((time.min() + time.max()) / 2)
            cls.fill(main, time)
        cls.comet.write(cls.table)

    @classmethod
    def fill(cls, main, mjd):
        """A point that goes where the comet goes, with a line of its own velocity over 1 Jy."""
        with tables.table(cls.set + "/SPECTRAL_WINDOW", ack=False) as windows:
            hz = windows.getcol("CHAN_FREQ")[0]
        east = np.array([-np.sin(RA), np.cos(RA), 0])
        centre = unit(np.array([RA]), np.array([DEC]))[0]
        north = np.cross(centre, east)
        times, of_row = np.unique(mjd, return_inverse=True)
        seen = in_j2000(cls.comet.seen(times))
        along = np.stack([seen @ east, seen @ north, seen @ centre - 1], axis=1)[of_row]
        delay_s = np.sum(main.getcol("UVW") * along, axis=1) / LIGHT_M_S
        beta = cls.comet.recession_seen(times)[of_row] / LIGHT_M_S
        line_hz = LINE_HZ * np.sqrt((1 - beta) / (1 + beta))
        flux = 1 + np.exp(-0.5 * ((hz[None, :] - line_hz[:, None]) / WIDTH_HZ) ** 2)
        visibility = flux * np.exp(2j * np.pi * delay_s[:, None] * hz[None, :])
        data = main.getcol("DATA")
        main.putcol("DATA", np.repeat(visibility[:, :, None], data.shape[2], axis=2).astype(data.dtype))

    def image(self, name, *options):
        run("image", "--vis", self.set, "--imagename", self.folder / name, "--imsize", 64, "--cell", "4arcsec", "--datacolumn",
            "data", "--quiet", *options)
        return fits.open(self.folder / f"{name}.residual.fits")[0]

    def test_a_comet_stays_a_point_where_the_ephemeris_has_it(self):
        moved = np.degrees(np.arccos(self.comet.seen(self.comet.middle + np.array([-0.5, 0.5]) / 48).prod(axis=0).sum())) * 3600
        self.assertGreater(moved, 600)
        image = self.image("along", "--phasecenter", self.table, "--spw", "0:0")
        psf = fits.getdata(self.folder / "along.psf.fits")[0, 0]
        dirty = image.data[0, 0]
        flux = dirty[32, 32]
        np.testing.assert_allclose(dirty / flux, psf, atol=1e-3)  # everywhere: it is a point at the centre, and nothing else
        self.assertAlmostEqual(flux, 1, delta=2e-3)  # and the wing of the line
        at = Time(image.header["TRACKFLD"], scale="utc").mjd
        expected = SkyCoord(*self.comet.seen(np.array([at]))[0], representation_type="cartesian", frame="icrs")
        stated = SkyCoord(image.header["CRVAL1"] * u.deg, image.header["CRVAL2"] * u.deg,
                          frame=image.header["RADESYS"].lower())
        self.assertLess(stated.separation(expected).to_value(u.arcsec), 0.01)

    def test_without_its_ephemeris_it_is_smeared(self):
        self.assertLess(self.image("still", "--spw", "0:0").data.max(), 0.1)

    def test_the_line_is_where_it_is_at_rest(self):
        image = self.image("rest", "--phasecenter", self.table, "--specmode", "cubesource", "--start", f"{LINE_HZ - 3 * WIDTH_HZ}Hz",
                           "--width", f"{WIDTH_HZ / 8}Hz", "--nchan", 49, "--restfreq", f"{LINE_HZ}Hz")
        self.assertEqual(image.header["SPECSYS"], "SOURCE")
        hz = LINE_HZ - 3 * WIDTH_HZ + np.arange(49) * WIDTH_HZ / 8
        spectrum = image.data[0, :, 32, 32]
        taken = spectrum > 0.9  # where the data reach
        expected = 1 + np.exp(-0.5 * ((hz - LINE_HZ) / WIDTH_HZ) ** 2)
        # Interpolation between channels of an eighth of the line's width errs by a part in 512 of the peak.
        np.testing.assert_allclose(spectrum[taken], expected[taken], atol=4e-3)
        line = spectrum[taken] - 1
        centroid = np.sum(line * hz[taken]) / np.sum(line)
        self.assertLess(abs(centroid - LINE_HZ), 0.05 * CHANNEL_HZ)

    def test_without_its_velocity_the_line_is_elsewhere(self):
        image = self.image("topo", "--phasecenter", self.table, "--specmode", "cubedata", "--start", 10, "--nchan", 76)
        self.assertEqual(image.header.get("SPECSYS", ""), "")
        peak_hz = image.header["CRVAL3"] + int(np.argmax(image.data[0, :, 32, 32])) * image.header["CDELT3"]
        self.assertGreater(abs(peak_hz - LINE_HZ), 100e3)


if __name__ == "__main__":
    unittest.main()
