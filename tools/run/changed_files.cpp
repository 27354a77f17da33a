#include "tools/run/changed_files.h"

#include <stdexcept>
#include <vector>

#include "tools/base/interrupt.h"

namespace misfit::tools {

std::string changed_files_warning(const ms_io::MeasurementSet& data) {
  const std::vector<std::string> paths = data.changed_files();
  if (paths.empty()) return "";
  return paths.front() + (paths.size() == 1 ? "" : " and " + std::to_string(paths.size() - 1) + " more files of the data") +
         " changed during the run: what it read may be partly as before and partly as after, and no error stated here tells of "
         "that; expected data that nothing writes to";
}

void rethrow_with_changed_files(const ms_io::MeasurementSet* data) {
  try {
    throw;
  } catch (const Interrupted&) {
    throw;
  } catch (const std::runtime_error& error) {
    const std::string warning = data ? changed_files_warning(*data) : "";
    if (warning.empty()) throw;
    throw std::runtime_error(error.what() + ("; " + warning));
  }
}

}  // namespace misfit::tools
