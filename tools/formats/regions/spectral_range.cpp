#include "tools/formats/regions/spectral_range.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "imager/numerics/constants.h"
#include "ms_io/capitals.h"
#include "ms_io/spectral_frame.h"
#include "tools/base/numbers.h"
#include "tools/base/quantity.h"
#include "tools/base/text.h"
#include "tools/formats/regions/words.h"

namespace misfit::tools::regions {
namespace {

using Kind = SpectralRange::Kind;

constexpr const char* ranges_known =
    "two channels, two frequencies or two velocities, each with its unit, such as [3chan, 7chan], [1.42GHz, 1.421GHz] or "
    "[-10km/s, 20km/s]";

/// FITS SPECSYS of the keyword `frame`; empty where there is none.
std::string frame_of(const RegionKeywords& keywords) {
  const std::string frame = value_of(keywords, "frame");
  return frame.empty() ? "" : ms_io::capitals(frame) == "REST" ? "SOURCE" : ms_io::parse_spectral_frame(frame);
}

std::string velocity_type(const RegionKeywords& keywords) {
  const std::string type = ms_io::capitals(value_of(keywords, "veltype"));
  for (const char* known : {"", "RADIO", "OPTICAL", "Z", "BETA", "GAMMA"})
    if (type == known) return type.empty() ? "RADIO" : type;
  refuse_value(keywords, "veltype", "one of RADIO, OPTICAL, Z, BETA, GAMMA");
}

/// The frequency of `restfreq`; 0 where there is none.
double rest_frequency_hz(const RegionKeywords& keywords) {
  const std::string rest = value_of(keywords, "restfreq"), expected = "a frequency above 0, such as 1.420405752GHz";
  if (rest.empty()) return 0;
  double hz = 0;
  try {
    if (has_unit(rest)) hz = parse_frequency_hz(rest);
  } catch (const std::invalid_argument&) {
  }
  if (!(hz > 0)) refuse_value(keywords, "restfreq", expected);
  return hz;
}

/// f/f_rest at a velocity of this type.
double frequency_ratio(double velocity_m_s, const std::string& type) {
  const double beta = velocity_m_s / imager::speed_of_light_m_s;
  if (type == "RADIO") return 1 - beta;
  return type == "BETA" ? std::sqrt((1 - beta) / (1 + beta)) : 1 / (1 + beta);
}

/// "[a, b]".
std::pair<std::string, std::string> ends_of(const RegionKeywords& keywords) {
  const std::string range = value_of(keywords, "range");
  const std::size_t comma = range.find(',');
  if (!range.starts_with('[') || !range.ends_with(']') || comma == std::string::npos)
    refuse_value(keywords, "range", ranges_known);
  return {std::string(trimmed(std::string_view(range).substr(1, comma - 1))),
          std::string(trimmed(std::string_view(range).substr(comma + 1, range.size() - comma - 2)))};
}

/// One end of a range; nothing where `text` is none.
std::optional<std::pair<Kind, double>> end_of(std::string_view text) {
  for (const std::string_view unit : {"channel", "chan"})
    if (text.ends_with(unit)) {
      const auto number = finite_number(trimmed(text.substr(0, text.size() - unit.size())));
      return number ? std::optional(std::pair(Kind::channels, *number)) : std::nullopt;
    }
  const std::string quantity(text);
  try {
    if (text.ends_with("/s")) return std::pair(Kind::velocities, parse_velocity_m_s(quantity));
    if (has_unit(quantity)) return std::pair(Kind::frequencies, parse_frequency_hz(quantity));
  } catch (const std::invalid_argument&) {
  }
  return {};
}

void check_ends(const RegionKeywords& keywords, const SpectralRange& range) {
  const std::string type = velocity_type(keywords);
  for (const double end : {range.one, range.other}) {
    if (range.kind == Kind::channels && !(end >= 0 && end == std::floor(end)))
      refuse_value(keywords, "range", "whole channels, counted from 0");
    if (range.kind == Kind::frequencies && !(end > 0)) refuse_value(keywords, "range", "frequencies above 0");
    if (range.kind != Kind::velocities) continue;
    if (type == "GAMMA") refuse_value(keywords, "veltype", "RADIO, OPTICAL, Z or BETA: a velocity by its γ has no direction");
    const double ratio = frequency_ratio(end, type);
    if (!(ratio > 0 && std::isfinite(ratio)))
      refuse_value(keywords, "range", "velocities of type " + type + " at which the line has a frequency above 0");
  }
  if (range.kind == Kind::channels && range.one > range.other) refuse_value(keywords, "range", "the lower channel first");
}

void check_frame(const RegionKeywords& keywords, const imager::SpectralAxis& axis) {
  const std::string frame = frame_of(keywords);
  if (frame.empty() || frame == axis.frame) return;
  if (axis.frame.empty()) refuse_value(keywords, "frame", "none: the frame of the image's frequencies is not known");
  refuse_value(keywords, "frame",
               "the image's, " + axis.frame +
                   (frame == "SOURCE" ? ": that at rest in the source takes the source's velocity, which nothing names" : ""));
}

/// The planes in words, for errors.
std::string planes_text(const imager::SpectralAxis& axis) {
  const imager::FrequencyBand band = axis.band();
  return frequency_text(band.low_hz, 8) + " to " + frequency_text(band.high_hz, 8);
}

/// The fractional planes of a range's ends.
std::pair<double, double> fractional_planes(const SpectralRange& range, const RegionKeywords& keywords,
                                            const imager::SpectralAxis& axis) {
  if (range.kind == Kind::channels) return {range.one, range.other};
  check_frame(keywords, axis);
  const double named_hz = rest_frequency_hz(keywords), rest_hz = named_hz > 0 ? named_hz : axis.rest_frequency_hz;
  const std::string type = velocity_type(keywords);
  if (range.kind == Kind::velocities && !(rest_hz > 0))
    refuse_value(keywords, "range", "restfreq beside velocities, or --restfreq for the image");
  const auto plane = [&](double end) {
    const double at = axis.plane_of(range.kind == Kind::frequencies ? end : rest_hz * frequency_ratio(end, type));
    return std::isnan(at) ? 0 : at;  // at the frequency of a plane without width
  };
  const double one = plane(range.one), other = plane(range.other);
  return {std::min(one, other), std::max(one, other)};
}

}  // namespace

std::optional<SpectralRange> spectral_range(const RegionKeywords& keywords) {
  frame_of(keywords);
  velocity_type(keywords);
  rest_frequency_hz(keywords);
  if (value_of(keywords, "range").empty()) return {};
  const auto [first, second] = ends_of(keywords);
  const auto one = end_of(first), other = end_of(second);
  if (!one || !other || one->first != other->first) refuse_value(keywords, "range", ranges_known);
  const SpectralRange range{one->first, one->second, other->second};
  check_ends(keywords, range);
  return range;
}

PlaneSpan planes_of_range(const RegionKeywords& keywords, const imager::SpectralAxis& axis) {
  const std::optional<SpectralRange> range = spectral_range(keywords);
  if (!range) return {0, axis.channels - 1};
  const auto [low, high] = fractional_planes(*range, keywords, axis);
  constexpr double rounding = 1e-6;  // of a plane: a range that ends where a plane begins does not reach into it
  PlaneSpan span;
  span.first = static_cast<int>(std::clamp(std::floor(low + 0.5 + rounding), 0.0, 1.0 * axis.channels));
  span.last = static_cast<int>(std::clamp(std::ceil(high - 0.5 - rounding), -1.0, axis.channels - 1.0));
  if (axis.channels == 1 && !span.holds(0))
    refuse_value(keywords, "range", "one that reaches into the image's only plane, " + planes_text(axis) + ", or none");
  span.beyond = range->kind == Kind::channels && range->other >= axis.channels;
  return span;
}

}  // namespace misfit::tools::regions
