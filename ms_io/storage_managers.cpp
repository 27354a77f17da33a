#include <casacore/casa/OS/Path.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "ms_io/incremental_headers_internal.h"
#include "ms_io/lock_files_internal.h"
#include "ms_io/standard_headers_internal.h"
#include "ms_io/storage_managers_internal.h"
#include "ms_io/tiled_headers_internal.h"

namespace misfit::ms_io {
namespace {

namespace fs = std::filesystem;

/// Throws where a file of the table is no regular file: casacore would wait for somebody to write into a pipe.
void check_files(const std::string& table) {
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(table, none))
    if (entry.path().filename().string().rfind("table.", 0) == 0 && entry.exists(none) && !entry.is_regular_file(none))
      throw std::runtime_error("cannot read " + entry.path().string() + ": it is no regular file");
}

/// True if this project reads cells of a subtable; casacore opens all subtables of a set, but reads only the headers of others.
bool reads_cells_of(const std::string& subtable) {
  static const std::set<std::string> read{"ANTENNA",      "DATA_DESCRIPTION", "FEED", "FIELD", "OBSERVATION",
                                          "POLARIZATION", "SPECTRAL_WINDOW",  "STATE"};
  return read.count(fs::path(subtable).filename()) > 0;
}

/// The tables of ephemerides, which casacore finds by their names, in the folder of FIELD.
std::vector<std::string> ephemerides(const std::string& table) {
  std::vector<std::string> found;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(table, none))
    if (entry.path().filename().string().rfind("EPHEM", 0) == 0) found.push_back(entry.path());
  return found;
}

class TableChecks {
 public:
  /// `referring`: tables that refer to it, one through the other.
  void check(const std::string& path, bool reads_cells, std::vector<std::string> referring = {}) {
    if (std::find(referring.begin(), referring.end(), path) != referring.end())
      throw std::runtime_error("cannot read " + path + ": it refers to itself, expected rows of another table");
    if (!checked_.insert({path, reads_cells}).second) return;
    check_files(path);
    try {
      const std::uint64_t locked_rows = check_lock_file(path);
      TableFile table = read_table_file(path);
      if (locked_rows > 0) table.rows = locked_rows;
      check_managers(path, table, reads_cells);
      referring.push_back(path);
      for (const std::string& other : table.references) check(other, reads_cells, referring);
      for (const std::string& other : table.subtables) check(other, reads_cells_of(other));
      for (const std::string& other : ephemerides(path)) check(other, true);
    } catch (const Malformed&) {  // casacore will say so
    }
  }

 private:
  static void check_managers(const std::string& path, const TableFile& table, bool reads_cells) {
    for (const StorageManager& manager : table.managers) try {
        if (manager.type.find('/') != std::string::npos)
          throw std::runtime_error(path + " has columns stored by '" + manager.type +
                                   "', expected the name of a storage manager, not a path");
        if (manager.type.rfind("Tiled", 0) == 0) check_tiled_header(path, table, manager);  // which is read in any case
        if (reads_cells && manager.type == "StandardStMan") check_standard_header(path, table, manager);
        if (reads_cells && manager.type == "IncrementalStMan") check_incremental_header(path, table, manager);
      } catch (const Malformed& file) {  // casacore refuses one once, and believes what it has read of it when asked again
        std::error_code none;
        if (fs::exists(file.path, none))
          throw std::runtime_error("cannot read " + file.path + ": it ends early, or is not as " + manager.type + " writes it");
      }
  }

  std::set<std::pair<std::string, bool>> checked_;
};

}  // namespace

void check_storage_managers(const std::string& path) {
  TableChecks().check(casacore::Path(path).absoluteName(), true);
}

}  // namespace misfit::ms_io
