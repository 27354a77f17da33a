#pragma once

#include <string>
#include <string_view>

#include "imager/data/geometry.h"
#include "tools/formats/regions/shape.h"

namespace misfit::tools::regions {

/// A coordinate or a length: in pixels, or an angle on the sky.
struct Quantity {
  bool pixels = false;
  double value = 0;  ///< pixels, a coordinate counted from 0; or radians
};

/// A place as a region file names it.
struct Place {
  Quantity x;         ///< column, or longitude
  Quantity y;         ///< row, or latitude
  std::string frame;  ///< of longitude and latitude: see ms_io::in_frame()
  std::string text;   ///< as it is written, for errors
};

/// True if longitudes of a frame are right ascensions, of which sexagesimal ones are in hours.
bool has_right_ascensions(const std::string& frame);

/// The pixels of an image, for regions to be drawn on.
class Canvas {
 public:
  explicit Canvas(const imager::ImageGeometry& geometry) : geometry_(geometry) {}

  const std::string& frame() const { return geometry_.phase_centre.frame; }
  /// Refuses places of one coordinate in pixels and the other on the sky, longitudes beyond 360 degrees and latitudes beyond
  /// 90, and what lies beyond the image's horizon, or 1e9 pixels or more away.
  Point point(const Place& place) const;
  /// How far the north of the place's frame is turned there, anticlockwise from the image's columns; 0 of one in pixels.
  double north_rad(const Place& place) const;
  /// A length in pixels; an angle is as many pixels anywhere as at the phase centre. Refuses 0, less, and more than 1e9.
  double pixels(const Quantity& length, std::string_view text) const;

 private:
  Point at(const Place& place, double latitude_rad) const;

  imager::ImageGeometry geometry_;
};

}  // namespace misfit::tools::regions
