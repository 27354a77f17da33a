#include <casacore/casa/IO/LockFile.h>
#include <casacore/casa/Logging/LogSink.h>
#include <casacore/casa/Logging/NullLogSink.h>
#include <casacore/tables/Tables/ColumnDesc.h>
#include <casacore/tables/Tables/TableDesc.h>

#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>
#include <sstream>

#include "ms_io/storage_managers_internal.h"
#include "ms_io/table_access_internal.h"

namespace misfit::ms_io {
namespace {

constexpr casacore::uInt lock_attempts = 3;  ///< a second apart

bool is_visibility_column(const casacore::ColumnDesc& column) {
  return column.isArray() && column.dataType() == casacore::TpComplex;
}

void require_main_columns(const casacore::Table& table, const std::string& path) {
  std::string missing;
  for (const casacore::String& column : casacore::MS::requiredTableDesc().columnNames()) {
    if (!table.tableDesc().isColumn(column)) missing += (missing.empty() ? "" : ", ") + column;
  }
  if (!missing.empty()) throw std::runtime_error(path + " is a table but not a MeasurementSet: it has no column " + missing);
}

/// True if the table has other columns than its lock file says: another process changed it just now, or was killed before it
/// wrote both.
bool contradicts_lock_file(const casacore::AipsError& error) {
  return std::string(error.getMesg()).find("cannot sync table") != std::string::npos;
}

/// Removes a lock file that no other process uses: casacore makes a new one, from the table as it is.
void forget_lock_file(const std::string& path) {
  const std::string file = path + "/table.lock";
  casacore::uInt process = 0;
  bool permanent = false;
  std::error_code ignored;
  if (casacore::LockFile::showLock(process, permanent, file) == 0) std::filesystem::remove(file, ignored);
}

casacore::MeasurementSet opened(const std::string& path, Access access) {
  if (!casacore::Table::isReadable(path)) {
    throw std::runtime_error(path + " is not a casacore table; expected the directory of a MeasurementSet");
  }
  // Locking creates lock files where there are none, which reading must not. Unlike the default, neither waits for others.
  const bool update = access == Access::update;
  const casacore::TableLock look(update ? casacore::TableLock::AutoNoReadLocking : casacore::TableLock::NoLocking);
  require_main_columns(casacore::Table(path, look), path);
  if (update && !casacore::Table::isWritable(path)) {
    throw std::runtime_error(path + " is read-only; writing a column needs write permission");
  }
  const auto option = update ? casacore::Table::Update : casacore::Table::Old;
  const casacore::TableLock lock(update ? casacore::TableLock::UserNoReadLocking : casacore::TableLock::NoLocking);
  casacore::MeasurementSet set(path, lock, option);
  if (update && !set.lock(casacore::FileLocker::Write, lock_attempts)) {
    throw std::runtime_error(path +
                             " is locked by another process; expected a set that no other program writes or keeps locked");
  }
  // Counts as written from here on. casacore would truncate table.info to write the same again.
  if (update) set.tableInfo().flush("/dev/null");
  return set;
}

}  // namespace

void silence_casacore() {
  static std::once_flag once;
  std::call_once(once, [] {
    casacore::LogSinkInterface* silent = new casacore::NullLogSink;  // owned by casacore from here on
    casacore::LogSink::globalSink(silent);
  });
}

std::string one_line(const std::string& message) {
  std::istringstream words(message);
  std::string line;
  for (std::string word; words >> word;) line += (line.empty() ? "" : " ") + word;
  return line;
}

std::string reason_of(const casacore::AipsError& error) {
  const int of_system = errno;
  std::string reason = one_line(error.getMesg());
  if (reason.find("LockFile.cc") != std::string::npos && reason.find("PWRITE") != std::string::npos)
    reason = "its lock file cannot be written";
  if (of_system != ENOSPC && of_system != EDQUOT && of_system != EIO) return reason;
  const std::string why = std::strerror(of_system);
  return reason.find(why) == std::string::npos ? reason + ": " + why : reason;
}

casacore::MeasurementSet open_measurement_set(const std::string& path, Access access) {
  silence_casacore();
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) throw std::runtime_error(path + " does not exist; expected a MeasurementSet");
  check_storage_managers(path);
  return translated("cannot open " + path, [&] {
    try {
      return opened(path, access);
    } catch (const casacore::AipsError& error) {
      if (access == Access::read || !contradicts_lock_file(error)) throw;
    }
    forget_lock_file(path);
    return opened(path, access);
  });
}

std::string column_name(const std::string& name) {
  static const std::map<std::string, std::string> full = {
      {"data", "DATA"}, {"corrected", "CORRECTED_DATA"}, {"model", "MODEL_DATA"}};
  const auto found = full.find(name);
  return found == full.end() ? name : found->second;
}

std::string column_name(const casacore::Table& table, const std::string& name) {
  if (name != "auto") return column_name(name);
  return table.tableDesc().isColumn("CORRECTED_DATA") ? "CORRECTED_DATA" : "DATA";
}

std::string visibility_columns(const casacore::Table& table) {
  const casacore::TableDesc& description = table.tableDesc();
  std::string list;
  for (casacore::uInt column = 0; column < description.ncolumn(); ++column) {
    if (is_visibility_column(description[column])) list += (list.empty() ? "" : ", ") + description[column].name();
  }
  return list.empty() ? "none" : list;
}

void require_visibility_column(const casacore::Table& table, const std::string& path, const std::string& column) {
  const casacore::TableDesc& description = table.tableDesc();
  if (description.isColumn(column) && is_visibility_column(description[column])) return;
  throw std::runtime_error(path + " has no visibilities in a column '" + column +
                           "'; columns with visibilities: " + visibility_columns(table) +
                           (description.isColumn("FLOAT_DATA") ? " (FLOAT_DATA holds real numbers)" : ""));
}

}  // namespace misfit::ms_io
