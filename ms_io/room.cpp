#include "ms_io/room.h"

#include <filesystem>
#include <stdexcept>
#include <system_error>

namespace misfit::ms_io {

void require_room(const std::string& path, std::uintmax_t bytes) {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  const std::uintmax_t free = std::filesystem::space(folder, error).available;
  if (!error && free < bytes)
    throw std::runtime_error("cannot write " + path + ": it takes " + std::to_string(bytes) + " bytes, and " +
                             std::to_string(free) + " are free");
}

}  // namespace misfit::ms_io
