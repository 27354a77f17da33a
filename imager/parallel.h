#pragma once

#include <cstddef>
#include <functional>

namespace misfit::imager {

/// Runs body(i) for i = 0 … count − 1, shared among `threads` threads, each taking the next i when it is free. Returns when all
/// are done; the first exception that a body throws is rethrown, and no further i is begun.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t i)>& body);

/// The number of threads that `--threads 0` means: all cores this process may use.
int available_threads();

}  // namespace misfit::imager
