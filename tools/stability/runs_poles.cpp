#include <algorithm>
#include <cmath>
#include <string>

#include "imager/numerics/constants.h"
#include "tools/stability/stability_runs.h"

namespace misfit::tools {
namespace {

constexpr double pole_rad = imager::pi / 2;

imager::ImageGeometry field_at(double dec_rad, double cell_rad) {
  return {stability_pixels, stability_pixels, cell_rad, {1.2, dec_rad}, {}};
}

/// The largest error, in pixels, of a pixel's way to the sky and back.
double round_trip(const imager::ImageGeometry& geometry) {
  double farthest = 0;
  for (int row = 0; row < geometry.height; ++row)
    for (int column = 0; column < geometry.width; ++column) {
      const imager::DirectionCosines at = geometry.at(row, column);
      const imager::DirectionCosines back =
          imager::direction_cosines(imager::sky_direction(at, geometry.phase_centre), geometry.phase_centre);
      farthest = std::max(farthest, std::hypot(back.l - at.l, back.m - at.m) / geometry.cell_rad);
    }
  return farthest;
}

DataTable round_trips() {
  DataTable table{.name = "poles",
                  .title = "From pixels to the sky and back",
                  .caption =
                      "The farthest that a pixel of 64² comes from itself, in pixels. Declinations are rounded to doubles, "
                      "1.1 × 10⁻¹⁶ rad near the poles.",
                  .columns = {"declination of the phase centre", "pixels of 1″", "pixels of 1°"},
                  .rows = {}};
  constexpr double degree = imager::pi / 180, arcsec = degree / 3600;
  for (const auto& [name, dec_rad] : {std::pair("+90°", pole_rad), std::pair("1 mas off it", pole_rad - arcsec / 1000),
                                      std::pair("0°", 0.0), std::pair("−90°", -pole_rad)})
    table.rows.push_back({std::string(name), round_trip(field_at(dec_rad, arcsec)), round_trip(field_at(dec_rad, degree))});
  return table;
}

}  // namespace

std::vector<StabilityCase> pole_cases(const StabilityData& data) {
  return {case_of("declination +90°", data.block, field_at(pole_rad, data.cell_rad())),
          case_of("declination −90°", data.block, field_at(-pole_rad, data.cell_rad()))};
}

ReportSection poles_section(const StabilityData& data) {
  return {
      .heading = "Whole runs: phase centres at the poles",
      .paragraphs = {"Right ascension there is a mere direction on the sky: that of the phase centre says where north is up."},
      .figures = {},
      .tables = {round_trips(), outcome_table("pole-images", "Images at the poles", run_cases(pole_cases(data)))}};
}

}  // namespace misfit::tools
