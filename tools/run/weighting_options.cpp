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
constexpr int largest_box = 200;  ///< of superuniform weights and the rank filter

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

/// A limit in the uv plane, or the width of its edge; throws std::invalid_argument that names the option.
double distance_lambda(const std::string& option, const std::string& value) {
  const std::string expected = "more than 0 wavelengths, such as 3klambda or 3000";
  double distance = 0;
  try {
    distance = parse_uv_distance_lambda(value);
  } catch (const std::invalid_argument& wrong) {
    refuse_option(option, value, expected + "; " + wrong.what());
  }
  if (!(distance > 0)) refuse_option(option, value, expected);
  return distance;
}

imager::UvWindow window_of(const TypedWeighting& o) {
  imager::UvWindow window;
  const auto set = [](double& wavelengths, const char* option, const std::string& value) {
    if (!value.empty()) wavelengths = distance_lambda(option, value);
  };
  set(window.min_lambda, "minuv-l", o.minuv_l);
  set(window.max_lambda, "maxuv-l", o.maxuv_l);
  set(window.inner_edge_lambda, "taper-inner-tukey", o.taper_inner_tukey);
  set(window.outer_edge_lambda, "taper-tukey", o.taper_tukey);
  if (window.min_lambda >= window.max_lambda) refuse_option("minuv-l", o.minuv_l, "less than --maxuv-l " + o.maxuv_l);
  if (window.outer_edge_lambda > 0 && o.maxuv_l.empty())
    refuse_option("taper-tukey", o.taper_tukey, "--maxuv-l beside it, where the taper ends");
  return window;
}

/// The options by which weights depend on where in the uv plane a sample lies, as they are typed.
std::vector<std::string> taper_arguments(const TypedWeighting& o) {
  std::vector<std::string> words;
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) words.insert(words.end(), {option, value});
  };
  add("--uvtaper", o.uvtaper);
  add("--minuv-l", o.minuv_l);
  add("--maxuv-l", o.maxuv_l);
  add("--taper-tukey", o.taper_tukey);
  add("--taper-inner-tukey", o.taper_inner_tukey);
  return words;
}

/// "5klambda", also where the unit is left out.
std::string with_lambda(const std::string& distance) {
  return has_unit(distance) ? distance : distance + "lambda";
}

/// ", tapered by 5arcsec, from 80lambda, up to 7klambda with a Tukey edge of 1klambda".
std::string taper_text(const TypedWeighting& o) {
  const auto edge = [](const std::string& width) { return width.empty() ? "" : " with a Tukey edge of " + with_lambda(width); };
  std::string said;
  if (!o.uvtaper.empty()) said += ", tapered by " + o.uvtaper;
  if (!o.minuv_l.empty() || !o.taper_inner_tukey.empty())
    said += ", from " + with_lambda(o.minuv_l.empty() ? "0" : o.minuv_l) + edge(o.taper_inner_tukey);
  if (!o.maxuv_l.empty()) said += ", up to " + with_lambda(o.maxuv_l) + edge(o.taper_tukey);
  return said;
}

/// The words on taper and window, besides weighing by density.
std::string taper_reason(const TypedWeighting& o) {
  std::string said = o.uvtaper.empty() ? "" : " times a Gaussian";
  if (!o.minuv_l.empty() || !o.maxuv_l.empty()) said += ", 0 outside the limits in the uv plane";
  if (!o.taper_tukey.empty() || !o.taper_inner_tukey.empty()) said += ", with the edges of a Tukey window";
  return said;
}

std::string cells_text(const imager::ImageGeometry& geometry) {
  const imager::UvCells cells(geometry);
  return std::to_string(geometry.width) + " × " + std::to_string(geometry.height) + " cells of " +
         significant(cells.width_lambda(), 3) + " × " + significant(cells.height_lambda(), 3) + " λ";
}

/// The divisor of a sample's weight, in words.
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

/// Says whose samples a density counts, where there are several pointings.
std::string pointings_text(const TypedWeighting& o, std::size_t pointings) {
  if (pointings <= 1) return "";
  const std::string all = std::to_string(pointings) + " pointings";
  return o.mosweight ? "; each of the " + all + " has its own density" : "; the density is that of all " + all + " together";
}

void check_rank_filter(const TypedWeighting& o) {
  const std::string option = "weighting-rank-filter", size_option = "weighting-rank-filter-size";
  if (!(o.rank_filter >= 0 && std::isfinite(o.rank_filter)))
    refuse_option(option, typed(o.rank_filter), "a number above 0, such as 3, or 0 (none)");
  const std::string size = std::to_string(o.rank_filter_size);
  if (o.rank_filter_size < 2 || o.rank_filter_size > largest_box)
    refuse_option(size_option, size, "2 to " + std::to_string(largest_box) + " cells");
  if (o.rank_filter == 0 && o.rank_filter_size != TypedWeighting().rank_filter_size)
    refuse_option(size_option, size, "--" + option + " beside it");
  if (o.rank_filter > 0 && (o.scheme == "natural" || o.scheme == "briggsbwtaper"))
    refuse_option(option, typed(o.rank_filter), "--weighting uniform, superuniform, briggs or briggsabs beside it");
}

