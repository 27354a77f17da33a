#include "ms_io/model_writer.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "tests/ms_io/small_set.h"

namespace misfit::ms_io {

BOOST_AUTO_TEST_SUITE(model_writer)

using namespace testing;

namespace {

/// What the small set holds at (row, channel): the function the writer is given too.
casacore::Complex expected_at(std::size_t row, std::size_t channel) {
  return {static_cast<float>(row + 1), 1000 + static_cast<float>(channel)};
}

ModelWriteReport write(const SmallSet& set, const Selection& selection, const std::string& column) {
  return write_model(set.path(), selection, {column}, small_visibilities, {});
}

}  // namespace

BOOST_AUTO_TEST_CASE(every_selected_sample_is_written_whatever_its_flags_and_weights) {
  const SmallSet set;
  set.put("FLAG_ROW", 1, true);
  set.put("FLAG", 2, 0, 3, true);
  set.put("ANTENNA2", 3, 1);
  set.put("WEIGHT", 4, 0, 0, 0.0F);
  const ModelWriteReport report = write(set, {}, "model");
  BOOST_TEST(report.rows == rows);
  BOOST_TEST(report.samples == rows * channels);
  BOOST_TEST(report.nonfinite_uvw_rows == 0U);
  for (std::size_t r = 0; r < rows; ++r) {
    const auto cell = set.cell("MODEL_DATA", r);
    for (std::size_t c = 0; c < channels; ++c) {
      BOOST_TEST(cell(0, c) == expected_at(r, c));
      BOOST_TEST(cell(1, c) == expected_at(r, c));
    }
  }
}

BOOST_AUTO_TEST_CASE(a_new_column_is_zero_outside_the_selection) {
  const SmallSet set;
  set.add_field(1.5, -0.25);
  write(set, {"1", "0:1;3~4"}, "MODEL_DATA");
  for (std::size_t r = 0; r < rows; ++r) {
    const auto cell = set.cell("MODEL_DATA", r);
    for (std::size_t c = 0; c < channels; ++c) {
      const bool selected = r % 2 == 1 && (c == 1 || c == 3 || c == 4);
      BOOST_TEST(cell(0, c) == (selected ? expected_at(r, c) : casacore::Complex(0)));
    }
  }
}

BOOST_AUTO_TEST_CASE(an_existing_column_is_left_alone_outside_the_selection) {
  const SmallSet set;
  set.add_spectral_window();
  write(set, {}, "MODEL_DATA");
  const auto minus = [](const imager::SampleCoordinates& where) {
    return std::vector<std::complex<double>>(where.samples(), -1.0);
  };
  write_model(set.path(), {"", "1:0~4^2"}, {"MODEL_DATA"}, minus, {});
  for (std::size_t r = 0; r < rows; ++r) {
    const auto cell = set.cell("MODEL_DATA", r);
    for (std::size_t c = 0; c < channels; ++c) {
      const bool selected = r % 3 == 2 && c % 2 == 0;
      const bool second_window = r % 3 == 2;  // its frequencies, and so its visibilities, are higher
      const auto before = expected_at(r, c) + casacore::Complex(0, second_window ? 1000 : 0);
      BOOST_TEST(cell(1, c) == (selected ? casacore::Complex(-1) : before));
    }
  }
}

BOOST_AUTO_TEST_CASE(cross_hands_get_zero) {
  for (const std::vector<int>& types : std::vector<std::vector<int>>{{9, 10, 11, 12}, {5, 6, 7, 8}}) {
    const SmallSet set;
    set.store_correlations(types);
    write(set, {}, "MODEL_DATA");
    const auto cell = set.cell("MODEL_DATA", 7);
    BOOST_TEST(cell.nrow() == 4U);
    for (std::size_t c = 0; c < channels; ++c) {
      BOOST_TEST(cell(0, c) == expected_at(7, c));
      BOOST_TEST(cell(1, c) == casacore::Complex(0));
      BOOST_TEST(cell(2, c) == casacore::Complex(0));
      BOOST_TEST(cell(3, c) == expected_at(7, c));
    }
  }
}

BOOST_AUTO_TEST_CASE(a_new_column_has_the_storage_of_data) {
  const auto storage = [](const SmallSet& set, const std::string& column) {
    const casacore::MeasurementSet ms(set.path());
    return std::string(casacore::TableColumn(ms, column).columnDesc().dataManagerType());
  };
  const SmallSet fixed;
  write(fixed, {}, "MODEL_DATA");
  BOOST_TEST(storage(fixed, "MODEL_DATA") == "TiledColumnStMan");
  const SmallSet varying;
  varying.store_correlations({9, 12});
  write(varying, {}, "MODEL_DATA");
  BOOST_TEST(storage(varying, "MODEL_DATA") == "TiledShapeStMan");
}

BOOST_AUTO_TEST_CASE(cells_without_a_shape_are_given_one) {
  const SmallSet set;
  set.modify([](casacore::MeasurementSet& ms) { ms.addColumn(casacore::ArrayColumnDesc<casacore::Complex>("MINE", 2)); });
  write(set, {"", "0:5"}, "MINE");
  const auto cell = set.cell("MINE", 4);
  BOOST_TEST(cell(0, 4) == casacore::Complex(0));
  BOOST_TEST(cell(0, 5) == expected_at(4, 5));
}

BOOST_AUTO_TEST_CASE(rows_with_a_nonfinite_uvw_get_zero_and_are_counted) {
  const SmallSet set;
  set.put("UVW", 5, 1, 0, nan_value);
  bool finite = true;
  const auto check_finite = [&](const imager::SampleCoordinates& where) {
    for (const double x : where.uvw_m) finite = finite && std::isfinite(x);
    return std::vector<std::complex<double>>(where.samples(), 1.0);
  };
  const ModelWriteReport report = write_model(set.path(), {}, {"MODEL_DATA"}, check_finite, {});
  BOOST_TEST(finite);
  BOOST_TEST(report.nonfinite_uvw_rows == 1U);
  BOOST_TEST(set.cell("MODEL_DATA", 5)(0, 0) == casacore::Complex(0));
  BOOST_TEST(set.cell("MODEL_DATA", 6)(0, 0) == casacore::Complex(1));
}

BOOST_AUTO_TEST_CASE(a_prediction_that_fails_ends_the_writing_at_once) {
  for (const int failing : {1, 2, 3}) {
    const SmallSet set;
    int calls = 0;
    const auto predict = [&](const imager::SampleCoordinates& where) {
      if (++calls == failing) throw std::runtime_error("no more");
      return std::vector<std::complex<double>>(where.samples(), 1.0);
    };
    BOOST_CHECK_THROW(write_model(set.path(), {}, {"MODEL_DATA"}, predict, {}, {channels}), std::runtime_error);
    BOOST_TEST(calls == failing);
  }
}

BOOST_AUTO_TEST_CASE(progress_grows_to_the_total) {
  const SmallSet set;
  set.add_spectral_window();
  std::uint64_t last = 0, end = 0;
  write_model(set.path(), {}, {"MODEL_DATA"}, small_visibilities, [&](std::uint64_t done, std::uint64_t total) {
    BOOST_TEST(done > last);
    last = done;
    end = total;
  });
  BOOST_TEST(last == rows * channels);
  BOOST_TEST(end == rows * channels);
}

BOOST_AUTO_TEST_CASE(data_and_columns_without_visibilities_are_never_overwritten) {
  const SmallSet set;
  for (const std::string column : {"DATA", "data", "", "FLAG", "UVW", "TIME"}) {
    BOOST_CHECK_THROW(write(set, {}, column), std::runtime_error);
  }
  BOOST_TEST(set.cell("DATA", 3)(0, 2) == expected_at(3, 2));
}

BOOST_AUTO_TEST_CASE(a_refused_write_creates_no_column) {
  const SmallSet set;
  set.add_field(1.5, -0.25);  // two phase centres
  BOOST_CHECK_THROW(write(set, {}, "MODEL_DATA"), std::runtime_error);
  BOOST_CHECK_THROW(write(set, {"NOBODY", ""}, "MODEL_DATA"), std::runtime_error);
  BOOST_TEST(!casacore::MeasurementSet(set.path()).tableDesc().isColumn("MODEL_DATA"));
}

BOOST_AUTO_TEST_CASE(a_prediction_of_the_wrong_size_is_refused) {
  const SmallSet set;
  const auto one = [](const imager::SampleCoordinates&) { return std::vector<std::complex<double>>(1); };
  BOOST_CHECK_THROW(write_model(set.path(), {}, {"MODEL_DATA"}, one, {}), std::invalid_argument);
}

BOOST_AUTO_TEST_CASE(a_read_only_set_is_named) {
  if (geteuid() == 0) {
    BOOST_TEST_MESSAGE("skipped: the superuser can write everywhere");
    return;
  }
  const SmallSet set;
  const auto permit = [&](std::filesystem::perm_options option) {
    const auto writing = std::filesystem::perms::owner_write;
    std::filesystem::permissions(set.path(), writing, option);
    for (const auto& file : std::filesystem::directory_iterator(set.path())) {
      std::filesystem::permissions(file, writing, option);
    }
  };
  permit(std::filesystem::perm_options::remove);
  const std::string error = error_of([&] { write(set, {}, "MODEL_DATA"); });
  permit(std::filesystem::perm_options::add);
  BOOST_TEST(contains(error, set.path() + " is read-only"));
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
