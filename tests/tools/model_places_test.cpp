// What models and start models state of their place: equivalent statements predict the same, and all others are refused by
// name.
#include <complex>

#include "ms_io/celestial_frames.h"
#include "tests/stated_fits.h"
#include "tests/tools/casa_copy.h"
#include "tests/tools/program.h"
#include "tests/tools/set_changes.h"

BOOST_AUTO_TEST_SUITE(model_places)

namespace {

using namespace misfit;
using namespace misfit::tools::testing;
using misfit::testing::stated;
using misfit::testing::StatedCards;
using misfit::testing::with;
using misfit::testing::write_stated_fits;
using Visibilities = std::vector<std::complex<float>>;

constexpr double cell_deg = 0.1 / 3600, degree = M_PI / 180;

/// A copy of the snapshot, a model of its 64 × 64 pixels of 0.1 arcsec, and where they lie.
struct Model {
  TemporaryFolder folder;
  std::string set = folder / "copy.ms";
  imager::Image pixels{64, 64};
  StatedCards cards;
  double ra_deg = 0, dec_deg = 0;

  Model() {
    std::filesystem::copy(snapshot(), set, std::filesystem::copy_options::recursive);
    succeed(small_image(set, folder / "a"));
    const imager::SkyDirection centre = imager::read_fits(folder / "a.residual.fits").geometry.phase_centre;
    ra_deg = centre.ra_rad / degree;
    dec_deg = centre.dec_rad / degree;
    BOOST_REQUIRE(centre.frame == "FK5");
    pixels.at(25, 20) = 2;
    pixels.at(46, 53) = 1;
    cards = {{"CTYPE1", "'RA---SIN'"},
             {"CTYPE2", "'DEC--SIN'"},
             {"CRPIX1", "33"},
             {"CRPIX2", "33"},
             {"CRVAL1", stated(ra_deg)},
             {"CRVAL2", stated(dec_deg)},
             {"CDELT1", stated(-cell_deg)},
             {"CDELT2", stated(cell_deg)},
             {"RADESYS", "'FK5'"},
             {"EQUINOX", "2000."},
             {"BUNIT", "'Jy/pixel'"}};
  }

  std::string write(const StatedCards& changes) const {
    write_stated_fits(folder / "m.fits", pixels, with(cards, changes));
    return folder / "m.fits";
  }
  Visibilities predicted(const std::string& model) const {
    succeed({"predict", "--vis", set, "--model", model});
    return visibilities(set, "MODEL_DATA");
  }
};

/// The largest difference, as a part of the largest visibility.
double difference(const Visibilities& a, const Visibilities& b) {
  float most = 0, largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    most = std::max(most, std::abs(a[i] - b[i]));
    largest = std::max(largest, std::abs(b[i]));
  }
  return most / largest;
}

/// Of all visibilities, as a part of those of `b`.
double rms_difference(const Visibilities& a, const Visibilities& b) {
  double square = 0, norm = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    square += std::norm(a[i] - b[i]);
    norm += std::norm(b[i]);
  }
  return std::sqrt(square / norm);
}

/// Whether a run fails for what a file holds, and says so in one line with this in it.
bool refused(const Outcome& outcome, const std::string& part) {
  BOOST_TEST(outcome.code == 1);
  BOOST_TEST_INFO(outcome.err);
  return outcome.err.find(part) != std::string::npos && outcome.err.find("m.fits") != std::string::npos;
}

StatedCards in_unit(const Model& m, const std::string& name, double per_degree) {
  return {{"CUNIT1", "'" + name + "'"},
          {"CUNIT2", "'" + name + "'"},
          {"CRVAL1", stated(m.ra_deg * per_degree)},
          {"CRVAL2", stated(m.dec_deg * per_degree)},
          {"CDELT1", stated(-cell_deg * per_degree)},
          {"CDELT2", stated(cell_deg * per_degree)}};
}

/// What the model is about, and of which pixels, 64 × 64.
struct Reference {
  imager::SkyDirection at;
  double cells = 1;   ///< of the usual size
  double aspect = 1;  ///< height of a pixel over its width
  bool told = false;  ///< that it lies away from the phase centre

