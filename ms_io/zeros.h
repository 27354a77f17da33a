#pragma once

#include <cstdint>
#include <vector>

namespace misfit::ms_io {

/// A part of a selection: a field in a spectral window, by their ids.
struct SelectionPart {
  static constexpr int all = -1;
  int window = all;
  int field = all;
  std::uint64_t rows = 0;
};

/// Where the data of a selection are 0 in all rows that can be used, as where a column was never filled.
struct Zeros {
  bool everywhere = false;
  std::vector<SelectionPart> parts;  ///< whole windows first, then whole fields, then others; none where it is everywhere

  bool none() const { return !everywhere && parts.empty(); }
};

}  // namespace misfit::ms_io
