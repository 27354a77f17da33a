#include <boost/test/unit_test.hpp>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "ms_io/model_writer.h"
#include "tests/ms_io/small_set.h"

namespace misfit::ms_io {

BOOST_AUTO_TEST_SUITE(model_subtraction)

using namespace testing;

namespace {

using casacore::Complex;

const ModelColumn corrected{"CORRECTED_DATA", "DATA"};

/// What the small set holds at (row, channel).
Complex data_at(std::size_t row, std::size_t channel) {
  return {static_cast<float>(row + 1), 1000 + static_cast<float>(channel)};
}

/// A model that depends on row and channel, with quarters, so that it and its difference from the data are exact in floats.
std::vector<std::complex<double>> quarters(const imager::SampleCoordinates& where) {
  std::vector<std::complex<double>> model = small_visibilities(where);
  for (std::complex<double>& value : model) value = {value.imag() / 4, value.real() / 4};
  return model;
}

Complex residual_at(std::size_t row, std::size_t channel) {
  const Complex data = data_at(row, channel);
  return data - Complex(data.imag() / 4, data.real() / 4);
}

ModelWriteReport subtract(const SmallSet& set, const Selection& selection = {}, const ModelColumn& column = corrected) {
  return write_model(set.path(), selection, column, quarters, {});
}

/// Every cell of the column is what `expected(row, channel)` says.
template <typename Expected>
void check_column(const SmallSet& set, const std::string& column, const Expected& expected) {
  for (std::size_t r = 0; r < rows; ++r) {
    const auto cell = set.cell(column, r);
    for (std::size_t c = 0; c < channels; ++c) {
      for (std::size_t k = 0; k < cell.nrow(); ++k) BOOST_TEST(cell(k, c) == expected(r, c));
    }
  }
}

bool has_column(const SmallSet& set, const std::string& column) {
  return casacore::MeasurementSet(set.path()).tableDesc().isColumn(column);
}

std::uint32_t bits(float x) {
  std::uint32_t result = 0;
  std::memcpy(&result, &x, sizeof x);
  return result;
}

bool same_bits(const Complex& a, const Complex& b) {
  return bits(a.real()) == bits(b.real()) && bits(a.imag()) == bits(b.imag());
}

}  // namespace

BOOST_AUTO_TEST_CASE(every_selected_sample_loses_the_model_whatever_its_flags_and_weights) {
  const SmallSet set;
  set.put("FLAG_ROW", 1, true);
  set.put("FLAG", 2, 0, 3, true);
  set.put("ANTENNA2", 3, 1);
  set.put("WEIGHT", 4, 0, 0, 0.0F);
  const ModelWriteReport report = subtract(set);
  BOOST_TEST(report.rows == rows);
  BOOST_TEST(report.samples == rows * channels);
  check_column(set, "CORRECTED_DATA", residual_at);
  check_column(set, "DATA", data_at);
}

BOOST_AUTO_TEST_CASE(data_that_are_the_model_leave_nothing) {
  const SmallSet set;
  write_model(set.path(), {}, corrected, small_visibilities, {}, {2 * channels});
  check_column(set, "CORRECTED_DATA", [](std::size_t, std::size_t) { return Complex(0); });
}

BOOST_AUTO_TEST_CASE(parallel_hands_lose_stokes_i_and_cross_hands_are_copied_bit_by_bit) {
  for (const std::vector<int>& types : std::vector<std::vector<int>>{{9, 10, 11, 12}, {5, 6, 7, 8}}) {
    const SmallSet set;
    set.store_correlations(types);
    const Complex odd{-0.0F, nan_float}, tiny{1e-42F, -infinite_float};
    set.put("DATA", 7, 1, 2, odd);
    set.put("DATA", 7, 2, 3, tiny);
    subtract(set);
    const auto cell = set.cell("CORRECTED_DATA", 7);
    BOOST_TEST(cell.nrow() == 4U);
    for (std::size_t c = 0; c < channels; ++c) {
      const Complex model = data_at(7, c) - residual_at(7, c);
      BOOST_TEST(cell(0, c) == Complex(1) - model);
      BOOST_TEST(same_bits(cell(1, c), c == 2 ? odd : Complex(2)));
      BOOST_TEST(same_bits(cell(2, c), c == 3 ? tiny : Complex(3)));
      BOOST_TEST(cell(3, c) == Complex(4) - model);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_new_column_holds_the_data_outside_the_selection) {
  for (const bool varying : {false, true}) {
    const SmallSet set;
    set.add_field(1.5, -0.25);
    if (varying) set.add_spectral_window();
    subtract(set, {"1", "0:1;3~4"});
    check_column(set, "CORRECTED_DATA", [&](std::size_t r, std::size_t c) {
      const bool selected = r % 2 == 1 && !(varying && r % 3 == 2) && (c == 1 || c == 3 || c == 4);
      return selected ? residual_at(r, c) : data_at(r, c) + Complex(0, 0);
    });
  }
}

BOOST_AUTO_TEST_CASE(an_existing_column_is_left_alone_outside_the_selection) {
  const SmallSet set;
  const auto sevens = [](const imager::SampleCoordinates& where) {
    return std::vector<std::complex<double>>(where.samples(), 7.0);
  };
  write_model(set.path(), {}, {"CORRECTED_DATA"}, sevens, {});
  subtract(set, {"", "0:0~4^2"});
  check_column(set, "CORRECTED_DATA", [](std::size_t r, std::size_t c) { return c % 2 == 0 && c < 5 ? residual_at(r, c) : 7; });
}

BOOST_AUTO_TEST_CASE(the_data_may_come_from_any_column_under_its_short_name_too) {
  const SmallSet set;
  write_model(set.path(), {}, {"CORRECTED_DATA"}, small_visibilities, {});
  set.put("DATA", 3, 0, 0, Complex(99));
  subtract(set, {}, {"RESIDUAL", "corrected"});
  check_column(set, "RESIDUAL", residual_at);
}

BOOST_AUTO_TEST_CASE(rows_with_a_nonfinite_uvw_keep_their_data_and_are_counted) {
  const SmallSet set;
  set.put("UVW", 5, 1, 0, nan_value);
  set.put("DATA", 6, 0, 1, Complex(nan_float, 1));
  const ModelWriteReport report = subtract(set);
  BOOST_TEST(report.nonfinite_uvw_rows == 1U);
  for (std::size_t c = 0; c < channels; ++c) BOOST_TEST(set.cell("CORRECTED_DATA", 5)(0, c) == data_at(5, c));
  BOOST_TEST(std::isnan(set.cell("CORRECTED_DATA", 6)(0, 1).real()));
  BOOST_TEST(set.cell("CORRECTED_DATA", 6)(1, 1) == residual_at(6, 1));
}

BOOST_AUTO_TEST_CASE(cells_without_a_shape_get_the_data_where_no_channel_is_selected) {
  const SmallSet set;
  set.modify([](casacore::MeasurementSet& ms) { ms.addColumn(casacore::ArrayColumnDesc<Complex>("MINE", 2)); });
  subtract(set, {"", "0:5"}, {"MINE", "DATA"});
  check_column(set, "MINE", [](std::size_t r, std::size_t c) { return c == 5 ? residual_at(r, c) : data_at(r, c); });
}

BOOST_AUTO_TEST_CASE(rows_without_data_are_an_error_only_where_they_are_selected) {
  const SmallSet set;
  set.modify([](casacore::MeasurementSet& ms) {
    ms.addColumn(casacore::ArrayColumnDesc<Complex>("MINE", 2));
    casacore::ArrayColumn<Complex> mine(ms, "MINE"), data(ms, "DATA");
    for (casacore::rownr_t r = 1; r < rows; r += 2) mine.put(r, data(r));
  });
  set.add_field(1.5, -0.25);
  subtract(set, {"1", ""}, {"RESIDUAL", "MINE"});
  check_column(set, "RESIDUAL", [](std::size_t r, std::size_t c) { return r % 2 == 1 ? residual_at(r, c) : Complex(0); });
  const std::string error = error_of([&] { subtract(set, {"0", ""}, {"RESIDUAL", "MINE"}); });
  BOOST_TEST(contains(error, "cannot read MINE of " + set.path() + ": row 0 has no data"));
}

BOOST_AUTO_TEST_CASE(a_run_cut_short_leaves_a_full_column_that_another_run_mends) {
  for (const int failing : {1, 2, 4}) {
    const SmallSet set;
    int calls = 0;
    const auto predict = [&](const imager::SampleCoordinates& where) {
      if (++calls == failing) throw std::runtime_error("no more");
      return quarters(where);
    };
    const std::size_t rows_at_once = 4;
    BOOST_CHECK_THROW(write_model(set.path(), {}, corrected, predict, {}, {rows_at_once * channels}), std::runtime_error);
    const std::size_t done = (static_cast<std::size_t>(failing) - 1) * rows_at_once;
    check_column(set, "DATA", data_at);
    check_column(set, "CORRECTED_DATA",
                 [&](std::size_t r, std::size_t c) { return r < done ? residual_at(r, c) : data_at(r, c); });
    subtract(set);
    check_column(set, "CORRECTED_DATA", residual_at);
  }
}

BOOST_AUTO_TEST_CASE(data_are_never_overwritten) {
  const SmallSet set;
  write_model(set.path(), {}, {"CORRECTED_DATA"}, small_visibilities, {});
  for (const ModelColumn& column :
       std::vector<ModelColumn>{{"DATA", "DATA"}, {"data", "corrected"}, {"", "DATA"}, {"FLAG", "DATA"}}) {
    BOOST_TEST(error_of([&] { subtract(set, {}, column); }) != "");
    BOOST_TEST(error_of([&] { require_writable(set.path(), column); }) != "");
  }
  check_column(set, "DATA", data_at);
  check_column(set, "CORRECTED_DATA", data_at);
}

BOOST_AUTO_TEST_CASE(a_column_that_must_be_new_is_not_overwritten) {
  const SmallSet set;
  subtract(set, {}, {"corrected", "data", false});
  const ModelColumn again{"corrected", "data", false};
  BOOST_TEST(contains(error_of([&] { subtract(set, {}, again); }), "CORRECTED_DATA already"));
  BOOST_TEST(contains(error_of([&] { require_writable(set.path(), again); }), "CORRECTED_DATA already"));
  require_writable(set.path(), corrected);
}

BOOST_AUTO_TEST_CASE(data_that_are_missing_or_real_create_no_column) {
  const SmallSet set;
  BOOST_TEST(contains(error_of([&] { subtract(set, {}, {"RESIDUAL", "MODEL_DATA"}); }), "visibilities: DATA"));
  set.modify([](casacore::MeasurementSet& ms) {
    ms.removeColumn("DATA");
    ms.addColumn(casacore::ArrayColumnDesc<float>("FLOAT_DATA", 2));
  });
  for (const std::string data : {"DATA", "FLOAT_DATA"}) {
    const std::string error = error_of([&] { subtract(set, {}, {"RESIDUAL", data}); });
    BOOST_TEST(contains(error, "no visibilities in a column '" + data + "'"));
    BOOST_TEST(contains(error, "FLOAT_DATA holds real numbers"));
  }
  BOOST_TEST(!has_column(set, "RESIDUAL"));
}

BOOST_AUTO_TEST_CASE(a_column_that_cannot_be_filled_is_not_left_behind) {
  const SmallSet set;
  set.modify([](casacore::MeasurementSet& ms) {
    ms.addColumn(casacore::ArrayColumnDesc<Complex>("MINE", 2));
    casacore::ArrayColumn<Complex> mine(ms, "MINE");
    for (casacore::rownr_t r = 0; r < rows; ++r) mine.put(r, casacore::Matrix<Complex>(2, channels + (r == 20), Complex(1)));
  });
  BOOST_TEST(contains(error_of([&] { subtract(set, {}, {"RESIDUAL", "MINE"}); }), "row 20 of MINE has the shape"));
  BOOST_TEST(!has_column(set, "RESIDUAL"));
  check_column(set, "DATA", data_at);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
