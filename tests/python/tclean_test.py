"""misfit.tclean: what is called is what the program makes, and what is returned is what tclean returns."""

import contextlib
import io
import itertools
import json
import logging
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

import numpy as np

import misfit

try:
    from astropy.io import fits
except ImportError:
    fits = None

PROGRAM = os.environ.get("MISFIT_PROGRAM", "misfit")
CALLS = Path(os.environ.get("MISFIT_TEST_DATA") or Path(__file__).parents[3] / "shared" / "data", "tclean_calls.json")
RETURNED = {"cleanstate", "cyclefactor", "cycleiterdone", "cycleniter", "cyclethreshold", "interactiveiterdone",
            "interactivemode", "interactiveniter", "interactivethreshold", "iterdone", "loopgain", "maxpsffraction",
            "maxpsfsidelobe", "minpsffraction", "niter", "nmajordone", "nsigma", "stopcode", "stopDescription",
            "summarymajor", "summaryminor", "threshold", "misfit"}


def run(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], check=True, capture_output=True, text=True)


@contextlib.contextmanager
def misfit_files(folder, name, kinds):
    """The pixels of images before something is done."""
    yield {kind: fits.getdata(folder / f"{name}.{kind}.fits").copy() for kind in kinds}


class Sets(unittest.TestCase):
    SIMULATED = ()
    GIVEN = dict(imsize=64, cell="0.2arcsec")

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        cls.sets = [str(cls.folder / name) for name in ("a.ms", "b.ms")]
        for path, frequency in zip(cls.sets, ("4GHz", "4.02GHz")):
            run("simulate", "--output", path, "--frequency", frequency, "--channels", 4, "--channel-width", "1MHz", "--noise",
                "10mJy", "--hours", 0.1, *cls.SIMULATED, "--quiet")

    def name(self, name):
        return str(self.folder / name)

    def tclean(self, name, **parameters):
        return misfit.tclean(**{**self.GIVEN, "vis": self.sets[0], "imagename": self.name(name), **parameters})

    def refusal(self, error=ValueError, **parameters):
        with self.assertRaises(error) as refused:
            self.tclean("refused", **parameters)
        return str(refused.exception)

    def files(self, name):
        return {path.name[len(name):] for path in self.folder.glob(name + ".*")}