  imager::ImageGeometry geometry() const { return {64, 64, cell_deg * degree * cells, at, {}, aspect}; }
  StatedCards cards() const {
    const imager::ImageGeometry g = geometry();
    return {
        {"CRVAL1", stated(at.ra_rad / degree)},   {"CRVAL2", stated(at.dec_rad / degree)},
        {"CDELT1", stated(-g.cell_rad / degree)}, {"CDELT2", stated(g.cell_height_rad() / degree)},
        {"RADESYS", "'" + at.frame + "'"},        {"EQUINOX", at.frame == "FK4" ? "1950." : at.frame == "ICRS" ? "" : "2000."}};
  }
};

std::vector<Reference> references_about(const Model& m) {
  const double ra = m.ra_deg * degree, dec = m.dec_deg * degree, cell = cell_deg * degree;
  const imager::SkyDirection centre{ra, dec, "FK5"}, icrs = ms_io::in_frame(centre, "ICRS"),
                                                     fk4 = ms_io::in_frame(centre, "FK4");
  return {
      {{ra + 1e-10 * degree, dec - 1e-10 * degree, "FK5"}},
      {{ra, dec - 0.95e-3 * cell, "FK5"}},
      {{ra - 0.4 * cell, dec + 0.6 * cell, "FK5"}},
      {centre, 1.00002},
      {centre, 1, 1.00002},
      {centre, 1, 1 - 1e-5},
      {icrs},
      {{icrs.ra_rad + 0.3 * cell, icrs.dec_rad, "ICRS"}},
      {{ra, dec, "ICRS"}},  // 20 mas away, a fifth of a pixel
      {fk4},
      {{ra + 20 * cell, dec, "FK5"}, 1, 1, true},
      {{ra, dec - 0.02, "FK5"}, 1, 1, true},
      {{icrs.ra_rad + 0.2, icrs.dec_rad, "ICRS"}, 1, 1, true},
      {{fk4.ra_rad, fk4.dec_rad + 0.1, "FK4"}, 1, 1, true},
  };
}

/// The visibilities of the model's pixels by direct sums, each where `place(row, column)` has it, in the list's two columns.
template <typename Place>
Visibilities by_sums(const Model& m, const std::string& columns, const Place& place) {
  std::ofstream list(m.folder / "m.csv");
  list << columns << ",flux_jy\n";
  list.precision(17);
  for (int row = 0; row < 64; ++row)
    for (int column = 0; column < 64; ++column) {
      if (m.pixels.at(row, column) == 0) continue;
      const auto [x, y] = place(row, column);
      list << x << ',' << y << ',' << m.pixels.at(row, column) << '\n';
    }
  list.close();
  succeed({"predict", "--vis", m.set, "--components", m.folder / "m.csv"});
  return visibilities(m.set, "MODEL_DATA");
}

const StatedCards no_cdelt{{"CDELT1", ""}, {"CDELT2", ""}};
/// Pixels of a degree, among which no projection is another.
const StatedCards wide{{"CDELT1", "-1."}, {"CDELT2", "1."}};

}  // namespace

BOOST_AUTO_TEST_CASE(equivalent_statements_of_a_place_predict_the_same) {
  const Model m;
  const Visibilities usual = m.predicted(m.write({}));
  const std::vector<StatedCards> statements{
      in_unit(m, "rad", degree),
      in_unit(m, "arcsec", 3600),
      in_unit(m, "arcmin", 60),
      {{"LONPOLE", "180."}, {"LATPOLE", "12."}},
      {{"CROTA2", "0."}},
      {{"CROTA2", "180."}, {"CDELT1", stated(cell_deg)}, {"CDELT2", stated(-cell_deg)}},
      with(no_cdelt, {{"CD1_1", stated(-cell_deg)}, {"CD1_2", "0."}, {"CD2_1", "0."}, {"CD2_2", stated(cell_deg)}}),
      {{"PC1_1", "2."}, {"PC2_2", "2."}, {"CDELT1", stated(-cell_deg / 2)}, {"CDELT2", stated(cell_deg / 2)}},
      {{"LONPOLE", "90."}, {"PC1_1", "0."}, {"PC1_2", "-1."}, {"PC2_1", "1."}, {"PC2_2", "0."}},
      {{"PV2_1", "0."}, {"PV2_2", "0."}},
      {{"EQUINOX", ""}},
      {{"RADESYS", ""}},
      {{"RADESYS", ""}, {"EQUINOX", ""}, {"EPOCH", "2000."}},
      {{"RADESYS", ""}, {"RADECSYS", "'FK5'"}},
      {{"CTYPE1", "'RA---TAN'"}, {"CTYPE2", "'DEC--TAN'"}},  // whose pixels lie 4e-9 pixels elsewhere
      {{"BUNIT", "'JY/PIXEL'"}},
  };
  for (const StatedCards& statement : statements) {
    const std::string fits = m.write(statement);
    BOOST_TEST_INFO(statement.begin()->first + " = " + statement.begin()->second);
    // 2^-24 is the rounding of a visibility; degrees in decimals move pixels by less.
    BOOST_TEST(difference(m.predicted(fits), usual) < 1e-7);
    std::filesystem::remove_all(m.folder / "m.image");
    copy_to_casa(fits, m.folder / "m.image");
    BOOST_TEST(difference(m.predicted(m.folder / "m.image"), usual) < 1e-7);
  }
}

