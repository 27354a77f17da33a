// Fields whose phase centres move, or differ by rounding, about a direction.
#include <filesystem>

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
    for (const Selection& selection : {to_direction({1.24, -0.49}, way), with(Moving::shifted_to_middle)}) {
      const MeasurementSet opened(set.path(), selection, "DATA");
      BOOST_TEST(largest_error_jy(opened, source_from(opened.observation().phase_centre)) < roundings_jy);
    }
    for (const Moving moving : {Moving::about_themselves, Moving::about_targets}) {
      const std::string error = error_of([&] { MeasurementSet(set.path(), with(moving), "DATA"); });
      BOOST_TEST(contains(error, "fields 0 (SIMULATED) and 1 (STILL) of " + set.path() + " differ: one moves, by "), error);
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

BOOST_AUTO_TEST_CASE(where_a_frame_turns_with_the_earth_the_order_of_antennas_does_not_matter) {
  for (const std::string name : {"VLA", "EVLA"}) {
    const MovingSet set(Path::azimuth);
    set.modify([&](casacore::MeasurementSet& open) {
      casacore::ScalarColumn<casacore::String>(open.observation(), "TELESCOPE_NAME").put(0, name);
      // Five kilometres, which turn directions by 2.7 arcmin, and the source by half a turn of phase.
      casacore::ArrayColumn<double> position(open.antenna(), "POSITION");
      position.put(0, position(0) + 3000.0);
    });
    const MeasurementSet opened(set.path(), to_direction(about, Path::azimuth), "DATA");
    BOOST_TEST(largest_error_jy(opened, source_from(opened.observation().phase_centre)) < roundings_jy);
    BOOST_TEST(!says(opened, "the middle of its antennas"));
  }
  const MovingSet set(Path::azimuth);
  const auto open_as = [&](const std::string& telescope, const std::string& second, const std::string& observation) {
    set.modify([&](casacore::MeasurementSet& open) {
      casacore::ScalarColumn<casacore::String> names(open.observation(), "TELESCOPE_NAME");
      if (open.observation().nrow() == 1 && !second.empty()) open.observation().addRow(1);
      names.put(0, telescope);
      if (!second.empty()) names.put(1, second);
      casacore::ScalarColumn<int>(open, "OBSERVATION_ID").put(7, second.empty() ? 0 : 1);
    });
    Selection selection = to_direction(about, Path::azimuth);
    selection.observation = observation;
    return MeasurementSet(set.path(), selection, "DATA");
  };
  BOOST_TEST(says(open_as("NOWHERE", "", ""), "the middle of its antennas"));
  BOOST_CHECK_NO_THROW(open_as("VLA", "EVLA", ""));
  const std::string error = error_of([&] { open_as("VLA", "ATCA", ""); });
  BOOST_TEST(contains(error, "its rows are of telescopes in several places; expected those of one, by --observation"), error);
  BOOST_CHECK_NO_THROW(open_as("VLA", "ATCA", "0"));
}

namespace {

/// Writes into FIELD.
void change_field(const SmallSet& set, const std::function<void(casacore::MSFieldColumns&)>& change) {
  set.modify([&](casacore::MeasurementSet& open) {
    casacore::MSFieldColumns columns(open.field());
    change(columns);
  });
}

/// A polynomial of time.
void put_direction(casacore::ArrayColumn<double>& column, casacore::rownr_t field, const std::vector<double>& terms) {
  const casacore::IPosition shape(2, 2, static_cast<ssize_t>(terms.size() / 2));
  column.put(field, casacore::Array<double>(shape, terms.data()));
}

}  // namespace

BOOST_AUTO_TEST_CASE(what_is_no_direction_is_refused_with_its_values) {
  const double nan = nan_value, inf = std::numeric_limits<double>::infinity();
  const SmallSet set;
  for (const auto& terms : {std::vector<double>{nan, 0.5},
                            {0.1, inf},
                            {0, 1.7},
                            {3, -1.6},
                            {187.7, 12.4},
                            {1e9, 0.3},
                            {1.25, -0.5, nan, 0},
                            {1.25, -0.5, 1e-9, inf}}) {
    change_field(set, [&](auto& columns) {
      columns.numPoly().put(0, static_cast<int>(terms.size() / 2) - 1);
      put_direction(columns.phaseDir(), 0, terms);
    });
    for (const Selection& selection : {Selection{}, to_direction(about, Path::rate)}) {
      const std::string error = error_of([&] { MeasurementSet(set.path(), selection, "DATA"); });
      BOOST_TEST(contains(error, "phase centre of field 0 of " + set.path() + ": PHASE_DIR is ("), error);
      BOOST_TEST(contains(error, ") rad, expected finite numbers, a longitude within two turns and a latitude from"), error);
    }
    change_field(set, [&](auto& columns) {
      put_direction(columns.phaseDir(), 0, {1.25, -0.5, 0, 0});
      put_direction(columns.referenceDir(), 0, terms);
    });
    const MeasurementSet opened(set.path(), {}, "DATA");
    BOOST_TEST(contains(error_of([&] { opened.field_pointings(); }), "REFERENCE_DIR is ("));
  }
  for (const double turns : {-1.0, 0.0, 1.0}) {  // of one direction
    change_field(set, [&](auto& columns) {
      columns.numPoly().put(0, 0);
      put_direction(columns.phaseDir(), 0, {1.25 + turns * 360 * degree, -0.5});
    });
    BOOST_TEST(std::abs(MeasurementSet(set.path(), {}, "DATA").observation().phase_centre.ra_rad - 1.25) < 1e-14);
  }
}

BOOST_AUTO_TEST_CASE(rates_that_are_applied_over_years_are_told_of) {
  const MovingSet set(Path::rate);
  const auto told = [&](double field_time_s) {
    change_field(set, [&](auto& columns) { columns.time().put(0, field_time_s); });
    return says(MeasurementSet(set.path(), to_direction(about, Path::rate), "DATA"), "by NUM_POLY's rates");
  };
  BOOST_TEST(!told(set.moving.middle_s()));
  BOOST_TEST(!told(set.moving.middle_s() - 10 * day_s));
  for (const double time_s : {0.0, set.moving.middle_s() - 500 * day_s, set.moving.middle_s() + 500 * day_s})
    BOOST_TEST(told(time_s));
}

BOOST_AUTO_TEST_CASE(a_field_that_hardly_moves_beside_one_that_stands_still_is_one_image_with_it) {
  // The finest beam is some 7e-3 rad, of which a thousandth is not noticed, in 40 minutes.
  const SmallSet alone(slow_observation()), mixed(slow_observation()), still(slow_observation());
  add_still_field(mixed.path(), about);
  for (const double rate : {0.0, 1e-14, 1e-10, 1e-9, 1e-8})
    for (const bool other_set : {false, true}) {
      const SmallSet& set = other_set ? alone : mixed;
      change_field(set, [&](auto& columns) {
        columns.numPoly().put(0, 1);
        columns.time().put(0, slow_observation().time_mjd_s[integrations / 2]);
        for (auto* const column : {&columns.phaseDir(), &columns.referenceDir(), &columns.delayDir()})
          put_direction(*column, 0, {about.ra_rad, about.dec_rad, 0, rate});
      });
      const auto paths = other_set ? std::vector<std::string>{set.path(), still.path()} : std::vector<std::string>{set.path()};
      const auto open = [&] { return MeasurementSet(paths, {}, "DATA"); };
      if (rate == 1e-8) {
        BOOST_TEST(contains(error_of(open), "one stands still"), error_of(open));
        continue;
      }
      const MeasurementSet opened = open();
      BOOST_TEST(opened.observation().moving_at == "");
      BOOST_TEST(apart_rad(opened.observation().phase_centre, about) < 1e-12);
      BOOST_TEST(says(opened, "as if by rounding") == (rate > 0));
    }
}

BOOST_AUTO_TEST_CASE(flagged_rows_at_times_when_a_field_is_nowhere_change_nothing) {
  for (const Path way : {Path::ephemeris, Path::rate, Path::azimuth}) {
    const MovingSet set(way);
    for (const double time_s : {0.0, nan_value, 1e12}) {
      for (const std::size_t row : {std::size_t{0}, std::size_t{7}}) {
        set.put<double>("TIME", row, time_s);
        set.put<bool>("FLAG_ROW", row, true);
      }
      for (const Selection& selection : {to_direction(source, way), with(Moving::about_targets)}) {
        BOOST_TEST_INFO(name_of(way) << " " << time_s);
        const AllSamples all = read_all(MeasurementSet(set.path(), selection, "DATA"));
        BOOST_TEST(all.counts.flagged == 2 * channels);
        BOOST_TEST(all.counts.used == (rows - 2) * channels);
        if (!selection.phase_centre) continue;
        for (std::size_t i = 0; i < all.visibility.size(); ++i)
          if (all.weight[i] > 0) BOOST_TEST(std::abs(all.visibility[i] - std::complex<float>(flux_jy)) < roundings_jy);
      }
    }
  }
}

// casacore opens the tables of all fields wherever it looks at FIELD.
BOOST_AUTO_TEST_CASE(an_ephemeris_that_is_missing_or_odd_concerns_its_own_field_alone) {
  for (const bool missing : {true, false}) {
    const MovingSet set(Path::ephemeris);
    add_still_field(set.path(), {1.252, -0.501});
    const std::string table = set.path() + "/FIELD/EPHEM0_Object.tab";
    if (missing) {
      std::filesystem::remove_all(table);
    } else {
      casacore::Table open(table, casacore::Table::Update);
      open.rwKeywordSet().removeField("VS_TYPE");
      open.rwKeywordSet().define("MJD0", 1.0);
    }
    for (const std::string field : {"1", "STILL"}) {
      Selection selection;
      selection.field = field;
      BOOST_TEST(MeasurementSet(set.path(), selection, "DATA").observation().phase_centre.ra_rad == 1.252);
      selection.time_range = ">2000/01/01";
      BOOST_TEST(MeasurementSet(set.path(), selection, "DATA").rows() == 2 * baselines);
    }
    Selection moving = to_direction(about, Path::ephemeris);
    moving.field = "0";
    const std::string error = error_of([&] { MeasurementSet(set.path(), moving, "DATA"); });
    BOOST_TEST(error.empty() == !missing, error);
    if (missing)
      BOOST_TEST(contains(error, "phase centre of field 0 of " + set.path() + ": its EPHEMERIS_ID is 0, and "), error);
    if (missing) BOOST_TEST(contains(error, " holds 0 tables EPHEM0_*.tab, expected one"), error);
  }
}

BOOST_AUTO_TEST_CASE(how_near_counts_as_rounding_does_not_depend_on_the_unit_of_positions) {
  for (const double beams : {1e-4, 0.1}) {
    const SmallSet set;
    set.add_field(about.ra_rad, about.dec_rad + beams * 3e-3);
    for (const double times : {1e-3, 1e3, 1e3}) {
      set.modify([&](casacore::MeasurementSet& open) {
        casacore::ArrayColumn<double> position(open.antenna(), "POSITION");
        for (casacore::rownr_t a = 0; a < antennas; ++a) position.put(a, position(a) * times);
      });
      const std::string error = error_of([&] { MeasurementSet(set.path(), {}, "DATA"); });
      BOOST_TEST(contains(error, " apart; select one with --field") == (beams == 0.1), error);
    }
  }
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
  BOOST_TEST((error.empty() || contains(error, "casacore takes the place of planets from the tables DE200")));
}

BOOST_AUTO_TEST_CASE(a_field_that_moves_is_named_for_where_it_is_in_the_middle_of_its_rows) {
  for (const Path way : all_paths) {
    const MovingSet set(way);
    const Selection selection = phased_to({}, "SIMULATED", {set.path()});
    BOOST_TEST(apart_rad(*selection.phase_centre, about) < 1e-10);
    BOOST_TEST(contains(selection.phase_centre_remark, "field 0 (SIMULATED) of " + set.path() +
                                                           " moves: --phasecenter takes where it was in the middle of its "
                                                           "rows, at 2014-02-24T23:26:40"));
    BOOST_TEST(says(MeasurementSet(set.path(), selection, "DATA"), "moves: --phasecenter takes"));
  }
  const SmallSet still;
  BOOST_TEST(phased_to({}, "SIMULATED", {still.path()}).phase_centre_remark == "");
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
  set.add_field(about.ra_rad, about.dec_rad + 10 * arcsec);  // of beams of 25 arcmin
  BOOST_TEST(contains(error_of([&] { MeasurementSet(set.path(), {}, "DATA"); }), "10 arcsec apart; select one with --field"));
}

BOOST_AUTO_TEST_CASE(sets_that_differ_by_rounding_are_one_image_about_the_first) {
  const SmallSet first;
  put_fixed_source(first.path(), {}, source, flux_jy);
  for (const double apart : {1e-11, 4e-11, 1e-8}) {
    SimulatedObservation beside = small_observation();
    beside.fields.front().phase_centre.ra_rad += apart;
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