class Program(Sets):
    """It is the program that runs."""

    @unittest.skipIf(fits is None, "there is no python3-astropy")
    def test_bits_are_those_of_the_program(self):
        clean = dict(niter=50, gain=0.2, threshold="1mJy")
        options = ["--niter", 50, "--gain", 0.2, "--threshold", "1mJy", "--imsize", 64, 48, "--cell", "0.2arcsec"]
        cases = {
            "mfs": (dict(vis=self.sets, spw=["0:1~2", "0"], weighting="briggs", robust=-0.5),
                    ["--vis", *self.sets, "--spw", "0:1~2", "0", "--weighting", "briggs", "--robust", -0.5, "--gridder",
                     "standard"]),
            "cube": (dict(specmode="cube", start=2, nchan=2, restoringbeam="common", gridder="wproject"),
                     ["--vis", self.sets[0], "--specmode", "cube", "--start", "2", "--nchan", 2, "--restoringbeam", "common",
                      "--gridder", "wide"]),
            "terms": (dict(deconvolver="mtmfs", scales=[0, 5], stokes="I"),
                      ["--vis", self.sets[0], "--nterms", 2, "--deconvolver", "multiscale", "--scales", "0,5", "--gridder",
                       "standard"]),
        }
        for name, (parameters, words) in cases.items():
            with self.subTest(name):
                self.tclean(name, imsize=[64, 48], outformat="fits", **clean, **parameters)
                run("image", "--imagename", self.name("p" + name), *options, *words, "--quiet")
                end = ".tt0" if name == "terms" else ""
                for kind in ("psf", "residual", "model", "image"):
                    ours, programs = (fits.getdata(self.name(f"{which}.{kind}{end}.fits")) for which in (name, "p" + name))
                    np.testing.assert_array_equal(ours, programs, kind)

    def test_images_have_the_names_of_tclean(self):
        self.tclean("names", niter=5, pbcor=True, mask="circle[[32pix,32pix],20pix]")
        wanted = {".psf", ".residual", ".model", ".image", ".mask", ".pb", ".image.pbcor", ".sumwt"}
        self.tclean("unmasked", niter=5, pbcor=True)
        self.assertLessEqual(wanted, self.files("unmasked"))
        self.tclean("dirty")
        self.assertLessEqual({".psf", ".residual", ".image", ".pb", ".sumwt"}, self.files("dirty"))
        self.assertLessEqual(wanted, self.files("names"))
        self.assertFalse({name for name in self.files("names") if name.endswith(".fits")})
        self.tclean("ofterms", niter=5, deconvolver="mtmfs")
        self.assertLessEqual({".psf.tt2", ".residual.tt1", ".model.tt0", ".image.tt1", ".alpha", ".sumwt.tt2", ".pb.tt0"},
                             self.files("ofterms"))

    @unittest.skipIf(fits is None, "there is no python3-astropy")
    def test_sums_of_weights_are_those_of_the_samples(self):
        report = self.tclean("sums", specmode="cube", outformat="fits", imsize=32)["misfit"]
        sums = fits.getdata(self.name("sums.sumwt.fits"))
        self.assertEqual(sums.shape, (1, 4, 1, 1))
        # Of natural weights noise is 1/√Σw.
        np.testing.assert_allclose(sums.ravel(), [plane["noise"]["predicted_jy"] ** -2 for plane in report["planes"]], rtol=1e-6)

    def test_what_it_says_goes_to_the_logger(self):
        with self.assertLogs("misfit", logging.INFO) as said:
            self.tclean("said", cell="1arcsec", parallel=True, wprojplanes=128)
        self.assertTrue(any("lie beyond 1/(2 cell)" in line for line in said.output if line.startswith("WARNING")))
        self.assertTrue(any("wprojplanes=128 changes nothing" in line for line in said.output))
        with self.assertLogs("misfit", logging.INFO) as said:
            self.tclean("said", wprojplanes=128)
        self.assertFalse(any("wprojplanes" in line for line in said.output))  # said once
        with self.assertLogs("misfit", logging.INFO) as said:
            self.tclean("said", outframe="BARY", restoration=False)
        for told in ("outframe='BARY' changes nothing of specmode='mfs'", "restoration=False changes nothing"):
            self.assertTrue(any(told in line for line in said.output))

    def test_other_threads_run_meanwhile_and_calls_wait_for_each_other(self):
        said, seen = threading.Event(), threading.Event()

        class Waiting(logging.Handler):
            def emit(self, record):  # the run goes on once another thread has seen that it said something
                said.set()
                seen.wait(30)

        handler, log = Waiting(), logging.getLogger("misfit")
        log.addHandler(handler)
        self.addCleanup(log.removeHandler, handler)
        level = log.level
        log.setLevel(logging.INFO)
        self.addCleanup(log.setLevel, level)
        threads = [threading.Thread(target=self.tclean, args=(f"thread{i}",), kwargs=dict(niter=20)) for i in range(2)]
        for thread in threads:
            thread.start()
        self.assertTrue(said.wait(30))
        self.assertFalse(self.files("thread0") & self.files("thread1"))
        seen.set()
        for thread in threads:
            thread.join()
        self.assertLessEqual({".image"}, self.files("thread0") & self.files("thread1"))

    def test_a_dry_run_returns_the_plan_and_writes_nothing(self):
        plan = self.tclean("dry", niter=10, dryrun=True)
        self.assertIn("kernel width", [decision["item"] for decision in plan["plan"]])
        self.assertGreater(plan["timings_expected_s"]["total"], 0)
        self.assertFalse(self.files("dry"))

    def test_ctrl_c_ends_clean_with_its_images_and_python_goes_on(self):
        code = """
import misfit, sys
try:
    misfit.tclean(sys.argv[1], imagename=sys.argv[2], imsize=512, cell="0.02arcsec", niter=100000000, gain=1e-5, cycleniter=2000)
except KeyboardInterrupt as stopped:
    print("stopped:", stopped)
try:
    import os, signal
    os.kill(os.getpid(), signal.SIGINT)  # Python's own again
    print("not caught")
except KeyboardInterrupt:
    print("caught")
"""
        python = subprocess.Popen([sys.executable, "-c", code, self.sets[0], self.name("stopped")], stdout=subprocess.PIPE,
                                  text=True)
        state = Path(self.name("stopped.clean.state"))
        for _ in range(600):
            if state.exists() or python.poll() is not None:
                break
            time.sleep(0.05)
        python.send_signal(signal.SIGINT)
        said, _ = python.communicate(timeout=60)
        self.assertIn("stopped: ", said)
        self.assertIn("\ncaught", said)
        self.assertLessEqual({".image", ".model", ".residual"}, self.files("stopped"))

    def test_ctrl_c_that_comes_late_is_not_lost(self):
        code = """
import logging, misfit, os, signal, sys
class Late(logging.Handler):
    def emit(self, record):  # the last that a dirty image says before its files are written
        os.kill(os.getpid(), signal.SIGINT)
logging.getLogger("misfit").addHandler(Late())
logging.getLogger("misfit").setLevel(logging.INFO)
try:
    misfit.tclean(sys.argv[1], imagename=sys.argv[2], imsize=64, cell="0.2arcsec")
    print("lost")
except KeyboardInterrupt:
    print("stopped")
"""
        said = subprocess.run([sys.executable, "-c", code, self.sets[0], self.name("late")], capture_output=True, text=True).stdout
        self.assertEqual(said, "stopped\n")

    def test_models_are_predicted_and_subtracted(self):
        self.tclean("model", niter=20)
        written = misfit.predict(self.sets[0], model=self.name("model.model"), spw="0:1~2")
        self.assertEqual((written["column"], written["visibilities"]), ("MODEL_DATA", 2 * written["rows"]))
        again = misfit.subtract(self.sets[0], model=self.name("model.model"))
        self.assertEqual(again["column"], "CORRECTED_DATA")
        seen = misfit.predict(self.sets[0], model=self.name("model.model"), column="SEEN", apply_beam=True, beam="airy:25")
        self.assertEqual(seen["column"], "SEEN")
        self.assertIn("'SEEN'", str(self.tclean("seen", datacolumn="SEEN", dryrun=True)["plan"]))
        with self.assertRaisesRegex(ValueError, "beam requires apply_beam"):
            misfit.predict(self.sets[0], model=self.name("model.model"), beam="airy:25")
        with self.assertRaisesRegex(ValueError, "expected either model or components"):
            misfit.predict(self.sets[0])


