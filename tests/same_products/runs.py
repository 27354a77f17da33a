"""The runs of tests/same-products: for each name the steps that are taken in a folder of its own, where `in` are the inputs.

    misfit WORD…            must end with code 0
    refused CODE WORD…      misfit WORD… must end with that code
    ranks N WORD…           misfit WORD… in N processes of mpirun
    learned WORD…           misfit WORD… knows the times that an earlier run took
    killed FILE TEXT WORD…  misfit WORD… is killed as soon as the file holds the text; `.err` is what it says on stderr
    copy NAME               in/NAME.ms becomes NAME.ms here, to be written to
    arrays                  arrays.py with the Python module, where --modules names two
"""

CUBE = "--specmode cube"
CLEAN = "--niter 300"
LINE = "--imsize 96 --cell 1arcsec"
COARSE = "--imsize 256 --cell 20arcsec"
DEEP = "--niter 20000 --threshold 5mJy --imsize 512 --cell 0.3arcsec"
STILL = "--phasecenter 'J2000 4h00m00s +40d00m00s'"


def image(sets, options="", name="a", step="misfit", threads=2):
    """An image of sets among the inputs, or of files here, which end in .ms."""
    size = "" if "--imsize" in options else " --imsize 128 --cell 0.3arcsec"
    vis = " ".join(word if word.endswith(".ms") else f"in/{word}.ms" for word in sets.split())
    return f"{step} image --vis {vis} --imagename {name}{size} --threads {threads} {options}"


def predict(name, options, step="misfit"):
    return f"{step} predict --vis {name}.ms --threads 2 {options}"


def refused_image(code, sets, options):
    return image(sets, f"--imsize 64 --cell 0.3arcsec {options}", step=f"refused {code}")


REFUSALS = [
    refused_image(1, "nowhere", ""),
    refused_image(2, "narrow", "--robbust 1"),
    refused_image(2, "narrow", "--robust 7"),
    refused_image(2, "narrow", "--niter -3"),
    refused_image(2, "narrow", "--accuracy 1e-20"),
    refused_image(2, "narrow", "--nterms 2 --specmode cube"),
    refused_image(2, "narrow", "--deconvolver multiscale"),
    refused_image(1, "narrow", "--niter 5 --mask nowhere.fits"),
    refused_image(1, "narrow", "--stokes V"),
    refused_image(1, "narrow", "--field 7"),
    refused_image(1, "narrow", "--scan 9"),
    refused_image(1, "narrow", "--datacolumn NOTHING"),
    refused_image(1, "narrow beside", ""),
    refused_image(1, "far_fields", ""),
    refused_image(1, "fields", "--pblimit 0.1"),
    refused_image(1, "two_centres", ""),
    refused_image(1, "turning", ""),
    refused_image(1, "narrow", "--phasecenter TRACKFIELD"),
    "refused 2 image --vis in/narrow.ms --imagename a --imsize 64 --cell 0.3parsec",
    "refused 2 image --imsize 64 --cell 1arcsec",
    "refused 1 predict --vis in/narrow.ms --components in/wrong.csv",
    "refused 2 predict --vis in/narrow.ms",
    "refused 2 kernel --width 0 --output k.fits",
    "refused 2 kernel --width 7 --emit nobody --output k.h",
    "refused 2 kernel --emit ducc --width 6 --output k.h",
    "refused 1 simulate --output in/narrow.ms",
    "refused 2 nothing",
]

