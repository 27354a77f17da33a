#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "ms_io/beam_rows.h"
#include "ms_io/field_centres_internal.h"
#include "ms_io/field_directions_internal.h"
#include "ms_io/visibility_reader_internal.h"

namespace misfit::ms_io {

/// Finds where directions of the sky lie in an image with this phase centre, made of a set. Both arguments must outlive it.
/// Throws std::runtime_error when FIELD or ANTENNA cannot be read.
class ImageView {
 public:
  ImageView(const OpenSet& open_set, const imager::SkyDirection& centre);

  /// Where the direction lies in the image at a TIME, as the image's header has it.
  imager::SkyDirection seen(const imager::SkyDirection& direction, double time_s);
  /// The pointing of the antennas of a field, in that direction of the image; of one TIME where it is given.
  FieldPointing pointing(int field, const imager::SkyDirection& direction, std::optional<double> time_s = {}) const;
  /// One pointing of the field that has this row or, where it moves, three in the course of time.
  std::vector<FieldPointing> of_field(int field, std::uint64_t row);

 private:
  const OpenSet& open_set_;
  const imager::SkyDirection& centre_;
  double dish_m_;
  FieldDirections fields_;
  std::optional<std::pair<double, imager::SkyDirection>> then_;  ///< the moving centre at the TIME asked for last
};

/// The pointings of the fields that have selected rows, in the order of their ids, seen from `centre`. Throws
/// std::runtime_error when FIELD or ANTENNA cannot be read.
std::vector<FieldPointing> field_pointings(const OpenSet& open_set, const imager::SkyDirection& centre);

}  // namespace misfit::ms_io