class Returned(Sets):
    """What tclean returns."""

    def test_the_dictionary_is_that_of_the_cycles(self):
        made = self.tclean("made", niter=100, cycleniter=30, fullsummary=True)
        self.assertEqual(set(made), RETURNED)
        log = made["misfit"]["clean"]["major_cycles_log"]
        plane = made["summaryminor"][0][0][0]
        self.assertEqual(plane["iterDone"], [30, 30, 30, 10])
        self.assertEqual(list(made["summarymajor"]), [0, 30, 60, 90, 100])
        self.assertEqual((made["iterdone"], made["nmajordone"], made["stopcode"]), (100, 5, 1))
        for threshold, jy in (("3.5mJy", 3.5e-3), (2, 2), ("0.5", 0.5), ({"value": 5, "unit": "uJy"}, 5e-6)):
            self.assertAlmostEqual(self.tclean("flux", threshold=threshold, dryrun=False)["threshold"] / jy, 1)
        self.assertEqual(plane["cycleStartIters"], [0, 30, 60, 90])
        self.assertEqual(plane["startPeakRes"], [cycle["peak_residual_jy"] for cycle in log[:-1]])
        self.assertEqual(plane["stopCode"], [1, 1, 1, 1])
        self.assertEqual(plane["startPeakResNM"][1:], plane["peakResNM"][:-1])
        self.assertEqual(plane["peakResNM"], plane["peakRes"])  # without a mask
        self.assertEqual(plane["masksum"], [64 * 64] * 4)
        masked = self.tclean("made3", niter=40, cycleniter=20, fullsummary=True, mask="box[[0pix,0pix],[9pix,9pix]]")
        plane = masked["summaryminor"][0][0][0]
        self.assertEqual(plane["masksum"], [100, 100])
        self.assertGreater(plane["peakResNM"][-1], plane["peakRes"][-1])
        brief = self.tclean("made2", niter=100, cycleniter=30, outformat="fits")["summaryminor"][0][0][0]
        self.assertEqual(set(brief), {"iterDone", "peakRes", "modelFlux", "cycleThresh"})
        if fits is not None:
            residual, model = (fits.getdata(self.name(f"made2.{kind}.fits")).astype(float) for kind in ("residual", "model"))
            self.assertAlmostEqual(brief["peakRes"][-1] / np.abs(residual).max(), 1, places=6)
            self.assertAlmostEqual(brief["modelFlux"][-1] / model.sum(), 1, places=6)

    @unittest.skipIf(fits is None, "there is no python3-astropy")
    def test_modes_of_spectra_are_those_of_the_program(self):
        velocities = dict(restfreq="4.002GHz", start="-100km/s", width="50km/s", nchan=3)
        asked = ["--restfreq", "4.002GHz", "--start", "-100km/s", "--width", "50km/s", "--nchan", 3]
        for name, parameters, words in (
                ("cubedata", dict(specmode="cubedata", outframe="LSRK", veltype="optical"), ["--specmode", "cubedata"]),
                ("optical", dict(specmode="cube", veltype="Z", **velocities), ["--specmode", "cube", "--veltype", "optical", *asked]),
                ("jupiter", dict(specmode="cubesource", outframe="REST", phasecenter="JUPITER"),
                 ["--specmode", "cubesource", "--phasecenter", "Jupiter"]),
                ("pseudo", dict(stokes="pseudoI"), ["--stokes", "pseudoI"])):
            with self.subTest(name):
                self.tclean(name, outformat="fits", **parameters)
                run("image", "--vis", self.sets[0], "--imagename", self.name("p" + name), "--imsize", 64, "--cell", "0.2arcsec",
                    "--gridder", "standard", *words, "--quiet")
                ours, programs = (fits.open(self.name(f"{which}.residual.fits"))[0] for which in (name, "p" + name))
                np.testing.assert_array_equal(ours.data, programs.data)
                for key in ("CTYPE3", "CRVAL3", "CDELT3", "SPECSYS", "TRACKFLD", "CRVAL1", "CTYPE4", "CRVAL4"):
                    self.assertEqual(ours.header.get(key), programs.header.get(key), key)

    def test_planes_and_stokes_have_each_their_lists(self):
        made = self.tclean("planes", specmode="cube", stokes="IQ", niter=30, threshold="50mJy", nchan=3, fullsummary=True)
        minor = made["summaryminor"][0]
        self.assertEqual(set(minor), {0, 1, 2})
        self.assertTrue(all(set(of) == {0, 1} for of in minor.values()))
        self.assertEqual(made["iterdone"], sum(sum(plane["iterDone"]) for of in minor.values() for plane in of.values()))
        self.assertEqual(made["iterdone"], made["summarymajor"][-1])
        # Iterations are counted through all planes.
        starts = sorted((start, done) for of in minor.values() for plane in of.values()
                        for start, done in zip(plane["startIterDone"], plane["iterDone"]))
        self.assertEqual([start for start, done in starts], [sum(done for _, done in starts[:i]) for i in range(len(starts))])

    def test_stop_codes_are_those_of_tclean(self):
        self.assertEqual(self.tclean("s1", niter=1)["stopcode"], 1)
        self.assertEqual(self.tclean("s2", niter=5000, threshold=1.0)["stopcode"], 2)
        self.assertEqual(self.tclean("s8", niter=1000, nsigma=10)["stopcode"], 8)
        self.assertEqual(self.tclean("s9", niter=1000, nmajor=1, cycleniter=3)["stopcode"], 9)
        none = self.tclean("s0")
        self.assertEqual((none["iterdone"], none["nmajordone"], none["summaryminor"]), (0, 1, {0: {0: {}}}))

    @unittest.skipIf(fits is None, "there is no python3-astropy")
    def test_images_of_a_band_state_the_rest_frequency(self):
        self.tclean("rest", restfreq="1.42GHz", outformat="fits")
        self.assertEqual(fits.getheader(self.name("rest.image.fits"))["RESTFRQ"], 1.42e9)

    def test_start_counts_the_channels_of_the_window(self):
        for start, spw in ((2, "0:1~3"), ("2", "0:1~3"), (2, "")):
            plane = self.tclean("start", specmode="cube", start=start, nchan=1, spw=spw, outframe="TOPO")["misfit"]["planes"][0]
            self.assertAlmostEqual(plane["frequency_hz"], 4e9 + 2e6, delta=1)
        for start in (2.0, np.float32(2), " 2 ", {"unit": "GHz", "value": 4.002},
                      {"m0": {"unit": "GHz", "value": 4.002}, "refer": "TOPO", "type": "frequency"}):
            plane = self.tclean("start", specmode="cube", start=start, nchan=1, spw="0:1~3", outframe="TOPO")["misfit"]["planes"][0]
            self.assertAlmostEqual(plane["frequency_hz"], 4e9 + 2e6, delta=1)
        self.assertIn("expected a measure in LSRK, as outframe says",
                      self.refusal(specmode="cube", start={"m0": {"unit": "GHz", "value": 4.002}, "refer": "TOPO"}))
        self.assertIn("start 0chan: expected a channel that is selected of window 0",
                      self.refusal(specmode="cube", start=0, spw="0:1~3"))