WEIGHTS = {
    "natural": [image("narrow")],
    "uniform, uv taper": [image("narrow", "--weighting uniform --uvtaper 2arcsec")],
    "superuniform": [image("narrow", "--weighting superuniform --npixels 4")],
    "uniform, rank filter, uv limits with edges": [image("narrow", "--weighting uniform --weighting-rank-filter 2 --minuv-l 500 "
                                                         "--maxuv-l 20klambda --taper-tukey 5klambda --taper-inner-tukey 300")],
    "briggs, verified, sources outside": [image("narrow", "--weighting briggs --robust 0 --verify 100 --check-outside")],
    "selected": [image("narrow", "--spw 0:1~2 --uvrange >500m --antenna !0 --timerange >04:30:00 --scan 1 --stokes XX "
                                 "--imsize 100 80 --cell 0.25arcsec")],
    "samples left out, WEIGHT_SPECTRUM": [image("spoiled", f"{CLEAN} --weighting briggs --verify 100")],
    "little memory": [image("narrow", f"{CLEAN} --memory 0.13")],
    "options from a file, then as that run left them": ["misfit image --config in/run.ini --niter 50",
                                                        "misfit image --config a.last.ini --imagename b"],
}

CLEANS = {
    "hogbom": [image("narrow", f"{CLEAN} --nsigma 4 --gain 0.2 --cyclefactor 1.5 --outformat both")],
    "clark": [image("narrow", f"{CLEAN} --deconvolver clark --threshold 20mJy --restoringbeam 1.5arcsec,1arcsec,20deg")],
    "multiscale": [image("narrow", f"{CLEAN} --deconvolver multiscale --scales 0,4,9 --smallscalebias 0.4 --weighting briggs")],
    "cycles": [image("narrow", f"{CLEAN} --cycleniter 40 --nmajor 3 --minpsffraction 0.1 --maxpsffraction 0.5")],
    "without messages": [image("narrow", f"{CLEAN} --quiet")],
    "one hand after the other": [image("polarised", f"{CLEAN} --stokes XXYY --datacolumn data")],
    "IQUV": [image("polarised", f"{CLEAN} --stokes IQUV --weighting briggs --verify 50 --outformat both")],
    "IQ of samples left out": [image("spoiled", f"{CLEAN} --stokes IQ --deconvolver clark")],
    "masks of regions": [image("narrow", f"{CLEAN} --mask in/region.crtf"), image("narrow", f"{CLEAN} --mask in/region.reg", "b")],
    "auto mask, then as FITS and CASA image": [
        image("narrow", f"{CLEAN} --usemask auto --noisethreshold 4 --growiterations 20 --minbeamfrac 0.1 --outformat both"),
        image("narrow", f"{CLEAN} --mask a.mask.fits", "b"),
        image("narrow", f"{CLEAN} --mask a.mask --imsize 150 --cell 0.25arcsec", "c")],
    "start model": [image("narrow", "--niter 60"), image("narrow", f"{CLEAN} --startmodel a.model.fits --deconvolver clark", "b")],
    "circular beam, two sides of a pixel": [
        image("narrow", f"{CLEAN} --restoringbeam circular --imsize 128 --cell 0.3arcsec 300mas")],
    "restart": [image("narrow", "--niter 40"), image("narrow", f"{CLEAN} --restart"),
                image("narrow", "--niter 400 --restart --weighting uniform", step="refused 1")],
    "restart after a kill": [image("narrow", DEEP, step="killed .err components,"), image("narrow", f"{DEEP} --restart")],
}

