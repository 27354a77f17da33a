#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "ms_io/lock_files_internal.h"
#include "ms_io/stored_bytes_internal.h"

namespace misfit::ms_io {
namespace {

namespace fs = std::filesystem;

// The file's layout: the number of requests of waiting processes, and two numbers for each of at most 32; the length of the
// table's state, and the state. Numbers are 32-bit, the highest byte first.
constexpr std::size_t most_requests = 32, length_at = 4 * (1 + 2 * most_requests), state_at = length_at + 4;

std::uint32_t number_at(const std::array<unsigned char, state_at>& head, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t byte = at; byte < at + 4; ++byte) number = number << 8 | head[byte];
  return number;
}

[[noreturn]] void fail(const fs::path& file, const std::string& reason) {
  throw std::runtime_error("cannot read " + file.string() + ": " + reason);
}

/// Reads what casacore's TableSyncData writes, and returns the rows.
std::uint64_t rows_in(StoredBytes state) {
  if (state.size() == 0) return 0;
  ObjectReader in(state);
  in.magic();
  const std::uint64_t rows = in.object("sync") == 1 ? in.number(4) : in.number(8);
  const std::int64_t columns = in.integer(4);
  in.number(4);
  if (columns < 0) return rows;
  in.number(4);
  in.block("storage managers");
  return rows;
}

}  // namespace

std::uint64_t check_lock_file(const std::string& table) {
  const fs::path file = fs::path(table) / "table.lock";
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) {
    if (errno == ENOENT || errno == ENOTDIR || errno == EACCES) return 0;  // casacore does without it, or says why it cannot
    fail(file, std::strerror(errno));
  }
  std::array<unsigned char, state_at> head{};
  const ssize_t got = ::read(descriptor, head.data(), head.size());
  const int error = errno;
  close(descriptor);
  if (got < 0) fail(file, std::strerror(error));
  const std::uint32_t requests = number_at(head, 0), length = number_at(head, length_at);
  if (requests > most_requests)
    fail(file, "it states " + std::to_string(requests) + " requests, expected at most " + std::to_string(most_requests));
  StoredBytes bytes(file);
  if (length != 0 && state_at + length > bytes.size())
    bytes.fail("a state of " + std::to_string(length) + " bytes", "no more than it holds");
  try {
    return length == 0 ? 0 : rows_in(StoredBytes(file, bytes.read(state_at, length)));
  } catch (const Malformed&) {  // casacore will say so
    return 0;
  }
}

}  // namespace misfit::ms_io