BOOST_AUTO_TEST_CASE(a_reference_pixel_elsewhere_moves_the_model) {
  const Model m;
  Model moved;
  moved.pixels = imager::Image(64, 64);
  moved.pixels.at(25 - 4, 20 + 7) = 2;
  moved.pixels.at(46 - 4, 53 + 7) = 1;
  // The model's accuracy, twice: the two are gridded about different centres.
  BOOST_TEST(difference(moved.predicted(moved.write({{"CRPIX1", "40."}, {"CRPIX2", "29."}})), m.predicted(m.write({}))) < 4e-6);
}

BOOST_AUTO_TEST_CASE(other_statements_of_a_place_are_refused_with_their_value) {
  const Model m;
  const std::vector<std::pair<StatedCards, std::string>> statements{
      {{{"CROTA2", "10."}}, "turned by -10 degrees from north; expected square pixels with north up"},
      {{{"LONPOLE", "170."}}, "turned by -10 degrees"},
      {{{"CRVAL2", "90."}}, "from north (LONPOLE, which is 0 at the north pole where it is not stated)"},
      {{{"PC1_2", "0.1"}}, "turned by"},
      {{{"CDELT1", stated(cell_deg)}}, "mirrored"},
      {{{"CDELT2", stated(2 * cell_deg)}}, "0.1arcsec wide and 0.2arcsec high"},
      {{{"CDELT2", "0."}}, "no area"},
      {with(wide, {{"CTYPE1", "'RA---TAN'"}, {"CTYPE2", "'DEC--TAN'"}}), "its projection is TAN; expected SIN"},
      {with(wide, {{"CTYPE1", "'RA---ARC'"}, {"CTYPE2", "'DEC--ARC'"}}), "its projection is ARC; expected SIN"},
      {with(wide, {{"CTYPE1", "'RA---NCP'"}, {"CTYPE2", "'DEC--NCP'"}}), "slanted"},
      {with(wide, {{"PV2_1", "0.3"}}), "slanted by 0.3, 0"},
      {{{"CTYPE1", "'RA---SFL'"}, {"CTYPE2", "'DEC--SFL'"}}, "'RA---SFL' and 'DEC--SFL'; expected RA---SIN"},
      {{{"CTYPE1", "'RA---TAN-SIP'"}, {"CTYPE2", "'DEC--TAN-SIP'"}}, "RA---TAN-SIP"},
      {{{"CTYPE1", "'DEC--SIN'"}, {"CTYPE2", "'RA---SIN'"}}, "'DEC--SIN' and 'RA---SIN'"},
      {{{"CTYPE1", "'ELON-SIN'"}, {"CTYPE2", "'ELAT-SIN'"}}, "'ELON-SIN'"},
      {{{"CTYPE1", ""}, {"CTYPE2", ""}}, "there is no CTYPE1 that says of what"},
      {with(no_cdelt, {{"CTYPE1", ""}, {"CTYPE2", ""}}), "does not say where its pixels lie"},
      {{{"CTYPE1", "'GLON-SIN'"}, {"CTYPE2", "'GLAT-SIN'"}}, "in GALACTIC; expected ICRS, FK5"},
      {{{"RADESYS", "'FK4-NO-E'"}}, "its RADESYS is FK4-NO-E; expected ICRS, FK5 or FK4"},
      {{{"RADESYS", "'GAPPT'"}}, "its RADESYS is GAPPT"},
      {{{"RADESYS", ""}, {"RADECSYS", "'GAPPT'"}}, "its RADECSYS is GAPPT"},
      {{{"EQUINOX", "1975."}}, "its EQUINOX is 1975; expected 2000 of FK5"},
      {{{"RADESYS", ""}, {"EQUINOX", "1975."}}, "its EQUINOX is 1975; expected 1950 of FK4"},
      {{{"RADESYS", ""}, {"EQUINOX", ""}, {"EPOCH", "2016."}}, "its EPOCH is 2016; expected 2000 of FK5"},
      {{{"RADESYS", "'FK4'"}}, "its EQUINOX is 2000; expected 1950 of FK4"},
      {{{"CUNIT1", "'hour'"}}, "its CUNIT1 is hour; expected deg, rad"},
      {{{"CUNIT2", "'rad'"}}, "its CRVAL2 is"},
      {{{"CRVAL1", ""}}, "CRVAL1"},
      {{{"PV1_1", "10."}}, "its PV1_1 is 10; expected 0"},
      {{{"PV1_2", "45."}}, "its PV1_2 is 45; expected 90"},
      {{{"PV1_3", "45."}, {"LONPOLE", "180."}}, "its LONPOLE is 180 and its PV1_3 45"},
      {{{"CD1_1", stated(-cell_deg)}, {"PC1_1", "1."}}, "a matrix CD and a matrix PC"},
      {{{"CROTA2", "5."}, {"PC1_1", "1."}}, "CROTA2"},
      {{{"CROTA1", "5."}}, "its CROTA1 is 5"},
      {{{"A_ORDER", "2"}}, "its A_ORDER is 2; expected no distortion"},
      {{{"CPDIS1", "'LOOKUP'"}}, "its CPDIS1 is LOOKUP; expected no distortion"},
      {{{"BUNIT", "'K'"}}, "has the unit K, expected Jy/pixel"},
      {{{"BUNIT", "'Jy/beam'"}}, "has the unit Jy/beam, expected Jy/pixel"},
      {{{"BUNIT", ""}}, "has the unit none, expected Jy/pixel"},
  };
  const Arguments predict{"predict", "--vis", m.set, "--model", m.folder / "m.fits"};
  const Arguments begin =
      small_image(m.set, m.folder / "b") + Arguments{"--niter", "5", "--startmodel", m.folder / "m.fits", "--quiet"};
  for (const auto& [statement, part] : statements) {
    m.write(statement);
    BOOST_TEST(refused(run(predict), part), part);
  }
  for (const std::size_t some : {0U, 5U, 18U, 23U, 37U}) {  // start models are read by the same code
    m.write(statements[some].first);
    BOOST_TEST(refused(run(begin), statements[some].second.substr(0, 10)), statements[some].second);
  }
  for (const auto& [statement, part] :
       {std::pair<StatedCards, std::string>{{{"CRPIX1", "30."}}, "(FK5) at pixel 30, 33, expected"},
        {{{"RADESYS", "'ICRS'"}, {"EQUINOX", ""}}, "(ICRS) at pixel 33, 33, expected"},
        {{{"CRVAL2", stated(m.dec_deg + 1)}}, "has other pixels, 0.1arcsec × 0.1arcsec, SIN about"},
        {{{"CDELT1", stated(-2 * cell_deg)}, {"CDELT2", stated(2 * cell_deg)}}, "0.2arcsec × 0.2arcsec"}}) {
    m.write(statement);
    BOOST_TEST(refused(run(begin), part), part);
  }
  m.write({{"CRVAL2", stated(m.dec_deg + 1)}});
  BOOST_TEST(refused(run(predict + Arguments{"--phasecenter", "0"}), "expected the --phasecenter given"));
}