CUBES = {
    "cube": [image("line", f"{CUBE} {CLEAN} {LINE} --restfreq 1.42GHz --outframe LSRK --nsigma 4")],
    "cube, common beam": [image("line", f"{CUBE} {CLEAN} {LINE} --restoringbeam common --weighting briggs --outformat both "
                                        "--nchan 5 --start 2 --perchanweightdensity false")],
    "cube of velocities in BARY, nearest channels": [
        image("line", f"{CUBE} {LINE} --interpolation nearest --outframe BARY --restfreq 1.4202GHz --chanwidth -21km/s "
                      "--pblimit 0.1")],
    "cube of IQ": [image("polarised", f"{CUBE} {CLEAN} --stokes IQ --outframe TOPO --deconvolver multiscale --scales 0,4 "
                                      "--usemask auto")],
    "cube of two windows": [image("windows", f"{CUBE} {LINE} --spw 1,0 --niter 30")],
    "cube restarted": [image("line", f"{CUBE} {LINE} --niter 40"), image("line", f"{CUBE} {LINE} --niter 90 --restart")],
    "cube, masks and start models by planes": [
        image("line", f"{CUBE} {CLEAN} {LINE} --usemask auto --nchan 6"),
        image("line", f"{CUBE} {CLEAN} {LINE} --nchan 6 --mask a.mask.fits --startmodel a.model.fits", "b")],
    "cube of little memory and one thread": [image("line", f"{CUBE} {CLEAN} {LINE} --memory 0.12", threads=1)],
    "cube, pbcor": [image("line", f"{CUBE} {CLEAN} {LINE} --pbcor --nchan 4 --chanwidth 3")],
}

RANKS = {
    "cube of 3 ranks": [image("line", f"{CUBE} {CLEAN} {LINE} --restoringbeam common", step="ranks 3")],
    "cube of 2 ranks, restarted by 3": [image("line", f"{CUBE} {LINE} --niter 40", step="ranks 2"),
                                        image("line", f"{CUBE} {LINE} --niter 90 --restart", step="ranks 3")],
    "2 ranks": [image("narrow", f"{CLEAN} --weighting briggs --verify 50", step="ranks 2")],
    "3 ranks, several sets, IQ, wide": [
        image("narrow beside", f"{CLEAN} --stokes IQ --phasecenter 0 --gridder wide", step="ranks 3")],
    "2 ranks, terms": [image("band", f"{CLEAN} --nterms 2", step="ranks 2")],
}

TERMS = {
    "2 terms, scales": [image("band", f"{CLEAN} --nterms 2 --deconvolver multiscale --scales 0,4,9 --outformat both")],
    "3 terms, reference frequency": [
        image("band", f"{CLEAN} --nterms 3 --reffreq 3.5GHz --weighting briggs --nsigma 3 --verify 50")],
    "2 terms, begun with those of a model": [
        image("band", f"{CLEAN} --nterms 2 --restoringbeam common"),
        image("band", f"{CLEAN} --nterms 2 --startmodel a.model.tt0.fits a.model.tt1.fits", "b")],
    "2 terms, pbcor": [image("band", f"{CLEAN} --nterms 2 --pbcor --pblimit 0.1")],
    "2 terms, restarted": [image("band", "--nterms 2 --niter 40"), image("band", "--nterms 2 --niter 120 --restart")],
    "2 terms, auto mask": [image("band", f"{CLEAN} --nterms 2 --usemask auto")],
}

PLACES = {
    "several sets": [image("narrow beside", f"{CLEAN} --phasecenter 0 --weighting uniform --usemask auto")],
    "several sets to a direction, cube": [
        image("beside narrow", f"{CUBE} --niter 50 --nchan 2 --phasecenter 'J2000 4h00m00.5s +40d00m05s'")],
    "phase centres equal but for rounding": [image("narrow nearly", CLEAN)],
    "pbcor": [image("dimmed", f"{CLEAN} --pbcor --outformat both"), image("dimmed", "--pblimit 0.3", "b")],
    "fields that point apart": [image("fields", CLEAN), image("far_fields", "--force-average", "b"),
                                image("far_fields", f"{CUBE} --force-average", "c"),
                                image("two_centres", "--phasecenter BESIDE", "d")],
    "fields that move": [image("moving", CLEAN), image("moving", f"{CLEAN} {STILL}", "b"),
                         image("moving", f"{CUBE} --niter 20 --nchan 2", "c"), image("turning", STILL, "d")],
    "field with an ephemeris": [image("tracking", CLEAN), image("tracking", f"{CUBE} --phasecenter TRACKFIELD", "b"),
                                "copy tracking", predict("tracking", "--model a.model.fits")],
}

