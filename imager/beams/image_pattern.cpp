#include "imager/beams/image_pattern.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "imager/beams/cubic_weights.h"
#include "imager/numerics/constants.h"

namespace misfit::imager {
namespace {

const PatternGrid& checked(const PatternGrid& grid) {
  constexpr int least = 4;
  const auto inside = [](double at, int pixels) { return at >= 1 && at <= pixels - 2; };
  if (grid.width < least || grid.height < least || !inside(grid.axis_column, grid.width) || !inside(grid.axis_row, grid.height))
    throw std::invalid_argument("pattern of " + std::to_string(grid.width) + " × " + std::to_string(grid.height) +
                                " pixels whose axis is at (" + std::to_string(grid.axis_column) + ", " +
                                std::to_string(grid.axis_row) + "); expected 4 × 4 or more about it");
  if (grid.planes.empty()) throw std::invalid_argument("pattern without planes; expected one or more");
  for (const PatternGrid::Plane& plane : grid.planes)
    if (!(plane.frequency_hz > 0) ||
        plane.voltage.size() != static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height))
      throw std::invalid_argument("plane of a pattern at " + std::to_string(plane.frequency_hz) + " Hz with " +
                                  std::to_string(plane.voltage.size()) + " pixels; expected a frequency and all pixels");
  return grid;
}

class ImagePattern : public VoltagePattern {
 public:
  explicit ImagePattern(PatternGrid grid) : grid_(std::move(grid)) {
    const double columns = std::min(grid_.axis_column, grid_.width - 1 - grid_.axis_column) * std::abs(grid_.column_rad);
    const double rows = std::min(grid_.axis_row, grid_.height - 1 - grid_.axis_row) * std::abs(grid_.row_rad);
    edge_ = std::min(columns, rows);
  }

  bool is_round() const override { return false; }

  double voltage_at(double sine, double angle_rad, double frequency_hz) const override {
    const double away = grid_.of_sines ? sine : std::asin(std::min(1.0, sine));
    const double east = away * std::sin(angle_rad), north = away * std::cos(angle_rad);
    const auto at_plane = [&](const PatternGrid::Plane& plane) {
      const double by = frequency_hz / plane.frequency_hz;
      return pixel(plane, grid_.axis_column + by * east / grid_.column_rad, grid_.axis_row + by * north / grid_.row_rad);
    };
    const auto above = std::find_if(grid_.planes.begin(), grid_.planes.end(),
                                    [=](const PatternGrid::Plane& plane) { return plane.frequency_hz > frequency_hz; });
    if (above == grid_.planes.begin()) return at_plane(grid_.planes.front());
    if (above == grid_.planes.end()) return at_plane(grid_.planes.back());
    const PatternGrid::Plane& below = *(above - 1);
    const double part = (frequency_hz - below.frequency_hz) / (above->frequency_hz - below.frequency_hz);
    return (1 - part) * at_plane(below) + part * at_plane(*above);
  }

  double voltage(double sine, double frequency_hz) const override {
    constexpr int angles = 72;
    double sum = 0;
    for (int a = 0; a < angles; ++a) sum += std::pow(voltage_at(sine, 2 * pi * a / angles, frequency_hz), 2);
    return std::sqrt(sum / angles);
  }

  /// sin θ up to which there are pixels in all directions.
  double main_lobe_sine(double frequency_hz) const override {
    double lowest_hz = grid_.planes.front().frequency_hz;
    for (const PatternGrid::Plane& plane : grid_.planes)
      if (plane.frequency_hz <= frequency_hz) lowest_hz = plane.frequency_hz;
    const double edge = edge_ * lowest_hz / frequency_hz;
    return grid_.of_sines ? std::min(1.0, edge) : std::sin(std::min(pi / 2, edge));
  }
  double continuous_sine(double frequency_hz) const override { return main_lobe_sine(frequency_hz); }
  std::string doubt(double frequency_hz) const override {
    constexpr double near = 1.1;
    const double low_hz = grid_.planes.front().frequency_hz, high_hz = grid_.planes.back().frequency_hz;
    if (frequency_hz * near >= low_hz && frequency_hz <= near * high_hz) return "";
    const auto mhz = [](double hz) { return std::to_string(std::lround(hz / 1e6)); };
    return "the beam that is given is of " + mhz(low_hz) + (high_hz > low_hz ? " to " + mhz(high_hz) : "") + " MHz: at " +
           mhz(frequency_hz) + " MHz it is taken to scale with frequency";
  }
  double detail_sine(double frequency_hz) const override { return main_lobe_sine(frequency_hz) / 16; }

 private:
  /// The voltage between pixels: 0 beyond them; at their rim by polynomials of the last four.
  double pixel(const PatternGrid::Plane& plane, double column, double row) const {
    if (!(column >= 0 && column <= grid_.width - 1 && row >= 0 && row <= grid_.height - 1)) return 0;
    const int c = std::clamp(static_cast<int>(column), 1, grid_.width - 3),
              r = std::clamp(static_cast<int>(row), 1, grid_.height - 3);
    const std::array<double, 4> along = cubic_weights(column - c), down = cubic_weights(row - r);
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = 0; k < 4; ++k)
        sum += down[i] * along[k] *
               plane.voltage[(static_cast<std::size_t>(r - 1) + i) * static_cast<std::size_t>(grid_.width) +
                             static_cast<std::size_t>(c - 1) + k];
    return sum;
  }

  PatternGrid grid_;
  double edge_ = 0;  ///< of the nearest rim, as the pixels are even
};

}  // namespace

Pattern image_pattern(PatternGrid grid) {
  checked(grid);
  return std::make_shared<ImagePattern>(std::move(grid));
}

}  // namespace misfit::imager
