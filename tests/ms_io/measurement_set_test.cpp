#include "ms_io/measurement_set.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <fstream>

#include "imager/numerics/constants.h"
#include "ms_io/celestial_frames.h"
#include "tests/ms_io/small_set.h"

namespace misfit::ms_io {

BOOST_AUTO_TEST_SUITE(measurement_set)

using namespace testing;

namespace {

AllSamples read_all(const SmallSet& set, const Selection& selection = {}, std::uint64_t block_samples = 1 << 22) {
  return testing::read_all(MeasurementSet(set.path(), selection, "DATA", {imager::Stokes::I}, block_samples));
}

std::string error_of(const SmallSet& set, const Selection& selection, const std::string& column = "DATA") {
  return testing::error_of([&] { MeasurementSet(set.path(), selection, column); });
}

/// By the definition, from every sample of weight not 0.
SetReach reach_of_samples(const MeasurementSet& set) {
  SetReach reach;
  const auto stream = set.open();
  while (const auto block = stream->next()) {
    for (std::size_t i = 0; i < block->samples(); ++i) {
      if (block->weight[i] == 0) continue;
      const double per_m = block->frequency_hz[i % block->channels()] / imager::speed_of_light_m_s;
      const double* const uvw_m = block->uvw_m.data() + 3 * (i / block->channels());
      reach.max_abs_u = std::max(reach.max_abs_u, std::abs(uvw_m[0]) * per_m);
      reach.max_abs_v = std::max(reach.max_abs_v, std::abs(uvw_m[1]) * per_m);
      reach.max_abs_w = std::max(reach.max_abs_w, std::abs(uvw_m[2]) * per_m);
      const double baseline_m = std::hypot(uvw_m[0], uvw_m[1]);
      reach.shortest_m = std::min(reach.shortest_m, baseline_m);
      reach.longest_m = std::max(reach.longest_m, baseline_m);
      reach.shortest_lambda = std::min(reach.shortest_lambda, baseline_m * per_m);
      reach.longest_lambda = std::max(reach.longest_lambda, baseline_m * per_m);
    }
  }
  return reach;
}

}  // namespace

BOOST_AUTO_TEST_CASE(what_was_written_is_read) {
  const SmallSet set;
  const MeasurementSet opened(set.path(), {}, "DATA");
  BOOST_TEST(opened.rows() == rows);
  BOOST_TEST(opened.samples() == rows * channels);
  const AllSamples all = testing::read_all(opened);
  std::size_t i = 0;
  for (std::size_t t = 0; t < integrations; ++t) {
    const imager::SampleCoordinates where{small_uvw(t), small_observation().frequency_hz};
    for (const double x : where.uvw_m) BOOST_TEST(x == all.uvw_m[i++]);
    const auto expected = small_visibilities(where);
    for (std::size_t s = 0; s < expected.size(); ++s) {
      BOOST_TEST(all.visibility[t * expected.size() + s] == std::complex<float>(expected[s]));
    }
  }
  for (const float w : all.weight) BOOST_TEST(w == 0.5F);  // two hands of weight 1
  BOOST_TEST(all.counts.used == rows * channels);
  BOOST_TEST(all.counts.rows_read == rows);
  BOOST_TEST(all.frequency_hz == small_observation().frequency_hz, boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(a_set_can_be_read_any_number_of_times) {
  const SmallSet set;
  const MeasurementSet opened(set.path(), {}, "DATA");
  BOOST_CHECK(testing::read_all(opened).visibility == testing::read_all(opened).visibility);
}

BOOST_AUTO_TEST_CASE(the_reach_is_that_of_the_samples_that_can_be_used) {
  const SmallSet set;  // |u|, |v| and |w| grow towards the last rows
  set.add_spectral_window();
  set.put("FLAG_ROW", 29, true);
  set.put("FLAG_ROW", 28, true);
  set.put("ANTENNA1", 27, 1);
  set.put("ANTENNA2", 27, 1);
  set.put("UVW", 26, 0, 0, nan_value);
  set.put("UVW", 25, 1, 0, double{infinite_float});
  for (const std::string spw : {"", "0", "1", "0:2~3", "1:0"}) {
    for (const std::uint64_t block_samples : {std::uint64_t{1}, std::uint64_t{1} << 20}) {
      const MeasurementSet opened(set.path(), {"", spw}, "DATA", {imager::Stokes::I}, block_samples);
      const SetReach is = opened.reach(), should = reach_of_samples(opened);
      const auto rounding = boost::test_tools::tolerance(1e-15);
      BOOST_TEST(is.max_abs_u == should.max_abs_u, rounding);
      BOOST_TEST(is.max_abs_v == should.max_abs_v, rounding);
      BOOST_TEST(is.max_abs_w == should.max_abs_w, rounding);
      BOOST_TEST(is.shortest_m == should.shortest_m, rounding);
      BOOST_TEST(is.longest_m == should.longest_m, rounding);
      BOOST_TEST(is.shortest_lambda == should.shortest_lambda, rounding);
      BOOST_TEST(is.longest_lambda == should.longest_lambda, rounding);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_summary_tells_of_the_rows_selected) {
  const SmallSet set;
  set.add_field(1.25, -0.5);  // every second row is its
  set.add_spectral_window();
  set.put("TIME", 29, 0.0);  // of a writer that leaves rows without a time
  const std::vector<SetSummary> all = MeasurementSet(set.path(), {"OTHER", "0"}, "").summaries();
  BOOST_REQUIRE(all.size() == 1U);
  const SetSummary& one = all.front();
  BOOST_TEST(one.path == set.path());
  BOOST_TEST(one.antennas == antennas);
  BOOST_REQUIRE(one.fields.size() == 1U);
  BOOST_TEST(one.fields.front().id == 1);
  BOOST_TEST(one.fields.front().name == "OTHER");
  BOOST_TEST(one.all_fields == 2U);
  BOOST_TEST(one.all_windows == 2U);
  BOOST_TEST(one.start_utc.substr(0, 16) == "2014-02-24T23:06");  // 4.9e9 s is 23:06:40
  BOOST_TEST(one.end_utc.substr(0, 16) == "2014-02-24T23:07");    // 40 s later, and an integration longer
  const double interval_s = casacore::ScalarColumn<double>(casacore::Table(set.path()), "INTERVAL")(0);
  BOOST_TEST(one.length_s == 40 + interval_s, boost::test_tools::tolerance(1e-6));  // times are good to 1e-6 s
}

BOOST_AUTO_TEST_CASE(coordinates_are_those_of_the_rows_that_can_be_used) {
  const SmallSet set;
  set.add_spectral_window();
  set.put("FLAG_ROW", 28, true);
  set.put("ANTENNA1", 27, 1);
  set.put("ANTENNA2", 27, 1);
  set.put("UVW", 26, 0, 0, nan_value);
  const MeasurementSet opened(set.path(), {}, "DATA");
  std::vector<std::pair<double, double>> seen, should;  // u and the last frequency
  opened.visit_coordinates([&](const imager::SampleCoordinates& some) {
    for (std::size_t row = 0; row < some.rows(); ++row) seen.emplace_back(some.uvw_m[3 * row], some.frequency_hz.back());
  });
  const auto stream = opened.open();
  while (const auto block = stream->next())
    for (std::size_t row = 0; row < block->rows(); ++row)
      if (block->weight[row * block->channels()] != 0) should.emplace_back(block->uvw_m[3 * row], block->frequency_hz.back());
  BOOST_TEST(!seen.empty());
  BOOST_CHECK(seen == should);
}

BOOST_AUTO_TEST_CASE(the_reach_is_a_bound_where_single_samples_are_flagged) {
  const SmallSet set;
  for (std::size_t c = 0; c < channels; ++c) set.put("FLAG", 29, 1, static_cast<ssize_t>(c), true);
  const MeasurementSet opened(set.path(), {}, "DATA");
  BOOST_TEST(opened.reach().max_abs_u > reach_of_samples(opened).max_abs_u);
}

BOOST_AUTO_TEST_CASE(a_stream_outlives_the_set_it_came_from) {
  const SmallSet set;
  auto opened = std::make_unique<MeasurementSet>(set.path(), Selection{}, "DATA");
  const auto stream = opened->open();
  opened.reset();
  BOOST_TEST(stream->next()->rows() == rows);
  BOOST_TEST(!stream->next());
}

BOOST_AUTO_TEST_CASE(samples_do_not_depend_on_the_block_size) {
  const SmallSet set;
  set.add_field(1.25, -0.5);
  for (const Selection& selection : {Selection{}, Selection{"1", "0:1;3~4"}}) {
    const AllSamples whole = read_all(set, selection);
    for (const std::uint64_t block_samples : {1, 7, 12, 36}) {
      const AllSamples parts = read_all(set, selection, block_samples);
      BOOST_TEST(parts.blocks > whole.blocks);
      BOOST_CHECK(parts.visibility == whole.visibility);
      BOOST_CHECK(parts.weight == whole.weight);
      BOOST_CHECK(parts.uvw_m == whole.uvw_m);
      BOOST_TEST(parts.counts.used == whole.counts.used);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_sample_left_out_is_counted_once_under_the_first_reason_and_reads_as_zero) {
  const SmallSet set;
  const casacore::Complex bad(nan_float, 0);
  set.put("ANTENNA2", 0, 0);  // auto-correlation, flagged and non-finite too
  set.put("FLAG_ROW", 0, true);
  set.put("DATA", 0, 0, 0, bad);
  set.put("FLAG_ROW", 1, true);  // flagged, with zero weight too
  set.put("WEIGHT", 1, 0, 0, 0.0F);
  set.put("FLAG", 2, 1, 3, true);  // flagged in one hand and channel, non-finite too
  set.put("DATA", 2, 0, 3, bad);
  set.put("DATA", 3, 1, 2, bad);  // non-finite data in one hand and channel
  set.put("WEIGHT", 4, 0, 0, infinite_float);
  set.put("WEIGHT", 5, 1, 0, nan_float);
  set.put("UVW", 6, 2, 0, nan_value);
  set.put("WEIGHT", 7, 0, 0, 0.0F);
  set.put("WEIGHT", 8, 1, 0, -1.0F);
  const AllSamples all = read_all(set);
  BOOST_TEST(all.counts.samples_read == rows * channels);
  BOOST_TEST(all.counts.autocorrelations == channels);
  BOOST_TEST(all.counts.flagged == channels + 1);
  BOOST_TEST(all.counts.nonfinite == 3 * channels + 1);
  BOOST_TEST(all.counts.zero_weight == 2 * channels);
  BOOST_TEST(all.counts.used == rows * channels - 7 * channels - 2);
  std::size_t unusable = 0;
  for (std::size_t i = 0; i < all.weight.size(); ++i) {
    BOOST_TEST(std::isfinite(std::abs(all.visibility[i])));
    if (all.weight[i] > 0) continue;
    BOOST_TEST(all.weight[i] == 0.0F);
    BOOST_TEST(all.visibility[i] == std::complex<float>(0));
    ++unusable;
  }
  BOOST_TEST(unusable == 7 * channels + 2);
}

BOOST_AUTO_TEST_CASE(weight_spectrum_wins_over_weight_where_its_cell_is_defined) {
  const SmallSet set;
  set.modify([](casacore::MeasurementSet& ms) {
    ms.addColumn(casacore::ArrayColumnDesc<float>("WEIGHT_SPECTRUM", 2));
    casacore::ArrayColumn<float> spectrum(ms, "WEIGHT_SPECTRUM");
    for (const casacore::rownr_t r : {1, 7}) {
      casacore::Matrix<float> cell(2, channels, 8.0F);
      cell(1, 4) = 0;
      spectrum.put(r, cell);
    }
  });
  for (const std::string spw : {"", "0:1~4"}) {
    const AllSamples all = read_all(set, {"", spw});
    const std::size_t count = all.frequency_hz.size(), first = spw.empty() ? 0 : 1;
    for (std::size_t r = 0; r < rows; ++r) {
      for (std::size_t c = 0; c < count; ++c) {
        const float expected = r != 1 && r != 7 ? 0.5F : c + first == 4 ? 0.0F : 4.0F;
        BOOST_TEST(all.weight[r * count + c] == expected);
      }
    }
    BOOST_TEST(all.counts.zero_weight == 2U);
  }
  set.modify([](casacore::MeasurementSet& ms) {
    casacore::ArrayColumn<float> spectrum(ms, "WEIGHT_SPECTRUM");
    for (casacore::rownr_t r = 0; r < rows; ++r) spectrum.put(r, casacore::Matrix<float>(2, channels, 6.0F));
  });
  for (const float w : read_all(set).weight) BOOST_TEST(w == 3.0F);
}

BOOST_AUTO_TEST_CASE(a_block_never_mixes_data_description_ids_and_keeps_their_order) {
  const SmallSet set;
  set.add_spectral_window();
  const MeasurementSet opened(set.path(), {}, "DATA", {imager::Stokes::I}, 3 * channels);
  const auto stream = opened.open();
  std::vector<double> last_u = {0, 0};
  std::vector<std::size_t> count = {0, 0};
  while (const auto block = stream->next()) {
    const std::size_t window = block->frequency_hz[0] > 1.5e9 ? 1 : 0;
    BOOST_TEST(block->frequency_hz[0] == (window == 1 ? 2e9 : 1e9));
    for (std::size_t r = 0; r < block->rows(); ++r) {
      const double u = block->uvw_m[3 * r];  // row + 1
      BOOST_TEST(u > last_u[window]);
      BOOST_TEST((std::fmod(u - 1, 3) == 2) == (window == 1));
      BOOST_TEST(block->visibility[r * channels].real() == static_cast<float>(u));
      last_u[window] = u;
      ++count[window];
    }
  }
  BOOST_TEST(count[0] == 2 * rows / 3);
  BOOST_TEST(count[1] == rows / 3);
}

BOOST_AUTO_TEST_CASE(blocks_whose_rows_alternate_are_read_at_once) {
  const SmallSet set;
  const auto read_at_once = [&](const std::string& spw) {
    return MeasurementSet(set.path(), {"", spw}, "DATA", {imager::Stokes::I}, 3 * channels).read_at_once();
  };
  BOOST_TEST(read_at_once("") == 3 * channels);
  set.add_spectral_window();
  BOOST_TEST(read_at_once("") == 6 * channels);
  BOOST_TEST(read_at_once("1") == 3 * channels);
  BOOST_TEST(read_at_once("0:1~2,1:1~2") == 2 * 2 * 9U);  // 9 rows of two channels each
}

BOOST_AUTO_TEST_CASE(the_spectral_windows_selected_decide_rows_and_band) {
  const SmallSet set;
  set.add_spectral_window();
  const MeasurementSet second(set.path(), {"", "1:2~3"}, "DATA");
  BOOST_TEST(second.rows() == rows / 3);
  BOOST_TEST(second.samples() == 2 * rows / 3);
  BOOST_TEST(second.observation().frequency_hz == 2.0025e9);
  BOOST_TEST(second.observation().bandwidth_hz == 2e6);
  BOOST_TEST(MeasurementSet(set.path(), {}, "DATA").observation().bandwidth_hz == 1.006e9);
}

BOOST_AUTO_TEST_CASE(four_circular_correlations_give_half_of_rr_plus_ll) {
  const SmallSet set;
  set.store_correlations({5, 6, 7, 8});
  const AllSamples all = read_all(set);
  for (const auto& v : all.visibility) BOOST_TEST(v == std::complex<float>(2.5F));  // (1 + 4)/2
  for (const float w : all.weight) BOOST_TEST(std::abs(w - 0.8F) < 1e-6F);          // 1/(1/1 + 1/4), rounding
}

BOOST_AUTO_TEST_CASE(a_stored_stokes_i_is_read_as_it_is) {
  const SmallSet set;
  set.store_correlations({2, 1});
  const AllSamples all = read_all(set);
  for (const auto& v : all.visibility) BOOST_TEST(v == std::complex<float>(2.0F));
  for (const float w : all.weight) BOOST_TEST(w == 0.5F);  // 1/(4 σ²), where the data's own is 1/σ²
}

BOOST_AUTO_TEST_CASE(several_stokes_parameters_come_in_blocks_that_share_samples_and_weights) {
  const SmallSet set;
  set.store_correlations({9, 10, 11, 12});  // V = 1, 2, 3, 4 with weights 1, 2, 3, 4
  set.put("FLAG", 3, 1, 2, true);
  const MeasurementSet opened(set.path(), {}, "DATA", imager::parse_stokes("IQUV"), 7 * channels);
  const std::vector<std::complex<float>> expected = {2.5F, -1.5F, 2.5F, {0, 0.5F}};
  std::size_t used = 0;
  const auto stream = opened.open();
  while (const auto block = stream->next()) {
    BOOST_TEST_REQUIRE(block->stokes() == 4U);
    for (std::size_t s = 0; s < 4; ++s)
      for (std::size_t i = 0; i < block->samples(); ++i)
        BOOST_TEST(block->visibility_of(s)[i] == (block->weight[i] > 0 ? expected[s] : 0.0F));
    used += block->counts.used;
  }
  BOOST_TEST(used == rows * channels - 1);
}

BOOST_AUTO_TEST_CASE(only_the_hands_needed_decide_whether_a_sample_is_used) {
  const SmallSet set;
  set.store_correlations({9, 10, 11, 12});
  set.put("FLAG", 3, 1, 2, true);
  set.put("DATA", 4, 2, 2, casacore::Complex(nan_float, 0));
  set.put("WEIGHT", 5, 1, 0, 0.0F);
  BOOST_TEST(read_all(set).counts.used == rows * channels);
}

BOOST_AUTO_TEST_CASE(without_both_hands_the_error_lists_the_correlations_there_are) {
  const SmallSet set;
  set.store_correlations({10, 9});
  const std::string error = error_of(set, {});
  BOOST_TEST(contains(error, "XY, XX"));
  BOOST_TEST(contains(error, set.path()));
  BOOST_TEST(contains(error, "it needs XX and YY, RR and LL, or I"));
}

BOOST_AUTO_TEST_CASE(rows_of_one_field_can_be_selected_by_index_and_name) {
  const SmallSet set;
  set.add_field(1.5, -0.25);
  for (const std::string field : {"1", "OTHER", "OTH*"}) {
    const MeasurementSet opened(set.path(), {field, ""}, "DATA");
    BOOST_TEST(opened.rows() == rows / 2);
    BOOST_TEST(opened.observation().object == "OTHER");
    BOOST_TEST(opened.observation().phase_centre.ra_rad == 1.5);
    BOOST_TEST(opened.observation().phase_centre.dec_rad == -0.25);
    const AllSamples all = testing::read_all(opened);
    for (std::size_t r = 0; r < rows / 2; ++r) BOOST_TEST(all.uvw_m[3 * r] == static_cast<double>(2 * r + 2));
  }
}

BOOST_AUTO_TEST_CASE(fields_with_several_phase_centres_are_refused_by_name) {
  const SmallSet set;
  set.add_field(1.25 + 2e-5, -0.5);  // a 300th of the beam
  const std::string error = error_of(set, {});
  BOOST_TEST(contains(error, "0 (SIMULATED)"));
  BOOST_TEST(contains(error, "1 (OTHER)"));
  BOOST_TEST(contains(error, "--field"));
}

BOOST_AUTO_TEST_CASE(fields_that_share_their_phase_centre_are_one_image) {
  const SmallSet set;
  set.add_field(1.25, -0.5);
  BOOST_TEST(MeasurementSet(set.path(), {}, "DATA").rows() == rows);
}

BOOST_AUTO_TEST_CASE(fields_without_rows_do_not_matter) {
  const SmallSet set;
  set.add_field(0.1, 0.2);
  for (std::size_t r = 0; r < rows; ++r) set.put("FIELD_ID", r, 1);
  BOOST_TEST(MeasurementSet(set.path(), {}, "DATA").observation().object == "OTHER");
}

BOOST_AUTO_TEST_CASE(channels_are_selected_by_range_step_list_and_frequency) {
  const SmallSet set;
  const std::vector<std::pair<std::string, std::vector<std::size_t>>> laws = {
      {"0", {0, 1, 2, 3, 4, 5}}, {"*:0~2", {0, 1, 2}},           {"0:1~5^2", {1, 3, 5}}, {"0:0;3~4", {0, 3, 4}}, {"0:4", {4}},
      {"0:3~4,0:1", {1, 3, 4}},  {"0:1001.5~1003.5MHz", {2, 3}},
  };
  for (const auto& [expression, expected] : laws) {
    BOOST_TEST_CONTEXT(expression) {
      const AllSamples all = read_all(set, {"", expression});
      BOOST_TEST(all.frequency_hz.size() == expected.size());
      BOOST_TEST(all.visibility.size() == rows * expected.size());
      for (std::size_t i = 0; i < all.visibility.size(); ++i) {
        const std::size_t channel = expected[i % expected.size()];
        BOOST_TEST(all.frequency_hz[i % expected.size()] == 1e9 + 1e6 * static_cast<double>(channel));
        BOOST_TEST(all.visibility[i].imag() == 1000 + static_cast<float>(channel));
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(descending_frequencies_keep_their_order) {
  SimulatedObservation observation = small_observation();
  std::reverse(observation.frequency_hz.begin(), observation.frequency_hz.end());
  observation.channel_width_hz = -1e6;
  const SmallSet set(observation);
  const MeasurementSet opened(set.path(), {"", "0:1~2"}, "DATA");
  BOOST_TEST(opened.observation().frequency_hz == 1.0035e9);
  BOOST_TEST(opened.observation().bandwidth_hz == 2e6);
  const AllSamples all = testing::read_all(opened);
  BOOST_TEST(all.frequency_hz[0] == 1.004e9);
  BOOST_TEST(all.visibility[0].imag() == 1004.0F);
}

BOOST_AUTO_TEST_CASE(a_wrong_selection_is_one_line_that_names_the_expression) {
  const SmallSet set;
  for (const Selection& selection : {Selection{"NOBODY", ""}, Selection{"0,", ""}, Selection{"7", ""}, Selection{"", "0:1~~"},
                                     Selection{"", "9"}, Selection{"", "0:2.4~2.5GHz"}}) {
    const std::string error = error_of(set, selection);
    BOOST_TEST(contains(error, "'" + selection.field.of(0) + selection.spectral_window.of(0) + "'"));
    BOOST_TEST(!contains(error, "\n"));
  }
}

BOOST_AUTO_TEST_CASE(a_selection_without_rows_is_an_error) {
  const SmallSet set;
  set.add_field(1.25, -0.5);
  for (std::size_t r = 0; r < rows; ++r) set.put("FIELD_ID", r, 0);
  BOOST_TEST(contains(error_of(set, {"OTHER", ""}), "none of its 30 rows"));
}

BOOST_AUTO_TEST_CASE(a_path_that_is_no_measurement_set_is_named) {
  const SmallSet set;
  const TemporaryFolder folder;
  std::ofstream((folder / "text.ms")) << "text";
  std::filesystem::create_directory((folder / "empty.ms"));
  const auto error = [](const std::string& path) { return testing::error_of([&] { MeasurementSet(path, {}, "DATA"); }); };
  BOOST_TEST(contains(error("/nowhere/a.ms"), "/nowhere/a.ms does not exist"));
  BOOST_TEST(contains(error((folder / "text.ms")), "text.ms is not a casacore table"));
  BOOST_TEST(contains(error((folder / "empty.ms")), "empty.ms is not a casacore table"));
  BOOST_TEST(contains(error(set.path() + "/ANTENNA"), "not a MeasurementSet"));
}

BOOST_AUTO_TEST_CASE(a_missing_data_column_is_answered_with_those_there_are) {
  const SmallSet set;
  BOOST_TEST(contains(error_of(set, {}, "corrected"), "'CORRECTED_DATA'; columns with visibilities: DATA"));
  BOOST_TEST(contains(error_of(set, {}, "UVW"), "columns with visibilities: DATA"));
  BOOST_TEST(error_of(set, {}, "data").empty());
}

BOOST_AUTO_TEST_CASE(frequencies_that_are_not_positive_are_an_error_only_where_selected) {
  const SmallSet set;
  set.modify([](casacore::MeasurementSet& ms) {
    casacore::MSSpWindowColumns columns(ms.spectralWindow());
    casacore::Vector<double> frequency = columns.chanFreq()(0);
    frequency(2) = 0;
    columns.chanFreq().put(0, frequency);
  });
  BOOST_TEST(contains(error_of(set, {}), "spectral window 0 has frequency 0 Hz at channel 2"));
  BOOST_TEST(error_of(set, {"", "0:3~5"}).empty());
}

BOOST_AUTO_TEST_CASE(rows_that_point_nowhere_are_an_error) {
  const SmallSet set;
  set.put("DATA_DESC_ID", 3, 5);
  BOOST_TEST(contains(error_of(set, {}), "DATA_DESC_ID 5"));
  set.put("DATA_DESC_ID", 3, 0);
  set.put("FIELD_ID", 3, 5);
  BOOST_TEST(contains(error_of(set, {}), "FIELD_ID 5"));
}

BOOST_AUTO_TEST_CASE(the_observation_is_described_from_its_first_row) {
  const SmallSet set;
  const imager::Observation seen = MeasurementSet(set.path(), {}, "DATA").observation();
  BOOST_TEST(seen.telescope == "EVLA");
  BOOST_TEST(seen.object == "SIMULATED");
  BOOST_TEST(seen.date_obs == "2014-02-24T23:06:35.000");  // MJD 4.9e9 s less half of 10 s
  BOOST_TEST(seen.spectral_frame == "TOPOCENT");
  BOOST_TEST(seen.phase_centre.ra_rad == 1.25);
  BOOST_TEST(seen.phase_centre.dec_rad == -0.5);
  BOOST_TEST(seen.frequency_hz == 1.0025e9);
  BOOST_TEST(seen.bandwidth_hz == 6e6);
}

BOOST_AUTO_TEST_CASE(the_frame_of_the_phase_centre_is_kept) {
  for (const std::string frame : {"FK5", "ICRS", "FK4"}) {
    SimulatedObservation observation = small_observation();
    observation.fields.front().phase_centre.frame = frame;
    const SmallSet set(observation);
    const imager::SkyDirection centre = MeasurementSet(set.path(), {}, "DATA").observation().phase_centre;
    BOOST_TEST(centre.frame == frame);
    BOOST_TEST(centre.ra_rad == 1.25);
  }
}

BOOST_AUTO_TEST_CASE(a_phase_centre_in_another_frame_is_where_headers_of_images_have_it) {
  for (const std::string frame : {"GALACTIC", "SUPERGAL", "ECLIPTIC"}) {
    const SmallSet set;
    set.modify([&](casacore::MeasurementSet& ms) {
      for (const char* name : {"PHASE_DIR", "REFERENCE_DIR"}) {
        casacore::TableColumn column(ms.field(), name);
        casacore::Record info = column.keywordSet().asRecord("MEASINFO");
        info.define("Ref", frame);
        column.rwKeywordSet().defineRecord("MEASINFO", info);
        casacore::Matrix<double> direction(2, 1);
        direction(0, 0) = 5.5;
        direction(1, 0) = -0.3;
        casacore::ArrayColumn<double>(ms.field(), name).put(0, direction);
      }
    });
    const MeasurementSet opened(set.path(), {}, "DATA");
    const imager::SkyDirection centre = opened.observation().phase_centre, expected = in_frame({5.5, -0.3, frame}, "FK5");
    for (const imager::SkyDirection& found : {centre, opened.field_pointings().at(0).direction}) {
      BOOST_TEST(found.frame == "FK5");
      BOOST_TEST(std::abs(found.ra_rad - expected.ra_rad) < 1e-14);
      BOOST_TEST(std::abs(found.dec_rad - expected.dec_rad) < 1e-14);
    }
  }
}

BOOST_AUTO_TEST_CASE(the_column_is_that_of_calibrated_data_where_a_set_has_it) {
  const SmallSet set, calibrated;
  calibrated.modify([](casacore::MeasurementSet& ms) {
    ms.addColumn(casacore::ArrayColumnDesc<casacore::Complex>("CORRECTED_DATA", 2));
    for (casacore::rownr_t row = 0; row < ms.nrow(); ++row)
      casacore::ArrayColumn<casacore::Complex>(ms, "CORRECTED_DATA")
          .put(row, casacore::Matrix<casacore::Complex>(2, channels, casacore::Complex(7)));
  });
  const std::vector<std::string> paths{set.path(), calibrated.path()};
  const auto columns = MeasurementSet(paths, {}, "auto").data_columns();
  BOOST_REQUIRE(columns.size() == 2U);
  BOOST_TEST(columns[0].name == "DATA");
  BOOST_TEST(columns[1].name == "CORRECTED_DATA");
  BOOST_TEST(columns[1].path == calibrated.path());
  BOOST_TEST(named_columns(paths, "auto") == "DATA,CORRECTED_DATA");
  BOOST_TEST(named_columns(paths, "data") == "DATA");
  BOOST_TEST(named_columns({calibrated.path()}, "auto") == "CORRECTED_DATA");
  BOOST_TEST((testing::read_all(MeasurementSet(calibrated.path(), {}, "auto")).visibility ==
              testing::read_all(MeasurementSet(calibrated.path(), {}, "CORRECTED_DATA")).visibility));
}

BOOST_AUTO_TEST_CASE(a_column_that_was_never_filled_is_told_from_one_with_a_single_value) {
  const SmallSet set, one_value;
  for (const SmallSet* of : {&set, &one_value})
    of->modify([](casacore::MeasurementSet& ms) {
      casacore::ArrayColumn<casacore::Complex> data(ms, "DATA");
      for (casacore::rownr_t row = 0; row < ms.nrow(); ++row)
        data.put(row, casacore::Matrix<casacore::Complex>(2, channels, casacore::Complex(0)));
    });
  one_value.put("DATA", rows - 1, 1, 2, casacore::Complex(0, 1e-30F));
  const SmallSet filled;
  for (const auto& [channels_selected, expected] : {std::pair("", 0U), {"0:0~1", 1U}}) {
    const MeasurementSet read({one_value.path(), filled.path()}, {"", channels_selected}, "data");
    testing::read_all(read);
    BOOST_TEST(read.columns_of_zeros(imager::alone()).size() == expected);
  }
  const MeasurementSet empty({set.path(), filled.path()}, {}, "data");
  testing::read_all(empty);
  const auto columns = empty.columns_of_zeros(imager::alone());
  BOOST_REQUIRE(columns.size() == 1U);
  BOOST_TEST(columns.front().path == set.path());
  BOOST_TEST(columns.front().zeros.everywhere);
}

BOOST_AUTO_TEST_CASE(samples_of_one_hand_count_where_either_is_asked_for) {
  const SmallSet set;
  set.modify([](casacore::MeasurementSet& open) {
    casacore::ArrayColumn<bool> flag(open, "FLAG");
    casacore::Matrix<bool> cell = flag(0);
    cell(0, 2) = cell(1, 3) = true;
    cell(0, 4) = cell(1, 4) = true;
    flag.put(0, cell);
  });
  const AllSamples strict = misfit::ms_io::testing::read_all(MeasurementSet(set.path(), {}, "DATA"));
  Selection selection;
  selection.either_hand = true;
  const AllSamples either = misfit::ms_io::testing::read_all(MeasurementSet(set.path(), selection, "DATA"));
  for (std::size_t c = 0; c < channels; ++c) {
    BOOST_TEST((strict.weight[c] == 0) == (c >= 2 && c <= 4));
    BOOST_TEST((either.weight[c] == 0) == (c == 4));
    if (c != 2 && c != 3) BOOST_TEST(either.visibility[c] == strict.visibility[c]);
  }
  BOOST_TEST(either.visibility[2] == set.cell("DATA", 0)(1, 2));
  BOOST_TEST(either.visibility[3] == set.cell("DATA", 0)(0, 3));
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