class GoingOn(Sets):
    """Runs of the same name."""

    def test_clean_goes_on_from_the_model_on_disk(self):
        first = self.tclean("on", niter=10, cycleniter=10)
        flux = first["misfit"]["clean"]["model_flux_jy"]
        second = self.tclean("on", niter=10, cycleniter=10, calcres=False, calcpsf=False)
        log = second["misfit"]["clean"]["major_cycles_log"]
        self.assertAlmostEqual(log[0]["model_flux_jy"] / flux, 1, places=6)  # a model in single precision
        self.assertAlmostEqual(log[0]["peak_residual_jy"] / first["misfit"]["clean"]["peak_residual_jy"], 1, places=5)
        both = self.tclean("both", niter=20, cycleniter=10)["misfit"]["clean"]
        self.assertAlmostEqual(second["misfit"]["clean"]["model_flux_jy"] / both["model_flux_jy"], 1, places=5)
        self.assertIn("restart=True begins with", self.refusal(imagename=self.name("on"), startmodel="m.fits", niter=1))

    @unittest.skipIf(fits is None, "there is no python3-astropy")
    def test_a_model_is_restored_corrected_and_predicted_without_more_components(self):
        first = self.tclean("zero", niter=30, mask="circle[[32pix,32pix],6pix]", outformat="fits")
        with misfit_files(self.folder, "zero", ("model", "mask", "residual", "image")) as before:
            made = self.tclean("zero", pbcor=True, savemodel="modelcolumn", outformat="fits")
        self.assertEqual((made["iterdone"], made["stopcode"], made["nmajordone"]), (0, 1, 1))
        self.assertAlmostEqual(made["misfit"]["clean"]["model_flux_jy"] / first["misfit"]["clean"]["model_flux_jy"], 1, places=6)
        self.assertIn(".image.pbcor.fits", self.files("zero"))
        for kind, pixels in before.items():
            np.testing.assert_allclose(fits.getdata(self.name(f"zero.{kind}.fits")), pixels, atol=1e-6 * np.nanmax(np.abs(pixels)))

    def test_a_mask_on_disk_is_kept_to(self):
        self.tclean("masked", niter=10, mask="circle[[20pix,32pix],6pix]")
        with self.assertLogs("misfit", logging.INFO) as said:
            again = self.tclean("masked", niter=10)
        self.assertTrue(any("CLEAN keeps to" in line for line in said.output))
        self.assertIn(".mask", self.files("masked"))
        self.assertTrue(again["misfit"]["options"]["mask"].endswith("masked.mask"))

    def test_another_number_of_terms_is_refused_beside_a_model(self):
        self.tclean("number", niter=2)
        self.assertIn("number.model, which restart=True goes on from", self.refusal(imagename=self.name("number"), niter=2,
                                                                                    deconvolver="mtmfs"))

    def test_without_restart_images_are_written_beside(self):
        self.tclean("beside", niter=2)
        self.tclean("beside", niter=2, restart=False)
        self.tclean("beside", niter=2, restart=False)
        for end in ("", "_1", "_2"):
            self.assertIn(".image", self.files("beside" + end))

    def test_images_that_are_to_be_there_are_named(self):
        self.assertIn("refused.psf does not exist", self.refusal(RuntimeError, calcpsf=False))
        self.assertIn("refused.residual.tt0 does not exist", self.refusal(RuntimeError, calcres=False, deconvolver="mtmfs", vis=self.sets))
        self.tclean("half", niter=2, deconvolver="mtmfs", outformat="fits")
        os.remove(self.name("half.model.tt1.fits"))
        self.assertIn("half.model.tt1 is not there: expected it beside",
                      self.refusal(imagename=self.name("half"), niter=2, deconvolver="mtmfs"))

    @unittest.skipIf(fits is None, "there is no python3-astropy")
    def test_a_pipelines_sequence_makes_the_image_of_one_call(self):
        mask = "circle[[32pix,32pix],24pix]"
        taken = dict(calcpsf=False, calcres=False)
        for number, kind in enumerate((dict(weighting="briggs"), dict(deconvolver="mtmfs"), dict(specmode="cube", outframe="LSRK"))):
            with self.subTest(**kind):
                given = dict(kind, vis=self.sets, niter=2000, cycleniter=40, outformat="fits")
                whole, first, steps = (f"{name}{number}" for name in ("whole", "first", "steps"))
                self.tclean(whole, **given, nmajor=4, threshold="1mJy", pbcor=True, mask=mask)
                self.tclean(first, **dict(given, niter=0))
                for path in self.folder.glob(first + ".*.fits"):
                    path.rename(self.folder / path.name.replace(first, steps))
                self.assertEqual(self.tclean(steps, **given, **taken, nmajor=1, threshold="9mJy", mask=mask)["nmajordone"], 2)
                self.tclean(steps, **given, **taken, nmajor=2, threshold="2mJy")
                self.tclean(steps, **given, **taken, nmajor=1, threshold="1mJy")
                self.tclean(steps, **dict(given, niter=0), **taken, pbcor=True)
                names = {path.name[len(whole):] for path in self.folder.glob(whole + ".*.fits")}
                self.assertLessEqual(names, self.files(steps))
                for end in names - {".alpha.fits", ".alpha.error.fits", ".alpha.pbcor.fits"}:  # what noise makes of quotients
                    pixels = fits.getdata(self.name(whole + end))
                    np.testing.assert_allclose(fits.getdata(self.name(steps + end)), pixels, err_msg=end,
                                               atol=3e-6 * np.nanmax(np.abs(pixels)))

    def test_what_is_taken_is_of_the_same_samples_and_weights(self):
        self.tclean("taken", weighting="briggs")
        for change, refused in ((dict(weighting="natural"), "taken.psf is .* where these samples give"),
                                (dict(weighting="briggs", spw="0:0~2"), "taken.residual is .* where these samples give"),
                                (dict(weighting="briggs", cell="0.21arcsec"), "taken.psf has other pixels"),
                                (dict(weighting="briggs", imsize=32), "taken.psf has 64 × 64 pixels"),
                                (dict(weighting="briggs", robust=0.4999), "taken.sumwt is .*, but the weights of")):
            message = self.refusal(RuntimeError, **{**dict(imagename=self.name("taken"), calcpsf=False, calcres=False), **change})
            self.assertRegex(message, refused)

    def test_the_newer_of_both_formats_goes_on(self):
        fluxes = [self.tclean("formats", niter=5, cycleniter=5, outformat=form)["misfit"]["clean"]["model_flux_jy"]
                  for form in ("casa", "fits", "fits", "casa")]
        self.assertEqual(fluxes, sorted(fluxes))
        self.assertEqual(len(set(fluxes)), 4)

    def test_calls_at_once_of_one_name_go_on_from_each_other(self):
        fluxes = []

        def call():
            fluxes.append(self.tclean("atonce", niter=5, cycleniter=5)["misfit"]["clean"]["model_flux_jy"])

        threads = [threading.Thread(target=call) for _ in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(set(fluxes)), 2)

    def test_a_call_within_a_call_is_refused(self):
        class Calling(logging.Handler):
            def __init__(self, call):
                super().__init__()
                self.call, self.said = call, None

            def emit(self, record):
                try:
                    self.call()
                except RuntimeError as error:
                    self.said = str(error)

        handler, log = Calling(lambda: self.tclean("within")), logging.getLogger("misfit")
        log.addHandler(handler)
        self.addCleanup(log.removeHandler, handler)
        self.tclean("outer", cell="1arcsec")  # which warns
        self.assertIn("a run of misfit is going on in this thread", handler.said)


