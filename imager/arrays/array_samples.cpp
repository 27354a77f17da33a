#include "imager/arrays/array_samples.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "imager/numerics/constants.h"
#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

std::string shape(std::size_t rows, std::size_t columns) {
  return "(" + std::to_string(rows) + ", " + std::to_string(columns) + ")";
}

template <typename T>
void check_shape(const ArrayCoordinates& at, const Strided<T>& table, const std::string& name) {
  if (!table || (table.rows == at.rows() && table.columns == at.channels())) return;
  throw std::invalid_argument(name + " has the shape " + shape(table.rows, table.columns) + ", expected " +
                              shape(at.rows(), at.channels()) + ", rows of uvw and channels of freq");
}

bool finite(const ArrayCoordinates& at, std::size_t row) {
  return std::isfinite(at.uvw_m.at(row, 0)) && std::isfinite(at.uvw_m.at(row, 1)) && std::isfinite(at.uvw_m.at(row, 2));
}

bool all_masked(const ArrayCoordinates& at, std::size_t row) {
  if (!at.mask) return at.channels() == 0;
  for (std::size_t channel = 0; channel < at.channels(); ++channel)
    if (at.mask.at(row, channel) != 0) return false;
  return true;
}

/// Keeps the lowest row with an error among threads.
void keep_least(std::atomic<std::size_t>& least, std::size_t row) {
  for (std::size_t seen = least; row < seen && !least.compare_exchange_weak(seen, row);) {
  }
}

/// True if a block can hold all weights of the rows: in single precision, and none negative.
bool fits_block(const Strided<const double>& weight, RowsOfArray, int) {
  return !weight;
}

bool fits_block(const Strided<const float>& weight, RowsOfArray rows, int threads) {
  if (!weight) return true;
  std::atomic<bool> fits = true;
  for_rows(rows, threads, [&](std::size_t begin, std::size_t end) {
    bool all = true;
    for (std::size_t row = begin; row < end; ++row)
      for (std::size_t channel = 0; channel < weight.columns; ++channel) {
        const float w = weight.at(row, channel);
        all = all && w >= 0 && w <= std::numeric_limits<float>::max();
      }
    if (!all) fits = false;
  });
  return fits;
}

}  // namespace

std::vector<RowsOfArray> pieces_of(const ArrayCoordinates& at) {
  constexpr std::size_t samples_a_piece = 1 << 23;
  const std::size_t step = std::max<std::size_t>(1, samples_a_piece / std::max<std::size_t>(1, at.channels()));
  std::vector<RowsOfArray> pieces;
  for (std::size_t row = 0; row < at.rows(); row += step) pieces.push_back({row, std::min(row + step, at.rows())});
  return pieces;
}

void check_coordinates(const ArrayCoordinates& at) {
  if (at.uvw_m.columns != 3)
    throw std::invalid_argument("uvw has the shape " + shape(at.uvw_m.rows, at.uvw_m.columns) + ", expected (rows, 3)");
  for (std::size_t channel = 0; channel < at.channels(); ++channel)
    if (!(at.frequency_hz[channel] > 0 && std::isfinite(at.frequency_hz[channel])))
      throw std::invalid_argument("freq[" + std::to_string(channel) + "] is " + std::to_string(at.frequency_hz[channel]) +
                                  ", expected a positive frequency in Hz");
  check_shape(at, at.mask, "mask");
}

UvwReach reach_of(const ArrayCoordinates& at, int threads) {
  if (at.channels() == 0) return {};
  std::vector<std::array<double, 3>> largest(at.rows() / rows_a_task + 1);
  for_rows({0, at.rows()}, threads, [&](std::size_t begin, std::size_t end) {
    std::array<double, 3>& most = largest[begin / rows_a_task];
    for (std::size_t row = begin; row < end; ++row)
      if (finite(at, row) && !all_masked(at, row))
        for (std::size_t k = 0; k < 3; ++k) most[k] = std::max(most[k], std::abs(at.uvw_m.at(row, k)));
  });
  std::array<double, 3> most{};
  for (const auto& of_task : largest)
    for (std::size_t k = 0; k < 3; ++k) most[k] = std::max(most[k], of_task[k]);
  const double per_m = *std::max_element(at.frequency_hz.begin(), at.frequency_hz.end()) / speed_of_light_m_s;
  return {most[0] * per_m, most[1] * per_m, at.w_sign == 0 ? 0 : most[2] * per_m};
}

VisibilityBlock block_of(const ArrayCoordinates& at, RowsOfArray rows, const ArrayBlockOptions& options) {
  const std::size_t count = rows.end - rows.begin, channels = at.channels();
  VisibilityBlock block;
  block.frequency_hz = at.frequency_hz;
  std::vector<double> uvw_m(3 * count);
  block.weight.assign(count * channels, 1);
  const double from_u = -at.u_sign * options.uv_factor, from_v = at.v_sign * options.uv_factor;
  std::atomic<std::size_t> bad = rows.end;
  for_rows(rows, options.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const std::size_t i = row - rows.begin;
      float* const weight = block.weight.data() + i * channels;
      if (at.mask)
        for (std::size_t channel = 0; channel < channels; ++channel) weight[channel] = at.mask.at(row, channel) != 0 ? 1 : 0;
      if (all_masked(at, row)) continue;
      if (!finite(at, row)) keep_least(bad, row);
      uvw_m[3 * i] = from_v * at.uvw_m.at(row, 1);
      uvw_m[3 * i + 1] = from_u * at.uvw_m.at(row, 0);
      uvw_m[3 * i + 2] = at.w_sign * at.uvw_m.at(row, 2);
    }
  });
  if (bad < rows.end)
    throw std::invalid_argument("uvw[" + std::to_string(bad) +
                                "] is not finite, expected coordinates in metres, or a mask of 0");
  block.uvw_m = std::move(uvw_m);
  return block;
}

template <typename Real>
void check_values(const ArrayCoordinates& at, const ArrayValues<Real>& values) {
  check_shape(at, values.visibility, "vis");
  check_shape(at, values.weight, "wgt");
}

template <typename Real>
ValuesOfBlock<Real> values_of(const ArrayValues<Real>& values, RowsOfArray rows, VisibilityBlock& block, int threads) {
  const Strided<const std::complex<Real>>& visibility = values.visibility;
  const Strided<const Real>& weight = values.weight;
  const bool by_block = fits_block(weight, rows, threads);
  const bool in_place = by_block && visibility.dense();
  const std::size_t channels = block.channels();
  ValuesOfBlock<Real> result;
  if (!in_place) result.own.resize(block.samples());
  if (!in_place || weight)
    for_rows(rows, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row < end; ++row)
        for (std::size_t channel = 0; channel < channels; ++channel) {
          const std::size_t i = (row - rows.begin) * channels + channel;
          if (block.weight[i] == 0) continue;
          if (weight && by_block) block.weight[i] = static_cast<float>(weight.at(row, channel));
          if (in_place) continue;
          const std::complex<Real> v = visibility.at(row, channel);
          result.own[i] = weight && !by_block ? weight.at(row, channel) * v : v;
        }
    });
  result.visibility = in_place ? &visibility.at(rows.begin, 0) : result.own.data();
  return result;
}

template void check_values(const ArrayCoordinates&, const ArrayValues<float>&);
template void check_values(const ArrayCoordinates&, const ArrayValues<double>&);
template ValuesOfBlock<float> values_of(const ArrayValues<float>&, RowsOfArray, VisibilityBlock&, int);
template ValuesOfBlock<double> values_of(const ArrayValues<double>&, RowsOfArray, VisibilityBlock&, int);

}  // namespace misfit::imager
