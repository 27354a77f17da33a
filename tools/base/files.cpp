#include "tools/base/files.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "kernels/whole_file.h"

namespace misfit::tools {

namespace fs = std::filesystem;

void check_writable_folder(const std::string& path) {
  fs::path folder = fs::path(path).parent_path();
  if (folder.empty()) folder = ".";
  if (!fs::is_directory(folder)) throw std::runtime_error("output folder " + folder.string() + " does not exist");
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    throw std::runtime_error("output folder " + folder.string() + " cannot be written: " + std::strerror(errno));
  if (fs::exists(folder / "table.dat"))
    throw std::runtime_error("output folder " + folder.string() + " is a casacore table; expected a folder of files");
}

void write_file(const std::string& path, const std::string& content) {
  kernels::write_whole_file(path, content.data(), content.size());
}

std::string read_file(const std::string& path) {
  if (fs::is_directory(path)) throw std::runtime_error("cannot read " + path + ": it is a folder; expected a file");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::ostringstream content;
  if (file.is_open()) content << file.rdbuf();
  if (!file.is_open() || file.bad())
    throw std::runtime_error("cannot read " + path + ": " + std::strerror(errno != 0 ? errno : EIO));
  return content.str();
}

}  // namespace misfit::tools
