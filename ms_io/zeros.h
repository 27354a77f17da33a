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

/// The parts of a selection whose data are 0 in all usable rows, as in a column that was never filled.
struct Zeros {
  bool everywhere = false;
  std::vector<SelectionPart> parts;  ///< whole windows first, then whole fields, then others; none where it is everywhere

  bool none() const { return !everywhere && parts.empty(); }
};

}  // namespace misfit::ms_io
