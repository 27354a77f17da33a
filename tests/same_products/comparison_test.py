"""Laws of comparison: whatever changes in a product is found, and what may differ is not."""
import json
import pathlib
import tempfile
import unittest

import numpy
from casacore import tables

from comparison import Build, differences

PIXELS = numpy.arange(12, dtype=">f4").reshape(3, 4)
PROGRESS = "dirty image and PSF      51 ms\n  38 components, peak residual 166 mJy/beam\nwarning: 5 samples were left out\n"
REPORT = {"version": "0.1.0", "timings_s": {"grid": 0.5, "fft": 0.25}, "memory_gib_peak": 0.5,
          "plan": [{"item": "pixels", "decision": "4"}, {"item": "expected time", "decision": "3 s"}],
          "clean": {"iterations": 3, "rms": 0.1}}
PAGE = '<dt>Run</dt><dd>540 ms<small>0.074 GiB</small></dd>\n<svg class="bar"><rect/></svg>\n<tr><td>pixels</td><td>4</td></tr>\n'


def unit(cards, data):
    header = "".join(card.ljust(80) for card in [*cards, "END"]).encode()
    return header.ljust(2880) + data.ljust(-(-len(data) // 2880) * 2880, b"\0")


def fits(pixels=PIXELS, history="natural", date="2026-01-01", version="0.1.0", table=b"\1\2\3\4\5\6"):
    beams = unit(["XTENSION= 'BINTABLE'", "BITPIX  =  8", "NAXIS   =  2", "NAXIS1  =  3", "NAXIS2  =  2", "PCOUNT  =  0",
                  "GCOUNT  =  1"], table)
    return unit(["SIMPLE  =  T", "BITPIX  =  -32 / bits", "NAXIS   =  2", "NAXIS1  =  4", "NAXIS2  =  3", f"DATE    = '{date}'",
                 f"ORIGIN  = 'misfit {version}'", f"HISTORY {history}"], pixels.tobytes()) + beams


def write_table(folder, data=PIXELS, time=1.0, keyword="Jy", flag=True):
    """A table with a log below it."""
    columns = [tables.makearrcoldesc("DATA", 0.0, 1, valuetype="float"), tables.makescacoldesc("FLAG", True)]
    with tables.table(str(folder), tables.maketabdesc(columns), nrow=3, ack=False) as rows:
        rows.putcol("DATA", data.astype(numpy.float32))
        rows.putcell("FLAG", 1, flag)
        rows.putkeyword("unit", keyword)
    with tables.table(str(folder / "logtable"), tables.maketabdesc([tables.makescacoldesc("TIME", 0.0)]), nrow=1, ack=False) as log:
        log.putcell("TIME", 0, time)


def changed(pixels, at, value):
    pixels = pixels.copy()
    pixels[at] = value
    return pixels


class Comparison(unittest.TestCase):
    def found(self, name, old, new, versions=("0.1.0", "0.1.0"), **options):
        """What differs in a product, of OLD and of NEW: text, bytes, keywords of write_table, or none."""
        with tempfile.TemporaryDirectory() as folder:
            builds = [Build(pathlib.Path(folder, of), f"misfit {version}") for of, version in zip(("old", "new"), versions)]
            for build, content in zip(builds, (old, new)):
                build.folder.mkdir()
                path = build.folder / name
                if isinstance(content, dict):
                    write_table(path, **content)
                elif content is not None:
                    text = content if isinstance(content, bytes) else content.replace("FOLDER", str(build.folder)).encode()
                    path.write_bytes(text)
            return differences(*[build.folder for build in builds], builds, **options)[1]

    def test_changes_are_found_where_they_are(self):
        report = json.dumps(REPORT)
        cases = [
            ("a.fits", fits(), fits(changed(PIXELS, (2, 1), 9.5)), "element [2, 1]: 9.0 / 9.5; 1 of 12 differ, by at most 0.5"),
            ("b.fits", fits(), fits(changed(PIXELS, (0, 0), -0.0)), "element [0, 0]: 0.0 / -0.0"),
            ("c.fits", fits(), fits(changed(PIXELS, (1, 0), numpy.nan)), "element [1, 0]: 4.0 / nan"),
            ("d.fits", fits(), fits(history="uniform"), "unit 1, line 7: «HISTORY natural» / «HISTORY uniform»"),
            ("both.fits", fits(), fits(changed(PIXELS, (1, 1), 0), "uniform"), "«HISTORY uniform»; element [1, 1]: 5.0 / 0.0"),
            ("e.fits", fits(), fits(table=b"\1\2\3\4\5\7"), "unit 2, byte 5 of 6"),
            ("f.fits", fits(), fits()[:-5760], "2 / 1 header-data units"),
            ("g.fits", fits(), fits()[:400], "cannot be read: a header without END"),
            ("d.json", report, report[:-1], "cannot be read: "),
            ("a.json", report, report.replace("0.1}", "0.10000000000000001}"), ".clean.rms: '0.1' / '0.10000000000000001'"),
            ("b.json", report, report.replace('"decision": "4"', '"decision": "5"'), ".plan[0].decision"),
            ("c.json", report, report.replace('"fft"', '"FFT"'), ".timings_s: members"),
            ("a.html", PAGE, PAGE.replace("<td>4</td>", "<td>5</td>"), "line 3: "),
            ("1.err", PROGRESS, PROGRESS.replace("38 comp", "39 comp"), "line 2: "),
            ("2.err", PROGRESS, PROGRESS.replace("5 samples", "6 samples"), "line 3: "),
            ("3.err", PROGRESS, PROGRESS.replace("dirty", "Dirty"), "line 1: "),
            ("1.code", "0\n", "1\n", "byte 0"),
            ("a.csv", "a,b\n1,2\n", "a,b\n1,3\n", "line 2: «1,2» / «1,3»"),
            ("a.ini", 'x="1"\n', 'x="1"\ny="2"\n', "line 2: «<end>» / «y="),
            ("a.png", b"\x89PNG1", b"\x89PNG2", "byte 4 of 5 / 5"),
            ("a.npy", b"12345", b"1234", "byte 4 of 5 / 4"),
            ("old.txt", "", None, "only OLD leaves it"),
            ("new.txt", None, "", "only NEW leaves it"),
            ("a.ms", {}, {"data": changed(PIXELS, (2, 1), 9.5)}, "column DATA, row 2: 9.0 / 9.5"),
            ("b.ms", {}, {"data": changed(PIXELS, (0, 0), -0.0)}, "column DATA, row 0: 0.0 / -0.0"),
            ("c.ms", {}, {"flag": False}, "column FLAG, row 1: True / False"),
            ("d.ms", {}, {"keyword": "K"}, "keywords, line 1"),
            ("e.ms", {}, {"keyword": {"beam": numpy.arange(2000.0)}}, "keywords, line 1"),
            ("f.ms", {"keyword": {"a": numpy.arange(2000.0)}}, {"keyword": {"a": changed(numpy.arange(2000.0), 999, 1)}}, "keywords"),
        ]
        for name, old, new, place in cases:
            with self.subTest(name):
                self.assertIn(place, "".join(self.found(name, old, new)))
                self.assertEqual(self.found(name, old, old), [])

    def test_what_clocks_and_versions_decide_is_not_found(self):
        later = {**REPORT, "version": "0.2.0", "timings_s": {"grid": 0.7, "fft": 0.1}, "memory_gib_peak": 0.6,
                 "plan": [REPORT["plan"][0], {"item": "expected time", "decision": "4 s"}]}
        self.assertEqual(self.found("a.fits", fits(), fits(date="2027-02-03", version="0.2.0"), ("0.1.0", "0.2.0")), [])
        self.assertEqual(self.found("a.json", json.dumps(REPORT), json.dumps(later)), [])
        self.assertEqual(self.found("a.html", PAGE, PAGE.replace("540 ms", "1.2 s").replace("<rect/>", "<rect/><rect/>")), [])
        self.assertEqual(self.found("1.err", PROGRESS, PROGRESS.replace("51 ms", "1 min 05 s")), [])
        self.assertEqual(self.found("1.out", "wrote FOLDER/a\n", "wrote FOLDER/a\n"), [])
        self.assertEqual(self.found("a.image", {}, {"time": 2.0}), [])
        self.assertEqual(self.found("scene.csv", 'a,seconds\n"x,y",2\n', 'a,seconds\n"x,y",3\n', ignored={"seconds"}), [])
        self.assertEqual(self.found("page.html", "1", "2", uncompared=r"page\..*"), [])


if __name__ == "__main__":
    unittest.main()
