#include "tools/run/weighting_options.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "tools/base/numbers.h"
#include "tools/base/option_checks.h"
#include "tools/base/quantity.h"
#include "tools/base/text.h"

namespace misfit::tools {
namespace {

using imager::Weighting;

constexpr double default_robust = 0.5;
constexpr int default_npixels = 6;

Weighting weighting_of(const std::string& name) {
  if (name == "uniform") return Weighting::uniform;
  if (name == "superuniform") return Weighting::superuniform;
  if (name == "briggsabs") return Weighting::briggs_abs;
  if (name == "briggsbwtaper") return Weighting::briggs_bandwidth_taper;
  return name == "briggs" ? Weighting::briggs : Weighting::natural;
}

int box_reach(const TypedWeighting& o) {
  return (o.npixels == 0 ? default_npixels : o.npixels) / 2;
}

bool is_uv_distance(const std::string& quantity) {
  return quantity.ends_with("lambda");
}

/// The taper that `values` name, one to three values; throws std::invalid_argument that shows the one that is wrong.
imager::UvTaper parse_taper(const std::string& values) {
  std::vector<std::string> parts;
  for (const std::string_view part : split_at_commas(values)) parts.emplace_back(part);
  if (parts.size() > 3) throw std::invalid_argument(std::to_string(parts.size()) + " values");
  const bool uv = is_uv_distance(parts[0]);
  if (parts.size() > 1 && is_uv_distance(parts[1]) != uv) throw std::invalid_argument("an angle beside wavelengths");
  const auto size = [&](std::size_t i) {
    const double value = uv ? parse_uv_distance_lambda(parts[i]) : parse_angle_rad(parts[i]);
    if (!(value > 0)) throw std::invalid_argument("'" + parts[i] + "' is not above 0");
    return value;
  };
  const double first = size(0), second = parts.size() > 1 ? size(1) : first;
  if (parts.size() > 2 && !has_unit(parts[2])) throw std::invalid_argument("position angle '" + parts[2] + "' has no unit");
  const double angle = parts.size() > 2 ? parse_angle_rad(parts[2]) : 0;
  return uv ? imager::taper_of_radii({first, second, angle}) : imager::taper_of_beam({first, second, angle});
}

std::string cells_text(const imager::ImageGeometry& geometry) {
  const imager::UvCells cells(geometry);
  return std::to_string(geometry.width) + " × " + std::to_string(geometry.height) + " cells of " +
         significant(cells.width_lambda(), 3) + " × " + significant(cells.height_lambda(), 3) + " λ";
}

/// By what the weight of a sample is divided.
std::string divisor_text(const TypedWeighting& o) {
  if (o.scheme == "uniform") return "divided by the weight of all samples and conjugates in the cell";
  if (o.scheme == "briggs") return "divided by 1 + f² times the weight of all samples and conjugates in the cell";
  if (o.scheme == "briggsbwtaper")
    return "divided by 1 + f²/m times the weight of all samples and conjugates in the cell; m grows with the bandwidth of the "
           "cube times the distance in the uv plane";
  if (o.scheme == "briggsabs")
    return "divided by " + typed(o.robust * o.robust) + " times the weight of all samples and conjugates in the cell and 2 (" +
           o.noise + ")²";
  const std::string side = std::to_string(2 * box_reach(o) + 1);
  return "divided by the weight of all samples and conjugates in the " + side + " × " + side + " cells about it";
}

}  // namespace

void declare(CLI::App& command, TypedWeighting& o) {
  command
      .add_option("--weighting", o.scheme,
                  "natural, uniform, superuniform, briggs, briggsbwtaper (of a cube: its planes are weighed about as its whole "
                  "band would be) or briggsabs, as tclean has them")
      ->check(CLI::IsMember({"natural", "uniform", "superuniform", "briggs", "briggsbwtaper", "briggsabs"}));
  command.add_option("--robust", o.robust,
                     "Of briggs and briggsbwtaper: from -2, nearly uniform, to 2, nearly natural; of briggsabs R, "
                     "whose sign makes no difference");
  command.add_option("--noise", o.noise, "Of briggsabs, in Jy without a unit")->check(quantity(parse_flux_jy));
  command.add_option("--npixels", o.npixels,
                     "Of superuniform: density is summed from -npixels/2 to npixels/2 cells about a sample's; 0 means 6");
  command.add_option("--uvtaper", o.uvtaper,
                     "Taper by a Gaussian, MAJ[,MIN[,PA]]: its full width at half maximum on the sky, such as 5arcsec, or its "
                     "half width in the uv plane, such as 3klambda; none when empty");
}

void check(const TypedWeighting& o, const CubeOptions& cube) {
  const bool briggs = o.scheme.rfind("briggs", 0) == 0, superuniform = o.scheme == "superuniform";
  if (!(o.robust >= -2 && o.robust <= 2)) refuse_option("robust", typed(o.robust), "-2 to 2");
  if (!briggs && o.robust != default_robust) refuse_option("robust", typed(o.robust), "--weighting briggs beside it");
  const bool absolute = o.scheme == "briggsabs";
  if (absolute && !(parse_flux_jy(o.noise) >= 0)) refuse_option("noise", o.noise, "0 or more");
  constexpr double least_jy = 1e-12;  // single precision has its inverse square
  if (absolute && std::abs(o.robust) < least_jy && parse_flux_jy(o.noise) < least_jy)
    refuse_option("noise", o.noise, "1e-12Jy or more, or --robust other than 0");
  if (!absolute && o.noise != TypedWeighting().noise) refuse_option("noise", o.noise, "--weighting briggsabs beside it");
  if (o.scheme == "briggsbwtaper" && (!cube.is_cube() || !cube.perchanweightdensity))
    refuse_option("weighting", o.scheme,
                  "--specmode cube beside it" + std::string(cube.is_cube() ? ", with --perchanweightdensity true" : ""));
  constexpr int most = 200;
  if (o.npixels < 0 || o.npixels == 1 || o.npixels > most)
    refuse_option("npixels", std::to_string(o.npixels), "2 to " + std::to_string(most) + " cells, or 0 (6)");
  if (!superuniform && o.npixels != 0)
    refuse_option("npixels", std::to_string(o.npixels), "--weighting superuniform beside it");
  if (cube.is_cube() && !cube.perchanweightdensity && o.scheme == "natural")
    refuse_option("perchanweightdensity", "false", "weights by density beside it, such as --weighting briggs");
  if (o.uvtaper.empty()) return;
  try {
    parse_taper(o.uvtaper);
  } catch (const std::invalid_argument& wrong) {
    refuse_option("uvtaper", o.uvtaper,
                  std::string("MAJ, MAJ,MIN or MAJ,MIN,PA such as 5arcsec,4arcsec,30deg or 3klambda; ") + wrong.what());
  }
}

imager::WeightingOptions weighting_options(const TypedWeighting& o) {
  imager::WeightingOptions options;
  options.weighting = weighting_of(o.scheme);
  options.robust = o.robust;
  options.noise_jy = parse_flux_jy(o.noise);
  options.box_reach = box_reach(o);
  if (!o.uvtaper.empty()) options.taper = parse_taper(o.uvtaper);
  return options;
}

/// Between the middles of the outermost planes, as CASA has it.
imager::WeightingOptions weighting_options(const TypedWeighting& o, const imager::SpectralAxis& cube) {
  imager::WeightingOptions options = weighting_options(o);
  const double first = cube.frequency_hz(0), last = cube.frequency_hz(cube.channels - 1);
  options.fractional_bandwidth = 2 * std::abs(last - first) / (last + first);
  return options;
}

std::string weighting_text(const TypedWeighting& o) {
  std::string said = o.scheme == "briggs" ? "Briggs, robust " + typed(o.robust) : o.scheme;
  if (o.scheme == "briggsbwtaper" || o.scheme == "briggsabs") said += ", robust " + typed(o.robust);
  if (o.scheme == "briggsabs") said += ", noise " + o.noise;
  if (!o.uvtaper.empty()) said += ", tapered by " + o.uvtaper;
  return said;
}

std::vector<std::string> weighting_arguments(const TypedWeighting& o) {
  std::vector<std::string> words{"--weighting", o.scheme};
  if (o.scheme.rfind("briggs", 0) == 0) words.insert(words.end(), {"--robust", typed(o.robust)});
  if (o.scheme == "briggsabs") words.insert(words.end(), {"--noise", o.noise});
  if (o.npixels != 0) words.insert(words.end(), {"--npixels", std::to_string(o.npixels)});
  if (!o.uvtaper.empty()) words.insert(words.end(), {"--uvtaper", o.uvtaper});
  return words;
}

imager::Decision weighting_decision(const TypedWeighting& o, const imager::ImageGeometry& geometry) {
  if (weighting_options(o).needs_density())
    return {"weighting", weighting_text(o),
            "weights of the data " + divisor_text(o) + "; the image's uv grid has " + cells_text(geometry)};
  return {"weighting", weighting_text(o),
          o.uvtaper.empty() ? "weights of the data as they are, which give the least noise"
                            : "weights of the data times a Gaussian"};
}

imager::Decision weights_decision(const imager::ImagingWeights& weights, const imager::WeightSums& sums) {
  std::string because = "noise of " + with_prefix(sums.noise_jy(), "Jy/beam", 3) + " against " +
                        with_prefix(sums.natural_noise_jy(), "Jy/beam", 3) + " predicted from the weights";
  if (weights.cells_filled() > 0)
    because += "; " + grouped(static_cast<long long>(weights.cells_filled())) + " cells of half the uv plane hold samples";
  if (weights.f2() > 0) because += ", f² = " + significant(weights.f2(), 4);
  return {"weights", significant(sums.noise_jy() / sums.natural_noise_jy(), 4) + " times the noise of natural weights",
          because};
}

}  // namespace misfit::tools
