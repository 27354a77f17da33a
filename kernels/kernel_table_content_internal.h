#pragma once

#include <array>
#include <vector>

#include "kernels/kernel_table.h"

namespace misfit::kernels {

inline constexpr int longest_name = 60;  ///< of a kernel: what a card of 80 characters holds beside keyword and quotes

/// A number of a kernel and the header key that holds it.
struct Fact {
  const char* key;
  double* value;
  const char* comment;
  bool may_lack = false;  ///< NaN, which a header cannot hold, is left out
};

/// Every number of `kernel` but the polynomial's.
std::array<Fact, 10> facts_of(Kernel& kernel);

/// CONVFUNC, CORRECT and MAPERROR.
std::vector<HostTable> host_tables(const Kernel& kernel, int per_cell);

/// Throws std::invalid_argument for what a kernel table cannot hold.
void check_storable(const Kernel& kernel, const std::optional<TableSampling>& sampling);

}  // namespace misfit::kernels