@unittest.skipIf(fits is None, "there is no python3-astropy")
class ByHand(Sets):
    """CLEAN a major cycle at a time."""

    def test_cycles_without_masks_are_those_of_one_run(self):
        whole = self.tclean("whole", niter=60, cycleniter=20, outformat="fits")
        cycles = list(misfit.clean_cycles(self.sets[0], imagename=self.name("cycles"), imsize=64, cell="0.2arcsec", niter=60,
                                          cycleniter=20))
        self.assertEqual([cycle.number for cycle in cycles], [0, 1, 2, 3])
        np.testing.assert_array_equal(cycles[-1].residual, fits.getdata(self.name("whole.residual.fits")))
        for cycle, peak in zip(cycles[1:], whole["summaryminor"][0][0][0]["peakRes"]):
            self.assertAlmostEqual(np.abs(cycle.residual).max() / peak, 1, places=6)

    def test_each_cycle_keeps_to_the_mask_that_was_drawn(self):
        drawn = np.zeros((64, 64), bool)
        models = []
        for cycle in misfit.clean_cycles(self.sets[0], imagename=self.name("drawn"), imsize=64, cell="0.2arcsec", niter=90,
                                         cycleniter=15):
            if cycle.number:
                models.append(fits.getdata(self.name("drawn.model.fits"))[0, 0])
            drawn[:, 20 * min(2, cycle.number):20 * min(2, cycle.number) + 20] = True  # a strip more each time
            cycle.mask = drawn if cycle.number < 3 else cycle.mask
            if cycle.number == 4:
                break
        for model, strips in zip(models, (20, 40, 60, 60)):
            self.assertFalse(model[:, strips:].any())
            self.assertTrue(model[:, :strips].any())
        self.assertEqual(cycle.result["misfit"]["clean"]["iterations"], 60)

    def test_it_begins_anew_alone(self):
        self.tclean("begun", niter=2, outformat="fits")
        arguments = dict(imagename=self.name("begun"), imsize=64, cell="0.2arcsec")
        for parameters, words in ((dict(niter=5), "expected one without a model"), (dict(nmajor=2), "clean_cycles() decides it"),
                                  (dict(outformat="casa"), "expected 'fits' or 'both'")):
            with self.assertRaises(ValueError) as refused:
                next(misfit.clean_cycles(self.sets[0], **{**arguments, **parameters}))
            self.assertIn(words, str(refused.exception))

    def test_the_example_runs(self):
        example = Path(misfit.__file__).parents[1] / "clean_by_hand.py"
        said = subprocess.run([sys.executable, example, self.sets[0], self.name("hand"), "64", "0.2arcsec"], check=True,
                              capture_output=True, text=True).stdout.splitlines()
        self.assertIn("after 0 major cycles", said[0])
        self.assertIn("after 1 major cycles", said[1])


