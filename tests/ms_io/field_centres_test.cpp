// Fields whose phase centres move, or differ by rounding, about a direction.
#include "ms_io/model_writer.h"
#include "ms_io/phase_centre.h"
#include "tests/ms_io/moving_set.h"

namespace misfit::ms_io {

BOOST_AUTO_TEST_SUITE(field_centres)

using namespace testing;
using namespace moving_testing;

BOOST_AUTO_TEST_CASE(what_stands_still_on_the_sky_does_so_about_a_direction_however_the_field_moves) {
  for (const Path way : all_paths) {
    const MovingSet set(way);
    for (const SkyPoint& to : {source, about, SkyPoint{1.24, -0.49}})
      for (const std::uint64_t block_samples : {std::uint64_t{1}, std::uint64_t{1} << 20}) {
        const MeasurementSet opened(set.path(), to_direction(to, way), "DATA", {imager::Stokes::I}, block_samples);
        BOOST_TEST_INFO(name_of(way));
        BOOST_TEST(largest_error_jy(opened, source_from(opened.observation().phase_centre)) < roundings_jy);
        BOOST_TEST(opened.observation().moving_at == "");
      }
    // It does not, where one direction is taken for all times: the source moves by a tenth of a turn of the longest baseline.
    const MeasurementSet own(set.path(), with(Moving::about_targets), "DATA");
    const double smeared_jy = largest_error_jy(own, source_from(own.observation().phase_centre));
    BOOST_TEST_INFO(name_of(way));
    BOOST_TEST(smeared_jy > (way == Path::apparent ? 2 : 100) * roundings_jy);
  }
}

// Rows of two windows and two fields alternate, and are read together.
BOOST_AUTO_TEST_CASE(rows_that_alternate_between_windows_and_fields_keep_their_own_shifts) {
  for (const Path way : {Path::ephemeris, Path::acceleration}) {
    const MovingSet set(way);
    set.add_spectral_window();
    add_still_field(set.path(), {1.252, -0.501});
    put_fixed_source(set.path(), {set.moving}, source, flux_jy);
    for (const std::uint64_t block_samples : {7, 1 << 20}) {
      const MeasurementSet opened(set.path(), to_direction({1.24, -0.49}, way), "DATA", {imager::Stokes::I}, block_samples);
      BOOST_TEST(largest_error_jy(opened, source_from(opened.observation().phase_centre)) < roundings_jy);
    }
  }
}

BOOST_AUTO_TEST_CASE(coordinates_and_reach_are_those_that_are_read) {
  for (const Path way : all_paths) {
    const MovingSet set(way);
    const MeasurementSet opened(set.path(), to_direction({1.24, -0.49}, way), "DATA");
    const AllSamples all = read_all(opened);
    double largest_w = 0;
    for (std::size_t i = 2; i < all.uvw_m.size(); i += 3) largest_w = std::max(largest_w, std::abs(all.uvw_m[i]));
    BOOST_TEST(std::abs(opened.reach().max_abs_w - largest_w * 1.005e9 / 299792458) < 1e-12 * opened.reach().max_abs_w);
    std::vector<double> seen;
    opened.visit_coordinates([&](const auto& some) { seen.insert(seen.end(), some.uvw_m.begin(), some.uvw_m.end()); });
    BOOST_TEST((seen == all.uvw_m));
  }
}

BOOST_TEST_DECORATOR(*boost::unit_test::label("sweep"))
BOOST_AUTO_TEST_CASE(a_model_that_stands_still_is_written_as_the_moving_field_sees_it) {
  for (const Path way : all_paths)
    for (const bool direction_is_given : {true, false}) {
      const MovingSet set(way);
      const Selection selection = direction_is_given ? to_direction({1.24, -0.49}, way) : with(Moving::shifted_to_middle);
      const imager::Source of = source_from(MeasurementSet(set.path(), selection, "DATA").observation().phase_centre);
      for (const std::uint64_t block_samples : {1, 1 << 20})
        write_model(set.path(), selection, {"MODEL_DATA"},
                    [&](const imager::SampleCoordinates& at) { return imager::predict_sources({of}, at, 1); }, {},
                    {block_samples, 2});
      for (std::size_t row = 0; row < rows; ++row) {
        const auto model = set.cell("MODEL_DATA", row), data = set.cell("DATA", row);
        for (std::size_t c = 0; c < channels; ++c) BOOST_TEST(std::abs(model(1, c) - data(1, c)) < roundings_jy);
      }
    }
}

BOOST_AUTO_TEST_CASE(fields_of_which_one_moves_are_one_image_about_a_direction_alone) {
  for (const Path way : {Path::ephemeris, Path::rate, Path::acceleration}) {
    const MovingSet set(way);
    add_still_field(set.path(), {1.252, -0.501});
    put_fixed_source(set.path(), {set.moving}, source, flux_jy);
    const MeasurementSet opened(set.path(), to_direction({1.24, -0.49}, way), "DATA");
    BOOST_TEST(largest_error_jy(opened, source_from(opened.observation().phase_centre)) < roundings_jy);
    for (const Moving moving : {Moving::about_themselves, Moving::about_targets, Moving::shifted_to_middle}) {
      const std::string error = error_of([&] { MeasurementSet(set.path(), with(moving), "DATA"); });
      BOOST_TEST(contains(error, "of fields 0 (SIMULATED) and 1 (STILL) of " + set.path() + " one moves, by "), error);
      BOOST_TEST(contains(error, "--phasecenter"));
    }
  }
}

BOOST_AUTO_TEST_CASE(where_a_frame_turns_with_the_earth_the_telescope_must_stand_somewhere) {
  const MovingSet set(Path::azimuth);
  set.modify([](casacore::MeasurementSet& open) {
    casacore::ScalarColumn<casacore::String>(open.observation(), "TELESCOPE_NAME").put(0, "NOWHERE");
    casacore::ArrayColumn<double>(open.antenna(), "POSITION").put(0, casacore::Vector<double>(3, 20.0));
    for (casacore::rownr_t a = 1; a < antennas; ++a)
      casacore::ArrayColumn<double>(open.antenna(), "POSITION").put(a, casacore::Vector<double>(3, 100.0));
  });
  const std::string error = error_of([&] { MeasurementSet(set.path(), to_direction(about, Path::azimuth), "DATA"); });
  BOOST_TEST(contains(error,
                      "its frame AZELGEO turns with the Earth, and casacore does not know where a telescope 'NOWHERE' "
                      "stands, and POSITION of antenna 0 (A0) is 34.641 m from the middle of the Earth"),
             error);
}

BOOST_AUTO_TEST_CASE(times_at_which_a_field_is_nowhere_are_refused) {
  const MovingSet polynomial(Path::rate);
  polynomial.put<double>("TIME", 7, nan_value);
  const std::string error = error_of([&] { MeasurementSet(polynomial.path(), to_direction(about, Path::rate), "DATA"); });
  BOOST_TEST(contains(error, "row 7 has TIME nan, and its field 0 moves; expected a finite number"), error);
  const MovingSet ephemeris(Path::ephemeris);
  move_times(ephemeris.path(), 2 * day_s);
  const std::string beyond = error_of([&] { MeasurementSet(ephemeris.path(), to_direction(about, Path::ephemeris), "DATA"); });
  BOOST_TEST(contains(beyond, "cannot find the phase centre of field 0 of " + ephemeris.path()), beyond);
  BOOST_TEST(contains(beyond, " goes from MJD "), beyond);
}

BOOST_AUTO_TEST_CASE(an_ephemeris_in_an_unknown_frame_is_refused) {
  const MovingSet set(Path::ephemeris);
  {
    casacore::Table table(set.path() + "/FIELD/EPHEM0_Object.tab", casacore::Table::Update);
    table.rwKeywordSet().define("posrefsys", casacore::String("GALACTIC"));
  }
  const std::string error = error_of([&] { MeasurementSet(set.path(), {}, "DATA"); });
  BOOST_TEST(contains(error, "EPHEM0_Object.tab is in the frame posrefsys 'GALACTIC', expected one such as ICRF/ICRS"), error);
}

// casacore's tables of planets may be there or not.
BOOST_AUTO_TEST_CASE(a_planet_without_tables_is_one_line_that_says_so) {
  const SmallSet set;
  set.modify([](casacore::MeasurementSet& open) {
    casacore::MSFieldColumns(open.field()).phaseDirMeasCol().setDescRefCode(casacore::MDirection::JUPITER, false);
  });
  const std::string error = error_of([&] { MeasurementSet(set.path(), {}, "DATA"); });
  BOOST_TEST_MESSAGE(error);
  BOOST_TEST((error.empty() || contains(error, "it is phased to JUPITER, whose place casacore takes from the tables DE200")));
}

BOOST_AUTO_TEST_CASE(a_field_that_moves_is_named_for_where_it_is_in_the_middle_of_its_rows) {
  for (const Path way : all_paths) {
    const MovingSet set(way);
    const Selection selection = phased_to({}, "SIMULATED", set.path());
    BOOST_TEST(apart_rad(*selection.phase_centre, about) < 1e-10);
    BOOST_TEST(contains(selection.phase_centre_remark, "field 0 (SIMULATED) of " + set.path() +
                                                           " moves: --phasecenter takes where it was in the middle of its "
                                                           "rows, at 2014-02-24T23:26:40"));
    BOOST_TEST(says(MeasurementSet(set.path(), selection, "DATA"), "moves: --phasecenter takes"));
  }
  const SmallSet still;
  BOOST_TEST(phased_to({}, "SIMULATED", still.path()).phase_centre_remark == "");
}

BOOST_AUTO_TEST_CASE(fields_that_differ_by_rounding_are_one_image_about_the_first) {
  for (const double apart : {2e-12, 1e-11, 4e-11, 1e-8}) {
    const SmallSet set;
    set.add_field(about.ra_rad, about.dec_rad + apart);
    put_fixed_source(set.path(), {}, source, flux_jy);
    const MeasurementSet opened(set.path(), {}, "DATA");
    BOOST_TEST(opened.observation().phase_centre.dec_rad == about.dec_rad);
    BOOST_TEST(largest_error_jy(opened, source_from(opened.observation().phase_centre)) < roundings_jy);
    BOOST_REQUIRE(opened.remarks().size() == 1);
    BOOST_TEST(contains(opened.remarks().front(),
                        "mas apart, as if by rounding, or far below a pixel: all are shifted to that of field 0"));
    const imager::Source of = source_from(opened.observation().phase_centre);
    write_model(set.path(), {}, {"MODEL_DATA"},
                [&](const imager::SampleCoordinates& at) { return imager::predict_sources({of}, at, 1); }, {});
    for (std::size_t row = 0; row < rows; ++row)
      BOOST_TEST(std::abs(set.cell("MODEL_DATA", row)(0, 0) - set.cell("DATA", row)(0, 0)) < roundings_jy);
  }
  const SmallSet set;
  set.add_field(about.ra_rad, about.dec_rad + arcsec);
  BOOST_TEST(contains(error_of([&] { MeasurementSet(set.path(), {}, "DATA"); }), " apart; select one with --field"));
}

BOOST_AUTO_TEST_CASE(sets_that_differ_by_rounding_are_one_image_about_the_first) {
  const SmallSet first;
  put_fixed_source(first.path(), {}, source, flux_jy);
  for (const double apart : {1e-11, 4e-11, 1e-8}) {
    SimulatedObservation beside = small_observation();
    beside.phase_centre.ra_rad += apart;
    const SmallSet second(beside);
    put_fixed_source(second.path(), {}, source, flux_jy);
    const MeasurementSet both({first.path(), second.path()}, {}, "DATA");
    BOOST_TEST(both.observation().phase_centre.ra_rad == about.ra_rad);
    BOOST_REQUIRE(both.selection().phase_centre.has_value());
    BOOST_TEST(both.selection().phase_centre->ra_rad == about.ra_rad);
    BOOST_REQUIRE(both.remarks().size() == 1);
    BOOST_TEST(
        contains(both.remarks().front(), "the phase centre of " + second.path() + " differs from that of " + first.path()));
    const auto stream = both.open();
    while (const auto block = stream->next()) {
      const auto expected = imager::predict_sources({source_from(both.observation().phase_centre)}, *block, 1);
      for (std::size_t i = 0; i < expected.size(); ++i)
        BOOST_TEST(std::abs(expected[i] - std::complex<double>(block->visibility[i])) < roundings_jy);
    }
  }
  BOOST_TEST(!MeasurementSet(first.path(), {}, "DATA").selection().phase_centre.has_value());
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
