#include <casacore/tables/DataMan/TiledColumnStMan.h>
#include <casacore/tables/DataMan/TiledShapeStMan.h>
#include <casacore/tables/Tables/ArrColDesc.h>
#include <casacore/tables/Tables/ArrayColumn.h>
#include <casacore/tables/Tables/ScalarColumn.h>
#include <casacore/tables/Tables/TableColumn.h>
#include <casacore/tables/Tables/TableRecord.h>

#include <algorithm>
#include <sstream>
#include <vector>

#include "ms_io/model_column_internal.h"
#include "ms_io/model_journal_internal.h"
#include "ms_io/room.h"
#include "ms_io/setup_internal.h"
#include "ms_io/table_access_internal.h"

namespace misfit::ms_io {

casacore::Record storage_of(const casacore::Table& set, const casacore::String& column) {
  const casacore::Record managers = set.dataManagerInfo();
  for (casacore::uInt i = 0; i < managers.nfields(); ++i) {
    const casacore::Record manager = managers.asRecord(i);
    const casacore::Vector<casacore::String> columns = manager.asArrayString("COLUMNS");
    if (std::find(columns.begin(), columns.end(), column) != columns.end()) return manager;
  }
  return {};
}

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

namespace {

/// A keyword of columns that were made here, which tells them from those that another program made while a journal lay about.
constexpr const char* made_here = "MISFIT_MADE";

constexpr ssize_t tile_samples = 1 << 16;  ///< half a megabyte of complex<float>

/// The tile shape of DATA, or one that holds whole cells of `cell`.
casacore::IPosition tile_shape(const casacore::MeasurementSet& set, const casacore::IPosition& cell) {
  const casacore::Record storage = storage_of(set, "DATA");
  if (storage.isDefined("SPEC") && storage.asRecord("SPEC").isDefined("DEFAULTTILESHAPE")) {
    casacore::IPosition shape(storage.asRecord("SPEC").toArrayInt("DEFAULTTILESHAPE"));
    if (shape.nelements() == 3 && shape.product() > 0) return shape;
  }
  return casacore::IPosition(3, cell(0), cell(1), std::max<ssize_t>(1, tile_samples / std::max<ssize_t>(1, cell.product())));
}

void add_column(casacore::MeasurementSet& set, const std::string& column, const casacore::IPosition& cell, bool fixed) {
  using Description = casacore::ArrayColumnDesc<casacore::Complex>;
  const std::string group = "Tiled" + column;  // no hypercolumn, whose definition would outlive the column
  casacore::TableDesc description;
  if (fixed) {
    description.addColumn(Description(column, "", "TiledColumnStMan", group, cell, casacore::ColumnDesc::FixedShape));
    description.rwColumnDesc(column).rwKeywordSet().define(made_here, true);
    set.addColumn(description, casacore::TiledColumnStMan(group, tile_shape(set, cell)));
  } else {
    description.addColumn(Description(column, "", "TiledShapeStMan", group, 2));
    description.rwColumnDesc(column).rwKeywordSet().define(made_here, true);
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

  /// True if all of these rows have data of that shape.
  bool holds(const RowSpan& rows, const casacore::IPosition& shape) const {
    for (std::size_t row = rows.begin; row < rows.end; ++row) {
      if (!data_.isDefined(row) || !data_.shape(row).isEqual(shape)) return false;
    }
    return true;
  }

  casacore::ArrayColumn<casacore::Complex> cells_, data_;
};

void fill(casacore::MeasurementSet& set, const ModelColumn& column, const std::vector<casacore::IPosition>& shapes) {
  const std::vector<int> setup = casacore::ScalarColumn<int>(set, "DATA_DESC_ID").getColumn().tovector();
  Filler filler(set, column);
  for (RowSpan rows; rows.begin < setup.size(); rows.begin = rows.end) {
    const casacore::IPosition& shape = shapes[static_cast<std::size_t>(setup[rows.begin])];
    const auto most = static_cast<std::size_t>(std::max<ssize_t>(1, (1 << 20) / std::max<ssize_t>(1, shape.product())));
    while (rows.end < setup.size() && rows.end - rows.begin < most && setup[rows.end] == setup[rows.begin]) ++rows.end;
    filler.fill(rows, shape);
  }
}

/// Throws unless all data that are to be copied into cells of one shape have it.
void require_shape(const casacore::MeasurementSet& set, const std::string& path, const std::string& data,
                   const casacore::IPosition& shape) {
  const casacore::ArrayColumn<casacore::Complex> cells(set, data);
  if (cells.columnDesc().isFixedShape() && cells.shapeColumn().isEqual(shape)) return;
  for (casacore::rownr_t row = 0; row < cells.nrow(); ++row)
    if (cells.isDefined(row) && !cells.shape(row).isEqual(shape))
      throw std::runtime_error(path + ": row " + std::to_string(row) + " of " + data + " has the shape " +
                               cells.shape(row).toString() + ", expected " + shape.toString());
}

/// The bytes of a column with a cell for every row. Throws where a row's DATA_DESC_ID is none.
std::uintmax_t column_bytes(const casacore::MeasurementSet& set, const std::string& path,
                            const std::vector<casacore::IPosition>& shapes) {
  const SetupTable table(set, path);
  std::uintmax_t samples = 0;
  for (const int setup : casacore::ScalarColumn<int>(set, "DATA_DESC_ID").getColumn()) {
    table.spectral_window(setup);
    samples += static_cast<std::uintmax_t>(shapes[static_cast<std::size_t>(setup)].product());
  }
  return samples * sizeof(casacore::Complex);
}

/// "A.ms, B.ms", for tables that only refer to the rows of others; nothing for one that has rows of its own.
std::string tables_referred_to(const casacore::Table& set) {
  const casacore::Block<casacore::String> tables = set.getPartNames();
  if (tables.nelements() == 1 && tables[0] == set.tableName()) return "";
  std::string list;
  for (std::size_t t = 0; t < tables.nelements(); ++t) list += (t == 0 ? "" : ", ") + tables[t];
  return list;
}

/// Throws unless an existing column gives back what is put into it, cell by cell.
void require_exact_storage(const casacore::MeasurementSet& set, const std::string& path, const std::string& column) {
  const casacore::ColumnDesc& description = set.tableDesc()[column];
  const std::string name = "column " + column + " of " + path;
  if (!description.isArray() || description.dataType() != casacore::TpComplex) {
    std::ostringstream type;
    type << description.dataType();
    throw std::runtime_error(name + " holds " + (description.isArray() ? "arrays" : "single values") + " of type " +
                             type.str() + "; a model needs arrays of type " + "Complex, or a --column that does not exist yet");
  }
  if (!set.isColumnWritable(column)) throw std::runtime_error(name + " cannot be written; expected another --column");
  const casacore::Record manager = storage_of(set, column);
  const std::string storage = manager.isDefined("TYPE") ? std::string(manager.asString("TYPE")) : "";
  if (storage == "DyscoStMan" || storage.rfind("CompressComplex", 0) == 0) {
    throw std::runtime_error(name + " is stored by " + storage +
                             ", which rounds what it is given, other rows with it; expected another --column");
  }
  if (storage == "IncrementalStMan") {
    throw std::runtime_error(name +
                             " is stored by IncrementalStMan, whose index changes with the values, so that a run that is "
                             "killed could spoil the set; expected another --column");
  }
}

}  // namespace

void throw_exists(const std::string& path, const std::string& column) {
  const bool corrected = column == "CORRECTED_DATA";
  const std::string other = column == "RESIDUAL_DATA" ? "RESIDUAL_DATA_2" : "RESIDUAL_DATA";
  throw std::runtime_error(path + " has a column " + column + " already; expected --column " + other +
                           ", which leaves it as it is, or --column " + column + " --datacolumn " +
                           (corrected ? "corrected" : column) + ", which subtracts from it in place");
}

void require_writable_column(const casacore::MeasurementSet& set, const std::string& path, const ModelColumn& column) {
  const std::string& data = column.subtracted_from;
  if (column.name.empty() || column.name == "DATA") {
    throw std::runtime_error("a model cannot be written to column '" + column.name + "' of " + path +
                             "; expected a column other than DATA, such as " +
                             (data.empty() ? "MODEL_DATA" : "CORRECTED_DATA"));
  }
  if (!data.empty()) require_visibility_column(set, path, data);
  if (set.tableDesc().isColumn(column.name)) {
    const bool made = casacore::TableColumn(set, column.name).keywordSet().isDefined(made_here);
    if (!column.may_exist && !(made && read_journal(set, column.name))) throw_exists(path, column.name);
    require_exact_storage(set, path, column.name);
  } else if (const std::string others = tables_referred_to(set); !others.empty()) {
    throw std::runtime_error(path + " has no column " + column.name + " and refers to the rows of " + others +
                             "; expected a column that is there, or prediction into " + others);
  }
}

void create_model_column(casacore::MeasurementSet& set, const std::string& path, const ModelColumn& column) {
  translated("cannot create " + column.name + " in " + path, [&] {
    const std::vector<casacore::IPosition> shapes = cell_shapes(set, path);
    const casacore::TableDesc& description = set.tableDesc();
    const bool fixed = description.isColumn("DATA") && description["DATA"].isFixedShape() && shapes.size() == 1;
    if (fixed && !column.subtracted_from.empty()) require_shape(set, path, column.subtracted_from, shapes.front());
    require_room(path, column_bytes(set, path, shapes));
    // From here on, what fails leaves a column that is incomplete, as a kill does: casacore removes the files of one before it
    // forgets it, for which the disk may be too full.
    add_column(set, column.name, shapes.front(), fixed);
    fill(set, column, shapes);
    set.flush();
  });
}

}  // namespace misfit::ms_io
