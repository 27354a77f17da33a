#include "tools/formats/region_keywords.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "imager/constants.h"
#include "ms_io/spectral_frame.h"
#include "tools/base/numbers.h"
#include "tools/base/quantity.h"
#include "tools/base/text.h"

namespace misfit::tools {
namespace {

const std::string ranges_known =
    "expected two channels, frequencies or velocities, such as [3chan, 7chan], [1.42GHz, 1.421GHz] or [-10km/s, 20km/s]";

/// Empty where there is none.
std::string value_of(const RegionKeywords& keywords, const std::string& name) {
  const auto found = keywords.find(name);
  return found == keywords.end() ? "" : found->second;
}

/// Throws what `keyword` is and `what` was expected.
[[noreturn]] void refuse(const std::string& keyword, const std::string& value, const std::string& what) {
  throw std::runtime_error("'" + keyword + "=" + value + "', " + what);
}

/// From the velocities of a range to frequencies.
class Doppler {
 public:
  Doppler(const RegionKeywords& keywords, const imager::SpectralAxis& axis) : rest_hz_(axis.rest_frequency_hz) {
    const std::string type = value_of(keywords, "veltype"), rest = value_of(keywords, "restfreq");
    optical_ = type == "OPTICAL";
    if (!type.empty() && type != "RADIO" && !optical_) refuse("veltype", type, "expected RADIO or OPTICAL");
    if (!rest.empty() && !has_unit(rest)) refuse("restfreq", rest, "expected a frequency such as 1.420405752GHz");
    if (!rest.empty()) rest_hz_ = parse_frequency_hz(rest);
    if (!(rest_hz_ > 0))
      refuse("range", value_of(keywords, "range"), "expected restfreq beside velocities, or --restfreq for the image");
  }

  double frequency_hz(double velocity_m_s) const {
    const double beta = velocity_m_s / imager::speed_of_light_m_s;
    return optical_ ? rest_hz_ / (1 + beta) : rest_hz_ * (1 - beta);
  }

 private:
  double rest_hz_;
  bool optical_ = false;
};

void check_spectral_frame(const RegionKeywords& keywords, const imager::SpectralAxis& axis) {
  const std::string frame = value_of(keywords, "frame");
  if (frame.empty() || axis.frame.empty() || ms_io::parse_spectral_frame(frame) == axis.frame) return;
  refuse("frame", frame, "expected the image's, " + axis.frame);
}

/// "3chan", "3channel" or "3"; nothing where it is none.
std::optional<double> channel_number(std::string_view text) {
  for (const std::string_view unit : {"channel", "chan"})
    if (text.ends_with(unit)) text.remove_suffix(unit.size());
  return finite_number(trimmed(text));
}

/// The fractional plane of a frequency or a velocity.
double plane_at(const std::string& text, const RegionKeywords& keywords, const imager::SpectralAxis& axis) {
  if (!has_unit(text)) throw std::invalid_argument(text + " without a unit");
  const bool velocity = text.ends_with("/s");
  const double hz = velocity ? Doppler(keywords, axis).frequency_hz(parse_velocity_m_s(text)) : parse_frequency_hz(text);
  const double plane = axis.plane_of(hz);
  return std::isnan(plane) ? 0 : plane;  // at the frequency of a plane without width
}

/// "[a, b]".
std::pair<std::string, std::string> ends_of(const std::string& range) {
  const std::size_t comma = range.find(',');
  if (!range.starts_with('[') || !range.ends_with(']') || comma == std::string::npos) refuse("range", range, ranges_known);
  return {std::string(trimmed(std::string_view(range).substr(1, comma - 1))),
          std::string(trimmed(std::string_view(range).substr(comma + 1, range.size() - comma - 2)))};
}

/// What the planes are, for errors.
std::string planes_text(const imager::SpectralAxis& axis) {
  const double half = 0.5 * axis.width_hz() * axis.channels;
  const double middle = 0.5 * (axis.frequency_hz(0) + axis.frequency_hz(axis.channels - 1));
  return frequency_text(middle - half, 8) + " to " + frequency_text(middle + half, 8);
}

}  // namespace

RegionKeywords parse_region_keywords(std::string_view text) {
  RegionKeywords keywords;
  const auto add = [&](std::string_view one) {
    const std::size_t equals = one.find('=');
    if (equals == std::string_view::npos) return;
    keywords[std::string(trimmed(one.substr(0, equals)))] = trimmed(one.substr(equals + 1));
  };
  int depth = 0;
  char quote = 0, before = 0;  // of what is quoted; the last that is no blank
  std::size_t begin = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quote != 0) {
      if (c == quote) quote = 0;
      continue;
    }
    if (before == '=' && (c == '\'' || c == '"')) quote = c;  // elsewhere it is an apostrophe
    if (c != ' ') before = c;
    depth = std::max(0, depth + (c == '[' ? 1 : c == ']' ? -1 : 0));
    if (c != ',' || depth > 0) continue;
    add(text.substr(begin, i - begin));
    begin = i + 1;
  }
  add(text.substr(begin));
  return keywords;
}

PlaneSpan planes_of_range(const RegionKeywords& keywords, const imager::SpectralAxis& axis) {
  const std::string range = value_of(keywords, "range");
  if (range.empty()) return {0, axis.channels - 1};
  const auto [one, other] = ends_of(range);
  const std::optional<double> channel = channel_number(one), last_channel = channel_number(other);
  double low = channel.value_or(0), high = last_channel.value_or(0);
  if (channel.has_value() != last_channel.has_value()) refuse("range", range, ranges_known);
  if (!channel) {
    check_spectral_frame(keywords, axis);
    try {
      low = plane_at(one, keywords, axis);
      high = plane_at(other, keywords, axis);
    } catch (const std::invalid_argument&) {
      refuse("range", range, ranges_known);
    }
  }
  if (low > high) std::swap(low, high);
  constexpr double rounding = 1e-6;  // of a plane: a range that ends where a plane begins does not reach into it
  PlaneSpan span;
  span.first = static_cast<int>(std::clamp(std::floor(low + 0.5 + rounding), 0.0, 1.0 * axis.channels));
  span.last = static_cast<int>(std::clamp(std::ceil(high - 0.5 - rounding), -1.0, axis.channels - 1.0));
  if (axis.channels == 1 && !span.holds(0))
    refuse("range", range, "expected one that reaches into the image's only plane, " + planes_text(axis) + ", or none");
  return span;
}

}  // namespace misfit::tools
