#pragma once

#include "imager/coplanar/sample_shares.h"
#include "imager/data/visibilities.h"

namespace misfit::imager {

/// Where the shares of a batch of samples come from.
template <typename Real>
struct SharePlaces {
  static constexpr int capacity = TilePlaces<Real>::capacity;
  int count = 0;
  std::size_t images = 0;
  std::size_t point_stride = 0;  ///< of the tables, see ShareTable
  std::size_t part_stride = 0;
  const Real* from[capacity];  ///< Re c of the first image at the first of six points
  Real weight[ShareTable::points][capacity];
  Real phase_real[capacity];
  Real phase_imaginary[capacity];
  Real sign[capacity];     ///< −1 where w < 0
  Real on_grid[capacity];  ///< −1 where the grid has the conjugate of the sample

  /// Finds the shares of samples of a block, each numbered row × channels + channel. The grid holds the visibilities of samples
  /// that `conjugate` marks, and the conjugates of all others.
  /// Throws std::invalid_argument where the tables do not reach a sample's
  /// w.
  SharePlaces(const SampleShares& shares, const SampleCoordinates& at, const std::size_t* sample, const bool* conjugate,
              int samples);
};

/// Visibilities on their way to or from the planes of a grid, of which images have two each.
template <typename Real>
struct SharedValues {
  static constexpr int capacity = TilePlaces<Real>::capacity;
  Real real[capacity];
  Real imaginary[capacity];
};

/// Sets the planes [image][Re, Im] of each sample to c̄_k v, or to the conjugate of that.
void share_out(const SharePlaces<float>& places, const SharedValues<float>& values,
               float (*planes)[SharedValues<float>::capacity]);
void share_out(const SharePlaces<double>& places, const SharedValues<double>& values,
               double (*planes)[SharedValues<double>::capacity]);

/// The transpose: sets v of each sample to Σ c_k of what the planes hold, or of its conjugate.
void bring_together(const SharePlaces<float>& places, float (*planes)[SharedValues<float>::capacity],
                    SharedValues<float>& values);
void bring_together(const SharePlaces<double>& places, double (*planes)[SharedValues<double>::capacity],
                    SharedValues<double>& values);

}  // namespace misfit::imager
