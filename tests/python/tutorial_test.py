"""The tutorial runs, and what it shows is so."""

import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import matplotlib.image
import numpy as np

import misfit

TUTORIAL = Path(misfit.__file__).parent.parent / "tutorial.py"


class Tutorial(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        run = subprocess.run([sys.executable, str(TUTORIAL), os.path.join(cls.folder.name, "figures")],
                             env=dict(os.environ, MPLBACKEND="Agg"), capture_output=True, text=True)
        if run.returncode != 0:
            raise AssertionError(run.stderr)
        cls.printed = run.stdout

    def error_table(self):
        """RMS errors by family, one for each width; NaN where there is none."""
        header, *rows = re.search(r"^width.*(?:\n *\d+ .*)+", self.printed, re.MULTILINE)[0].splitlines()
        columns = np.array([[float(text) for text in row.split()] for row in rows]).T
        return dict(zip(header.split(), columns))

    def test_every_figure_is_drawn(self):
        figures = sorted(Path(self.folder.name, "figures").iterdir())
        named = re.findall(r'^finish\(figure, "([\w-]+)"\)', TUTORIAL.read_text(), re.MULTILINE)
        self.assertEqual([figure.name for figure in figures], sorted(f"{name}.png" for name in named))
        for figure in figures:
            pixels = matplotlib.image.imread(figure)
            self.assertGreater(np.mean(np.any(pixels[..., :3] < 0.9, axis=-1)), 0.01, f"{figure.name} is almost blank")

    def test_least_misfit_lies_below_all_rivals(self):
        table = self.error_table()
        rivals = [name for name in table if name not in ("width", "least-misfit")]
        self.assertGreaterEqual(len(rivals), 4)
        for name in rivals:
            known = np.isfinite(table[name])
            self.assertGreaterEqual(np.count_nonzero(known), 5)
            np.testing.assert_array_less(table["least-misfit"][known], table[name][known])

    def test_errors_fall_with_every_cell_of_width(self):
        for name, errors in self.error_table().items():
            if name != "width":
                self.assertTrue(np.all(np.diff(errors[np.isfinite(errors)]) < 0), name)

    def test_gridding_by_hand_errs_as_expected(self):
        found = re.findall(r"^(\S+): RMS error measured (\S+), expected (\S+)$", self.printed, re.MULTILINE)
        self.assertEqual([name for name, _, _ in found], [name for name in self.error_table() if name != "width"])
        for name, measured, expected in found:  # errors of 1000 visibilities depend on where they are in their cells
            self.assertAlmostEqual(float(measured) / float(expected), 1, delta=0.05, msg=name)

    def test_no_family_needs_less_width_than_least_misfit(self):
        lines = re.findall(r"^accuracy \S+: (.*)$", self.printed, re.MULTILINE)
        self.assertGreaterEqual(len(lines), 3)
        for line in lines:
            widths = dict(re.findall(r"([a-z-]+) (\d+)", line))
            self.assertEqual(int(widths["least-misfit"]), min(map(int, widths.values())))


if __name__ == "__main__":
    unittest.main()
