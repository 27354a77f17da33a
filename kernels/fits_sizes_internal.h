#pragma once

#include <cstddef>
#include <string_view>

namespace misfit::kernels {

/// Checks what a reader of the FITS file in memory would take memory by: in each header the mandatory cards in their order,
/// each a whole number (FITS Standard 4.0, section 4.4.1), and data no larger than the file. Throws std::runtime_error that
/// says what is wrong.
void check_fits_sizes(std::string_view file);

}  // namespace misfit::kernels
