#include <boost/test/unit_test.hpp>
#include <set>

#include "ms_io/filled_data_internal.h"
#include "ms_io/model_writer.h"
#include "tests/ms_io/small_set.h"

namespace misfit::ms_io {

BOOST_AUTO_TEST_SUITE(filled_data)

using namespace testing;

namespace {

using casacore::Complex;
using Key = std::pair<int, int>;  ///< of a window and a field

/// Two fields and two windows, with rows of each field in each window.
struct Fields : SmallSet {
  Fields() {
    add_field(1.25, -0.5);
    add_spectral_window();
  }

  Key key(std::size_t row) const { return {cell_of("DATA_DESC_ID", row), cell_of("FIELD_ID", row)}; }

  /// Leaves zeros where `zero` holds of a row.
  void clear(const std::function<bool(std::size_t)>& zero) const {
    modify([&](casacore::MeasurementSet& ms) {
      casacore::ArrayColumn<Complex> data(ms, "DATA");
      for (casacore::rownr_t row = 0; row < ms.nrow(); ++row)
        if (zero(row)) data.put(row, casacore::Array<Complex>(data.shape(row), Complex(0)));
    });
  }
  int cell_of(const std::string& column, std::size_t row) const {
    const casacore::MeasurementSet set(path());
    return casacore::ScalarColumn<int>(set, column)(row);
  }
};

/// What a part says of each window and field that it stands for.
std::set<Key> meant(const Zeros& zeros, const std::set<Key>& all) {
  std::set<Key> keys;
  for (const SelectionPart& part : zeros.parts)
    for (const Key& key : all)
      if ((part.window == SelectionPart::all || part.window == key.first) &&
          (part.field == SelectionPart::all || part.field == key.second))
        keys.insert(key);
  return zeros.everywhere ? all : keys;
}

Zeros zeros_of(const MeasurementSet& set) {
  const auto stream = set.open();
  while (stream->next()) {
  }
  const auto columns = set.columns_of_zeros(imager::alone());
  return columns.empty() ? Zeros() : columns.front().zeros;
}

}  // namespace

BOOST_AUTO_TEST_CASE(zeros_are_told_of_by_whole_windows_and_fields_with_their_rows_in_blocks_of_any_size) {
  const std::set<Key> all{{0, 0}, {0, 1}, {1, 0}, {1, 1}};
  const Fields whole;
  std::map<Key, std::uint64_t> rows_of;
  for (std::size_t row = 0; row < rows; ++row) ++rows_of[whole.key(row)];
  BOOST_REQUIRE(rows_of.size() == all.size());
  for (unsigned choice = 0; choice < 16; ++choice) {
    std::set<Key> zero;
    for (const Key& key : all)
      if ((choice >> (2 * key.first + key.second) & 1U) != 0) zero.insert(key);
    const Fields set;
    set.clear([&](std::size_t row) { return zero.count(set.key(row)) > 0; });
    for (const std::uint64_t samples : {std::uint64_t{6}, MeasurementSet::usual_block_samples})
      for (const bool shifted : {false, true}) {
        Selection selection;
        if (shifted) selection.phase_centre = imager::SkyDirection{1.25, -0.5, "FK5"};
        const Zeros zeros = zeros_of(MeasurementSet(set.path(), selection, "DATA", {imager::Stokes::I}, samples));
        BOOST_TEST_CONTEXT("choice " << choice) {
          BOOST_TEST((meant(zeros, all) == zero));
          BOOST_TEST(zeros.everywhere == (zero.size() == 4));
          const bool crossed =
              zero.size() == 2 && zero.begin()->first != zero.rbegin()->first && zero.begin()->second != zero.rbegin()->second;
          // Two of one window or field are one part, and so is a field of which the other window was told already.
          const std::size_t expected_parts = zero.size() == 4 ? 0 : zero.size() == 3 || crossed ? 2 : zero.empty() ? 0 : 1;
          BOOST_TEST(zeros.parts.size() == expected_parts);
          std::uint64_t told = 0, expected = 0;
          for (const SelectionPart& part : zeros.parts) told += part.rows;
          for (const Key& key : zero) expected += rows_of[key];
          if (!zeros.everywhere && zero.size() != 3) BOOST_TEST(told == expected);  // of three, one is in two parts
        }
      }
  }
}

BOOST_AUTO_TEST_CASE(a_window_is_filled_by_one_value_of_what_is_selected_and_flagged_rows_tell_nothing) {
  const Fields set;
  std::size_t last = 0;
  for (std::size_t row = 0; row < rows; ++row)
    if (set.key(row).first == 1) last = row;
  set.clear([&](std::size_t row) { return set.key(row).first == 1; });
  BOOST_TEST(zeros_of(MeasurementSet(set.path(), {}, "DATA")).parts.size() == 1U);
  BOOST_TEST(zeros_of(MeasurementSet(set.path(), {"", "0"}, "DATA")).none());
  BOOST_TEST(zeros_of(MeasurementSet(set.path(), {"", "1"}, "DATA")).everywhere);
  set.modify([&](casacore::MeasurementSet& ms) {
    casacore::ArrayColumn<Complex> data(ms, "DATA");
    casacore::Array<Complex> one(data.shape(last), Complex(0));
    *one.begin() = Complex(0, 1e-30F);
    data.put(last, one);
  });
  const Zeros one_field = zeros_of(MeasurementSet(set.path(), {}, "DATA"));
  BOOST_REQUIRE(one_field.parts.size() == 1U);
  BOOST_TEST(one_field.parts.front().window == 1);
  BOOST_TEST(one_field.parts.front().field == 1 - set.key(last).second);
  BOOST_TEST(zeros_of(MeasurementSet(set.path(), {"", "*:1~2"}, "DATA")).parts.front().field == SelectionPart::all);
  set.modify([&](casacore::MeasurementSet& ms) {
    for (casacore::rownr_t row = 0; row < ms.nrow(); ++row)
      if (set.key(row).first == 1) casacore::ScalarColumn<bool>(ms, "FLAG_ROW").put(row, true);
  });
  BOOST_TEST(zeros_of(MeasurementSet(set.path(), {}, "DATA")).none());
}

BOOST_AUTO_TEST_CASE(a_subtraction_from_windows_that_were_never_filled_is_told_of) {
  const Fields set;
  set.clear([&](std::size_t row) { return set.key(row).first == 1; });
  const Predict nothing = [](const imager::SampleCoordinates& at) {
    return StokesVisibilities(std::vector<std::complex<double>>(at.samples()));
  };
  const ModelWriteReport report = write_model(set.path(), {}, {"CORRECTED_DATA", "DATA"}, nothing, {});
  BOOST_TEST(report.zeros.name == "DATA");
  BOOST_REQUIRE(report.zeros.zeros.parts.size() == 1U);
  BOOST_TEST(report.zeros.zeros.parts.front().window == 1);
  BOOST_TEST(write_model(set.path(), {}, {"MODEL_DATA"}, nothing, {}).zeros.zeros.none());
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
