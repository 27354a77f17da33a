#include "tools/run/pixel_plan.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "imager/beams/primary_beam.h"
#include "imager/beams/telescopes.h"
#include "tools/base/numbers.h"
#include "tools/base/quantity.h"
#include "tools/run/dish_beams.h"

namespace misfit::tools {
namespace {

/// Two angles in the unit of the second: "40 to 67 mas", "51.2 × 51.2 arcsec".
std::string angles_text(double one_rad, const std::string& between, double other_rad, int digits) {
  const ScaledUnit unit = angle_unit(other_rad);
  return significant(one_rad / unit.size, digits) + between + significant(other_rad / unit.size, digits) + " " + unit.name;
}

/// The beams of a set's antennas.
struct KnownBeams {
  double narrowest_rad = 0;  ///< FWHM; 0 where none is known
  double widest_rad = 0;
  bool in_doubt = false;
};

KnownBeams known_beams(const ImageOptions& options, const ms_io::MeasurementSet& set) {
  KnownBeams known;
  std::vector<imager::AntennaSort> antennas;
  try {
    antennas = set.antennas();
  } catch (const std::runtime_error&) {  // of ANTENNA, which images do not need
    return known;
  }
  const DishBeams beams(options.primary_beam.beam);
  const double frequency_hz = set.observation().frequency_hz;
  for (std::size_t a = 0; a < antennas.size(); ++a) {
    const auto before = antennas.begin() + static_cast<std::ptrdiff_t>(a);
    if (std::any_of(antennas.begin(), before, [&](const auto& one) { return imager::alike(one, antennas[a]); })) continue;
    try {
      const imager::BeamModel model = beams.of(antennas[a]);
      const double width_rad = imager::PrimaryBeam({{model.pattern, model.pattern, frequency_hz, 1}}).half_power_width_rad();
      known.narrowest_rad = known.narrowest_rad == 0 ? width_rad : std::min(known.narrowest_rad, width_rad);
      known.widest_rad = std::max(known.widest_rad, width_rad);
      known.in_doubt = known.in_doubt || !model.doubt_at(frequency_hz).empty();
    } catch (const imager::NoSimpleBeam&) {
    }
  }
  return known;
}

}  // namespace

std::string cell_words(const ImageOptions& options) {
  return "--cell " + options.cell + (has_unit(options.cell) ? "" : " has no unit, and is in arcsec as in tclean");
}

imager::Decision pixels_decision(const ImageOptions& options, const imager::ImageGeometry& geometry, double longest_lambda) {
  constexpr double fewest = 3, most = 5;  // cells across a beam
  std::string because = cell_words(options);
  if (longest_lambda > 0) {
    const ScaledUnit unit = uv_unit(longest_lambda);
    const double beam_rad = 1 / longest_lambda;
    because += "; the longest baseline, " + significant(longest_lambda / unit.size, 4) + " " + unit.name +
               ", makes a beam of about λ/B = " + angle_text(beam_rad, 3) + ": cells of " +
               angles_text(beam_rad / most, " to ", beam_rad / fewest, 3) + " sample it 3 to 5 times, these " +
               significant(beam_rad / geometry.cell_rad, 2) + " times";
  }
  return {"pixels",
          std::to_string(geometry.width) + " × " + std::to_string(geometry.height) + " of " + angle_text(geometry.cell_rad, 6),
          because};
}

imager::Decision field_decision(const ImageOptions& options, const imager::ImageGeometry& geometry,
                                const ms_io::MeasurementSet& set) {
  const KnownBeams beams = known_beams(options, set);
  std::string because = "pixels times cell";
  if (beams.narrowest_rad > 0)
    because = std::string("primary beam FWHM ") + (beams.in_doubt ? "about " : "") +
              (beams.narrowest_rad < beams.widest_rad ? angles_text(beams.narrowest_rad, " to ", beams.widest_rad, 3)
                                                      : angle_text(beams.widest_rad, 3)) +
              " at " + frequency_text(set.observation().frequency_hz, 4);
  return {"field of view", angles_text(geometry.width * geometry.cell_rad, " × ", geometry.height * geometry.cell_rad, 4),
          because};
}

bool leaves_grid(const imager::UvwReach& reach, const imager::ImageGeometry& geometry) {
  return std::max(reach.max_abs_u, reach.max_abs_v) * geometry.cell_rad > 0.5;
}

std::string keeping_cell_words(const imager::UvwReach& reach) {
  constexpr int digits = 4;
  const double largest_cell_rad = 0.5 / std::max(reach.max_abs_u, reach.max_abs_v);
  const ScaledUnit unit = angle_unit(largest_cell_rad);
  const double size = largest_cell_rad / unit.size, last_digit = std::pow(10, std::floor(std::log10(size)) - (digits - 1));
  return "a cell of " + significant(std::floor(size / last_digit) * last_digit, digits) + unit.name + " would keep them";
}

std::string outside_grid_forecast(const imager::UvwReach& reach) {
  return "samples of the longest baselines lie beyond 1/(2 cell) and may be left out; " + keeping_cell_words(reach);
}

std::string outside_grid_warning(std::uint64_t samples, const imager::UvwReach& reach) {
  return grouped(static_cast<long long>(samples)) + " samples lie beyond 1/(2 cell) and were left out; " +
         keeping_cell_words(reach);
}

}  // namespace misfit::tools
