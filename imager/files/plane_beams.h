#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "imager/beams/beam.h"
#include "imager/files/image_writer.h"

namespace misfit::imager {

/// A circle of this width stands for no beam in files. tclean writes it, since casacore opens no image, CASA's or FITS, with a
/// beam of no width.
constexpr double no_beam_arcsec = 1e-6;
inline bool stands_for_no_beam(double major_arcsec) {
  return !(major_arcsec > 1.001 * no_beam_arcsec);
}

/// True if two beams are the same to the last bit.
inline bool same_beam(const Beam& a, const Beam& b) {
  return a.major_rad == b.major_rad && a.minor_rad == b.minor_rad && a.position_angle_rad == b.position_angle_rad;
}

/// The beams of an image's planes, where they have any.
class PlaneBeams {
 public:
  PlaneBeams() = default;
  PlaneBeams(int channels, int stokes) : channels_(channels), stokes_(stokes), beam_(size(channels) * size(stokes)) {}

  int channels() const { return channels_; }
  int stokes() const { return stokes_; }
  std::optional<Beam>& at(const PlaneIndex& plane) { return beam_[size(plane.channel) * size(stokes_) + size(plane.stokes)]; }
  const std::optional<Beam>& at(const PlaneIndex& plane) const {
    return beam_[size(plane.channel) * size(stokes_) + size(plane.stokes)];
  }

  bool any() const {
    for (const std::optional<Beam>& beam : beam_)
      if (beam) return true;
    return false;
  }
  /// The beam that every plane has; nothing where planes have different beams, or none.
  std::optional<Beam> shared() const {
    for (const std::optional<Beam>& beam : beam_)
      if (!beam || !same_beam(*beam, *beam_.front())) return std::nullopt;
    return beam_.empty() ? std::nullopt : beam_.front();
  }

 private:
  static std::size_t size(int count) { return static_cast<std::size_t>(count); }

  int channels_ = 0;
  int stokes_ = 0;
  std::vector<std::optional<Beam>> beam_;  ///< [channel][Stokes]
};

}  // namespace misfit::imager
