"""What the runs of tests/same-products read: simulated MeasurementSets, changed where simulation has no option, and small files.

Each set is one that a program of the OLD build simulated, so that both builds read the same bytes."""
import os
import pathlib
import shutil
import subprocess

import numpy
from casacore import tables

SKY = """l_arcsec,m_arcsec,flux_jy,scale_arcsec,spectral_index,reference_frequency_hz
0,0,1,0,-0.7,4e9
9,6,0.5,0,0.3,4e9
-7,10,0.7,1.6,-1,4e9
-4,-11,0.1,0,-0.5,4e9
"""
WIDE_SKY = """l_arcsec,m_arcsec,flux_jy,scale_arcsec
100,-50,1,0
2400,1800,0.6,0
-2000,2300,0.4,30
-4300,-3900,2,0
"""
POLARISED = """l_arcsec,m_arcsec,flux_jy,flux_q_jy,flux_u_jy,flux_v_jy,scale_arcsec
0,0,1,0.1,0.05,0.01,0
9,6,0.5,-0.05,0.1,-0.02,0
-7,10,0.7,0,-0.1,0,1.6
"""
POINTS = "ra_deg,dec_deg,flux_jy\n60,40,1\n60.003,40.002,0.5\n"
WRONG_COLUMN = "l_arcsec,m_arcsec,flux_mjy\n0,0,1\n"
REGION = """#CRTFv0
global coord=J2000
circle [[04:00:00.0, +40.00.00.0], 4arcsec]
-circle [[04:00:00.0, +40.00.00.0], 1arcsec]
box [[60.002deg, 40.001deg], [60.005deg, 40.003deg]]
"""
DS9_REGION = """# Region file format: DS9
icrs
circle(60.0,40.0,5")
ellipse(60.0033,40.0017,4",2",30) # color=red
"""
CONFIG = 'vis="in/narrow.ms"\nimagename="a"\nimsize="96"\ncell="0.3arcsec"\nweighting="uniform"\nthreads="2"\n'
TEXTS = {"sky.csv": SKY, "wide.csv": WIDE_SKY, "polarised.csv": POLARISED, "points.csv": POINTS, "wrong.csv": WRONG_COLUMN,
         "region.crtf": REGION, "region.reg": DS9_REGION, "run.ini": CONFIG}

NARROW = "--sky sky.csv --array vla-b --coplanar --hours 1 --interval 120 --channels 4 --channel-width 10MHz --noise 0.2Jy"
SETS = {
    "narrow": NARROW,
    "snapshot": "--array vla-c --hours 0.2 --interval 60 --noise 10mJy",
    "beside": NARROW.replace("--coplanar", "--noncoplanar --ra 60.002deg --dec 39.999deg --seed 2"),
    "line": "--sky sky.csv --array vla-c --coplanar --hours 1 --interval 120 --frequency 1.42GHz --channels 12 "
            "--channel-width 50kHz --noise 0.3Jy --seed 3",
    "wide": "--sky wide.csv --array vla-b --hours 2 --interval 300 --frequency 300MHz --channels 3 --channel-width 4MHz "
            "--noise 0.1Jy",
    "band": "--sky sky.csv --array vla-b --coplanar --hours 1 --interval 120 --frequency 3GHz --channels 8 --channel-width 250MHz "
            "--noise 0.05Jy --seed 4",
    "dimmed": "--sky sky.csv --array vla-b --coplanar --hours 0.5 --interval 120 --primary-beam --noise 0.1Jy --seed 5",
}
DIRECTIONS = ("PHASE_DIR", "DELAY_DIR", "REFERENCE_DIR")
OBSERVATIONS = ["alma_antennae_mosaic", "alma_hd142527_b9", "askap36_sim_4chan", "atca_sim_tileddata", "lofar_3c295_snapshot",
                "vlba_m87_mojave"]


def opened(path):
    return tables.table(str(path), readonly=False, ack=False)


def copy_of(folder, name, copy):
    return pathlib.Path(shutil.copytree(folder / f"{name}.ms", folder / f"{copy}.ms"))


