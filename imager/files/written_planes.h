#pragma once

#include <optional>
#include <vector>

#include "imager/files/image_writer.h"
#include "imager/files/plane_beams.h"

namespace misfit::imager {

/// The planes of an image that have been written, and their beams, which every ImageWriter keeps.
class WrittenPlanes {
 public:
  /// Throws std::invalid_argument where the header has no pixels or no planes.
  explicit WrittenPlanes(const ImageHeader& header);

  /// Notes a plane. Throws std::invalid_argument for one that the header does not have, pixels of another shape, or a plane
  /// that was written before.
  void add(const PlaneIndex& at, const Image& image, const std::optional<Beam>& beam);
  std::vector<PlaneIndex> missing() const;
  /// A plane without values.
  Image blank() const;
  const PlaneBeams& beams() const { return beams_; }

 private:
  std::size_t place(const PlaneIndex& at) const;

  int width_;
  int height_;
  PlaneBeams beams_;
  std::vector<bool> written_;  ///< [channel][Stokes]
};

}  // namespace misfit::imager
