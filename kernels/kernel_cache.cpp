#include "kernels/kernel_cache.h"

#include <cstdint>
#include <cstring>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "kernels/kernel_table.h"

namespace misfit::kernels {
namespace {

namespace fs = std::filesystem;

struct Key {
  std::string name;
  int width = 0;
  double x0 = 0;
};

std::uint64_t bits_of(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

std::string file_name(const Key& key) {
  std::ostringstream name;
  name.imbue(std::locale::classic());
  name << key.name << "-w" << key.width << "-x0-" << std::hex << bits_of(key.x0) << std::dec << "-v" << solver_version
       << ".fits";
  return name.str();
}

std::optional<Kernel> kept(const fs::path& path, const Key& key) {
  try {
    const KernelTable table = read_kernel_table(path);
    const Kernel& kernel = table.kernel;
    if (table.checksum_ok && table.solver == solver_version && kernel.name == key.name && kernel.width() == key.width &&
        bits_of(kernel.x0) == bits_of(key.x0))
      return kernel;
  } catch (const std::exception&) {  // absent or damaged
  }
  return {};
}

void keep(const fs::path& path, const Kernel& kernel) {
  try {
    std::error_code ignored;
    fs::create_directories(path.parent_path(), ignored);
    write_kernel_table(kernel, {}, path);
  } catch (const std::exception&) {  // a cache that cannot be written is none
  }
}

}  // namespace

KernelFamily cached(KernelFamily family, const fs::path& folder) {
  if (!family.costly || folder.empty()) return family;
  family.solve = [name = family.name, solve = family.solve, folder](int width, double x0) {
    const Key key{name, width, x0};
    const fs::path path = folder / file_name(key);
    if (const std::optional<Kernel> found = kept(path, key)) return *found;
    Kernel kernel = solve(width, x0);
    keep(path, kernel);
    return kernel;
  };
  return family;
}

}  // namespace misfit::kernels