def make_four_correlations(path):
    """XX and YY become XX, XY, YX, YY: what was noise stays, and the new ones hold other noise."""
    random = numpy.random.default_rng(1)
    with opened(path) as rows:
        for name in ("DATA", "FLAG", "WEIGHT", "SIGMA"):
            old = rows.getcol(name)
            new = numpy.repeat(old, 2, axis=-1)
            if name == "DATA":
                new[..., 1:3] = random.normal(0, 0.2, new[..., 1:3].shape) + 1j * random.normal(0, 0.2, new[..., 1:3].shape)
            rows.removecols([name])
            kind = {"DATA": "complex", "FLAG": "boolean"}.get(name, "float")
            rows.addcols(tables.makearrcoldesc(name, old.flat[0].item(), new.ndim - 1, valuetype=kind))
            rows.putcol(name, new)
    with opened(path / "POLARIZATION") as products:
        products.putcell("NUM_CORR", 0, 4)
        products.putcell("CORR_TYPE", 0, numpy.array([9, 10, 11, 12], numpy.int32))
        products.putcell("CORR_PRODUCT", 0, numpy.array([[0, 0], [0, 1], [1, 0], [1, 1]], numpy.int32))


def spoil(path):
    """Leaves out samples for each reason that there is, and gives channels weights of their own."""
    with opened(path) as rows:
        data, flag, weight, uvw = (rows.getcol(name) for name in ("DATA", "FLAG", "WEIGHT", "UVW"))
        flag[::7, 0], flag[5::50] = True, True
        data[3::40, 1, 0], data[4, 2, 1] = numpy.nan, numpy.inf
        weight[2::30], weight[6::31] = 0, -1
        uvw[8::60] *= 300
        rows.putcol("DATA", data)
        rows.putcol("FLAG", flag)
        rows.putcol("UVW", uvw)
        rows.putcol("WEIGHT", weight)
        rows.putcol("ANTENNA2", numpy.where(numpy.arange(len(uvw)) % 45 == 9, rows.getcol("ANTENNA1"), rows.getcol("ANTENNA2")))
        rows.addcols(tables.makearrcoldesc("WEIGHT_SPECTRUM", 0.0, 2, valuetype="float"))
        spectrum = numpy.repeat(weight[:, None, :], data.shape[1], axis=1) * numpy.linspace(0.5, 2, data.shape[1])[:, None]
        rows.putcol("WEIGHT_SPECTRUM", spectrum.astype(numpy.float32))


