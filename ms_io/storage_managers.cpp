#include <casacore/casa/OS/Path.h>

#include <filesystem>
#include <set>
#include <stdexcept>
#include <vector>

#include "ms_io/buckets_internal.h"
#include "ms_io/incremental_headers_internal.h"
#include "ms_io/lock_files_internal.h"
#include "ms_io/standard_headers_internal.h"
#include "ms_io/storage_managers_internal.h"
#include "ms_io/tiled_headers_internal.h"

namespace misfit::ms_io {
namespace {

namespace fs = std::filesystem;

/// casacore would wait for somebody to write into a pipe.
void check_files(const std::string& table) {
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(table, none))
    if (entry.path().filename().string().rfind("table.", 0) == 0 && entry.exists(none) && !entry.is_regular_file(none))
      throw std::runtime_error("cannot read " + entry.path().string() + ": it is no regular file");
}

void check_manager(const std::string& path, const TableFile& table, const StorageManager& manager) {
  if (manager.type.find('/') != std::string::npos)
    throw std::runtime_error(path + " has columns stored by '" + manager.type +
                             "', expected the name of a storage manager, not a path");
  try {
    if (manager.type.rfind("Tiled", 0) == 0) check_tiled_header(file_of(path, manager));
    if (manager.type == "StandardStMan") check_standard_header(path, table, manager);
    if (manager.type == "IncrementalStMan") check_incremental_header(path, table, manager);
  } catch (const Malformed&) {  // casacore will say so
  }
}

/// Which casacore finds by their names, in the folder of FIELD.
std::vector<std::string> ephemerides(const std::string& table) {
  std::vector<std::string> found;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(table, none))
    if (entry.path().filename().string().rfind("EPHEM", 0) == 0) found.push_back(entry.path());
  return found;
}

void check(const std::string& path, std::set<std::string>& checked) {
  if (!checked.insert(path).second) return;
  check_files(path);
  try {
    const std::uint64_t locked_rows = check_lock_file(path);
    TableFile table = read_table_file(path);
    if (locked_rows > 0) table.rows = locked_rows;
    for (const StorageManager& manager : table.managers) check_manager(path, table, manager);
    for (const std::string& other : table.tables) check(other, checked);
    for (const std::string& other : ephemerides(path)) check(other, checked);
  } catch (const Malformed&) {  // casacore will say so
  }
}

}  // namespace

void check_storage_managers(const std::string& path) {
  std::set<std::string> checked;
  check(casacore::Path(path).absoluteName(), checked);
}

}  // namespace misfit::ms_io
