#pragma once

#include <mutex>

namespace misfit::kernels {

/// Builds of CFITSIO need not be safe in threads: whoever calls it holds this meanwhile.
std::mutex& cfitsio_mutex();

}  // namespace misfit::kernels
