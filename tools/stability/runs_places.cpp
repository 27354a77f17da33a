#include <array>
#include <cmath>
#include <string>

#include "imager/numerics/constants.h"
#include "tools/stability/stability_runs.h"

namespace misfit::tools {
namespace {

/// The samples at other places: place(u, v, row) changes u and v.
template <typename Place>
imager::VisibilityBlock moved(const StabilityData& data, const Place& place) {
  imager::VisibilityBlock block = data.block;
  std::vector<double>& uvw_m = block.uvw_m.edit();
  for (std::size_t row = 0; row < block.rows(); ++row) place(uvw_m[3 * row], uvw_m[3 * row + 1], row);
  return block;
}

StabilityCase on_line(const StabilityData& data, double angle_rad, const std::string& name) {
  return case_of(name,
                 moved(data,
                       [angle_rad](double& u, double& v, std::size_t) {
                         const double along = u * std::cos(angle_rad) + v * std::sin(angle_rad);
                         u = along * std::cos(angle_rad);
                         v = along * std::sin(angle_rad);
                       }),
                 data);
}

StabilityCase in_cells(const StabilityData& data, std::size_t cells, const std::string& name) {
  constexpr std::array<std::array<double, 2>, 3> at{{{0.11, 0.17}, {-0.23, 0.08}, {0.3, 0.31}}};  // of 1/cell
  const double whole = 1 / data.cell_rad();
  return case_of(name,
                 moved(data,
                       [&](double& u, double& v, std::size_t row) {
                         constexpr double within = 1e-3;  // a uv cell of this image is 1/64 of 1/cell, or less
                         const auto& [to_u, to_v] = at[row % cells];
                         u = to_u * whole + within * u;
                         v = to_v * whole + within * v;
                       }),
                 data);
}

/// A power of 2, so that 1/(2 cell) and the cells of an FFT of a power of 2 are exact.
double exact_cell_rad(const StabilityData& data) {
  return std::exp2(std::floor(std::log2(data.cell_rad())));
}

/// Channels over a band whose top is `ratio` times its bottom, the highest where the data are.
StabilityCase in_band(const StabilityData& data, double ratio, std::size_t channels, const std::string& name) {
  imager::VisibilityBlock block;
  const std::size_t rows = (data.block.rows() + channels - 1) / channels, step = data.block.rows() / rows;
  for (std::size_t c = 0; c < channels; ++c) {
    const double part = channels == 1 ? 1 : static_cast<double>(c) / static_cast<double>(channels - 1);
    block.frequency_hz.push_back(imager::speed_of_light_m_s * (1 + (ratio - 1) * part) / ratio);
  }
  for (std::size_t row = 0; row < rows; ++row) {
    const double* const uvw_m = &data.block.uvw_m[3 * row * step];
    block.uvw_m.append(uvw_m, uvw_m + 3);
    block.weight.insert(block.weight.end(), channels, data.block.weight[row * step]);
  }
  return case_of(name, block, data);
}

}  // namespace

std::vector<StabilityCase> few_places_cases(const StabilityData& data) {
  return {on_line(data, 0, "on the u axis"), on_line(data, 0.7, "on an oblique line"), in_cells(data, 2, "in two uv cells"),
          in_cells(data, 3, "in three uv cells")};
}

std::vector<StabilityCase> boundary_cases(const StabilityData& data) {
  const double cell_rad = exact_cell_rad(data), edge = 1 / (2 * cell_rad);
  const imager::ImageGeometry geometry{stability_pixels, stability_pixels, cell_rad, {}, {}};
  const auto at_edge = moved(data, [&](double& u, double& v, std::size_t row) {
    if (row % 3 != 1) u = std::copysign(edge, u);
    if (row % 3 != 0) v = std::copysign(edge, v);
  });
  const auto on_grid = [&](double offset) {
    return moved(data, [&](double& u, double& v, std::size_t) {
      const double step = 1 / (2 * stability_pixels * cell_rad);  // of the FFT at padding 2
      u = step * (std::round(u / step) + offset);
      v = step * (std::round(v / step) + offset);
    });
  };
  return {case_of("at 1/(2 cell) exactly", at_edge, geometry), case_of("on grid points", on_grid(0), geometry),
          case_of("half way between them", on_grid(0.5), geometry)};
}

std::vector<StabilityCase> bandwidth_cases(const StabilityData& data) {
  return {in_band(data, 1, 1, "one channel"), in_band(data, 3, 2, "two channels, 3:1"),
          in_band(data, 3, 64, "64 channels, 3:1"), in_band(data, 3, 1000, "1000 channels, 3:1")};
}

ReportSection places_section(const StabilityData& data) {
  return {
      .heading = "Whole runs: uv coverage, edges, bandwidth",
      .paragraphs = {"A PSF of few places has sidelobes as high as its peak, which no CLEAN can tell from sources: what counts "
                     "is that it ends, with a smaller residual. Where no beam fits the PSF its largest sidelobe is taken to "
                     "be 1."},
      .figures = {},
      .tables = {outcome_table("few-places", "Lines, and PSFs that are nearly singular", run_cases(few_places_cases(data))),
                 outcome_table("edges", "Where cells meet, and where the grid ends", run_cases(boundary_cases(data))),
                 outcome_table("bandwidths", "From one channel to 3:1", run_cases(bandwidth_cases(data)))}};
}

}  // namespace misfit::tools
