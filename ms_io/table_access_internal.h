#pragma once

#include <casacore/casa/Arrays/ArrayError.h>
#include <casacore/casa/Exceptions/Error.h>
#include <casacore/ms/MeasurementSets/MeasurementSet.h>
#include <casacore/tables/Tables/BaseTable.h>

#include <cerrno>
#include <stdexcept>
#include <string>

namespace misfit::ms_io {

/// `message` with every run of white space, line ends included, as one blank.
std::string one_line(const std::string& message);

/// casacore's reason for a failure, on one line, with the system's reason where a disk failed and casacore does not say so.
std::string reason_of(const casacore::AipsError& error);

/// The result of `action`, with casacore's exceptions turned into std::runtime_error("`doing`: reason") of one line.
template <typename Action>
auto translated(const std::string& doing, const Action& action) -> decltype(action()) {
  try {
    errno = 0;
    return action();
  } catch (const casacore::AipsError& error) {
    throw std::runtime_error(doing + ": " + reason_of(error));
  } catch (const casacore::ArrayError& error) {
    throw std::runtime_error(doing + ": " + one_line(error.what()));
  }
}

/// Silences casacore's log, since nothing below the program prints.
void silence_casacore();

enum class Access { read, update };

/// Opens the MeasurementSet at `path`, and silences casacore's log. Throws std::runtime_error when there is none, or when it
/// cannot be written but `access` asks for it.
casacore::MeasurementSet open_measurement_set(const std::string& path, Access access);

/// A table that is written only when it is flushed, not when it is closed, whoever else has it open.
class UnwrittenTable : public casacore::Table {
 public:
  explicit UnwrittenTable(const casacore::Table& table) : casacore::Table(table) { baseTabPtr_p->doNotWrite(); }
};

/// `name`, with the short names data, corrected and model spelt out.
std::string column_name(const std::string& name);

/// The name of a column in `table`, where auto is CORRECTED_DATA if there is such a column, else DATA.
std::string column_name(const casacore::Table& table, const std::string& name);

/// The columns with complex visibilities, "DATA, CORRECTED_DATA", or "none".
std::string visibility_columns(const casacore::Table& table);

/// Throws std::runtime_error, which lists the columns there are, unless `column` holds complex visibilities.
void require_visibility_column(const casacore::Table& table, const std::string& path, const std::string& column);

}  // namespace misfit::ms_io
