#include "tests/tools/set_changes.h"

#include <casacore/casa/Arrays/ArrayMath.h>
#include <casacore/casa/Arrays/Matrix.h>
#include <casacore/ms/MeasurementSets/MSFieldColumns.h>
#include <casacore/ms/MeasurementSets/MSPolColumns.h>
#include <casacore/ms/MeasurementSets/MeasurementSet.h>
#include <casacore/tables/Tables/ArrColDesc.h>
#include <casacore/tables/Tables/ArrayColumn.h>
#include <casacore/tables/Tables/ScalarColumn.h>
#include <casacore/tables/Tables/TableRow.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace misfit::tools::testing {
namespace {

casacore::MeasurementSet opened(const std::string& set) {
  return casacore::MeasurementSet(set, casacore::Table::Update);
}

template <typename T>
void put_first(const std::string& set, const std::string& column, std::size_t row, T value) {
  const casacore::MeasurementSet open = opened(set);
  casacore::ArrayColumn<T> cells(open, column);
  casacore::Array<T> cell = cells(row);
  *cell.data() = value;
  cells.put(row, cell);
}

/// Puts a column of one cell for all rows in place of what is there.
template <typename T>
void replace(casacore::MeasurementSet& set, const std::string& column, const casacore::Array<T>& cell) {
  set.removeColumn(column);
  set.addColumn(casacore::ArrayColumnDesc<T>(column, static_cast<int>(cell.ndim())));
  casacore::ArrayColumn<T> cells(set, column);
  for (casacore::rownr_t row = 0; row < set.nrow(); ++row) cells.put(row, cell);
}

}  // namespace

void shuffle_rows(const std::string& set, const std::string& copy, unsigned seed) {
  const casacore::MeasurementSet open(set);
  std::vector<casacore::rownr_t> order(open.nrow());
  std::iota(order.begin(), order.end(), casacore::rownr_t{0});
  std::shuffle(order.begin(), order.end(), std::mt19937(seed));
  const casacore::Table shuffled = open(casacore::Vector<casacore::rownr_t>(order));
  shuffled.deepCopy(copy, casacore::Table::New, true);
}

void put_data(const std::string& set, std::size_t row, std::complex<float> value) {
  put_first(set, "DATA", row, value);
}

void put_weight(const std::string& set, std::size_t row, float value) {
  put_first(set, "WEIGHT", row, value);
}

void put_weights(const std::string& set, float value) {
  const casacore::MeasurementSet open = opened(set);
  casacore::ArrayColumn<float> weights(open, "WEIGHT");
  casacore::Array<float> all = weights.getColumn();
  all = value;
  weights.putColumn(all);
}

void put_u(const std::string& set, std::size_t row, double u_m) {
  put_first(set, "UVW", row, u_m);
}

void flag_sample(const std::string& set, std::size_t row) {
  put_first(set, "FLAG", row, true);
}

void flag_channel(const std::string& set, std::size_t channel, std::size_t first_row) {
  const casacore::MeasurementSet open = opened(set);
  casacore::ArrayColumn<bool> cells(open, "FLAG");
  for (casacore::rownr_t row = first_row; row < open.nrow(); ++row) {
    casacore::Matrix<bool> cell = cells(row);
    cell.column(channel) = true;
    cells.put(row, cell);
  }
}

void flag_row(const std::string& set, std::size_t row) {
  casacore::ScalarColumn<bool>(opened(set), "FLAG_ROW").put(row, true);
}

void flag_all(const std::string& set) {
  casacore::ScalarColumn<bool>(opened(set), "FLAG_ROW").fillColumn(true);
}

void name_all(const std::string& set, const std::string& name) {
  const casacore::MeasurementSet open = opened(set);
  casacore::ScalarColumn<casacore::String>(open.field(), "NAME").fillColumn(name);
  casacore::ScalarColumn<casacore::String>(open.antenna(), "NAME").fillColumn(name);
  casacore::ScalarColumn<casacore::String>(open.observation(), "TELESCOPE_NAME").fillColumn(name);
  casacore::ScalarColumn<casacore::String>(open.observation(), "OBSERVER").fillColumn(name);
}

void add_field(const std::string& set, const AddedField& field) {
  casacore::MeasurementSet open = opened(set);
  const casacore::rownr_t row = open.field().nrow();
  open.field().addRow(1);
  casacore::MSFieldColumns columns(open.field());
  casacore::Matrix<double> direction(2, 1);
  direction(0, 0) = field.ra_rad;
  direction(1, 0) = field.dec_rad;
  columns.name().put(row, field.name);
  columns.numPoly().put(row, 0);
  columns.phaseDir().put(row, direction);
  columns.delayDir().put(row, direction);
  columns.referenceDir().put(row, direction);
  casacore::ScalarColumn<int> of_rows(open, "FIELD_ID");
  for (casacore::rownr_t r = field.first_row; r < open.nrow(); r += 2) of_rows.put(r, static_cast<int>(row));
}