def add_window(path):
    """The second half of the rows gets a spectral window of its own, 30 MHz higher."""
    with opened(path / "SPECTRAL_WINDOW") as windows:
        windows.addrows(1)
        for name in windows.colnames():
            if windows.iscelldefined(name, 0):
                windows.putcell(name, 1, windows.getcell(name, 0))
        windows.putcell("CHAN_FREQ", 1, windows.getcell("CHAN_FREQ", 0) + 30e6)
        windows.putcell("REF_FREQUENCY", 1, windows.getcell("REF_FREQUENCY", 0) + 30e6)
    with opened(path / "DATA_DESCRIPTION") as descriptions:
        descriptions.addrows(1)
        descriptions.putcell("SPECTRAL_WINDOW_ID", 1, 1)
        descriptions.putcell("POLARIZATION_ID", 1, descriptions.getcell("POLARIZATION_ID", 0))
    give_rows(path, "DATA_DESC_ID", lambda row, rows: row >= rows // 2)


def give_rows(path, column, is_one):
    with opened(path) as rows:
        row = numpy.arange(rows.nrows())
        rows.putcol(column, is_one(row, rows.nrows()).astype(numpy.int32))


def add_field(path, east_rad, moved):
    """Every second row gets a field, BESIDE, whose directions that are named in `moved` lie to the east of the first one's."""
    with opened(path / "FIELD") as fields:
        fields.addrows(1)
        for name in fields.colnames():
            fields.putcell(name, 1, fields.getcell(name, 0))
        fields.putcell("NAME", 1, "BESIDE")
        for name in moved:
            fields.putcell(name, 1, fields.getcell(name, 0) + numpy.array([[east_rad, 0]]))
    give_rows(path, "FIELD_ID", lambda row, _: row % 2)


def middle_s(path):
    with opened(path) as rows:
        return float(rows.getcol("TIME").mean())


def put_directions(fields, directions, frame=None):
    """Polynomials in time, [power][angle], of field 0, in another frame where one is named."""
    for name in DIRECTIONS:
        if frame:
            fields.putcolkeyword(name, "MEASINFO", {**fields.getcolkeyword(name, "MEASINFO"), "Ref": frame})
        fields.putcell(name, 0, numpy.array(directions))


def let_field_move(path):
    """The field's phase centre moves by some pixels in an hour, as NUM_POLY = 1 has it."""
    with opened(path / "FIELD") as fields:
        fields.putcell("NUM_POLY", 0, 1)
        fields.putcell("TIME", 0, middle_s(path))
        put_directions(fields, [*fields.getcell("PHASE_DIR", 0), [4e-9, -2e-9]])


def let_field_turn(path):
    """The field stands at an hour angle of 0, so that it moves along the sky."""
    with opened(path / "FIELD") as fields:
        put_directions(fields, [[0.0, fields.getcell("PHASE_DIR", 0)[0, 1]]], "HADEC")


def follow_ephemeris(path):
    """The field follows a body that moves by 2 degrees a day, in a table as CASA attaches it."""
    row = numpy.arange(97)
    places = {"MJD": middle_s(path) / 86400 + (row - 48) / 48, "RA": 60 + (row - 48) / 24, "DEC": 40 + (row - 48) / 96,
              "Rho": numpy.full(97, 5000.0), "RadVel": numpy.zeros(97)}
    description = tables.maketabdesc([tables.makescacoldesc(name, 0.0) for name in places])
    with tables.table(str(path / "FIELD/EPHEM0_Object.tab"), description, nrow=97, readonly=False, ack=False) as ephemeris:
        for name, column in places.items():
            ephemeris.putcol(name, column)
        ephemeris.putkeywords({"MJD0": places["MJD"][0] - 1 / 48, "dMJD": 1 / 48, "GeoLong": 0.0, "GeoLat": 0.0, "GeoDist": 0.0,
                               "NAME": "Object", "VS_CREATE": "2014/12/01/00:00", "VS_DATE": "2014/12/01/00:00",
                               "VS_TYPE": "Table of comet/planetary positions", "VS_VERSION": "0001.0001",
                               "posrefsys": "ICRF/ICRS", "obsloc": "GEOCENTRIC"})
        ephemeris.putinfo({"type": "IERS", "subType": "", "readme": ""})
    with opened(path / "FIELD") as fields:
        fields.addcols(tables.makescacoldesc("EPHEMERIS_ID", 0))
        fields.putcell("EPHEMERIS_ID", 0, 0)
        put_directions(fields, [[0.0, 0.0]], "ICRS")


def store_phase_apart(path, shift_rad):
    """A phase centre that lies so far from what it was, though visibilities stay."""
    with opened(path / "FIELD") as fields:
        put_directions(fields, fields.getcell("PHASE_DIR", 0) + shift_rad)


def unpacked_observations(folder):
    """Other people's observations, in the folder that MISFIT_TEST_DATA names, or ../shared/data; none where that is absent."""
    root = pathlib.Path(__file__).resolve().parents[2]
    data = pathlib.Path(os.environ.get("MISFIT_TEST_DATA", root / "../shared/data"))
    for name in OBSERVATIONS:
        archive = data / f"{name}.tar.xz"
        if archive.exists():
            subprocess.run(["tar", "-xJf", archive, "-C", folder], check=True)


def make(program, folder, environment):
    """Writes all inputs into the folder; `program` is the misfit that simulates."""
    def run(*words):
        subprocess.run([program, *words], cwd=folder, env=environment, check=True, stdout=subprocess.DEVNULL)

    many = "".join(f"{0.1 * i},{-0.2 * i},1\n" for i in range(400))
    for name, text in {**TEXTS, "many.csv": "l_arcsec,m_arcsec,flux_jy\n" + many}.items():
        (folder / name).write_text(text)
    for name, options in SETS.items():
        run("simulate", "--output", f"{name}.ms", "--quiet", *options.split())
    make_four_correlations(copy_of(folder, "narrow", "polarised"))
    run("predict", "--vis", "polarised.ms", "--components", "polarised.csv", "--column", "CORRECTED_DATA", "--quiet")
    spoil(copy_of(folder, "narrow", "spoiled"))
    add_window(copy_of(folder, "line", "windows"))
    add_field(copy_of(folder, "narrow", "fields"), 5e-4, ["REFERENCE_DIR"])
    add_field(copy_of(folder, "narrow", "far_fields"), 2e-2, ["REFERENCE_DIR"])
    add_field(copy_of(folder, "narrow", "two_centres"), 3e-5, DIRECTIONS)
    let_field_move(copy_of(folder, "narrow", "moving"))
    let_field_turn(copy_of(folder, "narrow", "turning"))
    follow_ephemeris(copy_of(folder, "narrow", "tracking"))
    store_phase_apart(copy_of(folder, "narrow", "nearly"), 1e-11)
    run("kernel", "--accuracy", "1e-4", "--imsize", "256", "--samples", "1e6")  # measures what transforms cost here
    run(*"image --vis narrow.ms --imagename timed --imsize 512 --cell 0.3arcsec --niter 100 --quiet".split())  # for times.json
    unpacked_observations(folder)
