#pragma once

#include <complex>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <vector>

#include "imager/data/ranks.h"
#include "imager/numerics/shared_vector.h"

namespace misfit::imager {

/// Counts of the samples read, in Stokes samples (row × channel). Each sample left out is counted once, under the first of
/// these reasons that applies, in the order in which they stand here.
struct SampleCounts {
  std::uint64_t rows_read = 0;
  std::uint64_t samples_read = 0;
  std::uint64_t autocorrelations = 0;
  std::uint64_t flagged = 0;
  std::uint64_t nonfinite = 0;     ///< NaN or infinity in data, weight or UVW
  std::uint64_t zero_weight = 0;   ///< weight zero or negative
  std::uint64_t outside_grid = 0;  ///< |u| or |v| beyond 1/(2 cell); known only once there is an image
  std::uint64_t used = 0;

  SampleCounts& operator+=(const SampleCounts& other);
  /// Adds the counts of all other ranks.
  void add_up(const Ranks& ranks);
};

/// Thrown where none of the samples read can be used: its message counts the reasons.
struct NothingUsable : std::runtime_error {
  explicit NothingUsable(const SampleCounts& counts);
};

/// The sight of a row: the antennas that observed it, and their direction. Numbers are places in lists that the source of the
/// rows has; -1 is in no list.
struct RowSight {
  std::int32_t antenna_one = 0;
  std::int32_t antenna_other = 0;
  std::int32_t field = 0;  ///< or pointing: the direction of the row's dishes
  float zenith_rad = 0;    ///< position angle of the zenith, from north through east, by which the dishes are turned
};

/// The coordinates of samples: rows of UVW, each seen at every channel. Coordinates of the same rows share UVW.
struct SampleCoordinates {
  SharedVector<double> uvw_m;         ///< [row][3], metres, with the sign stored in the MeasurementSet
  std::vector<double> frequency_hz;   ///< [channel]
  std::vector<RowSight> sights = {};  ///< [row] where they were asked for, else empty

  std::size_t rows() const { return uvw_m.size() / 3; }
  std::size_t channels() const { return frequency_hz.size(); }
  std::size_t samples() const { return rows() * channels(); }
};

/// A run of visibilities that share their channels, of one Stokes parameter or of all that are imaged in the same run.
struct VisibilityBlock : SampleCoordinates {
  /// [Stokes][row][channel], Jy; finite wherever the weight is not 0.
  std::vector<std::complex<float>> visibility;
  /// [row][channel], of all Stokes parameters; 0 = unusable, never negative. As read it is 1/(4 σ²), σ the standard deviation
  /// of real and imaginary part in Jy where the data's own weights are 1/σ²; weighting for an image multiplies it.
  std::vector<float> weight;
  SampleCounts counts;  ///< of this block alone
  /// [row]: a frequency in the image's spectral frame over the same in the frame of frequency_hz; empty: 1.
  std::vector<double> frame_ratio;
  std::vector<double> channel_width_hz;  ///< [channel], positive; may be empty unless a cube is made of the block

  /// How many Stokes parameters it carries.
  std::size_t stokes() const { return samples() == 0 ? 1 : visibility.size() / samples(); }
  /// [row][channel] of one Stokes parameter. Throws std::invalid_argument when there are not as many.
  const std::complex<float>* visibility_of(std::size_t stokes) const;
};

/// Hands out blocks in a fixed order.
class BlockStream {
 public:
  virtual ~BlockStream() = default;
  /// The next block, or null at the end.
  virtual std::shared_ptr<const VisibilityBlock> next() = 0;
};

/// Visibilities that can be read any number of times, always in the same blocks.
class VisibilitySource {
 public:
  virtual ~VisibilitySource() = default;
  virtual std::unique_ptr<BlockStream> open() const = 0;
  /// Samples that a full pass hands out, usable or not.
  virtual std::uint64_t samples() const = 0;
  /// The ranks that share the samples of the image: sums over samples are added up over them.
  virtual const Ranks& ranks() const { return alone(); }
  /// To be called by all ranks, each in the thread that exchanges, when it has read a pass to its end: from then on the
  /// source's facts about its passes are those of all ranks.
  virtual void end_pass() const {}
};

/// One of the Stokes parameters that a source's blocks carry.
struct OneStokes {
  OneStokes(const VisibilitySource& from, std::size_t number = 0)  // mostly there is one
      : source(from), index(number) {}
  const VisibilitySource& source;
  std::size_t index;
};

}  // namespace misfit::imager