void point_field(const std::string& set, std::size_t field, double ra_rad, double dec_rad) {
  casacore::MeasurementSet open = opened(set);
  casacore::Matrix<double> direction(2, 1);
  direction(0, 0) = ra_rad;
  direction(1, 0) = dec_rad;
  casacore::MSFieldColumns(open.field()).referenceDir().put(field, direction);
}

void forget_pointing(const std::string& set, std::size_t field) {
  casacore::MeasurementSet open = opened(set);
  casacore::MSFieldColumns(open.field()).referenceDir().put(field, casacore::Matrix<double>(2, 0));
}

void add_feed(const std::string& set, double x_rad, double y_rad) {
  casacore::MeasurementSet open = opened(set);
  casacore::Table& feed = open.feed();
  const casacore::rownr_t feeds = feed.nrow();
  feed.addRow(feeds);
  for (casacore::rownr_t row = 0; row < feeds; ++row) {
    casacore::TableRow(feed).put(feeds + row, casacore::ROTableRow(feed).get(row));
    casacore::ScalarColumn<int>(feed, "FEED_ID").put(feeds + row, 1);
    casacore::Matrix<double> offset(2, casacore::ScalarColumn<int>(feed, "NUM_RECEPTORS")(row));
    offset.row(0) = x_rad;
    offset.row(1) = y_rad;
    casacore::ArrayColumn<double>(feed, "BEAM_OFFSET").put(feeds + row, offset);
  }
  for (const char* column : {"FEED1", "FEED2"})
    for (casacore::rownr_t row = 1; row < open.nrow(); row += 2) casacore::ScalarColumn<int>(open, column).put(row, 1);
}

void name_telescope(const std::string& set, const std::string& name) {
  casacore::MeasurementSet open = opened(set);
  casacore::ScalarColumn<casacore::String>(open.observation(), "TELESCOPE_NAME").fillColumn(name);
}

void set_dish_diameters(const std::string& set, double diameter_m) {
  casacore::MeasurementSet open = opened(set);
  casacore::ScalarColumn<double>(open.antenna(), "DISH_DIAMETER").fillColumn(diameter_m);
}

void make_autocorrelation(const std::string& set, std::size_t row) {
  const casacore::MeasurementSet open = opened(set);
  casacore::ScalarColumn<int>(open, "ANTENNA2").put(row, casacore::ScalarColumn<int>(open, "ANTENNA1")(row));
}

void scale_data(const std::string& set, float factor) {
  const casacore::MeasurementSet open = opened(set);
  casacore::ArrayColumn<casacore::Complex> data(open, "DATA");
  data.putColumn(data.getColumn() * casacore::Complex(factor));
}

void scale_uvw(const std::string& set, double factor) {
  const casacore::MeasurementSet open = opened(set);
  casacore::ArrayColumn<double> uvw(open, "UVW");
  uvw.putColumn(uvw.getColumn() * factor);
}

void store_correlations(const std::string& path, const std::vector<int>& types) {
  casacore::MeasurementSet set = opened(path);
  const auto channels = static_cast<std::size_t>(casacore::ArrayColumn<casacore::Complex>(set, "DATA").shape(0)(1));
  casacore::MSPolarizationColumns polarization(set.polarization());
  polarization.numCorr().put(0, static_cast<int>(types.size()));
  polarization.corrType().put(0, casacore::Vector<int>(types));
  polarization.corrProduct().put(0, casacore::Matrix<int>(2, types.size(), 0));
  replace<casacore::Complex>(set, "DATA", casacore::Matrix<casacore::Complex>(types.size(), channels, casacore::Complex(0)));
  replace<bool>(set, "FLAG", casacore::Matrix<bool>(types.size(), channels, false));
  replace<float>(set, "WEIGHT", casacore::Vector<float>(types.size(), 1));
}

std::vector<std::complex<float>> visibilities(const std::string& set, const std::string& column) {
  return casacore::ArrayColumn<casacore::Complex>(casacore::MeasurementSet(set), column).getColumn().tovector();
}

struct LockedSet::Open {
  casacore::MeasurementSet set;
};

LockedSet::LockedSet(const std::string& set) : open_(std::make_unique<Open>()) {
  const casacore::TableLock lock(casacore::TableLock::PermanentLocking);
  open_->set = casacore::MeasurementSet(set, lock, casacore::Table::Update);
}

LockedSet::~LockedSet() = default;

}  // namespace misfit::tools::testing
