#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace misfit::imager {

/// Sources of one kind, all points or all Gaussians, [source]. Their number is a multiple of `together`: sources that fill it
/// up have no flux.
struct SourceArrays {
  static constexpr std::size_t together = 2;
  std::vector<double> l, m, n_minus_1;
  std::vector<double> flux_jy;
  std::vector<double> decay;  ///< (π fwhm)² / (4 ln 2); 0 for points

  std::size_t size() const { return l.size(); }
};

/// Sources that one call takes: [begin, end), both multiples of SourceArrays::together.
struct SourceRange {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// A group of rows, in light-seconds.
struct RowGroup {
  static constexpr std::size_t rows = 8;
  alignas(64) std::array<double, rows> u_s{}, v_s{}, w_s{};
};

/// Channels at first_hz + c step_hz, ascending.
struct EvenChannels {
  /// So few that recurrences over them lose no more than most²/2 units of rounding, 5e-13 of a source's flux.
  static constexpr std::size_t most = 64;
  double first_hz = 0;
  double step_hz = 0;
  std::size_t count = 0;
};

/// Visibilities of a group of rows, [channel][row].
struct GroupSums {
  alignas(64) std::array<double, EvenChannels::most * RowGroup::rows> real{}, imaginary{};
};

/// A source is left out of rows and channels where the Gaussian is below exp(−64) = 2e-28 at the lowest of the channels.
inline constexpr double largest_decay = 64;

/// Adds the visibilities of points: those of `source.h`, with decay 0. Along channels, phasors follow from the two before them,
/// p(c+1) = 2 cos(2π step) p(c) − p(c−1).
void add_points(const SourceArrays& sources, SourceRange range, const RowGroup& rows, const EvenChannels& channels,
                GroupSums& sums);

/// Adds the visibilities of Gaussians, whose values along channels have ratios with a constant ratio.
void add_gaussians(const SourceArrays& sources, SourceRange range, const RowGroup& rows, const EvenChannels& channels,
                   GroupSums& sums);

}  // namespace misfit::imager
