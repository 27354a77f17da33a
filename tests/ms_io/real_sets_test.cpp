// Observations of other people; see Unpacked.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <map>

#include "tests/ms_io/small_set.h"

namespace misfit::ms_io {

BOOST_AUTO_TEST_SUITE(real_sets)

using namespace testing;
using misfit::testing::Unpacked;

namespace {

/// Reads everything, and checks what holds for any set.
AllSamples read_checked(const MeasurementSet& set) {
  AllSamples all = read_all(set);
  const imager::SampleCounts& n = all.counts;
  BOOST_TEST(n.rows_read == set.rows());
  BOOST_TEST(n.samples_read == set.samples());
  BOOST_TEST(n.autocorrelations + n.flagged + n.nonfinite + n.zero_weight + n.used == n.samples_read);
  std::size_t usable = 0, wrong = 0;
  for (std::size_t i = 0; i < all.weight.size(); ++i) {
    usable += all.weight[i] > 0;
    wrong += !std::isfinite(std::abs(all.visibility[i])) || !std::isfinite(all.weight[i]) || all.weight[i] < 0;
  }
  BOOST_TEST(usable == n.used);
  BOOST_TEST(wrong == 0U);
  return all;
}

}  // namespace

BOOST_AUTO_TEST_CASE(alma_has_three_windows_and_is_56_percent_flagged) {
  const Unpacked data("alma_hd142527_b9");
  if (!data.present()) return;
  const MeasurementSet set(data / "alma_hd142527_b9.ms", {}, "DATA");
  const AllSamples all = read_checked(set);
  BOOST_TEST(all.frequency_hz.size() == 3U);
  BOOST_TEST(all.counts.samples_read == 78375U);
  BOOST_TEST(std::round(100.0 * static_cast<double>(all.counts.flagged) / 78375.0) == 56.0);
  BOOST_TEST(set.observation().telescope == "ALMA");
  BOOST_TEST(set.observation().object == "HD 142527");
  BOOST_TEST(set.observation().spectral_frame == "TOPOCENT");
  std::uint64_t sum = 0;
  for (const char* window : {"0", "1", "2"}) {
    sum += MeasurementSet(data / "alma_hd142527_b9.ms", {"", window}, "DATA").samples();
  }
  BOOST_TEST(sum == 78375U);
}

BOOST_AUTO_TEST_CASE(lofar_has_122_autocorrelation_rows) {
  const Unpacked data("lofar_3c295_snapshot");
  if (!data.present()) return;
  const MeasurementSet set(data / "lofar_3c295_snapshot.ms", {}, "corrected");
  const AllSamples all = read_checked(set);
  BOOST_TEST(all.counts.rows_read == 3782U);
  BOOST_TEST(all.counts.autocorrelations == 122U);
  BOOST_TEST(std::abs(set.observation().frequency_hz - 131e6) < 1e6);
}

BOOST_AUTO_TEST_CASE(vlba_has_two_windows_of_circular_feeds) {
  const Unpacked data("vlba_m87_mojave");
  if (!data.present()) return;
  const MeasurementSet set(data / "vlba_m87_mojave.ms", {}, "DATA");
  const AllSamples all = read_checked(set);
  BOOST_TEST(all.frequency_hz.size() == 2U);
  BOOST_TEST(all.counts.samples_read == 6300U);
  BOOST_TEST(set.observation().object == "1228+126");
  double longest = 0;
  for (std::size_t r = 0; r < 6300; ++r) longest = std::max(longest, std::hypot(all.uvw_m[3 * r], all.uvw_m[3 * r + 1]));
  BOOST_TEST(std::abs(longest - 8.6e6) < 0.1e6);
}

BOOST_AUTO_TEST_CASE(askap_has_four_descending_channels) {
  const Unpacked data("askap36_sim_4chan");
  if (!data.present()) return;
  const AllSamples all = read_checked(MeasurementSet(data / "askap36_sim_4chan.ms", {}, "DATA"));
  BOOST_TEST(all.counts.used == 90720U * 4U);
  BOOST_TEST(all.frequency_hz.size() == 4U);
  BOOST_TEST(all.frequency_hz[0] > all.frequency_hz[3]);
}

BOOST_AUTO_TEST_CASE(atca_leaves_its_unflagged_autocorrelations_out) {
  const Unpacked data("atca_sim_tileddata");
  if (!data.present()) return;
  const AllSamples all = read_checked(MeasurementSet(data / "atca_sim_tileddata.ms", {}, "CORRECTED_DATA"));
  BOOST_TEST(all.counts.samples_read == 8820U * 13U);
  BOOST_TEST(all.counts.autocorrelations > 0U);
}

BOOST_AUTO_TEST_CASE(a_bad_input_is_read_without_nans_or_named_with_its_fault) {
  const Unpacked data("bad_inputs");
  if (!data.present()) return;
  const std::map<std::string, std::string> faults = {
      {"askap_emu_1baseline", ""},
      {"mwa_allflag_zeroweight", ""},
      {"lwasv_inf_data", ""},
      {"paper_xy_only", "Stokes I cannot be formed from correlations XY; it needs XX and YY, RR and LL, or I"},
      {"ovro_missing_tsm_file", "cannot read DATA of "},
      {"wsrt_1d_descfreq", ""},
      {"lofar_bda_badframe", ""},
      {"alma_1baseline_varref_field", ""},
  };
  for (const auto& [name, fault] : faults) {
    BOOST_TEST_CONTEXT(name) {
      const std::string path = data / ("bad_inputs/" + name + ".ms");
      const std::string error = error_of([&] { read_checked(MeasurementSet(path, {}, "DATA")); });
      BOOST_TEST(error.empty() == fault.empty());
      BOOST_TEST(contains(error, fault));
      BOOST_TEST((error.empty() || contains(error, path)));
      BOOST_TEST(!contains(error, "\n"));
    }
  }
}

BOOST_AUTO_TEST_CASE(bad_inputs_are_described_as_far_as_they_go) {
  const Unpacked data("bad_inputs");
  if (!data.present()) return;
  const auto open = [&](const std::string& name) { return MeasurementSet(data / ("bad_inputs/" + name + ".ms"), {}, "DATA"); };
  BOOST_TEST(read_all(open("mwa_allflag_zeroweight")).counts.used == 0U);
  BOOST_TEST(open("lofar_bda_badframe").observation().spectral_frame.empty());
  BOOST_TEST(read_all(open("lofar_bda_badframe")).frequency_hz.size() == 3U + 4U + 1U + 8U);
  BOOST_TEST(open("alma_1baseline_varref_field").observation().object == "GAMA567624");
  BOOST_TEST(open("alma_1baseline_varref_field").observation().phase_centre.frame == "ICRS");
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