class Refused(Sets):
    """One line that names parameter, value and what was expected."""

    def test_what_is_not_made_yet_is_refused_by_name(self):
        for parameters in (dict(gridder="awp2"), dict(facets=4), dict(gridder="awproject"), dict(weighting="radial"),
                           dict(stokes="pseudoQ"), dict(cell={"value": None, "unit": "arcsec"}), dict(phasecenter=3.2), dict(phasecenter=None),
                           dict(specmode="cube", width={"m0": 5}), dict(specmode="cube", start={"value": "x", "unit": "GHz"}),
                           dict(specmode="cube", start={"m0": {"value": 5, "unit": "km/s"}, "refer": "OPTICAL"}), dict(specmode="cubesky"), dict(outframe="REST", specmode="cube"),
                           dict(veltype="beta", specmode="cube", start="3km/s", restfreq="4GHz"), dict(outframe="BARY", specmode="cubedata"),
                           dict(usemask="shape"), dict(usemask="auto-multithresh", negativethreshold=-7.0, niter=1),
                           dict(outlierfile="o.txt"), dict(interactive=True), dict(projection="NCP"), dict(usepointing=True), dict(psfphasecenter=0), dict(usepointing=2),
                           dict(normtype="pbsquare", gridder="mosaic"), dict(vptable="a.vp", gridder="mosaic"),
                           dict(psfphasecenter=[1], gridder="mosaic"), dict(psfphasecenter=True, gridder="mosaic"),
                           dict(deconvolver="mem"), dict(pbmask=0.1, niter=1), dict(niter=-1),
                           dict(cell=["1arcsec", "2arcsec"]), dict(imsize=[64.5]), dict(gain=2, niter=1),
                           dict(datacolumn=""), dict(datacolumn=None), dict(savemodel="virtual"), dict(deconvolver="mtmfs", nterms=1), dict(imagename="a\nb"), dict(calcpsf="False"),
                           dict(specmode=5), dict(gridder=[]), dict(vis=5), dict(vis=b"x"), dict(nterms=None, deconvolver="mtmfs"),
                           dict(imagename="x\udcff"), dict(restart=False, calcres=False), dict(imsize="6\n4"),
                           dict(savemodel="modelcolumn"), dict(reffreq="1GHz"),
                           dict(mask=5, niter=1), dict(scales="0,5"), dict(stokes=["I"]), dict(gain=None),
                           dict(imsize=[]), dict(datacolumn=["data", "data"]), dict(niter=""), dict(pblimit="x"),
                           dict(pblimit=-1), dict(specmode="cube", start=1.5), dict(imagename=None),
                           dict(threshold=[1], niter=1), dict(vis=[]), dict(imagename=""), dict(spw=["0", "0", "0"])):
            with self.subTest(parameters):
                words = self.refusal(**parameters)
                self.assertEqual(len(words.splitlines()), 1)
                self.assertIn(next(name for name in parameters if name not in ("niter", "specmode", "usemask") or len(parameters) == 1), words)
                self.assertIn("expected", words)
                self.assertNotIn("--", words)
        self.assertEqual(self.files("refused"), set())

    def test_data_that_cannot_be_used_are_named(self):
        self.assertEqual(self.refusal(RuntimeError, vis="nosuch.ms"), "nosuch.ms does not exist; expected a MeasurementSet")
        self.assertIn("spw '7': the set has no such spectral window; expected some of 0 (", self.refusal(RuntimeError, spw="7"))
        self.assertIn("has no visibilities in a column 'residual'", self.refusal(RuntimeError, datacolumn="residual"))


