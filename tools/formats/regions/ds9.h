#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "imager/files/image_header.h"
#include "tools/formats/regions/canvas.h"
#include "tools/formats/regions/region.h"

namespace misfit::tools::regions {

/// True if DS9 knows a word, in small letters, for a frame that is read.
bool is_ds9_frame(const std::string& word);

/// DS9's regions, as its reference manual's chapter "Regions" defines them:
///
///     # Region file format: DS9 version 4.1
///     global color=green
///     fk5
///     circle(12:30:49.42, +12:23:28.0, 10")
///     -box(187.70, 12.39, 4", 2", 30) # text={not this}
///     image; ellipse 100 80 20 10 45; annulus(50, 60, 5, 10)
///
/// Pixels count from 1. Angles turn anticlockwise the width of a box and the first radius of an ellipse, which lie east-west at
/// 0; north is that of the place's own frame at the centre, or the columns' direction where the centre is given in pixels.
/// Numbers alone are degrees in a frame of the sky, pixels in `image` and `physical`, which is the same here and the default.
/// Annuli of several radii, or of n, go from the first to the last; so do panda, cpanda, epanda and bpanda, which hold the part
/// of an annulus in a sector, anticlockwise from one angle to another, counted from the west, or the rows' direction. Parts of
/// a composite region are written as others. `-`, or include=0, takes pixels away. Properties of drawing and of the viewer mean
/// nothing here. Points, lines, vectors, segments, projections, rulers, compasses and texts have no pixels, and are reported.
class Ds9Reader : public RegionReader {
 public:
  explicit Ds9Reader(const imager::ImageHeader& image);
  RegionLine read(std::string_view line) override;

 private:
  void read_statement(std::string_view statement, RegionLine& found);
  Region read_shape(std::string_view description) const;

  Canvas canvas_;
  std::vector<bool> stokes_;
  PlaneSpan channels_;
  std::string frame_;        ///< of numbers without a frame; empty = pixels
  bool included_ = true;     ///< for lines without `include`
  bool background_ = false;  ///< for lines without `background` or `source`
};

}  // namespace misfit::tools::regions
