#include "ms_io/simulated_set.h"

#include <array>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "tests/ms_io/small_set.h"

namespace misfit::ms_io {

BOOST_AUTO_TEST_SUITE(simulated_set)

using namespace testing;

BOOST_AUTO_TEST_CASE(every_required_subtable_has_rows) {
  const SmallSet set;
  const casacore::MeasurementSet ms(set.path());
  BOOST_TEST(ms.antenna().nrow() == antennas);
  BOOST_TEST(ms.feed().nrow() == antennas);
  BOOST_TEST(ms.field().nrow() == 1U);
  BOOST_TEST(ms.spectralWindow().nrow() == 1U);
  BOOST_TEST(ms.polarization().nrow() == 1U);
  BOOST_TEST(ms.dataDescription().nrow() == 1U);
  BOOST_TEST(ms.observation().nrow() == 1U);
  BOOST_TEST(ms.state().nrow() == 1U);
  BOOST_TEST(ms.processor().nrow() == 1U);
  BOOST_TEST(casacore::MSAntennaColumns(ms.antenna()).name()(2) == "A2");
}

BOOST_AUTO_TEST_CASE(rows_run_over_integrations_then_antenna1_then_antenna2) {
  const SmallSet set;
  const casacore::MeasurementSet ms(set.path());
  const casacore::MSMainColumns columns(ms);
  casacore::rownr_t row = 0;
  for (const double time : small_observation().time_mjd_s) {
    for (int a = 0; a < 4; ++a) {
      for (int b = a + 1; b < 4; ++b, ++row) {
        BOOST_TEST(columns.time()(row) == time);
        BOOST_TEST(columns.antenna1()(row) == a);
        BOOST_TEST(columns.antenna2()(row) == b);
      }
    }
  }
  BOOST_TEST(row == ms.nrow());
}

BOOST_AUTO_TEST_CASE(noise_is_white_and_independent_between_correlations) {
  SimulatedObservation observation = small_observation();
  observation.frequency_hz.assign(400, 1e9);
  observation.noise_jy = 2;
  const TemporaryFolder folder;
  const auto silent = [](const imager::SampleCoordinates& where) {
    return std::vector<std::complex<double>>(where.samples(), 0.0);
  };
  write_simulated_set((folder / "noise.ms"), observation, small_uvw, silent, {});
  const casacore::MeasurementSet ms((folder / "noise.ms"));
  const casacore::Array<casacore::Complex> data = casacore::ArrayColumn<casacore::Complex>(ms, "DATA").getColumn();
  std::array<double, 4> square = {};
  double cross = 0;
  const std::size_t count = data.nelements() / 2;
  for (std::size_t i = 0; i < count; ++i) {
    const casacore::Complex x = data.data()[2 * i], y = data.data()[2 * i + 1];
    const std::array<double, 4> part = {x.real(), x.imag(), y.real(), y.imag()};
    for (std::size_t p = 0; p < 4; ++p) square[p] += part[p] * part[p];
    cross += part[0] * part[2];
  }
  // The mean square of n normal numbers scatters by sqrt(2/n) of itself, the mean product by sqrt(1/n): 5 sigma.
  const double n = static_cast<double>(count);
  for (const double s : square) BOOST_TEST(std::abs(s / n / 4 - 1) < 5 * std::sqrt(2 / n));
  BOOST_TEST(std::abs(cross / n / 4) < 5 * std::sqrt(1 / n));
  BOOST_TEST(casacore::ArrayColumn<float>(ms, "WEIGHT")(0)(casacore::IPosition(1, 0)) == 0.25F);
  BOOST_TEST(casacore::ArrayColumn<float>(ms, "SIGMA")(0)(casacore::IPosition(1, 1)) == 2.0F);
}

BOOST_AUTO_TEST_CASE(the_seed_alone_decides_the_noise) {
  const auto visibilities = [](unsigned seed) {
    SimulatedObservation observation = small_observation();
    observation.noise_jy = 1;
    observation.seed = seed;
    const SmallSet set(observation);
    return read_all(MeasurementSet(set.path(), {}, "DATA")).visibility;
  };
  BOOST_CHECK(visibilities(3) == visibilities(3));
  BOOST_CHECK(visibilities(3) != visibilities(4));
}

BOOST_AUTO_TEST_CASE(what_exists_is_not_replaced) {
  const SmallSet set;
  const auto zero = [](const imager::SampleCoordinates& where) {
    return std::vector<std::complex<double>>(where.samples(), 0.0);
  };
  const std::string error = error_of([&] { write_simulated_set(set.path(), small_observation(), small_uvw, zero, {}); });
  BOOST_TEST(contains(error, set.path() + " exists already"));
  BOOST_TEST(set.cell("DATA", 0)(0, 0) == casacore::Complex(1, 1000));
}

BOOST_AUTO_TEST_CASE(a_failure_leaves_nothing_behind) {
  const TemporaryFolder folder;
  const auto fail = [](const imager::SampleCoordinates&) -> std::vector<std::complex<double>> {
    throw std::runtime_error("no sky");
  };
  BOOST_CHECK_THROW(write_simulated_set((folder / "a.ms"), small_observation(), small_uvw, fail, {}), std::runtime_error);
  BOOST_CHECK(std::filesystem::is_empty((folder / "")));
}

BOOST_AUTO_TEST_CASE(a_path_that_cannot_be_written_is_named) {
  const std::string error =
      error_of([] { write_simulated_set("/nowhere/a.ms", small_observation(), small_uvw, small_visibilities, {}); });
  BOOST_TEST(contains(error, "/nowhere/a.ms"));
  BOOST_TEST(!contains(error, "\n"));
}

BOOST_AUTO_TEST_CASE(an_observation_that_is_incomplete_is_refused) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::function<void(SimulatedObservation&)>& spoil) {
    SimulatedObservation observation = small_observation();
    spoil(observation);
    BOOST_CHECK_THROW(write_simulated_set((folder / "a.ms"), observation, small_uvw, small_visibilities, {}),
                      std::invalid_argument);
  };
  refused([](auto& o) { o.antenna_itrf_m.pop_back(); });
  refused([](auto& o) { o.antenna_name.clear(); });
  refused([](auto& o) { o.time_mjd_s.clear(); });
  refused([](auto& o) { o.frequency_hz.clear(); });
  refused([](auto& o) { o.frequency_hz[0] = -1; });
  refused([](auto& o) { o.noise_jy = -1; });
  refused([](auto& o) { o.antenna_name.push_back("A4"), o.antenna_itrf_m.push_back({}); });  // UVW are for 4 antennas
}

