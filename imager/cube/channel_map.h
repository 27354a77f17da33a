#pragma once

#include <cstddef>
#include <vector>

#include "imager/data/spectral_axis.h"
#include "imager/data/visibilities.h"

namespace misfit::imager {

/// How channels of data become samples of a cube's planes.
enum class SpectralInterpolation {
  /// A plane takes the channels whose middles lie within it, each with its own u, v and w; where there is none, the channel
  /// that covers the plane's middle.
  nearest,
  /// A plane takes visibilities interpolated between adjacent channels: at its own middle; or, where it is wider than channels,
  /// at as many places, evenly spaced within it, as whole channels fit best. Up to half a channel beyond the last channel, the
  /// last channel counts.
  linear,
};

/// A cube's planes, and how they sample the data.
struct CubeSampling {
  SpectralAxis axis;
  SpectralInterpolation interpolation = SpectralInterpolation::linear;
};

/// Some planes of a cube.
struct PlaneRange {
  int first = 0;
  int count = 0;
};

/// A sample of a plane: (1 − part) of one channel's visibility and `part` of another's.
struct ChannelTap {
  std::size_t channel = 0;
  std::size_t other = 0;
  double part = 0;
};

/// The samples that a row gives to one plane.
struct PlaneChannels {
  std::vector<double> frequency_hz;  ///< [sample]
  std::vector<ChannelTap> tap;       ///< [sample]
};

/// The samples that rows of one frame ratio give to planes.
struct ChannelMap {
  double uvw_scale = 1;               ///< to be multiplied with UVW in metres, for samples at frequency_hz
  std::vector<PlaneChannels> planes;  ///< [plane − range.first]
};

/// The channels of a window, in the frame of the data.
struct Channels {
  const std::vector<double>& frequency_hz;
  const std::vector<double>& width_hz;  ///< positive
};

/// `frame_ratio` is that of VisibilityBlock. u, v and w are those at which the data were measured, by the data's frequency,
/// which is a plane's divided by `frame_ratio`. By linear interpolation all rows share the planes' frequencies, and UVW is
/// scaled to them.
ChannelMap map_channels(const CubeSampling& sampling, const PlaneRange& range, const Channels& channels, double frame_ratio);

}  // namespace misfit::imager
