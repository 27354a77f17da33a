#pragma once

#include <algorithm>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "imager/arrays/strided.h"
#include "imager/data/extent.h"
#include "imager/data/visibilities.h"
#include "imager/numerics/parallel.h"

namespace misfit::imager {

/// Where samples lie, in somebody else's arrays that outlive this, and how (x, y) of their image are counted. The image's first
/// axis is x, its second y, and with signs of 1
///   V(u,v,w) = Σ I(x,y) exp(−2πi(ux + vy − w(n−1))),   n = √(1 − x² − y²),
/// as in `wgridder` of DUCC (Reinecke; Arras et al. 2021, A&A 646, A58).
struct ArrayCoordinates {
  Strided<const double> uvw_m;       ///< [row][3], metres
  std::vector<double> frequency_hz;  ///< [channel]
  Strided<const std::uint8_t> mask;  ///< [row][channel], 0: left out; none: all count
  double u_sign = 1;                 ///< ±1, the factor of u
  double v_sign = 1;
  double w_sign = 1;  ///< 0: w is taken as 0

  std::size_t rows() const { return uvw_m.rows; }
  std::size_t channels() const { return frequency_hz.size(); }
  std::size_t samples() const { return rows() * channels(); }
};

/// A range of rows, [begin, end).
struct RowsOfArray {
  std::size_t begin = 0;
  std::size_t end = 0;
};

inline constexpr std::size_t rows_a_task = 4096;

/// Calls visit(begin, end) for parts of the rows, shared among threads.
template <typename Visit>
void for_rows(RowsOfArray rows, int threads, const Visit& visit) {
  const std::size_t tasks = (rows.end - rows.begin + rows_a_task - 1) / rows_a_task;
  parallel_for(tasks, threads, [&](std::size_t i) {
    const std::size_t begin = rows.begin + i * rows_a_task;
    visit(begin, std::min(begin + rows_a_task, rows.end));
  });
}

/// The rows in ranges of some millions of samples, each at least a row.
std::vector<RowsOfArray> pieces_of(const ArrayCoordinates& at);

/// Throws std::invalid_argument when shapes differ, or a frequency is not positive and finite.
void check_coordinates(const ArrayCoordinates& at);

/// How far rows reach that are not masked and whose UVW is finite, in wavelengths of the highest frequency.
UvwReach reach_of(const ArrayCoordinates& at, int threads);

/// How samples of an array become samples of a block.
struct ArrayBlockOptions {
  double uv_factor = 1;  ///< factor of u and v, for an image whose pixels are smaller by this factor
  int threads = 1;
};

/// Rows of an array as a block sees them: its u is v, its v −u, so that images have their rows along x and columns along −l =
/// y. Weights are 1, or 0 where the mask is 0. Throws std::invalid_argument where a row that is not masked has UVW that is not
/// finite.
VisibilityBlock block_of(const ArrayCoordinates& at, RowsOfArray rows, const ArrayBlockOptions& options);

/// Visibilities of one precision, with the weights by which they are multiplied, [row][channel].
template <typename Real>
struct ArrayValues {
  Strided<const std::complex<Real>> visibility;
  Strided<const Real> weight;  ///< none: 1
};

/// Throws std::invalid_argument when a table has other than `at`'s rows and channels.
template <typename Real>
void check_values(const ArrayCoordinates& at, const ArrayValues<Real>& values);

/// Visibilities of a block, without a copy where they can stay in the array.
template <typename Real>
struct ValuesOfBlock {
  const std::complex<Real>* visibility = nullptr;
  std::vector<std::complex<Real>> own;  ///< `visibility` points to these unless it points to the array
};

/// The values of the rows of `block`. Weights of single precision, none of which is negative, go into the block; otherwise
/// values are multiplied by them.
template <typename Real>
ValuesOfBlock<Real> values_of(const ArrayValues<Real>& values, RowsOfArray rows, VisibilityBlock& block, int threads);

}  // namespace misfit::imager