class Pointings(Sets):
    """Two sets of three pointings of wide dishes, whose beams half overlap."""

    PLACE = "J2000 04h00m00s +40d00m00s"
    SIMULATED = ("--array", "vla-d", "--dishes", 100, "--pointings", "hex,3,1arcmin", "--primary-beam", "--interval", 60, "--cell",
                 "0.4arcsec")
    GIVEN = dict(imsize=[48, 40], cell="5arcsec", phasecenter=PLACE, gridder="mosaic")


class Mosaics(Pointings):
    """Pointings that become one image."""

    @unittest.skipIf(fits is None, "there is no python3-astropy")
    def test_bits_are_those_of_the_program(self):
        options = ["--vis", *self.sets, "--imsize", 48, 40, "--cell", "5arcsec", "--phasecenter", self.PLACE, "--gridder", "mosaic"]
        for name, end, parameters, words in (
                ("flatsky", "", dict(normtype="flatsky", psfphasecenter=1, weighting="briggs", mosweight=False),
                 ["--normtype", "flatsky", "--psfphasecenter", 1, "--weighting", "briggs", "--mosweight", "false"]),
                ("cube", "", dict(gridder="ftmosaic", psfphasecenter=self.PLACE, weighting="uniform", niter=9, specmode="cube", nchan=2),
                 ["--psfphasecenter", self.PLACE, "--weighting", "uniform", "--niter", 9, "--specmode", "cube", "--nchan", 2]),
                ("terms", ".tt0", dict(gridder="mosaicft", deconvolver="mtmfs", niter=9, psfphasecenter=[], beam="airy:80:5"),
                 ["--nterms", 2, "--niter", 9, "--beam", "airy:80:5"])):
            with self.subTest(name):
                self.tclean(name, vis=self.sets, outformat="fits", pbcor=True, **parameters)
                run("image", "--imagename", self.name("p" + name), *options, *words, "--pbcor", "--products", "tclean", "--quiet")
                for kind in ("psf", "residual", "image", "pb", "weight"):
                    ours, programs = (fits.getdata(self.name(f"{which}.{kind}{end}.fits")) for which in (name, "p" + name))
                    np.testing.assert_array_equal(ours, programs, kind)

    def test_images_have_the_names_of_tclean(self):
        wanted = {".psf", ".residual", ".model", ".image", ".mask", ".pb", ".image.pbcor", ".sumwt", ".weight"}
        self.tclean("names", niter=5, pbcor=True)
        self.assertLessEqual(wanted, self.files("names"))
        self.tclean("ofterms", niter=5, deconvolver="mtmfs")
        self.assertLessEqual({".psf.tt2", ".image.tt1", ".alpha", ".pb.tt0", ".weight.tt0"}, self.files("ofterms"))

    @unittest.skipIf(fits is None, "there is no python3-astropy")
    def test_flat_noise_is_the_flat_sky_times_the_beam(self):
        for normtype in ("flatnoise", "flatsky"):
            self.tclean(normtype, normtype=normtype, outformat="fits")
        noise, sky, beam = (fits.getdata(self.name(name + ".fits")) for name in ("flatnoise.residual", "flatsky.residual", "flatsky.pb"))
        seen = np.isfinite(beam)
        self.assertGreater(seen.sum(), 1000)
        np.testing.assert_allclose(noise[seen], (sky * beam)[seen], rtol=0, atol=1e-6 * np.abs(noise).max())

    def test_pointings_are_those_of_the_table_if_asked(self):
        self.assertIn("POINTING has no rows", self.refusal(RuntimeError, usepointing=True))

    def test_clean_goes_on_from_the_model_on_disk(self):
        first, second = (self.tclean("on", niter=10, cycleniter=10, calcres=new, calcpsf=new)["misfit"]["clean"] for new in (True, False))
        self.assertAlmostEqual(second["major_cycles_log"][0]["peak_residual_jy"] / first["peak_residual_jy"], 1, places=5)

    def test_refusals_name_what_there_is(self):
        self.assertEqual(self.refusal(gridder="awproject"),
                         "gridder='awproject': expected 'mosaic', which has the beam of each antenna at each frequency")
        self.assertEqual(self.refusal(normtype="pbsquare"), "normtype='pbsquare': expected 'flatnoise' or 'flatsky'")
        self.assertEqual(self.refusal(gridder="standard", usepointing=True), "usepointing=True: expected gridder='mosaic' beside it")
        self.assertEqual(self.refusal(gridder="wproject", psfphasecenter=0), "psfphasecenter=0: expected gridder='mosaic' beside it")
        self.assertIn("lies outside the image", self.refusal(RuntimeError, psfphasecenter="J2000 04h00m00s +41d00m00s"))

    def test_what_is_not_needed_is_said(self):
        with self.assertLogs("misfit", logging.INFO) as said:
            self.tclean("said", mosweight=False, conjbeams=True, wbawp=False, computepastep=5.0)
        for told in ("mosweight=False changes nothing: natural weights", "conjbeams=True changes nothing: mosaics have each frequency's",
                     "wbawp=False changes nothing", "computepastep=5.0 changes nothing: it is of gridder='awproject'"):
            self.assertTrue(any(told in line for line in said.output), told)


