// Fields whose phase centres move, about themselves.
#include "ms_io/phase_centre.h"
#include "tests/ms_io/moving_set.h"

namespace misfit::ms_io {

BOOST_AUTO_TEST_SUITE(followed_field)

using namespace testing;
using namespace moving_testing;

BOOST_AUTO_TEST_CASE(about_itself_a_field_keeps_its_data_and_the_header_has_the_middle_of_the_run) {
  for (const Path way : all_paths)
    for (const Moving moving : {Moving::about_themselves, Moving::about_targets}) {
      const MovingSet set(way);
      if (moving == Moving::about_themselves && (way == Path::azimuth || way == Path::hour_angle)) continue;
      const MeasurementSet opened(set.path(), with(moving), "DATA");
      BOOST_TEST_INFO(name_of(way));
      BOOST_TEST(apart_rad(opened.observation().phase_centre, about) < 1e-10);
      BOOST_TEST(opened.observation().phase_centre.frame == frame_of(way));
      BOOST_TEST(opened.observation().moving_at == "2014-02-24T23:26:40.000");
      const AllSamples all = read_all(opened);
      for (std::size_t row = 0; row < rows; ++row)
        for (std::size_t c = 0; c < channels; ++c)
          BOOST_TEST(all.visibility[row * channels + c] == set.cell("DATA", row)(0, c));
      // Ten minutes of apparent places are some milliarcseconds, a thousandth of these beams 1 arcsec.
      BOOST_TEST(says(opened, "moves by ") == (way != Path::apparent));
    }
}

BOOST_AUTO_TEST_CASE(beams_move_along_with_an_image_of_the_field_and_over_one_of_the_sky) {
  for (const Path way : {Path::ephemeris, Path::rate}) {
    const MovingSet set(way);
    const MeasurementSet along(set.path(), {}, "DATA");
    BOOST_REQUIRE(along.beam_rows().pointings.size() == 3);
    for (const FieldPointing& pointing : along.beam_rows().pointings)
      BOOST_TEST(apart_rad(pointing.direction,
                           {along.observation().phase_centre.ra_rad, along.observation().phase_centre.dec_rad}) < 1e-12);
    const auto over = MeasurementSet(set.path(), to_direction(about, way), "DATA").beam_rows().pointings;
    BOOST_REQUIRE(over.size() == 3);
    const auto [first_s, last_s] = time_range_s(set.path());
    BOOST_TEST(apart_rad(over[0].direction, set.moving.at(first_s)) < 1e-10);
    BOOST_TEST(apart_rad(over[1].direction, about) < 1e-10);
    BOOST_TEST(apart_rad(over[2].direction, set.moving.at(last_s)) < 1e-10);
    BOOST_TEST(over[2].field == "0 (SIMULATED) at 2014-02-24T23:46:40.000");
  }
}

BOOST_AUTO_TEST_CASE(what_moves_and_how_far_is_said) {
  const MovingSet set(Path::rate);
  const MeasurementSet opened(set.path(), {}, "DATA");
  // 2 degrees a day × cos(−0.5) and 0.5, for 40 minutes.
  BOOST_REQUIRE(opened.remarks().size() == 1);
  BOOST_TEST(
      opened.remarks().front() ==
      "field 0 (SIMULATED) of " + set.path() +
          " moves by 3.04 arcmin while it is observed, and images and models move along: what stands still on the sky is "
          "smeared about it, and headers have where it was at 2014-02-24T23:26:40.000; --phasecenter with a "
          "direction on the sky keeps that still");
  BOOST_TEST(MeasurementSet(set.path(), to_direction(about, Path::rate), "DATA").remarks().empty());
}

BOOST_AUTO_TEST_CASE(about_itself_a_field_that_turns_with_the_earth_is_refused_with_the_distance) {
  for (const Path way : {Path::azimuth, Path::hour_angle}) {
    const MovingSet set(way);
    const std::string error = error_of([&] { MeasurementSet(set.path(), {}, "DATA"); });
    BOOST_TEST(contains(error, "field 0 (SIMULATED) of " + set.path() + " is phased to a direction that turns with the Earth"),
               error);
    BOOST_TEST(contains(error, "moves by "));
    BOOST_TEST(contains(error, " degrees over the sky"));
    BOOST_TEST(contains(error, "expected --phasecenter"));
  }
}

BOOST_AUTO_TEST_CASE(a_field_that_turns_with_the_earth_does_so_whatever_its_rates) {
  for (const double rate : {0.0, 1e-7}) {
    const MovingSet set(Path::azimuth);
    set.modify([&](casacore::MeasurementSet& open) {
      casacore::MSFieldColumns columns(open.field());
      columns.numPoly().put(0, 1);
      columns.time().put(0, set.moving.middle_s());
      casacore::Array<double> terms = columns.phaseDir()(0);
      terms.resize(casacore::IPosition(2, 2, 2), true);
      terms(casacore::IPosition(2, 0, 1)) = terms(casacore::IPosition(2, 1, 1)) = rate;
      for (auto* const column : {&columns.phaseDir(), &columns.referenceDir(), &columns.delayDir()}) column->put(0, terms);
    });
    BOOST_TEST(contains(error_of([&] { MeasurementSet(set.path(), {}, "DATA"); }), "turns with the Earth, and moves by "));
  }
}

BOOST_AUTO_TEST_CASE(where_a_target_was_is_known_as_far_as_its_way_is_told) {
  for (const Path way : {Path::ephemeris, Path::rate, Path::apparent}) {
    const MovingSet set(way);
    const MeasurementSet opened(set.path(), with(Moving::about_targets), "DATA");
    const auto at = opened.followed_at("2014-02-24T23:46:40.000");
    BOOST_REQUIRE(at.has_value());
    BOOST_TEST(apart_rad(*at, set.moving.at(time_range_s(set.path())[1])) < 1e-10);
    BOOST_TEST(opened.followed_at("2014-02-25T05:00:00").has_value() == (way != Path::rate));
    BOOST_TEST(opened.followed_at("2018-02-25T05:00:00").has_value() == (way == Path::apparent));
    BOOST_TEST(!opened.followed_at("").has_value());
    BOOST_TEST(!MeasurementSet(set.path(), to_direction(about, way), "DATA").followed_at("2014-02-24T23:46:40").has_value());
  }
}

namespace {

/// Offsets of PHASE_DIR from the ephemeris, as casacore means them: along the circle of declination, and along the meridian.
constexpr SkyPoint offset{0.002, -0.001};

/// A source that goes where the ephemeris goes, as a field beside it sees it.
void put_target(const SmallSet& set, const MovingField& target) {
  set.modify([&](casacore::MeasurementSet& open) {
    casacore::Matrix<double> direction(2, 1);
    direction(0, 0) = offset.ra_rad;
    direction(1, 0) = offset.dec_rad;
    casacore::MSFieldColumns(open.field()).phaseDir().put(0, direction);
    const casacore::ScalarColumn<double> time(open, "TIME");
    for (casacore::rownr_t row = 0; row < rows; ++row) {
      const SkyPoint at = target.at(time(row));
      casacore::MVDirection beside(at.ra_rad, at.dec_rad);
      beside.shift(casacore::Vector<double>(std::vector<double>{offset.ra_rad, offset.dec_rad}), true);
      const imager::SkyDirection centre{beside.getLong(), beside.getLat(), "ICRS"};
      put_point(open, row, at, centre);
    }
  });
}

}  // namespace

BOOST_AUTO_TEST_CASE(about_its_target_a_field_beside_the_ephemeris_is_shifted_there) {
  const MovingSet set(Path::ephemeris);
  put_target(set, set.moving);
  const MeasurementSet opened(set.path(), with(Moving::about_targets), "DATA");
  BOOST_TEST(largest_error_jy(opened, {{0, 0}, flux_jy}) < roundings_jy);
  BOOST_TEST(apart_rad(opened.observation().phase_centre, about) < 1e-10);
  const MeasurementSet beside(set.path(), {}, "DATA");
  BOOST_TEST(std::abs(apart_rad(beside.observation().phase_centre, about) - std::hypot(offset.ra_rad, offset.dec_rad)) < 1e-8);
}

BOOST_AUTO_TEST_CASE(sets_of_several_days_follow_one_target) {
  for (const Path way : {Path::ephemeris, Path::rate}) {
    const MovingSet first(way);
    SimulatedObservation later = slow_observation();
    for (double& time : later.time_mjd_s) time += 2 * day_s;
    const SmallSet second(later);
    // Passes `about` two days later: another track of the same name. The ephemerides reach some hours alone.
    const MovingField moving(second.path(), 0, way, about);
    put_fixed_source(second.path(), {moving}, source, flux_jy);
    const std::vector<std::string> paths{first.path(), second.path()};
    const auto open = [&](const Selection& selection) { return MeasurementSet(paths, selection, "DATA"); };
    const MeasurementSet fixed = open(to_direction(about, way));
    BOOST_TEST(fixed.rows() == 2 * rows);
    if (way == Path::rate) {
      const std::string error = error_of([&] { open({}); });
      BOOST_TEST(contains(error, "both move, "), error);
      BOOST_TEST(contains(error, " degrees apart; expected one target, or --phasecenter"));
      continue;
    }
    const MeasurementSet both = open({});
    // The time observed that is nearest to the middle is the first set's last.
    BOOST_TEST(both.observation().moving_at == "2014-02-24T23:46:40.000");
    BOOST_TEST(apart_rad(both.observation().phase_centre, first.moving.at(time_range_s(first.path())[1])) < 1e-10);
    BOOST_TEST(both.remarks().size() == 2U);
    second.modify([](casacore::MeasurementSet& set) { casacore::MSFieldColumns(set.field()).name().put(0, "OTHER"); });
    BOOST_TEST(contains(error_of([&] { open({}); }), "expected fields of one name"));
  }
}

BOOST_AUTO_TEST_CASE(sets_of_which_one_moves_are_one_image_about_a_direction_alone) {
  const MovingSet moving(Path::rate);
  SimulatedObservation there = slow_observation();
  const SmallSet still(there);
  put_fixed_source(still.path(), {}, source, flux_jy);
  for (const auto& paths : {std::vector<std::string>{moving.path(), still.path()}, {still.path(), moving.path()}}) {
    const MeasurementSet opened(paths, to_direction(source, Path::rate), "DATA");
    for (const auto& visibility : read_all(opened).visibility) BOOST_TEST(std::abs(visibility - 2.0F) < roundings_jy);
    const std::string error = error_of([&] { MeasurementSet(paths, {}, "DATA"); });
    BOOST_TEST(contains(error, "the phase centre of one moves, and one stands still"), error);
  }
}

BOOST_AUTO_TEST_CASE(what_is_followed_and_what_is_not_is_said_by_name) {
  const SmallSet still;
  BOOST_TEST((phased_to({}, "trackfield", {still.path()}).moving == Moving::about_targets));
  const std::string none = error_of([&] { MeasurementSet(still.path(), with(Moving::about_targets), "DATA"); });
  BOOST_TEST(contains(none, "--phasecenter TRACKFIELD: no selected field of " + still.path() + " moves"), none);
}

BOOST_AUTO_TEST_CASE(doppler_shifts_are_towards_where_the_field_is_at_each_time) {
  const MovingSet set(Path::ephemeris);
  Selection followed;
  followed.spectral_frame = "LSRK";
  const auto ratios = [&](const Selection& selection) {
    const MeasurementSet opened(set.path(), selection, "DATA");
    std::vector<double> all;
    const auto stream = opened.open();
    while (const auto block = stream->next()) all.insert(all.end(), block->frame_ratio.begin(), block->frame_ratio.end());
    return all;
  };
  const std::vector<double> own = ratios(followed);
  for (const std::size_t row : {std::size_t{0}, rows - 1}) {
    Selection fixed = followed;
    fixed.phase_centre = to_direction(set.moving.at(time_range_s(set.path())[row == 0 ? 0 : 1]), Path::ephemeris).phase_centre;
    // The field moves by 1e-3 rad, which is 1e-7 of the Earth's 30 km/s / c.
    BOOST_TEST(std::abs(own[row] - ratios(fixed)[row]) < 1e-14);
    BOOST_TEST(std::abs(own[row] - ratios(fixed)[rows - 1 - row]) > 1e-14);
  }
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
