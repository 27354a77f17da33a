#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "ms_io/lock_files_internal.h"

namespace misfit::ms_io {
namespace {

namespace fs = std::filesystem;

// Requests of processes that wait: how many there are, and two numbers for each of at most 32; then the length of the state of
// the table, and the state. Numbers are 32-bit, the highest byte first.
constexpr std::size_t most_requests = 32, length_at = 4 * (1 + 2 * most_requests), state_at = length_at + 4;

std::uint32_t number_at(const std::array<unsigned char, state_at>& head, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t byte = at; byte < at + 4; ++byte) number = number << 8 | head[byte];
  return number;
}

[[noreturn]] void fail(const fs::path& file, const std::string& reason) {
  throw std::runtime_error("cannot read " + file.string() + ": " + reason);
}

void check_lock_file(const fs::path& file) {
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) {
    if (errno == ENOENT || errno == ENOTDIR || errno == EACCES) return;  // casacore does without it, or says why it cannot
    fail(file, std::strerror(errno));
  }
  std::array<unsigned char, state_at> head{};
  const ssize_t got = read(descriptor, head.data(), head.size());
  const int error = errno;
  const off_t size = lseek(descriptor, 0, SEEK_END);
  close(descriptor);
  if (got < 0) fail(file, std::strerror(error));
  const std::uint32_t requests = number_at(head, 0), length = number_at(head, length_at);
  if (requests > most_requests)
    fail(file, "it tells of " + std::to_string(requests) + " requests, expected at most " + std::to_string(most_requests));
  if (length != 0 && static_cast<std::int64_t>(state_at) + length > size)
    fail(file, "it tells of a state of " + std::to_string(length) + " bytes, expected no more than it holds");
}

}  // namespace

void check_lock_files(const std::string& table) {
  std::error_code ignored;
  check_lock_file(fs::path(table) / "table.lock");
  for (const fs::directory_entry& entry : fs::directory_iterator(table, ignored))
    if (entry.is_directory(ignored)) check_lock_file(entry.path() / "table.lock");
}

}  // namespace misfit::ms_io
