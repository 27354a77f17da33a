#pragma once

#include "imager/coplanar/coplanar_transform.h"

namespace misfit::imager {

/// The work of gridding and its FFTs, in numbers.
struct GriddingWork {
  double samples = 0;  ///< visibilities
  int width = 1;       ///< cells a visibility touches along u and along v
  int degree = 0;      ///< of the kernels' polynomials
  int nu = 0;          ///< FFT lengths, of a facet where there are facets
  int nv = 0;
  int columns = 0;  ///< of the FFT's image that are kept
  Precision precision = Precision::double_precision;
  int width_w = 0;  ///< planes a visibility touches in each facet; 0 = no w axis
  int facets = 1;
  int planes = 1;   ///< FFTs of two dimensions: one for each w plane of each facet
  int gathers = 1;  ///< times that samples are gathered for a w axis and all planes transformed
  int stokes = 1;   ///< images made from the same samples; 0: the PSF alone
  bool psf = true;  ///< whether the PSF is made besides

  int images() const { return stokes + (psf ? 1 : 0); }
  bool has_w_axis() const { return width_w > 0; }
};

/// Time on one core, from counts of operations. The default constants are of one machine, fixed:
/// choices made with them depend on options and data alone. The constants of the machine at hand (measure_costs) predict
/// seconds.
struct CostModel {
  double sample_ns = 15;     ///< a sample's ordering and coordinates
  double cell_ns = 0.15;     ///< a cell of width × padded width in three planes
  double tap_ns = 0.012;     ///< a coefficient of the polynomials, for each padded tap of both axes
  double fft_ns = 0.6;       ///< a point and binary logarithm of an FFT
  double double_cost = 1.7;  ///< over single precision, without a w axis: twice the bytes, half the lanes
  double direct_ns = 4;      ///< a term of a direct sum, in double precision

  double seconds(const GriddingWork& work) const { return gridding_seconds(work) + fft_seconds(work); }
  /// The parts of seconds(): ordering, taps and cells; and FFTs.
  double gridding_seconds(const GriddingWork& work) const;
  double fft_seconds(const GriddingWork& work) const;
};

/// The operation count of the literature (after Ye, Gull, Tan & Nikolic 2020): W² multiply-adds a visibility (W² W_w with a w
/// axis), and N log2 N for an FFT of N points.
double operation_count(const GriddingWork& work);

/// The constants of this machine, from gridding 1.8 million random samples in all; takes about half a second.
CostModel measure_costs();

}  // namespace misfit::imager
