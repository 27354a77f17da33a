#include "kernels/whole_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iomanip>
#include <random>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace misfit::kernels {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& doing, const fs::path& path, const std::string& reason) {
  throw std::runtime_error("cannot " + doing + " " + path.string() + ": " + reason);
}

}  // namespace

fs::path temporary_beside(const fs::path& path) {
  std::random_device random;
  std::ostringstream name;
  name.imbue(std::locale::classic());  // grouped digits would make another name
  name << path.string() << '.' << std::hex << std::setfill('0') << std::setw(8) << random() << std::setw(8) << random()
       << ".part";
  return name.str();
}

bool is_temporary(const fs::path& path) {
  static const std::regex ending("\\.[0-9a-f]{16}\\.part$");
  return std::regex_search(path.string(), ending);
}

std::vector<char> read_whole_file(const fs::path& path, std::size_t limit) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status))
    fail("read", path, status.type() == fs::file_type::not_found ? "it does not exist" : error.message());
  if (!fs::is_regular_file(status)) fail("read", path, "it is no regular file");
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) fail("read", path, error.message());
  if (size > limit) fail("read", path, "it has " + std::to_string(size) + " bytes, expected at most " + std::to_string(limit));
  std::vector<char> bytes(size);
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file.read(bytes.data(), static_cast<std::streamsize>(size)))
    fail("read", path, errno != 0 ? std::strerror(errno) : "it ends early");
  return bytes;
}

fs::path writable_target(const fs::path& path) {
  std::error_code error;
  fs::path target = path;
  for (int links = 0; links < 40 && fs::is_symlink(target, error); ++links) {
    const fs::path to = fs::read_symlink(target, error);
    target = to.is_absolute() ? to : target.parent_path() / to;
  }
  const fs::file_status status = fs::status(target, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) fail("write", path, "it is no regular file");
  return target;
}

void write_whole_file(const fs::path& name, const char* bytes, std::size_t size) {
  const fs::path path = writable_target(name);
  const fs::path temporary = temporary_beside(path);
  errno = 0;
  std::ofstream file(temporary, std::ios::binary);
  file.write(bytes, static_cast<std::streamsize>(size));
  file.close();
  std::error_code error;
  if (!file) error = {errno != 0 ? errno : EIO, std::generic_category()};
  if (!error) fs::rename(temporary, path, error);
  if (!error) return;
  std::error_code ignored;
  fs::remove(temporary, ignored);
  fail("write", path, error.message());
}

}  // namespace misfit::kernels