BOOST_AUTO_TEST_CASE(progress_counts_integrations) {
  const TemporaryFolder folder;
  std::vector<std::size_t> done;
  write_simulated_set((folder / "a.ms"), small_observation(), small_uvw, small_visibilities,
                      [&](std::size_t d, std::size_t total) {
                        done.push_back(d);
                        BOOST_TEST(total == integrations);
                      });
  BOOST_TEST(done == (std::vector<std::size_t>{1, 2, 3, 4, 5}), boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(fields_are_visited_by_turns_by_dishes_of_several_sorts) {
  SimulatedObservation observation = small_observation();
  observation.fields = {{"A", {1, 0.5}}, {"B", {1.01, 0.5}}, {"C", {1, 0.51}}};
  observation.dish_diameter_m = {12, 7};
  std::vector<std::vector<imager::RowSight>> sights;
  const TemporaryFolder folder;
  const auto note = [&](const imager::SampleCoordinates& where) {
    sights.push_back(where.sights);
    return small_visibilities(where);
  };
  write_simulated_set((folder / "a.ms"), observation, small_uvw, note, {});
  const casacore::MeasurementSet set(folder / "a.ms");
  const casacore::MSMainColumns rows_of(set);
  BOOST_REQUIRE_EQUAL(sights.size(), integrations);
  for (std::size_t row = 0; row < rows; ++row) {
    const imager::RowSight& sight = sights[row / baselines][row % baselines];
    BOOST_TEST(rows_of.fieldId()(row) == static_cast<int>(row / baselines % 3));
    BOOST_TEST(sight.field == rows_of.fieldId()(row));
    BOOST_TEST(sight.antenna_one == rows_of.antenna1()(row));
    BOOST_TEST(sight.antenna_other == rows_of.antenna2()(row));
  }
  Selection third;
  third.field = "C";
  const MeasurementSet of_third(folder / "a.ms", third, "DATA");
  BOOST_TEST(of_third.observation().phase_centre.dec_rad == 0.51);
  BOOST_TEST(of_third.antennas().at(3).diameter_m == 7);
  BOOST_TEST(of_third.beam_rows().sorts.size() == 2U);
  observation.fields.back().phase_centre.frame = "ICRS";
  BOOST_CHECK_THROW(write_simulated_set((folder / "b.ms"), observation, small_uvw, small_visibilities, {}),
                    std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
