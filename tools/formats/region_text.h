#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "imager/image.h"
#include "imager/image_header.h"
#include "tools/formats/region_keywords.h"

namespace misfit::tools {

/// CASA region text (CRTF) of boxes, centred boxes and circles:
///
///     #CRTF
///     circle [[12h30m49.42s, +12d23m28.0s], 10arcsec]
///     box [[100pix, 100pix], [180pix, 140pix]], range=[3chan, 7chan]
///     -centerbox [[187.70deg, 12.39deg], [4arcsec, 2arcsec]]
///
/// Pixels count from 0, columns first. A minus sign takes a region's pixels away from those before it. `coord` must be the
/// image's frame; `range` names planes, see planes_of_range(), and the keywords of a line `global` hold for all that follow,
/// unless they have their own. Other keywords, and annotations, have no meaning here.
class RegionText {
 public:
  /// Throws std::runtime_error that names the file `path`, the line and what was expected.
  RegionText(const std::string& path, std::string_view text, const imager::ImageHeader& image);

  /// Whether no region is of some planes alone.
  bool one_for_all_channels() const;
  /// 1 in pixels of a plane that the regions allow, 0 elsewhere.
  imager::Image mask(int channel) const;

 private:
  /// Pixels between two corners, or the circle that fills them.
  struct Region {
    double low_column = 0, low_row = 0, high_column = 0, high_row = 0;
    bool circle = false;
    bool added = true;  ///< or taken away
    PlaneSpan planes;
  };

  void read_line(std::string_view line);
  Region parse_region(std::string_view text) const;

  imager::ImageGeometry geometry_;
  imager::SpectralAxis axis_;
  RegionKeywords global_;
  std::vector<Region> regions_;
};

}  // namespace misfit::tools
