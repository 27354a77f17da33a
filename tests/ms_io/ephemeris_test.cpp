#include <casacore/casa/Exceptions/Error.h>
#include <casacore/tables/Tables/ScaColDesc.h>
#include <casacore/tables/Tables/ScalarColumn.h>
#include <casacore/tables/Tables/SetupNewTab.h>
#include <casacore/tables/Tables/Table.h>
#include <casacore/tables/Tables/TableRecord.h>

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <functional>
#include <limits>

#include "ms_io/ephemeris_internal.h"
#include "tests/temporary_folder.h"

BOOST_AUTO_TEST_SUITE(ephemeris)

using misfit::ms_io::Ephemeris;

namespace {

constexpr double degree = 3.14159265358979323846 / 180, first_mjd = 57000, step_d = 1.0 / 48;

/// Right ascension and declination in degrees after so many days.
using Way = std::function<std::array<double, 2>(double)>;

class Table {
 public:
  Table(const Way& way, int rows) {
    casacore::TableDesc description;
    for (const char* const column : {"MJD", "RA", "DEC"}) description.addColumn(casacore::ScalarColumnDesc<double>(column));
    casacore::SetupNewTable made(path(), description, casacore::Table::New);
    casacore::Table table(made, static_cast<casacore::rownr_t>(rows));
    table.rwKeywordSet().define("posrefsys", casacore::String("ICRF/ICRS"));
    for (int row = 0; row < rows; ++row) {
      put(table, "MJD", row, first_mjd + row * step_d);
      put(table, "RA", row, way(row * step_d)[0]);
      put(table, "DEC", row, way(row * step_d)[1]);
    }
  }

  std::string path() const { return folder_ / "EPHEM0.tab"; }
  void change(const std::function<void(casacore::Table&)>& how) const {
    casacore::Table table(path(), casacore::Table::Update);
    how(table);
  }
  static void put(casacore::Table& table, const char* column, int row, double value) {
    casacore::ScalarColumn<double>(table, column).put(static_cast<casacore::rownr_t>(row), value);
  }
  /// The largest distance from the way, at thirty times between all rows.
  double largest_error_rad(const Way& way, int rows) const {
    const Ephemeris read(path());
    double largest = 0;
    for (int part = 0; part <= 30 * (rows - 1); ++part) {
      const double days = part * step_d / 30;
      const casacore::MVDirection at(way(days)[0] * degree, way(days)[1] * degree);
      largest = std::max(largest, at.separation(read.at(first_mjd + days).getValue()));
    }
    return largest;
  }

 private:
  misfit::testing::TemporaryFolder folder_;
};

std::string refused(const Table& table) {
  try {
    Ephemeris(table.path());
  } catch (const casacore::AipsError& error) {
    return error.getMesg();
  }
  return "";
}

/// A comet near the Earth, as fast as any: 2 degrees a day.
std::array<double, 2> fast(double days) {
  return {359.9 + 2 * days, 35 + 0.5 * days + 0.005 * days * days};
}

}  // namespace

// Dates are rounded to 7e-12 days, which are 3e-13 rad of this way; δ = 7e-4 rad, and 0.02 δ⁴ = 5e-15.
BOOST_AUTO_TEST_CASE(between_rows_it_follows_a_smooth_way_where_straight_lines_would_err_by_a_tenth_of_a_milliarcsecond) {
  const Table table(fast, 20);
  BOOST_TEST(table.largest_error_rad(fast, 20) < 1e-12);
  const Table two(fast, 2);
  const double straight_rad = two.largest_error_rad(fast, 2);
  BOOST_TEST(straight_rad > 1e-8);
  BOOST_TEST(straight_rad < 6e-8);  // δ²/8
  // A circle of 0.1 degrees about the pole, 7.5 degrees of it a row: x and y are cosines, whose fourth derivative is 1.
  const Way turning = [](double days) { return std::array<double, 2>{360 * days, 89.9}; };
  BOOST_TEST(Table(turning, 9).largest_error_rad(turning, 9) < 0.1 * degree * std::pow(7.5 * degree, 4));
}

BOOST_AUTO_TEST_CASE(the_frame_and_the_units_are_those_that_the_table_states) {
  const Table table(fast, 5);
  BOOST_TEST(Ephemeris(table.path()).at(first_mjd).getRef().getType() == casacore::MDirection::ICRS);
  table.change([](casacore::Table& open) {
    for (const char* const column : {"RA", "DEC"}) {
      casacore::ScalarColumn<double> values(open, column);
      for (casacore::rownr_t row = 0; row < open.nrow(); ++row) values.put(row, values(row) * degree);
      values.rwKeywordSet().define("QuantumUnits", casacore::Vector<casacore::String>(1, "rad"));
    }
    open.rwKeywordSet().define("posrefsys", casacore::String("icrf/j2000.0"));
  });
  BOOST_TEST(table.largest_error_rad(fast, 5) < 1e-12);
  BOOST_TEST(Ephemeris(table.path()).at(first_mjd).getRef().getType() == casacore::MDirection::J2000);
}

BOOST_AUTO_TEST_CASE(a_unit_may_stand_in_either_keyword) {
  for (const std::string keyword : {"QuantumUnits", "UNIT"}) {
    const Table table(fast, 5);
    table.change([&](casacore::Table& open) {
      casacore::ScalarColumn<double> values(open, "RA");
      for (casacore::rownr_t row = 0; row < open.nrow(); ++row) values.put(row, values(row) * degree);
      if (keyword == "UNIT") {
        values.rwKeywordSet().define(keyword, "rad");
      } else {
        values.rwKeywordSet().define(keyword, casacore::Vector<casacore::String>(1, "rad"));
      }
    });
    BOOST_TEST(table.largest_error_rad(fast, 5) < 1e-12);
  }
}

BOOST_AUTO_TEST_CASE(a_table_that_tells_no_way_is_refused_by_name) {
  const Table table(fast, 5);
  const Ephemeris read(table.path());
  BOOST_CHECK_NO_THROW(read.at(first_mjd + 4 * step_d));
  BOOST_CHECK_EXCEPTION(read.at(first_mjd + 5 * step_d), casacore::AipsError, [&](const auto& error) {
    return std::string(error.what()) ==
           "its ephemeris " + table.path() +
               " goes from MJD 57000 to 57000.083333, not to 57000.104167; --timerange selects rows within it";
  });
  BOOST_CHECK_THROW(read.at(std::numeric_limits<double>::quiet_NaN()), casacore::AipsError);
  table.change([](casacore::Table& open) { Table::put(open, "MJD", 3, first_mjd); });
  BOOST_TEST(refused(table).find("is not in the order of MJD at row 3") != std::string::npos);
  table.change([](casacore::Table& open) { Table::put(open, "RA", 2, std::numeric_limits<double>::infinity()); });
  BOOST_TEST(refused(table).find("has numbers that are not finite in row 2") != std::string::npos);
  table.change([](casacore::Table& open) { open.removeColumn("RA"); });
  BOOST_TEST(refused(table).find("has no column RA, expected MJD, RA and DEC") != std::string::npos);
  BOOST_TEST(refused(Table(fast, 1)).find("has 1 rows, expected two or more") != std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()