@unittest.skipUnless(CALLS.exists(), f"there is no {CALLS}")
class Pipelines(Pointings):
    """The calls that a pipeline made, with names, places, channels and sizes of their own."""

    REPLACED = ("sets", "same_spw_in_all_sets", "calls", "origin")
    ALIKE = ("threshold", "robust", "niter", "parallel")  # calls that differ in these alone are one

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        file = json.loads(CALLS.read_text())
        cls.calls = {}
        for kind in file["kinds"]:
            call = {**file["the_same_in_all_calls"], **kind}
            sets = min(2, call["sets"])
            cube = call["specmode"] == "cube"
            for name in cls.REPLACED:
                call.pop(name, None)
            call.update(cls.GIVEN, vis=cls.sets[:sets], field="", spw=["0"] * sets, antenna=[""] * sets, scan=[""] * sets, intent="",
                        nchan=2 if cube else -1, start="", width="", niter=min(20, call["niter"]), reffreq="",
                        gridder=call["gridder"])
            form = {name: value for name, value in call.items() if name not in cls.ALIKE}
            kind = {name: value for name, value in form.items() if isinstance(value, (bool, str, list))}
            cls.calls.setdefault(json.dumps(kind), {})[json.dumps(form)] = call

    def test_each_runs_whole(self):
        self.assertGreater(len(self.calls), 4)
        for number, (call, *_) in enumerate(alike.values() for alike in self.calls.values()):
            with self.subTest(number), contextlib.redirect_stderr(io.StringIO()):
                name = f"kind{number}"
                masked = dict(call, imagename=self.name(name))
                misfit.tclean(**dict(masked, niter=0, calcres=True, calcpsf=True))
                made = misfit.tclean(**masked)
                self.assertEqual(set(made), RETURNED)
                end = ".tt0" if call["deconvolver"] == "mtmfs" else ""
                wanted = {f".{kind}{end}" for kind in ("psf", "residual", "pb", "weight", "sumwt")}
                if call["niter"]:
                    wanted |= {f".model{end}", f".image{end}", ".alpha" if end else ".image.pbcor"}
                self.assertLessEqual(wanted, self.files(name))

    def test_numbers_of_each_are_taken(self):
        with contextlib.redirect_stderr(io.StringIO()):
            for call in itertools.chain(*(alike.values() for alike in self.calls.values())):
                self.assertIn("plan", misfit.tclean(**dict(call, imagename=self.name("numbers"), calcres=True, calcpsf=True, dryrun=True)))


if __name__ == "__main__":
    unittest.main()
