#include <casacore/tables/DataMan/TiledColumnStMan.h>
#include <casacore/tables/DataMan/TiledShapeStMan.h>
#include <casacore/tables/Tables/ArrColDesc.h>
#include <casacore/tables/Tables/ArrayColumn.h>
#include <casacore/tables/Tables/ScalarColumn.h>

#include <algorithm>
#include <vector>

#include "ms_io/model_column_internal.h"
#include "ms_io/setup_internal.h"
#include "ms_io/table_access_internal.h"

namespace misfit::ms_io {
namespace {

constexpr ssize_t tile_samples = 1 << 16;  ///< half a megabyte of complex<float>

/// The tile shape of DATA, or one that holds whole cells of `cell`.
casacore::IPosition tile_shape(const casacore::MeasurementSet& set, const casacore::IPosition& cell) {
  const casacore::Record managers = set.dataManagerInfo();
  for (casacore::uInt i = 0; i < managers.nfields(); ++i) {
    const casacore::Record manager = managers.asRecord(i);
    const casacore::Vector<casacore::String> columns = manager.asArrayString("COLUMNS");
    if (std::find(columns.begin(), columns.end(), "DATA") == columns.end()) continue;
    const casacore::Record& specification = manager.asRecord("SPEC");
    if (!specification.isDefined("DEFAULTTILESHAPE")) break;
    casacore::IPosition shape(specification.toArrayInt("DEFAULTTILESHAPE"));
    if (shape.nelements() == 3 && shape.product() > 0) return shape;
  }
  return casacore::IPosition(3, cell(0), cell(1), std::max<ssize_t>(1, tile_samples / std::max<ssize_t>(1, cell.product())));
}

/// The shape of a cell of each DATA_DESC_ID: correlations × channels.
std::vector<casacore::IPosition> cell_shapes(const casacore::MeasurementSet& set, const std::string& path) {
  const casacore::ScalarColumn<int> window(set.dataDescription(), "SPECTRAL_WINDOW_ID");
  const casacore::ScalarColumn<int> polarisation(set.dataDescription(), "POLARIZATION_ID");
  const casacore::ScalarColumn<int> channels(set.spectralWindow(), "NUM_CHAN");
  const casacore::ScalarColumn<int> correlations(set.polarization(), "NUM_CORR");
  const SetupTable table(set, path);
  std::vector<casacore::IPosition> shapes;
  for (casacore::rownr_t d = 0; d < set.dataDescription().nrow(); ++d) {
    table.spectral_window(static_cast<int>(d));  // throws when it points nowhere
    shapes.emplace_back(2, correlations(static_cast<casacore::rownr_t>(polarisation(d))),
                        channels(static_cast<casacore::rownr_t>(window(d))));
  }
  return shapes;
}

void add_column(casacore::MeasurementSet& set, const std::string& column, const casacore::IPosition& cell, bool fixed) {
  casacore::TableDesc description;
  if (fixed) {
    description.addColumn(casacore::ArrayColumnDesc<casacore::Complex>(column, cell, casacore::ColumnDesc::FixedShape));
  } else {
    description.addColumn(casacore::ArrayColumnDesc<casacore::Complex>(column, 2));
  }
  const std::string group = "Tiled" + column;
  description.defineHypercolumn(group, 3, casacore::Vector<casacore::String>(1, column));
  if (fixed) {
    set.addColumn(description, casacore::TiledColumnStMan(group, tile_shape(set, cell)));
  } else {
    set.addColumn(description, casacore::TiledShapeStMan(group, tile_shape(set, cell)));
  }
}

/// Consecutive rows of one setup.
struct RowSpan {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// The column and what it begins with: zeros, or the cells of another column.
class Filler {
 public:
  Filler(casacore::MeasurementSet& set, const ModelColumn& column) : cells_(set, column.name) {
    if (!column.subtracted_from.empty()) data_.attach(set, column.subtracted_from);
  }

  void fill(const RowSpan& rows, const casacore::IPosition& shape) {
    const auto count = static_cast<ssize_t>(rows.end - rows.begin);
    const casacore::Slicer range(casacore::IPosition(1, static_cast<ssize_t>(rows.begin)), casacore::IPosition(1, count));
    const casacore::IPosition all_shape = shape.concatenate(casacore::IPosition(1, count));
    if (data_.isNull() || holds(rows, shape)) {
      if (!cells_.columnDesc().isFixedShape()) {
        for (std::size_t row = rows.begin; row < rows.end; ++row) cells_.setShape(row, shape);
      }
      cells_.putColumnRange(range, data_.isNull() ? Cells(all_shape, casacore::Complex(0)) : data_.getColumnRange(range));
      return;
    }
    for (std::size_t row = rows.begin; row < rows.end; ++row) {
      cells_.put(row, data_.isDefined(row) ? data_(row) : Cells(shape, casacore::Complex(0)));
    }
  }

 private:
  using Cells = casacore::Array<casacore::Complex>;

  /// Whether all of these rows have data of that shape.
  bool holds(const RowSpan& rows, const casacore::IPosition& shape) const {
    for (std::size_t row = rows.begin; row < rows.end; ++row) {
      if (!data_.isDefined(row) || !data_.shape(row).isEqual(shape)) return false;
    }
    return true;
  }

  casacore::ArrayColumn<casacore::Complex> cells_, data_;
};

void fill(casacore::MeasurementSet& set, const std::string& path, const ModelColumn& column,
          const std::vector<casacore::IPosition>& shapes) {
  const std::vector<int> setup = casacore::ScalarColumn<int>(set, "DATA_DESC_ID").getColumn().tovector();
  const SetupTable table(set, path);
  Filler filler(set, column);
  for (RowSpan rows; rows.begin < setup.size(); rows.begin = rows.end) {
    table.spectral_window(setup[rows.begin]);  // throws when there is no such DATA_DESC_ID
    const casacore::IPosition& shape = shapes[static_cast<std::size_t>(setup[rows.begin])];
    const auto most = static_cast<std::size_t>(std::max<ssize_t>(1, (1 << 20) / std::max<ssize_t>(1, shape.product())));
    while (rows.end < setup.size() && rows.end - rows.begin < most && setup[rows.end] == setup[rows.begin]) ++rows.end;
    filler.fill(rows, shape);
  }
}

}  // namespace

void create_model_column(casacore::MeasurementSet& set, const std::string& path, const ModelColumn& column) {
  translated("cannot create " + column.name + " in " + path, [&] {
    const std::vector<casacore::IPosition> shapes = cell_shapes(set, path);
    const casacore::TableDesc& description = set.tableDesc();
    const bool fixed = description.isColumn("DATA") && description["DATA"].isFixedShape() && shapes.size() == 1;
    add_column(set, column.name, shapes.front(), fixed);
    try {
      fill(set, path, column, shapes);
      set.flush();
    } catch (...) {
      set.removeColumn(column.name);
      throw;
    }
  });
}

}  // namespace misfit::ms_io
