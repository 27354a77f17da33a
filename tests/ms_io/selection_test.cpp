// What is selected, against queries of the same meaning in casacore's table query language.
#include <casacore/tables/TaQL/TableParse.h>

#include <algorithm>
#include <boost/test/unit_test.hpp>

#include "ms_io/model_writer.h"
#include "tests/ms_io/small_set.h"

namespace misfit::ms_io {

BOOST_AUTO_TEST_SUITE(selection)

using namespace testing;
using misfit::testing::Unpacked;

namespace {

/// Two fields and two windows, a scan and an intent for each integration, and two observations.
class ManySet : public SmallSet {
 public:
  ManySet() {
    add_field(1.25, -0.5);
    add_spectral_window();
    modify([](casacore::MeasurementSet& set) {
      casacore::MSFieldColumns(set.field()).name().put(0, "3C 295");
      casacore::MSStateColumns states(set.state());
      set.state().addRow(integrations - set.state().nrow());
      casacore::ScalarColumn<int> scan(set, "SCAN_NUMBER"), state(set, "STATE_ID"), observation(set, "OBSERVATION_ID");
      for (std::size_t t = 0; t < integrations; ++t) {
        states.obsMode().put(t, t % 2 == 0 ? "CALIBRATE_PHASE#ON_SOURCE" : "OBSERVE_TARGET#ON_SOURCE");
        for (std::size_t r = t * baselines; r < (t + 1) * baselines; ++r) {
          scan.put(r, static_cast<int>(10 + t));
          state.put(r, static_cast<int>(t));
          observation.put(r, t < 3 ? 0 : 1);
        }
      }
      set.observation().addRow(1);
    });
  }
};

/// Every row has a u of its own; see small_uvw().
std::vector<std::size_t> rows_read(const std::string& path, const Selection& selection) {
  std::vector<std::size_t> numbers;
  const AllSamples all = read_all(MeasurementSet(path, selection, "DATA"));
  for (std::size_t i = 0; i < all.uvw_m.size(); i += 3) numbers.push_back(static_cast<std::size_t>(all.uvw_m[i]) - 1);
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

std::vector<std::size_t> rows_queried(const std::string& path, const std::string& where) {
  const casacore::Table found = casacore::tableCommand("select from '" + path + "' where " + where).table();
  const auto numbers = found.rowNumbers().tovector();
  return {numbers.begin(), numbers.end()};
}

struct Law {
  Selection selection;
  std::string query;
};

Selection one(PerSet Selection::*expression, const std::string& value) {
  Selection selection;
  selection.*expression = value;
  return selection;
}

void check(const SmallSet& set, const std::vector<Law>& laws) {
  for (const Law& law : laws) {
    BOOST_TEST_CONTEXT(to_text(law.selection)) {
      const std::vector<std::size_t> expected = rows_queried(set.path(), law.query);
      BOOST_TEST(!expected.empty());
      BOOST_TEST(expected.size() < rows);
      BOOST_TEST(rows_read(set.path(), law.selection) == expected, boost::test_tools::per_element());
    }
  }
}

std::string error_of_selection(const SmallSet& set, const Selection& selection) {
  return error_of([&] { MeasurementSet(set.path(), selection, "DATA"); });
}

}  // namespace

BOOST_AUTO_TEST_CASE(fields_scans_intents_and_observations_are_those_of_a_query) {
  check(ManySet(), {{one(&Selection::field, "3C 295"), "FIELD_ID == 0"},
                    {one(&Selection::field, "3C*"), "FIELD_ID == 0"},
                    {one(&Selection::field, ">0"), "FIELD_ID == 1"},
                    {one(&Selection::scan, "11"), "SCAN_NUMBER == 11"},
                    {one(&Selection::scan, "10,12~13"), "SCAN_NUMBER in [10,12,13]"},
                    {one(&Selection::scan, ">12"), "SCAN_NUMBER > 12"},
                    {one(&Selection::intent, "*TARGET*"), "STATE_ID in [1,3]"},
                    {one(&Selection::intent, "CALIBRATE_PHASE*"), "STATE_ID in [0,2,4]"},
                    {one(&Selection::observation, "1"), "OBSERVATION_ID == 1"}});
}

// Off the samples' own times: MSSelection takes the ends of a range through days, which rounds them to a microsecond.
BOOST_AUTO_TEST_CASE(times_are_those_of_a_query) {
  check(
      ManySet(),
      {{one(&Selection::time_range, "2014/02/24/23:06:45~2014/02/24/23:07:05"), "TIME between 4.900000005e9 and 4.900000025e9"},
       {one(&Selection::time_range, "2014/02/24/23:06:45.25~23:07:05"), "TIME between 4.90000000525e9 and 4.900000025e9"},
       {one(&Selection::time_range, "23:06:45~23:06:55,>23:07:15"),
        "TIME between 4.900000005e9 and 4.900000015e9 or TIME > 4.900000035e9"},
       {one(&Selection::time_range, "<23:06:55"), "TIME < 4.900000015e9"},
       {one(&Selection::time_range, "23:07:01"), "abs(TIME - 4.900000021e9) <= 5"}});
}

BOOST_AUTO_TEST_CASE(distances_in_wavelengths_are_at_the_reference_frequency_of_each_window) {
  const std::string metres = "sqrt(square(UVW[1]) + square(UVW[2]))";
  const std::string wavelengths = metres + " / 299792458. * iif(DATA_DESC_ID == 0, 1e9, 2e9)";
  check(ManySet(), {{one(&Selection::uv_range, "10~25m"), metres + " between 10 and 25"},
                    {one(&Selection::uv_range, "<25m"), metres + " <= 25"},
                    {one(&Selection::uv_range, ">20"), metres + " > 20"},
                    {one(&Selection::uv_range, "0.01~0.02km"), metres + " between 10 and 20"},
                    {one(&Selection::uv_range, "<12m,>0.03km"), metres + " <= 12 or " + metres + " > 30"},
                    {one(&Selection::uv_range, "50~100lambda"), wavelengths + " between 50 and 100"},
                    {one(&Selection::uv_range, ">0.1klambda"), wavelengths + " > 100"},
                    {one(&Selection::uv_range, "<1e-4Mlambda"), wavelengths + " <= 100"}});
}

BOOST_AUTO_TEST_CASE(rows_without_a_distance_are_counted_as_not_finite_and_a_model_is_not_written_there) {
  const SmallSet set;
  set.put("UVW", 1, 0, 0, nan_value);
  set.put("UVW", 2, 1, 0, -std::numeric_limits<double>::infinity());
  set.put("UVW", 4, 0, 0, nan_value);
  set.put("ANTENNA2", 4, 1);  // of A1 and A1
  const Selection far = one(&Selection::uv_range, ">25m");
  const std::size_t selected = rows_queried(set.path(), "sqrt(sum(square(UVW[1:2]))) between 25 and 1e9").size();
  const AllSamples read = read_all(MeasurementSet(set.path(), far, "DATA"));
  BOOST_TEST(read.counts.used == selected * channels);
  BOOST_TEST(read.counts.nonfinite == 2U * channels);
  BOOST_TEST(read.counts.autocorrelations == channels);
  const ModelWriteReport report = write_model(set.path(), far, {}, small_visibilities, {});
  BOOST_TEST(report.rows == selected);
  BOOST_TEST(report.nonfinite_uvw_rows == 0U);
}

BOOST_AUTO_TEST_CASE(distances_in_wavelengths_need_a_reference_frequency_and_others_do_not) {
  for (const double wrong : {0.0, nan_value, -1e9}) {
    const SmallSet set;
    set.modify(
        [&](casacore::MeasurementSet& ms) { casacore::MSSpWindowColumns(ms.spectralWindow()).refFrequency().put(0, wrong); });
    const std::string error = error_of_selection(set, one(&Selection::uv_range, "<25m,>0.1klambda"));
    BOOST_TEST(contains(error, set.path() + ": spectral window 0 has REF_FREQUENCY " + (wrong == 0 ? "0 Hz" : "")));
    BOOST_TEST(contains(error, "--uvrange"));
    BOOST_TEST(!rows_read(set.path(), one(&Selection::uv_range, "<25m")).empty());
  }
}

BOOST_AUTO_TEST_CASE(antennas_and_baselines_are_those_of_a_query) {
  check(ManySet(),
        {{one(&Selection::antenna, "A0"), "ANTENNA1 == 0 or ANTENNA2 == 0"},
         {one(&Selection::antenna, "1"), "ANTENNA1 == 1 or ANTENNA2 == 1"},
         {one(&Selection::antenna, "A1&A2"), "ANTENNA1 == 1 and ANTENNA2 == 2"},
         {one(&Selection::antenna, "A0&A1;2&3"), "ANTENNA1 == 0 and ANTENNA2 == 1 or ANTENNA1 == 2 and ANTENNA2 == 3"},
         {one(&Selection::antenna, "0~1&"), "ANTENNA1 == 0 and ANTENNA2 == 1"},
         {one(&Selection::antenna, "!A0"), "not (ANTENNA1 == 0 or ANTENNA2 == 0)"}});
}

BOOST_AUTO_TEST_CASE(a_sample_is_in_all_that_is_given) {
  Selection all;
  all.field = "OTHER";
  all.spectral_window = "SECOND:1~3";
  all.antenna = "!A1";
  all.uv_range = "<25m";
  const std::string query =
      "FIELD_ID == 1 and DATA_DESC_ID == 1 and ANTENNA1 != 1 and ANTENNA2 != 1 and sqrt(sum(square(UVW[1:2]))) <= 25";
  const ManySet set;
  check(set, {{all, query}});
  const AllSamples read = read_all(MeasurementSet(set.path(), all, "DATA"));
  BOOST_TEST(read.visibility.size() == 3 * rows_queried(set.path(), query).size());
  for (std::size_t i = 0; i < read.visibility.size(); ++i)
    BOOST_TEST(read.visibility[i].imag() == 1001 + static_cast<float>(i % 3));
}

BOOST_AUTO_TEST_CASE(a_time_without_a_date_has_that_of_the_first_row_that_the_rest_selects) {
  const SmallSet set;
  set.add_field(1.25, -0.5);
  for (std::size_t r = 1; r < rows; r += 2) set.put("TIME", r, 4.9e9 + 86400 + 10.0 * static_cast<double>(r / baselines));
  Selection late = one(&Selection::time_range, ">23:07:15");
  late.field = "1";
  check(set, {{late, "FIELD_ID == 1 and TIME > 4.900086435e9"}});
}

BOOST_AUTO_TEST_CASE(a_range_of_channels_ends_with_its_window_and_may_not_begin_beyond_it) {
  const ManySet set;
  BOOST_TEST(MeasurementSet(set.path(), {"", "0:4~99"}, "DATA").samples() == 2U * 20);
  for (const char* const beyond : {"0:6", "0:6~9", "*:2;17", "1:0,0:99", "0:7~9^2", "0~1: 8"}) {
    const std::string error = error_of_selection(set, {"", beyond});
    BOOST_TEST(contains(error, "beyond the 6 channels of spectral window"), beyond);
    BOOST_TEST(contains(error, "--spw '" + std::string(beyond) + "'"));
  }
}

BOOST_AUTO_TEST_CASE(ranges_of_frequency_are_the_same_where_channels_descend) {
  SimulatedObservation descending = small_observation();
  std::reverse(descending.frequency_hz.begin(), descending.frequency_hz.end());
  descending.channel_width_hz = -1e6;
  const SmallSet up, down(descending);
  for (const char* const range : {"0:1001.5~1003.5MHz", "0:0.9~1.0015GHz", "*:1003.5~2000MHz"}) {
    std::vector<double> of_up = read_all(MeasurementSet(up.path(), {"", range}, "DATA")).frequency_hz;
    const std::vector<double> of_down = read_all(MeasurementSet(down.path(), {"", range}, "DATA")).frequency_hz;
    std::reverse(of_up.begin(), of_up.end());
    BOOST_TEST(of_up.size() == 2U);
    BOOST_TEST(of_up == of_down, boost::test_tools::per_element());
  }
}

BOOST_AUTO_TEST_CASE(what_selects_nothing_is_one_line_that_names_what_was_given) {
  const ManySet set;
  const std::vector<std::pair<PerSet Selection::*, std::string>> wrong = {
      {&Selection::field, "NOBODY"},         {&Selection::spectral_window, "7"},
      {&Selection::time_range, "yesterday"}, {&Selection::time_range, "2014/25/25"},
      {&Selection::uv_range, "500m"},        {&Selection::uv_range, "0~5parsec"},
      {&Selection::uv_range, "0~~5m"},       {&Selection::antenna, "Z9"},
      {&Selection::antenna, "&&&&"},         {&Selection::scan, "99"},
      {&Selection::scan, "first"},           {&Selection::intent, "*SLEEP*"},
      {&Selection::observation, "5"},        {&Selection::observation, "x"}};
  for (const auto& [kind, expression] : wrong) {
    BOOST_TEST_CONTEXT(expression) {
      const std::string error = error_of_selection(set, one(kind, expression));
      BOOST_TEST_MESSAGE(error);
      BOOST_TEST(contains(error, set.path() + ": --"));
      BOOST_TEST(contains(error, "'" + expression + "'"));
      BOOST_TEST(!contains(error, "\n"));
    }
  }
  Selection apart = one(&Selection::scan, "10");
  apart.time_range = ">23:07:15";
  BOOST_TEST(contains(error_of_selection(set, apart), "--timerange '>23:07:15' --scan '10' selects none of its 30 rows"));
}

BOOST_AUTO_TEST_CASE(what_a_set_does_not_have_is_answered_with_what_it_has) {
  const ManySet set;
  const std::vector<std::pair<Selection, std::string>> missing = {
      {one(&Selection::field, "3~1"), "--field '3~1' selects nothing: "},
      {one(&Selection::antenna, "3~1"), "--antenna '3~1' selects nothing: "},
      {one(&Selection::field, "3C294"), "--field '3C294': the set has no such field; expected some of 0 '3C 295', 1 'OTHER'"},
      {one(&Selection::spectral_window, "7"),
       "--spw '7': the set has no such spectral window; expected some of 0 (1 to 1.005 GHz, 6 channels), 1 (2 to 2.005 GHz, "
       "6 channels)"},
      {one(&Selection::antenna, "Z9"),
       "--antenna 'Z9': the set has no such antenna; expected some of 0 'A0', 1 'A1', 2 'A2', 3 'A3'"},
      {one(&Selection::intent, "*SLEEP*"),
       "the set has no such intent; expected some of 'CALIBRATE_PHASE#ON_SOURCE', 'OBSERVE_TARGET#ON_SOURCE'"},
      {one(&Selection::scan, "99"), "at least one; the set has scans 10, 11, 12, 13, 14"},
      {one(&Selection::observation, "5"), "at least one; the set has observations 0, 1"},
      {one(&Selection::time_range, ">2020/01/01"), "at least one; the set has times 2014/02/24/23:06:40~2014/02/24/23:07:20"}};
  for (const auto& [selection, expected] : missing) {
    const std::string error = error_of_selection(set, selection);
    BOOST_TEST(contains(error, expected), error);
  }
  // An expression that casacore cannot parse is refused with the forms that it may have.
  BOOST_TEST(contains(error_of_selection(set, one(&Selection::field, "3~")), "expected fields by id, name or pattern"));
}

BOOST_AUTO_TEST_CASE(of_many_things_in_a_set_ten_are_listed_and_of_none_it_is_said) {
  const SmallSet set;
  set.modify([](casacore::MeasurementSet& ms) {
    ms.antenna().addRow(8);
    for (casacore::rownr_t id = 4; id < 12; ++id) casacore::MSAntennaColumns(ms.antenna()).name().put(id, "B");
  });
  BOOST_TEST(contains(error_of_selection(set, one(&Selection::antenna, "Z9")), ", 9 'B' and 2 more"));
}

BOOST_AUTO_TEST_CASE(of_real_sets_the_samples_are_those_of_a_query) {
  struct RealLaws {
    std::string set, column;
    std::vector<Law> laws;
  };
  const std::string metres = "sqrt(square(UVW[1]) + square(UVW[2]))", wavelengths = metres + " / 299792458. * ";
  const std::vector<RealLaws> all = {
      {"alma_hd142527_b9",
       "DATA",
       {{one(&Selection::field, "HD 142527"), "True"},
        {one(&Selection::spectral_window, "*:692~695GHz"), "DATA_DESC_ID == 1"},
        {one(&Selection::scan, "1~2"), "SCAN_NUMBER in [1,2]"},
        {one(&Selection::uv_range, "100~400klambda"),
         wavelengths +
             "iif(DATA_DESC_ID == 0, 708889018e3, iif(DATA_DESC_ID == 1, 693874370e3, 691457370e3)) between 1e5 and 4e5"}}},
      {"lofar_3c295_snapshot",
       "CORRECTED_DATA",
       {{one(&Selection::antenna, "CS001HBA0"), "(ANTENNA1 == 0 or ANTENNA2 == 0) and ANTENNA1 != ANTENNA2"},
        {one(&Selection::antenna, "CS001HBA0&CS002HBA*"), "ANTENNA1 == 0 and ANTENNA2 in [2,3]"},
        {one(&Selection::uv_range, "<5klambda"), wavelengths + "130664062.5 <= 5000"}}},
      {"vlba_m87_mojave",
       "DATA",
       {{one(&Selection::scan, "3,>5"), "SCAN_NUMBER == 3 or SCAN_NUMBER > 5"},
        {one(&Selection::time_range, ">2006/06/16/01:00:00"), "TIME > 4657136400"},
        {one(&Selection::uv_range, "1000~2000km"), metres + " between 1e6 and 2e6"}}},
      {"askap36_sim_4chan", "DATA", {{one(&Selection::uv_range, "0.5~1km"), metres + " between 500 and 1000"}}},
      {"atca_sim_tileddata",
       "CORRECTED_DATA",
       {{one(&Selection::antenna, "ATCA2&ATCA3"), "ANTENNA1 == 1 and ANTENNA2 == 2"},
        {one(&Selection::antenna, "ATCA1&&&"), "ANTENNA1 == 0 and ANTENNA2 == 0"}}}};
  for (const auto& [name, column, laws] : all) {
    const Unpacked data(name);
    if (!data.present()) return;
    const std::string path = data / (name + ".ms");
    for (const Law& law : laws) {
      BOOST_TEST_CONTEXT(name << " " << to_text(law.selection)) {
        const std::string queried = data / "queried.ms";
        casacore::tableCommand("select from '" + path + "' where " + law.query + " giving '" + queried + "'");
        const AllSamples is = read_all(MeasurementSet(path, law.selection, column));
        const AllSamples should = read_all(MeasurementSet(queried, {}, column));
        BOOST_TEST(is.counts.rows_read > 0U);
        BOOST_TEST(is.counts.used == should.counts.used);
        BOOST_TEST((is.uvw_m == should.uvw_m));
        BOOST_TEST((is.visibility == should.visibility));
        BOOST_TEST((is.weight == should.weight));
      }
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
