"""What the module makes of a MeasurementSet's columns is what the program makes of the set."""

import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np

import misfit

try:
    from astropy.io import fits
    from casacore import tables
except ImportError:
    tables = None

PROGRAM = os.environ.get("MISFIT_PROGRAM", "misfit")
SIZE, CELL_ARCSEC = (256, 200), 0.1


def run(*arguments):
    subprocess.run([PROGRAM, *map(str, arguments)], check=True, capture_output=True, text=True)


@unittest.skipIf(tables is None, "there is no python3-casacore or python3-astropy")
class Program(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.set = Path(cls.folder.name, "a.ms")
        run("simulate", "--output", cls.set, "--hours", 0.5, "--channels", 3, "--noise", "10mJy", "--noncoplanar")
        with tables.table(str(cls.set), ack=False) as rows:
            cross = rows.getcol("ANTENNA1") != rows.getcol("ANTENNA2")
            cls.uvw = rows.getcol("UVW")[cross]
            cls.xx = rows.getcol("DATA")[cross][..., 0]
            cls.flag = rows.getcol("FLAG")[cross][..., 0]
            cls.weight = np.repeat(rows.getcol("WEIGHT")[cross][:, :1], cls.xx.shape[1], axis=1)
        with tables.table(str(cls.set / "SPECTRAL_WINDOW"), ack=False) as windows:
            cls.freq = windows.getcell("CHAN_FREQ", 0)
        with tables.table(str(cls.set / "POLARIZATION"), ack=False) as products:
            cls.first = {5: "RR", 9: "XX"}[int(products.getcell("CORR_TYPE", 0)[0])]

    def program_image(self, name, epsilon, *options):
        """The dirty image as the program writes it, in 64 bits."""
        prefix = Path(self.folder.name, name)
        run("image", "--vis", self.set, "--imagename", prefix, "--imsize", *SIZE, "--cell", f"{CELL_ARCSEC}arcsec",
            "--stokes", self.first, "--accuracy", epsilon, *options)
        self.plan = json.loads(Path(f"{prefix}.report.json").read_text())["kernel"]
        with fits.open(f"{prefix}.residual.fits") as file:
            self.assertEqual(file[0].header["BITPIX"], -64)
            return file[0].data[0, 0]

    def module_image(self, epsilon, vis, wgt, **others):
        """The same from arrays: x is -l, y is m, and the phase of the program's images turns the other way."""
        image = misfit.vis2dirty(
            uvw=self.uvw, freq=self.freq, vis=vis, wgt=wgt, mask=~self.flag, npix_x=SIZE[0], npix_y=SIZE[1],
            pixsize_x=np.radians(CELL_ARCSEC / 3600), pixsize_y=np.radians(CELL_ARCSEC / 3600), epsilon=epsilon,
            do_wgridding=True, flip_v=True, divide_by_n=False, **others)
        return image.T / np.sum(wgt, where=~self.flag)

    def test_images_agree_to_1e_12(self):
        expected = self.program_image("fine", 1e-9)
        image = self.module_image(1e-9, self.xx.astype(np.complex128), self.weight.astype(np.float64))
        self.assertLessEqual(np.linalg.norm(image - expected), 1e-12 * np.linalg.norm(expected))

    def test_so_they_do_with_a_kernel_that_was_asked_for(self):
        expected = self.program_image("chosen", 1e-8, "--kernel", "kaiser-bessel", "--kernel-width", 12, "--padding", 2)
        image = self.module_image(1e-8, self.xx.astype(np.complex128), self.weight.astype(np.float64),
                                  kernel="kaiser-bessel", kernel_width=12, sigma_min=2.0, sigma_max=2.0)
        self.assertLessEqual(np.linalg.norm(image - expected), 1e-12 * np.linalg.norm(expected))


if __name__ == "__main__":
    unittest.main()