WIDE = {
    "wide": [image("wide", f"{CLEAN} --imsize 768 --cell 8arcsec --weighting briggs --verify 60 --check-outside --pblimit 0.2")],
    "wide cube": [image("wide", f"{CUBE} --niter 60 --imsize 512 512 --cell 12arcsec --deconvolver clark")],
    "wide, coplanar by option": [image("wide", f"{CLEAN} --gridder standard --imsize 256 --cell 8arcsec")],
    "wide, spheroidal": [image("wide", "--kernel spheroidal --kernel-width 6 --padding 1.5 --imsize 300 200 --cell 20arcsec")],
    "accuracy 1e-2": [image("wide", f"{COARSE} --accuracy 1e-2 --verify 100")],
    "accuracy 1e-4, minimax": [image("wide", f"{COARSE} --accuracy 1e-4 --kernel minimax --verify 100")],
    "accuracy 1e-9": [image("wide", f"{COARSE} --accuracy 1e-9 --psf-accuracy 1e-9 --verify 100")],
    "accuracy 1e-12": [image("narrow", "--accuracy 1e-12 --verify 100")],
    "kernel values from a table": [
        image("narrow", "--kernel-width 5 --padding 2 --evaluation linear --sampling 500 --precision double")],
}

MODELS = {
    "mosaic": [image("narrow", CLEAN), image("narrow", f"{CLEAN} --restoringbeam 1.5arcsec --pbcor", name="b"),
               "misfit mosaic a.image.fits b.image.fits --output m --outformat both --threads 2"],
    "predict": ["copy narrow", image("narrow", CLEAN), predict("narrow", "--model a.model.fits"),
                predict("narrow", "--components a.components.csv --column EXACT"),
                predict("narrow", "--components in/points.csv --column POINTS --field 0 --spw 0:1~2")],
    "predict, subtract": ["copy narrow", image("narrow", CLEAN, name="first"),
                          predict("narrow", "--model first.model.fits --subtract --accuracy 1e-4"),
                          predict("narrow", "--model first.model.fits --subtract", step="refused 1"), image("narrow.ms", CLEAN)],
    "predict after a kill": ["copy line",
                             "killed line.ms/misfit_unfinished_MODEL_DATA 'done 0 ' predict --vis line.ms --components in/many.csv",
                             predict("line", "--components in/many.csv --quiet")],
    "predict of 3 ranks": ["copy wide", image("wide", f"{CLEAN} --imsize 300 --cell 20arcsec"),
                           predict("wide", "--model a.model.fits", step="ranks 3")],
    "predict Stokes parameters": ["copy polarised", predict("polarised", "--components in/polarised.csv --column SUMS"),
                                  image("polarised", f"{CLEAN} --stokes IQUV"), predict("polarised", "--model a.model.fits")],
    "predict into fields that move, or several": [
        "copy moving", predict("moving", "--components in/points.csv"),
        "copy two_centres", predict("two_centres", "--components in/points.csv"),
        "copy beside", predict("beside", f"--components in/points.csv {STILL}")],
    "savemodel": ["copy narrow", "copy beside", image("narrow.ms beside.ms", f"{CLEAN} --phasecenter 0 --savemodel modelcolumn"),
                  image("narrow.ms", "--datacolumn model", "b")],
    "savemodel of terms": ["copy band", image("band.ms", "--niter 50 --savemodel modelcolumn --nterms 2")],
}

