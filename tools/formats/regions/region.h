#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "tools/formats/regions/keywords.h"
#include "tools/formats/regions/shape.h"

namespace misfit::tools::regions {

/// Pixels that a region file adds to a mask, or takes away from it, in some planes of the image.
struct Region {
  Shape shape;
  bool added = true;
  PlaneSpan channels;
  std::vector<bool> stokes;  ///< [Stokes parameter of the image], whether the region is of it
  std::string planes;        ///< the words that name its planes, as "corr=[Q]"; empty if none do
  int line = 0;              ///< of the file, counted from 1

  bool holds(int channel, std::size_t stokes_index) const { return channels.holds(channel) && stokes[stokes_index]; }
  /// True if it is of any plane of the image.
  bool of_planes() const { return !channels.empty() && std::find(stokes.begin(), stokes.end(), true) != stokes.end(); }
};

/// The content of one line of a region file.
struct RegionLine {
  std::vector<Region> regions;
  std::vector<std::string> passed_over;  ///< shapes that have no area, by name
};

/// Reads one format, line by line.
class RegionReader {
 public:
  virtual ~RegionReader() = default;
  /// Throws std::runtime_error or std::invalid_argument that says what was expected.
  virtual RegionLine read(std::string_view line) = 0;
};

}  // namespace misfit::tools::regions
