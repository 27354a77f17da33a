#include "tools/hosts/casacore_gridder.h"

#include <array>
#include <complex>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

#include "kernels/kernel_table.h"
#include "tools/hosts/image_divisor_internal.h"

namespace misfit::hosts {

using casacore::Complex;
using casacore::Double;

/// Without initial values: it is made for every visibility.
struct CasacoreFootprint {
  struct Axis {
    std::size_t cells;
    std::ptrdiff_t step;                                      ///< from one to the next, in elements of the array
    std::array<double, kernels::kernel_table_max_width> tap;  ///< of which `cells` are set
  };
  std::ptrdiff_t first;      ///< the first cell on every axis, in elements of the array
  std::array<Axis, 3> axis;  ///< an axis that the grid lacks has one cell, of tap 1
};

namespace {

/// Calls act(tap, row) for every row of cells along the first axis.
template <typename Value, typename Do>
void for_each_row(const CasacoreFootprint& at, Value* grid, Do&& act) {
  Value* plane = grid + at.first;
  for (std::size_t k = 0; k < at.axis[2].cells; ++k, plane += at.axis[2].step) {
    Value* row = plane;
    for (std::size_t j = 0; j < at.axis[1].cells; ++j, row += at.axis[1].step) act(at.axis[2].tap[k] * at.axis[1].tap[j], row);
  }
}

/// x[n] += V Π C. The grid is single precision, and so are the sums that it holds.
template <std::size_t Width>
void add(const CasacoreFootprint& at, Complex value, Complex* grid) {
  std::array<float, 2 * Width> along;  // the first axis, as real and imaginary parts
  for (std::size_t i = 0; i < Width; ++i) {
    along[2 * i] = static_cast<float>(at.axis[0].tap[i] * value.real());
    along[2 * i + 1] = static_cast<float>(at.axis[0].tap[i] * value.imag());
  }
  const std::ptrdiff_t step = at.axis[0].step;
  if (step == 1) {
    for_each_row(at, grid, [&along](double tap, Complex* row) {
      auto* const part = reinterpret_cast<float*>(row);  // as the standard allows for std::complex
      for (std::size_t i = 0; i < 2 * Width; ++i) part[i] += static_cast<float>(tap) * along[i];
    });
  } else {
    for_each_row(at, grid, [&along, step](double tap, Complex* row) {
      for (std::size_t i = 0; i < Width; ++i, row += step)
        *row += static_cast<float>(tap) * Complex(along[2 * i], along[2 * i + 1]);
    });
  }
}

/// Σ_n x[n] Π C: down the columns first, then along the first axis.
template <std::size_t Width>
Complex sum(const CasacoreFootprint& at, const Complex* grid) {
  std::array<double, 2 * Width> along{};  // the first axis, as real and imaginary parts
  const std::ptrdiff_t step = at.axis[0].step;
  if (step == 1) {
    for_each_row(at, grid, [&along](double tap, const Complex* row) {
      const auto* const part = reinterpret_cast<const float*>(row);
      for (std::size_t i = 0; i < 2 * Width; ++i) along[i] += tap * static_cast<double>(part[i]);
    });
  } else {
    for_each_row(at, grid, [&along, step](double tap, const Complex* row) {
      for (std::size_t i = 0; i < Width; ++i, row += step) {
        along[2 * i] += tap * static_cast<double>(row->real());
        along[2 * i + 1] += tap * static_cast<double>(row->imag());
      }
    });
  }
  double real = 0, imaginary = 0;
  for (std::size_t i = 0; i < Width; ++i) {
    real += at.axis[0].tap[i] * along[2 * i];
    imaginary += at.axis[0].tap[i] * along[2 * i + 1];
  }
  return {static_cast<float>(real), static_cast<float>(imaginary)};
}

template <std::size_t... Index>
constexpr auto adders(std::index_sequence<Index...>) {
  return std::array{&add<Index + 1>...};
}
template <std::size_t... Index>
constexpr auto summers(std::index_sequence<Index...>) {
  return std::array{&sum<Index + 1>...};
}

using Widths = std::make_index_sequence<kernels::kernel_table_max_width>;

}  // namespace

CasacoreGridder::CasacoreGridder(const std::filesystem::path& kernel_table, const casacore::IPosition& grid_shape,
                                 const casacore::Vector<Double>& cells_per_unit, const casacore::Vector<Double>& origin_cell)
    : Gridder<Double, Complex>(grid_shape, cells_per_unit, origin_cell),
      kernel_(kernels::read_intact_kernel_table(kernel_table).kernel),
      polynomial_(kernel_.polynomial),
      add_(adders(Widths())[static_cast<std::size_t>(kernel_.width()) - 1]),
      sum_(summers(Widths())[static_cast<std::size_t>(kernel_.width()) - 1]) {
  if (ndim < 1 || ndim > 3 || scale.size() != shape.size() || offset.size() != shape.size())
    throw std::invalid_argument("a grid of " + std::to_string(ndim) + " axes with " + std::to_string(scale.size()) +
                                " scales and " + std::to_string(offset.size()) + " offsets; expected 1 to 3 of each");
  fillCorrectionVectors();
}

bool CasacoreGridder::place(const casacore::ArrayBase& gridded, const casacore::Vector<Double>& position,
                            CasacoreFootprint& footprint) const {
  const auto axes = static_cast<std::size_t>(ndim);
  if (gridded.ndim() < axes || position.size() < axes)
    throw std::invalid_argument("an array of " + std::to_string(gridded.ndim()) + " axes and a position of " +
                                std::to_string(position.size()) + "; expected " + std::to_string(axes));
  const int width = polynomial_.width();
  footprint.first = 0;
  for (std::size_t a = 0; a < axes; ++a) {
    const double cell = scale[a] * position[a] + offset[a] - offsetVec[a];
    const double lowest = cell - (width / 2.0 - 1);  // the first tap lies on the cell below
    if (!(lowest >= 0 && lowest < static_cast<double>(gridded.shape()[a] - width + 1))) return false;  // nor where it is NaN
    const auto first = static_cast<std::ptrdiff_t>(lowest);
    CasacoreFootprint::Axis& axis = footprint.axis[a];
    axis.cells = static_cast<std::size_t>(width);
    axis.step = gridded.steps()[a];
    footprint.first += first * axis.step;
    polynomial_.taps(cell - (static_cast<double>(first) + (width - 1) / 2.0), axis.tap.data());
  }
  for (std::size_t a = axes; a < footprint.axis.size(); ++a) {
    footprint.axis[a].cells = 1;
    footprint.axis[a].step = 0;
    footprint.axis[a].tap[0] = 1;
  }
  return true;
}

casacore::Bool CasacoreGridder::grid(casacore::Array<Complex>& gridded, const casacore::Vector<Double>& position,
                                     const Complex& value) {
  CasacoreFootprint footprint;
  if (!place(gridded, position, footprint)) return false;
  add_(footprint, value, gridded.data());
  return true;
}

casacore::Bool CasacoreGridder::degrid(const casacore::Array<Complex>& gridded, const casacore::Vector<Double>& position,
                                       Complex& value) {
  CasacoreFootprint footprint;
  if (!place(gridded, position, footprint)) return false;
  value = sum_(footprint, gridded.data());
  return true;
}

casacore::Vector<casacore::Int> CasacoreGridder::cSupport() const {
  return casacore::Vector<casacore::Int>(shape.size(), polynomial_.width() / 2);
}

Complex CasacoreGridder::correctionFactor1D(casacore::Int loc, casacore::Int len) {
  if (divisor_.size() != len) divisor_ = image_divisor(kernel_.polynomial, len);
  return {static_cast<float>(divisor_[loc]), 0};
}

}  // namespace misfit::hosts