OTHERS = {
    "plan": [image("wide", "--dry-run --niter 100 --imsize 2048 --cell 8arcsec --check-outside --weighting briggs"),
             image("band", "--dry-run --niter 100 --nterms 2 --deconvolver multiscale --scales 0,6"),
             image("line", f"--dry-run {CUBE} --niter 100"), image("narrow", "--dry-run --niter 100", step="learned")],
    "plan of nodes": [
        image("wide", "--dry-run --nodes 16 --niter 100 --visibilities 1e11 --imsize 4096 --cell 4arcsec --network 5")],
    "simulate": ["misfit simulate --output a.ms --sky in/wide.csv --array vla-d --hours 1 --interval 600 --channels 2 "
                 "--noise 1Jy --seed 8",
                 "misfit simulate --output b.ms --primary-beam --noncoplanar --ra 10deg --dec -20deg --frequency 1.4GHz"],
    "kernels": ["misfit kernel --width 7 --padding 2 --output k.fits",
                "misfit kernel --inspect k.fits", "misfit kernel --inspect k.fits --json",
                "misfit kernel --kernel minimax --width 5 --x0 0.3 --sampling 64 --interpolation 2 --degree 6 --output m.fits",
                "misfit kernel --accuracy 1e-6 --imsize 4096 --samples 2e7",
                "misfit kernel --accuracy 1e-4 --imsize 1024 --samples 1e6 --w-turns 30 --kernel kaiser-bessel",
                image("narrow", "--kernel k.fits")],
    "kernels for other hosts": [f"misfit kernel --emit {host} --width 6 --output k.{host} {more}" for host, more in (
        ("casacore", "--padding 1.2"), ("wsclean", "--force"), ("ducc", "--padding 2"), ("finufft", "--padding 2"),
        ("c-header", "--padding 2"), ("csv", "--padding 2"))],
    "refusals": REFUSALS,
    "help": ["misfit --help"] + [f"misfit {command} --help" for command in (
        "image", "predict", "simulate", "kernel", "report", "report kernels", "report scene", "report stability")],
    "report scene": ["misfit report scene --vis in/wide.ms --imsize 200 --cell 20arcsec --quick --seconds 1 --threads 2 "
                     "--output page"],
    "arrays": ["arrays"],
}

OBSERVED = {
    "ALMA, three windows": [
        image("alma_hd142527_b9", f"{CLEAN} --imsize 256 --cell 0.04arcsec --weighting briggs --usemask auto"),
        image("alma_hd142527_b9", f"{CUBE} --imsize 64 --cell 0.1arcsec --spw 1,2 --niter 30 --nchan 4", "b")],
    "ALMA, three of many fields": [image("alma_antennae_mosaic", f"{CLEAN} --field 10~12 --phasecenter 10")],
    "ASKAP, IQUV": [image("askap36_sim_4chan", f"{CLEAN} --imsize 512 --cell 6arcsec --weighting briggs --robust 0 --stokes IQUV")],
    "ATCA": [image("atca_sim_tileddata", f"{CLEAN} --imsize 128 --cell 4arcsec --datacolumn corrected"),
             image("atca_sim_tileddata", f"{CUBE} --niter 50 --imsize 128 --cell 4arcsec", "b")],
    "LOFAR": [image("lofar_3c295_snapshot", f"{CLEAN} --imsize 1024 --cell 20arcsec --uvrange <5klambda --weighting briggs")],
    "VLBA, IV": [image("vlba_m87_mojave", f"{CLEAN} --imsize 256 --cell 0.0002arcsec --weighting briggs --robust 0 --stokes IV")],
}

RUNS = WEIGHTS | CLEANS | CUBES | RANKS | TERMS | PLACES | WIDE | MODELS | OTHERS | OBSERVED

LONG = {
    "report kernels": ["misfit report kernels --output page"],
    "report stability": ["misfit report stability --quick --output page"],
}

# Columns of CSV files that hold times, or what follows from them; and files that are made of such.
MEASURED_COLUMNS = {"report scene": {"time_s", "pareto", "grid_s", "fft_s", "degrid_s", "predict_fft_s", "spread", "memory_gib",
                                     "seconds"}}
MADE_OF_TIMES = {"report scene": r"page/(index\.html|report\.json|front\.csv|(image|predict)-error\..*)|.*\.(out|err)",
                 "report kernels": r"page/(evaluation\.csv|index\.html|report\.json)"}