BOOST_AUTO_TEST_CASE(a_model_is_predicted_where_it_lies_on_the_sky_wherever_that_is) {
  const Model m;
  for (const Reference& reference : references_about(m)) {
    const imager::ImageGeometry g = reference.geometry();
    const Visibilities sums = by_sums(m, "ra_deg,dec_deg", [&](int row, int column) {
      const imager::SkyDirection at = ms_io::in_frame(imager::sky_direction(g.at(row, column), g.phase_centre), "FK5");
      return std::pair(at.ra_rad / degree, at.dec_rad / degree);
    });
    const Outcome outcome = run({"predict", "--vis", m.set, "--model", m.write(reference.cards())});
    BOOST_TEST_INFO(reference.at.ra_rad << ' ' << reference.at.dec_rad << ' ' << reference.at.frame << ' ' << reference.aspect);
    BOOST_TEST(outcome.code == 0);
    BOOST_TEST((outcome.err.find("it is predicted where it lies on the sky") != std::string::npos) == reference.told,
               outcome.err);
    // --accuracy; and B1950's terms of aberration, which vary by 1.7e-6 of the 2 arcsec from the reference, or 4e-5 of a pixel.
    BOOST_TEST(rms_difference(visibilities(m.set, "MODEL_DATA"), sums) < (reference.at.frame == "FK4" ? 1e-4 : 1e-6));
    if (!reference.told && reference.cells * reference.aspect == 1) continue;
    std::filesystem::remove_all(m.folder / "m.image");
    copy_to_casa(m.folder / "m.fits", m.folder / "m.image");
    BOOST_TEST(rms_difference(m.predicted(m.folder / "m.image"), sums) < (reference.at.frame == "FK4" ? 1e-4 : 1e-6));
  }
}