void check_tapers(const TypedWeighting& o) {
  window_of(o);
  if (o.uvtaper.empty()) return;
  try {
    parse_taper(o.uvtaper);
  } catch (const std::invalid_argument& wrong) {
    refuse_option("uvtaper", o.uvtaper,
                  std::string("MAJ, MAJ,MIN or MAJ,MIN,PA such as 5arcsec,4arcsec,30deg or 3klambda; ") + wrong.what());
  }
}

/// ", f² = 0.0123", or its range over pointings; "" where there is none.
std::string f2_text(const imager::F2Range& f2) {
  if (f2.largest == 0) return "";
  const std::string least = significant(f2.least, 4), largest = significant(f2.largest, 4);
  return least == largest ? ", f² = " + least : ", f² from " + least + " to " + largest;
}

}  // namespace

void declare(CLI::App& command, TypedWeighting& o) {
  command
      .add_option("--weighting", o.scheme,
                  "natural, uniform, superuniform, briggs, briggsbwtaper or briggsabs, as in tclean. briggsbwtaper weighs the "
                  "planes of a cube about as an image of the whole band is weighed")
      ->check(CLI::IsMember({"natural", "uniform", "superuniform", "briggs", "briggsbwtaper", "briggsabs"}));
  command.add_option("--robust", o.robust,
                     "Robustness of briggs and briggsbwtaper, from -2 (nearly uniform) to 2 (nearly natural); for briggsabs R, "
                     "from -2 to 2, whose sign makes no difference");
  command.add_option("--noise", o.noise, "Noise of a visibility that --weighting briggsabs assumes; Jy without a unit")
      ->check(quantity(parse_flux_jy));
  command.add_option(
      "--npixels", o.npixels,
      "--weighting superuniform sums the density over the cells from -npixels/2 to npixels/2 about a sample's cell; 0 means 6");
  command.add_option("--weighting-rank-filter", o.rank_filter,
                     "Limit how much uniform, superuniform, briggs or briggsabs raises weights: the factor of a cell is at "
                     "most this many times the mean factor of the cells with samples about it; 0 means no limit");
  command.add_option("--weighting-rank-filter-size", o.rank_filter_size,
                     "--weighting-rank-filter takes the mean from -SIZE/2 to SIZE/2 cells about a cell");
  command
      .add_option("--mosweight", o.mosweight,
                  "true: a mosaic's weights follow from the density of each pointing's own samples; false: from the density of "
                  "all pointings' samples together. Natural weights do not depend on it")
      ->default_str("true")
      ->check(CLI::IsMember({"true", "false"}, CLI::ignore_case));
  command.add_option("--uvtaper", o.uvtaper,
                     "Taper by a Gaussian, MAJ[,MIN[,PA]]: its full width at half maximum on the sky, such as 5arcsec, or its "
                     "half width at half maximum in the uv plane, such as 3klambda; no taper when empty");
  command.add_option("--minuv-l", o.minuv_l,
                     "Give weight 0 to samples nearer to u = v = 0 than this many wavelengths at their channel's frequency, "
                     "such as 80 or 3klambda; the density still counts them");
  command.add_option("--maxuv-l", o.maxuv_l,
                     "Give weight 0 to samples farther from u = v = 0 than this many wavelengths at their channel's frequency; "
                     "the density still counts them");
  command.add_option("--taper-tukey", o.taper_tukey,
                     "Let weights fall to 0 at --maxuv-l along half a period of a cosine, this many wavelengths wide");
  command.add_option("--taper-inner-tukey", o.taper_inner_tukey,
                     "Let weights rise from 0 at --minuv-l, or at u = v = 0 without it, along half a period of a cosine, this "
                     "many wavelengths wide");
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
  if (o.npixels < 0 || o.npixels == 1 || o.npixels > largest_box)
    refuse_option("npixels", std::to_string(o.npixels), "2 to " + std::to_string(largest_box) + " cells, or 0 (6)");
  if (!superuniform && o.npixels != 0)
    refuse_option("npixels", std::to_string(o.npixels), "--weighting superuniform beside it");
  if (cube.is_cube() && !cube.perchanweightdensity && o.scheme == "natural")
    refuse_option("perchanweightdensity", "false", "weights by density beside it, such as --weighting briggs");
  if (!o.mosweight && o.scheme == "natural")
    refuse_option("mosweight", "false", "weights by density beside it, such as --weighting briggs");
  check_rank_filter(o);
  check_tapers(o);
}

