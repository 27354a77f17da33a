#include "ms_io/phase_centre.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "imager/data/phase_shift.h"
#include "imager/direct/source_sums.h"
#include "ms_io/model_writer.h"
#include "tests/ms_io/small_set.h"

namespace misfit::ms_io {

BOOST_AUTO_TEST_SUITE(phase_centre)

using namespace testing;

namespace {

constexpr double pi = 3.14159265358979323846, degree = pi / 180;

Selection shifted_to(const imager::SkyDirection& direction) {
  Selection selection;
  selection.phase_centre = direction;
  return selection;
}

/// Two fields, 3 degrees apart, of one sky: a source of 2 Jy, wherever they are phased to.
class Mosaic : public SmallSet {
 public:
  Mosaic() {
    add_field(second.ra_rad, second.dec_rad);
    put_sky(0, first);
    put_sky(1, second);
  }
  const imager::SkyDirection first{1.25, -0.5, "FK5"}, second{1.25 + 2 * degree, -0.5 - 2 * degree, "FK5"};
  const imager::SkyDirection source{1.26, -0.51, "FK5"};

 private:
  void put_sky(std::size_t field, const imager::SkyDirection& centre) const {
    modify([&](casacore::MeasurementSet& set) {
      casacore::ArrayColumn<casacore::Complex> data(set, "DATA");
      for (std::size_t row = field; row < rows; row += 2) {
        const imager::SampleCoordinates where{casacore::ArrayColumn<double>(set, "UVW")(row).tovector(),
                                              small_observation().frequency_hz};
        const auto visibilities =
            imager::predict_sources({imager::Source{imager::direction_cosines(source, centre), 2.0}}, where, 1);
        casacore::Matrix<casacore::Complex> cell(2, channels);
        for (std::size_t c = 0; c < channels; ++c) cell(0, c) = cell(1, c) = casacore::Complex(visibilities[c]);
        data.put(row, cell);
      }
    });
  }
};

}  // namespace

BOOST_AUTO_TEST_CASE(directions_are_understood_as_casa_writes_them) {
  const SmallSet set;
  const double ra = 187.70583333333333 * degree, dec = 12.391111111111111 * degree;
  const std::vector<std::pair<std::string, std::string>> laws = {{"J2000 12h30m49.4s +12d23m28s", "FK5"},
                                                                 {"12h30m49.4s 12d23m28s", "FK5"},
                                                                 {"ICRS 12:30:49.4 +12.23.28", "ICRS"},
                                                                 {"b1950  12h30m49.4 12d23m28", "FK4"},
                                                                 {"icrs 187.70583333333333deg 12.391111111111111deg", "ICRS"},
                                                                 {"12.513722222222222h 44608arcsec", "FK5"}};
  for (const auto& [text, frame] : laws) {
    BOOST_TEST_CONTEXT(text) {
      const imager::SkyDirection direction = ms_io::parse_phase_centre(text, set.path());
      BOOST_TEST(std::abs(direction.ra_rad - ra) < 1e-14);
      BOOST_TEST(std::abs(direction.dec_rad - dec) < 1e-14);
      BOOST_TEST(direction.frame == frame);
    }
  }
  BOOST_TEST(std::abs(ms_io::parse_phase_centre("J2000 -10deg -0d30m0s", set.path()).ra_rad - 350 * degree) < 1e-14);
  BOOST_TEST(std::abs(ms_io::parse_phase_centre("J2000 -10deg -0d30m0s", set.path()).dec_rad + 0.5 * degree) < 1e-14);
}

BOOST_AUTO_TEST_CASE(directions_are_told_from_other_texts_without_a_set) {
  const auto direction = parse_direction("B1950 12h30m00s +30deg");
  BOOST_REQUIRE(direction.has_value());
  BOOST_TEST(direction->ra_rad == 187.5 * degree, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(direction->dec_rad == 30 * degree, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(direction->frame == "FK4");
  for (const char* text : {"", "0", "JUPITER", "TRACKFIELD", "M31", "J2000 12h30m00s", "GALACTIC 1deg 2deg"})
    BOOST_TEST(!parse_direction(text).has_value(), text);
}

BOOST_AUTO_TEST_CASE(sixty_seconds_of_a_direction_are_its_next_minute) {
  const SmallSet set;
  const imager::SkyDirection whole = ms_io::parse_phase_centre("J2000 12h31m00s -12d24m00s", set.path());
  for (const char* text : {"J2000 12h30m60.00s -12d23m60.0s", "12:30:60 -12.23.60.00", "J2000 187d44m60s -12d23m60"}) {
    const imager::SkyDirection direction = ms_io::parse_phase_centre(text, set.path());
    BOOST_TEST(std::abs(direction.ra_rad - whole.ra_rad) < 1e-15, text);
    BOOST_TEST(direction.dec_rad == whole.dec_rad, text);
  }
}

BOOST_AUTO_TEST_CASE(fields_are_found_by_name_and_id) {
  const SmallSet set;
  set.add_field(1.5, -0.25);
  for (const char* const field : {"1", "OTHER", " OTHER "}) {
    BOOST_TEST(ms_io::parse_phase_centre(field, set.path()).ra_rad == 1.5);
    BOOST_TEST(ms_io::parse_phase_centre(field, set.path()).dec_rad == -0.25);
  }
}

BOOST_AUTO_TEST_CASE(a_number_is_an_id_before_it_is_a_name) {
  const SmallSet set;
  set.add_field(1.5, -0.25);
  const auto name = [&](const std::string& first, const std::string& second) {
    set.modify([&](casacore::MeasurementSet& open) {
      casacore::ScalarColumn<casacore::String> names(open.field(), "NAME");
      names.put(0, first);
      names.put(1, second);
    });
  };
  name("1", "0");
  for (const std::string id : {"0", "1"}) {
    Selection selection;
    selection.field = id;
    const double ra_rad = MeasurementSet(set.path(), selection, "DATA").observation().phase_centre.ra_rad;
    BOOST_TEST(ms_io::parse_phase_centre(id, set.path()).ra_rad == ra_rad);
  }
  name("7", "8");
  BOOST_TEST(ms_io::parse_phase_centre("8", set.path()).ra_rad == 1.5);
  name("A", "A");
  const std::string error = error_of([&] { ms_io::parse_phase_centre("A", set.path()); });
  BOOST_TEST(contains(error, "--phasecenter 'A' is the name of fields 0 and 1 of " + set.path() + ", "), error);
  BOOST_TEST(contains(error, " apart; expected one of them by its id"));
  set.modify([](casacore::MeasurementSet& open) {
    casacore::ScalarColumn<int> field(open, "FIELD_ID");
    for (casacore::rownr_t row = 0; row < open.nrow(); ++row) field.put(row, 1);
  });
  BOOST_TEST(ms_io::parse_phase_centre("A", set.path()).ra_rad == 1.5);
}

BOOST_AUTO_TEST_CASE(a_field_is_that_of_the_first_set_that_has_it_with_a_word_where_another_has_it_elsewhere) {
  SimulatedObservation observation = small_observation();
  observation.fields.front().phase_centre.dec_rad += 0.001;
  const SmallSet one, other(observation), same;
  other.add_field(1.5, -0.25);
  const auto remark = [](const std::string& text, const std::vector<std::string>& paths) {
    return phased_to({}, text, paths).phase_centre_remark;
  };
  BOOST_TEST(remark("0", {one.path(), other.path()}) == "--phasecenter '0' is field 0 (SIMULATED) of " + one.path() +
                                                            ", the first listed that has it: field 0 (SIMULATED) of " +
                                                            other.path() + " is 3.44 arcmin away");
  BOOST_TEST(remark("0", {one.path(), same.path()}) == "");
  BOOST_TEST(phased_to({}, "OTHER", {one.path(), other.path()}).phase_centre->ra_rad == 1.5);
  BOOST_TEST(remark("OTHER", {one.path(), other.path()}) == "");
  const std::string error = error_of([&] { remark("NOBODY", {one.path(), other.path()}); });
  BOOST_TEST(contains(error, "and no field of " + one.path() + ", " + other.path()), error);
}

BOOST_AUTO_TEST_CASE(what_is_no_direction_is_refused_with_what_was_expected) {
  const SmallSet set;
  for (const std::string wrong : {"",
                                  "2",
                                  "NOBODY",
                                  "J2000 12h30m49.4s",
                                  "J2000 1.2 0.3",
                                  "GALACTIC 1deg 2deg",
                                  "J2000 12h 91deg",
                                  "J2000 28h 1deg",
                                  "J2000 12h30m +12:23:28",
                                  "J2000 nan inf",
                                  "J2000 1deg 2Jy",
                                  "J2000 12h30m49.4s +12d23m28s now",
                                  "J2000 12h60m49.4s +12d23m28s",
                                  "J2000 12h30m60.1s +12d23m28s",
                                  "J2000 12h30m49.4s +12d60m28s",
                                  "J2000 12:30:49.4 +12.23.61",
                                  "J2000 12h30m-5s 1deg",
                                  "J2000 24h00m01s 1deg",
                                  "J2000 5m 1deg",
                                  "J2000 1deg 30s",
                                  "J2000 1deg 1h00m00s",
                                  "J2000 1deg 1h"}) {
    const std::string error = error_of([&] { ms_io::parse_phase_centre(wrong, set.path()); });
    BOOST_TEST(contains(error, "--phasecenter '" + wrong + "'"), wrong);
    BOOST_TEST(contains(error, "expected J2000, ICRS or B1950 with angles such as 12h30m49.4s +12d23m28s"));
  }
}

BOOST_AUTO_TEST_CASE(fields_apart_are_one_image_where_they_are_shifted_to_one_phase_centre) {
  const Mosaic set;
  for (const imager::SkyDirection& to : {set.first, set.second, imager::SkyDirection{1.2, -0.45, "FK5"}}) {
    for (const std::uint64_t block_samples : {std::uint64_t{1}, std::uint64_t{1} << 20}) {
      const MeasurementSet opened(set.path(), shifted_to(to), "DATA", {imager::Stokes::I}, block_samples);
      BOOST_TEST(opened.observation().phase_centre.ra_rad == to.ra_rad);
      const imager::Source source{imager::direction_cosines(set.source, to), 2.0};
      std::size_t seen = 0;
      const auto stream = opened.open();
      while (const auto block = stream->next()) {
        const auto expected = imager::predict_sources({source}, *block, 1);
        // The data were rounded to single precision once and again after the shift, each by 6e-8 of 2 Jy.
        for (std::size_t i = 0; i < expected.size(); ++i)
          BOOST_TEST(std::abs(expected[i] - std::complex<double>(block->visibility[i])) < 4e-7);
        seen += block->rows();
      }
      BOOST_TEST(seen == rows);
    }
  }
}

BOOST_AUTO_TEST_CASE(reach_and_coordinates_are_those_that_are_read) {
  const Mosaic set;
  const MeasurementSet opened(set.path(), shifted_to({1.2, -0.45, "FK5"}), "DATA");
  const AllSamples all = read_all(opened);
  double largest_w = 0;
  for (std::size_t i = 2; i < all.uvw_m.size(); i += 3) largest_w = std::max(largest_w, std::abs(all.uvw_m[i]));
  BOOST_TEST(std::abs(opened.reach().max_abs_w - largest_w * 1.005e9 / 299792458) < 1e-12 * opened.reach().max_abs_w);
  std::vector<double> seen;
  opened.visit_coordinates([&](const auto& some) { seen.insert(seen.end(), some.uvw_m.begin(), some.uvw_m.end()); });
  BOOST_TEST((seen == all.uvw_m));
}

BOOST_AUTO_TEST_CASE(axes_turn_with_the_frame_of_the_phase_centre) {
  const SmallSet set;  // J2000
  const imager::SkyDirection icrs = {1.25, -0.5, "ICRS"};
  const AllSamples all = read_all(MeasurementSet(set.path(), shifted_to(icrs), "DATA"));
  const AllSamples own = read_all(MeasurementSet(set.path(), {}, "DATA"));
  // The frames are 2e-2 arcsec, 1e-7 rad, apart.
  double most = 0;
  for (std::size_t i = 0; i < all.uvw_m.size(); ++i) most = std::max(most, std::abs(all.uvw_m[i] - own.uvw_m[i]));
  BOOST_TEST(most > 0);
  BOOST_TEST(most < 3e-7 * 50);  // of baselines of 50 m
  const AllSamples there = read_all(MeasurementSet(set.path(), shifted_to({1.25, -0.5, "FK5"}), "DATA"));
  BOOST_TEST((there.visibility == own.visibility));
  BOOST_TEST((there.uvw_m == own.uvw_m));
}

// 3C 286 in NRAO's list of VLA calibrators, whose B1950 positions are of 1979.9: printed to 1e-4 s of right ascension, 7e-9
// rad. The matrix that takes FK4 to FK5, and its change in arcseconds in a century, are those of Yallop et al. 1989, AJ 97,
// 274.
BOOST_AUTO_TEST_CASE(between_b1950_and_j2000_a_calibrator_stays_where_it_is_and_north_turns_with_the_pole) {
  const imager::SkyDirection b1950 = parse_phase_centre("B1950 13h28m49.6577s +30d45m58.640s", "");
  const imager::SkyDirection j2000 = parse_phase_centre("J2000 13h31m08.287984s +30d30m32.958850s", "");
  const double centuries = -0.201, epoch_mjd_s = 44203.0 * 86400, arcsec = degree / 3600;
  const double from_fk4[3][3] = {{0.9999256782, -0.0111820611, -0.0048579477},
                                 {0.0111820610, 0.9999374784, -0.0000271765},
                                 {0.0048579479, -0.0000271474, 0.9999881997}};
  const double change[3][3] = {
      {-0.000551, -0.238565, 0.435739}, {0.238514, -0.002667, -0.008541}, {-0.435623, 0.012254, 0.002117}};
  const imager::UvwAxes::Vector north = imager::uvw_axes(b1950).v, east = imager::uvw_axes(j2000).u;
  double turn = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) turn += east[i] * (from_fk4[i][k] + centuries * change[i][k] * arcsec) * north[k];
  BOOST_TEST(std::abs(turn) > 1e-3);
  for (const bool set_is_b1950 : {true, false}) {
    SimulatedObservation observation = small_observation();
    observation.fields.front().phase_centre = j2000;
    for (double& time : observation.time_mjd_s) time += epoch_mjd_s - 4.9e9;
    const SmallSet set(observation);
    if (set_is_b1950) set.phase_to_b1950(b1950.ra_rad, b1950.dec_rad);
    for (ssize_t axis = 0; axis < 3; ++axis) {
      for (ssize_t row = 0; row < 2; ++row) set.put("UVW", static_cast<std::size_t>(row), axis, 0, axis == row + 1 ? 1.0 : 0.0);
    }
    const MeasurementSet own(set.path(), {}, "DATA");
    BOOST_TEST(own.observation().phase_centre.frame == (set_is_b1950 ? "FK4" : "FK5"));
    const AllSamples read = read_all(MeasurementSet(set.path(), shifted_to(set_is_b1950 ? j2000 : b1950), "DATA"));
    const double *const v = read.uvw_m.data(), *const w = v + 3;  // a metre to the north, and one towards the source
    BOOST_TEST(std::abs(w[0]) < 5e-9);
    BOOST_TEST(std::abs(w[1]) < 5e-9);
    BOOST_TEST(std::abs(v[0] - (set_is_b1950 ? turn : -turn)) < 5e-9);
  }
}

BOOST_AUTO_TEST_CASE(a_phase_centre_beside_the_pole_is_as_exact_as_any) {
  const SmallSet set;
  const double dec_rad = pi / 2 - 1e-6;
  set.add_field(1.5, dec_rad);
  BOOST_TEST(std::abs(parse_phase_centre("1", set.path()).dec_rad - dec_rad) < 1e-15);
  BOOST_TEST(std::abs(parse_phase_centre("1", set.path()).ra_rad - 1.5) < 1e-9);  // 1e-15 rad on the sky
}

BOOST_AUTO_TEST_CASE(a_model_about_the_shifted_centre_is_written_as_each_field_sees_it) {
  const Mosaic set;
  const imager::SkyDirection to{1.2, -0.45, "FK5"};
  const imager::Source source{imager::direction_cosines(set.source, to), 2.0};
  write_model(set.path(), shifted_to(to), {"MODEL_DATA"},
              [&](const imager::SampleCoordinates& at) { return imager::predict_sources({source}, at, 1); }, {});
  for (std::size_t row = 0; row < rows; ++row) {
    const auto model = set.cell("MODEL_DATA", row), data = set.cell("DATA", row);
    for (std::size_t c = 0; c < channels; ++c) BOOST_TEST(std::abs(model(1, c) - data(1, c)) < 4e-7F);  // roundings to single
  }
}

BOOST_AUTO_TEST_CASE(sets_apart_are_one_image_where_they_are_shifted) {
  SimulatedObservation elsewhere = small_observation();
  elsewhere.fields.front().phase_centre.dec_rad += 0.01;
  const SmallSet first, second(elsewhere);
  const std::vector<std::string> paths{first.path(), second.path()};
  BOOST_TEST(!error_of([&] { MeasurementSet(paths, {}, "DATA"); }).empty());
  BOOST_TEST(MeasurementSet(paths, shifted_to({1.25, -0.5, "FK5"}), "DATA").rows() == 2 * rows);
}

BOOST_AUTO_TEST_CASE(a_field_without_its_directions_is_refused) {
  const auto refused = [](const std::function<void(casacore::Table&)>& change, const std::string& part) {
    const SmallSet set;
    {
      casacore::Table field(set.path() + "/FIELD", casacore::Table::Update);
      change(field);
    }
    const std::string error = error_of([&] { MeasurementSet(set.path(), {}, "DATA"); });
    BOOST_TEST(error.find("cannot find the phase centre of field 0") == 0U, error);
    BOOST_TEST(error.find(part) != std::string::npos, error);
  };
  refused([](casacore::Table& field) { casacore::ScalarColumn<int>(field, "NUM_POLY").put(0, 2000000000); },
          "PHASE_DIR has 1 directions, expected more than NUM_POLY, 2000000000");
  refused(
      [](casacore::Table& field) { casacore::ArrayColumn<double>(field, "PHASE_DIR").put(0, casacore::Matrix<double>(2, 0)); },
      "PHASE_DIR has 0 directions");
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