BOOST_AUTO_TEST_CASE(what_pixels_beside_their_places_do_to_visibilities_is_told_and_no_less) {
  const Model m;
  const Visibilities upright = m.predicted(m.write({}));
  const auto told = [&](const StatedCards& cards, const Arguments& options) {
    const Outcome outcome = run(Arguments{"predict", "--vis", m.set, "--model", m.write(cards)} + options);
    BOOST_TEST(outcome.code == 0, outcome.err);
    const std::string before = "visibilities may be wrong by another ";
    const std::size_t at = outcome.err.find(before);
    return at == std::string::npos ? 0 : std::stod(outcome.err.substr(at + before.size()));
  };
  for (const double turn_deg : {1e-3, 1e-5}) {
    const double error = told({{"CROTA2", stated(turn_deg)}}, {}), c = std::cos(turn_deg * degree),
                 s = std::sin(turn_deg * degree);
    const Visibilities turned = by_sums(m, "l_arcsec,m_arcsec", [&](int row, int column) {
      const double x = -(column - 32) * 0.1, y = (row - 32) * 0.1;
      return std::pair(c * x - s * y, s * x + c * y);
    });
    const double is = difference(upright, turned);
    BOOST_TEST(is < error + 1e-6);  // --accuracy
    BOOST_TEST(is > 0.05 * error);
  }
  BOOST_TEST(told({{"CROTA2", "1E-9"}}, {}) == 0);
  BOOST_TEST(told({{"CROTA2", "1E-5"}}, {"--accuracy", "1e-2"}) == 0);
  BOOST_TEST(told({{"LONPOLE", "179.9999"}}, {}) > 1e-6);
}

BOOST_AUTO_TEST_CASE(brightness_beyond_the_horizon_is_refused_and_a_model_of_none_told_of) {
  Model m;
  const Arguments predict{"predict", "--vis", m.set, "--model", m.folder / "m.fits"};
  m.pixels.at(0, 63) = 3;
  m.write({{"CDELT1", "-2."}, {"CDELT2", "2."}});
  BOOST_TEST(refused(run(predict), "has 3 Jy in pixel 64, 1, which lies beyond the horizon"));
  m.pixels.at(0, 63) = 0;
  m.write({{"CDELT1", "-2."}, {"CDELT2", "2."}});
  BOOST_TEST(run(predict).err.find("warning") == std::string::npos);
  m.pixels = imager::Image(64, 64);
  m.write({});
  BOOST_TEST(run(predict).err.find("m.fits is 0 in every pixel: all visibilities written are 0") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_model_of_another_band_is_told_of) {
  const Model m;
  imager::SkyImage model = imager::read_fits(m.folder / "a.residual.fits");
  model.unit = "Jy/pixel";
  const Arguments predict{"predict", "--vis", m.set, "--model", m.folder / "m.fits"};
  const Arguments begin = small_image(m.set, m.folder / "b") + Arguments{"--niter", "5", "--startmodel", m.folder / "m.fits"};
  for (const double times : {1.0, 1.5}) {
    model.observation.frequency_hz = times * 4e9;
    imager::write_fits(model, m.folder / "m.fits", imager::PixelFormat::float32);
    for (const Arguments& arguments : {predict, begin}) {
      const Outcome outcome = run(arguments);
      BOOST_TEST(outcome.code == 0);
      BOOST_TEST((outcome.err.find("m.fits is of 6 GHz, and the data of 4 GHz") != std::string::npos) == (times > 1),
                 outcome.err);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