imager::WeightingOptions weighting_options(const TypedWeighting& o, std::size_t pointings) {
  imager::WeightingOptions options;
  options.weighting = weighting_of(o.scheme);
  options.robust = o.robust;
  options.noise_jy = parse_flux_jy(o.noise);
  options.box_reach = box_reach(o);
  if (!o.uvtaper.empty()) options.taper = parse_taper(o.uvtaper);
  options.window = window_of(o);
  if (o.rank_filter > 0) options.rank_filter = {o.rank_filter, o.rank_filter_size / 2};
  if (o.mosweight && options.needs_density()) options.pointings = pointings;
  return options;
}

/// The bandwidth is taken between the middles of the outermost planes, as in CASA.
imager::WeightingOptions weighting_options(const TypedWeighting& o, const imager::SpectralAxis& cube, std::size_t pointings) {
  imager::WeightingOptions options = weighting_options(o, pointings);
  const double first = cube.frequency_hz(0), last = cube.frequency_hz(cube.channels - 1);
  options.fractional_bandwidth = 2 * std::abs(last - first) / (last + first);
  return options;
}

std::string weighting_text(const TypedWeighting& o) {
  std::string said = o.scheme == "briggs" ? "Briggs, robust " + typed(o.robust) : o.scheme;
  if (o.scheme == "briggsbwtaper" || o.scheme == "briggsabs") said += ", robust " + typed(o.robust);
  if (o.scheme == "briggsabs") said += ", noise " + o.noise;
  if (o.rank_filter > 0) said += ", rank filter " + typed(o.rank_filter);
  return said + taper_text(o);
}

std::vector<std::string> weighting_arguments(const TypedWeighting& o) {
  std::vector<std::string> words{"--weighting", o.scheme};
  if (o.scheme.rfind("briggs", 0) == 0) words.insert(words.end(), {"--robust", typed(o.robust)});
  if (o.scheme == "briggsabs") words.insert(words.end(), {"--noise", o.noise});
  if (o.npixels != 0) words.insert(words.end(), {"--npixels", std::to_string(o.npixels)});
  if (o.rank_filter > 0)
    words.insert(words.end(), {"--weighting-rank-filter", typed(o.rank_filter), "--weighting-rank-filter-size",
                               std::to_string(o.rank_filter_size)});
  if (!o.mosweight) words.insert(words.end(), {"--mosweight", "false"});
  const std::vector<std::string> tapers = taper_arguments(o);
  words.insert(words.end(), tapers.begin(), tapers.end());
  return words;
}

void require_weight(const TypedWeighting& o, const imager::WeightSums& sums, std::uint64_t samples, const std::string& of) {
  const std::vector<std::string> tapers = taper_arguments(o);
  if (tapers.empty() || sums.outweigh_least(samples)) return;
  std::string words, expected;
  for (const std::string& word : tapers) words += (words.empty() ? "" : " ") + word;
  if (tapers.size() > 2 || o.uvtaper.empty()) expected = "limits in the uv plane that samples lie well within";
  if (!o.uvtaper.empty())
    expected +=
        (expected.empty() ? "" : ", and ") + std::string("a taper of larger radius in the uv plane, or a smaller angle");
  throw std::runtime_error(words + ": no sample" + of + " keeps a weight that counts; expected " + expected);
}

imager::Decision weighting_decision(const TypedWeighting& o, const imager::ImageGeometry& geometry, std::size_t pointings) {
  const std::string tapered = taper_reason(o);
  if (!weighting_options(o).needs_density())
    return {"weighting", weighting_text(o),
            "weights of the data" + (tapered.empty() ? " as they are, which give the least noise" : tapered)};
  std::string filter;
  if (o.rank_filter > 0) {
    const std::string side = std::to_string(o.rank_filter_size / 2 * 2 + 1);
    filter = "; no cell's factor is above " + typed(o.rank_filter) + " times the mean of those in the " + side + " × " + side +
             " cells about it";
  }
  return {"weighting", weighting_text(o),
          "weights of the data " + divisor_text(o) + pointings_text(o, pointings) + filter + "; the image's uv grid has " +
              cells_text(geometry)};
}

imager::Decision weights_decision(const imager::ImagingWeights& weights, const imager::WeightSums& sums) {
  std::string because = "noise of " + with_prefix(sums.noise_jy(), "Jy/beam", 3) + " against " +
                        with_prefix(sums.natural_noise_jy(), "Jy/beam", 3) + " predicted from the weights";
  if (weights.cells_filled() > 0)
    because += "; " + grouped(static_cast<long long>(weights.cells_filled())) + " cells of half the uv plane hold samples";
  if (weights.pointings() > 1) because += ", each counted for every pointing that has samples there";
  because += f2_text(weights.f2());
  return {"weights", significant(sums.noise_jy() / sums.natural_noise_jy(), 4) + " times the noise of natural weights",
          because};
}

}  // namespace misfit::tools
