#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace misfit::kernels {

/// A FITS file that need not be in memory.
struct FitsBytes {
  std::uint64_t size = 0;
  std::function<std::string(std::uint64_t at, std::size_t count)> read;  ///< bytes of the file, as many as there are
};

/// Checks the sizes by which a reader of the FITS file would allocate memory: in each header the mandatory cards in their
/// order, each a whole number (FITS Standard 4.0, section 4.4.1), data no larger than the file, and the heap of a table within
/// them. Reads headers alone. Throws std::runtime_error that says what is wrong.
void check_fits_sizes(const FitsBytes& file);
/// Checks a file in memory likewise; its last block must be whole, too.
void check_fits_sizes(std::string_view file);

}  // namespace misfit::kernels
