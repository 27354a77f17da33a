#include "tools/formats/regions/keywords.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "imager/constants.h"
#include "ms_io/spectral_frame.h"
#include "tools/base/numbers.h"
#include "tools/base/quantity.h"
#include "tools/base/text.h"
#include "tools/formats/regions/words.h"

namespace misfit::tools::regions {
namespace {

constexpr std::array<std::string_view, 6> meant{"coord", "corr", "range", "frame", "veltype", "restfreq"};
constexpr std::array<std::string_view, 13> drawn{"color",      "linewidth", "linestyle", "symsize", "symthick",
                                                 "font",       "fontsize",  "fontstyle", "usetex",  "label",
                                                 "labelcolor", "labelpos",  "labeloff"};
constexpr std::array<std::string_view, 32> correlations{
    "I",  "Q",  "U",         "V",         "RR",     "RL",     "LR",      "LL",      "XX",       "XY",    "YX",
    "YY", "RX", "RY",        "LX",        "LY",     "XR",     "XL",      "YR",      "YL",       "PP",    "PQ",
    "QP", "QQ", "RCircular", "LCircular", "Linear", "Ptotal", "Plinear", "PFtotal", "PFlinear", "Pangle"};

template <std::size_t count>
bool contains(const std::array<std::string_view, count>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

template <std::size_t count>
std::string listed(const std::array<std::string_view, count>& names) {
  std::string list;
  for (const std::string_view name : names) list += (list.empty() ? "" : ", ") + std::string(name);
  return list;
}

const std::string ranges_known =
    "two channels, frequencies or velocities, such as [3chan, 7chan], [1.42GHz, 1.421GHz] or [-10km/s, 20km/s]";

/// Empty where there is none.
std::string value_of(const RegionKeywords& keywords, const std::string& name) {
  const auto found = keywords.find(name);
  return found == keywords.end() ? "" : found->second;
}

[[noreturn]] void refuse_keyword(const std::string& name, const std::string& value, const std::string& expected) {
  refuse(name + "=" + value, expected);
}

/// From the velocities of a range to frequencies.
class Doppler {
 public:
  Doppler(const RegionKeywords& keywords, const imager::SpectralAxis& axis) : rest_hz_(axis.rest_frequency_hz) {
    const std::string type = value_of(keywords, "veltype"), rest = value_of(keywords, "restfreq");
    type_ = type.empty() ? "RADIO" : type;
    if (type_ == "GAMMA") refuse_keyword("veltype", type, "RADIO, OPTICAL, Z or BETA: a velocity by its γ has no direction");
    if (!rest.empty() && !has_unit(rest)) refuse_keyword("restfreq", rest, "a frequency such as 1.420405752GHz");
    if (!rest.empty()) rest_hz_ = parse_frequency_hz(rest);
    if (!(rest_hz_ > 0))
      refuse_keyword("range", value_of(keywords, "range"), "restfreq beside velocities, or --restfreq for the image");
  }

  double frequency_hz(double velocity_m_s) const {
    const double beta = velocity_m_s / imager::speed_of_light_m_s;
    if (type_ == "RADIO") return rest_hz_ * (1 - beta);
    return type_ == "BETA" ? rest_hz_ * std::sqrt((1 - beta) / (1 + beta)) : rest_hz_ / (1 + beta);
  }

 private:
  double rest_hz_;
  std::string type_;
};

void check_spectral_frame(const RegionKeywords& keywords, const imager::SpectralAxis& axis) {
  const std::string frame = value_of(keywords, "frame");
  if (frame.empty() || axis.frame.empty() || ms_io::parse_spectral_frame(frame) == axis.frame) return;
  refuse_keyword("frame", frame, "the image's, " + axis.frame);
}

/// Refuses names of frames and velocities that CASA does not know, also where no range needs them.
void check_names(const RegionKeywords& keywords) {
  const std::string frame = value_of(keywords, "frame"), type = value_of(keywords, "veltype");
  if (!frame.empty() && frame != "REST") ms_io::parse_spectral_frame(frame);
  const std::array<std::string_view, 5> velocities{"RADIO", "OPTICAL", "Z", "BETA", "GAMMA"};
  if (!type.empty() && !contains(velocities, type)) refuse_keyword("veltype", type, "one of " + listed(velocities));
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
  if (!range.starts_with('[') || !range.ends_with(']') || comma == std::string::npos)
    refuse_keyword("range", range, ranges_known);
  return {std::string(trimmed(std::string_view(range).substr(1, comma - 1))),
          std::string(trimmed(std::string_view(range).substr(comma + 1, range.size() - comma - 2)))};
}

/// What the planes are, for errors.
std::string planes_text(const imager::SpectralAxis& axis) {
  const double half = 0.5 * axis.width_hz() * axis.channels;
  const double middle = 0.5 * (axis.frequency_hz(0) + axis.frequency_hz(axis.channels - 1));
  return frequency_text(middle - half, 8) + " to " + frequency_text(middle + half, 8);
}

/// Whether `text` begins with the next keyword and its equals sign.
bool begins_keyword(std::string_view text) {
  return !take_word(text).empty() && text.starts_with('=');
}

/// Takes a value off the beginning of `rest`: what stands in quotes, without them, or in brackets, with them, or else what
/// goes up to a comma or the next keyword.
std::string_view take_value(std::string_view& rest) {
  const std::string_view whole = rest;
  const char first = rest.empty() ? '\0' : rest.front();
  if (first == '\'' || first == '"' || first == '[') {
    const std::size_t end = rest.find(first == '[' ? ']' : first, 1);
    if (end == std::string_view::npos) refuse(whole, first == '[' ? "a closing bracket" : "a closing quote");
    rest.remove_prefix(end + 1);
    return first == '[' ? whole.substr(0, end + 1) : trimmed(whole.substr(1, end - 1));
  }
  std::size_t end = std::min(rest.find_first_of(", \t"), rest.size());
  while (end < rest.size() && rest[end] != ',') {  // blanks, and what is behind them
    const std::size_t next = std::min(rest.find_first_not_of(" \t", end), rest.size());
    if (rest.substr(next).starts_with('#')) refuse(rest.substr(next), "comments on lines of their own");
    if (begins_keyword(rest.substr(next))) break;
    end = std::min(rest.find_first_of(", \t", next), rest.size());
  }
  if (end == 0) refuse(rest, "a value behind the equals sign");
  rest.remove_prefix(end);
  return trimmed(whole.substr(0, end));
}

}  // namespace

RegionKeywords parse_region_keywords(std::string_view text) {
  RegionKeywords keywords;
  std::string_view rest = trimmed(text);
  if (rest.starts_with(',')) rest.remove_prefix(1);
  while (!(rest = trimmed(rest)).empty()) {
    const std::string_view whole = rest;
    const std::string name = small_letters(take_word(rest));
    if (name.empty() || !rest.starts_with('=')) refuse(whole, "a keyword and its value, such as coord=J2000");
    if (!contains(meant, name) && !contains(drawn, name))
      refuse(name, "one of " + listed(meant) + ", or for viewers one of " + listed(drawn));
    rest = trimmed(rest.substr(1));
    const std::string_view value = take_value(rest);
    if (!keywords.emplace(name, value).second) refuse(whole, name + " once");
    if ((rest = trimmed(rest)).starts_with(',')) rest.remove_prefix(1);
  }
  return keywords;
}

PlaneSpan planes_of_range(const RegionKeywords& keywords, const imager::SpectralAxis& axis) {
  check_names(keywords);
  const std::string range = value_of(keywords, "range");
  if (range.empty()) return {0, axis.channels - 1};
  const auto [one, other] = ends_of(range);
  const std::optional<double> channel = channel_number(one), last_channel = channel_number(other);
  double low = channel.value_or(0), high = last_channel.value_or(0);
  if (channel.has_value() != last_channel.has_value()) refuse_keyword("range", range, ranges_known);
  if (!channel) {
    check_spectral_frame(keywords, axis);
    try {
      low = plane_at(one, keywords, axis);
      high = plane_at(other, keywords, axis);
    } catch (const std::invalid_argument&) {
      refuse_keyword("range", range, ranges_known);
    }
  }
  if (low > high) std::swap(low, high);
  constexpr double rounding = 1e-6;  // of a plane: a range that ends where a plane begins does not reach into it
  PlaneSpan span;
  span.first = static_cast<int>(std::clamp(std::floor(low + 0.5 + rounding), 0.0, 1.0 * axis.channels));
  span.last = static_cast<int>(std::clamp(std::ceil(high - 0.5 - rounding), -1.0, axis.channels - 1.0));
  if (axis.channels == 1 && !span.holds(0))
    refuse_keyword("range", range, "one that reaches into the image's only plane, " + planes_text(axis) + ", or none");
  return span;
}

std::vector<bool> stokes_of_corr(const RegionKeywords& keywords, const std::vector<imager::Stokes>& image) {
  const std::string corr = value_of(keywords, "corr");
  std::vector<bool> named(image.size(), corr.empty());
  if (corr.empty()) return named;
  std::string_view list = corr;
  if (list.starts_with('[')) list = list.substr(1, list.size() - 2);
  for (const std::string_view name : split_at_commas(list)) {
    if (!contains(correlations, name)) refuse_keyword("corr", corr, "some of " + listed(correlations) + ", such as [I, Q]");
    for (std::size_t i = 0; i < image.size(); ++i)
      if (stokes_name(image[i]) == name) named[i] = true;
  }
  return named;
}

std::string frame_of_coord(const RegionKeywords& keywords, const std::string& image) {
  const std::string coord = value_of(keywords, "coord");
  if (coord.empty()) return image;
  const std::array<std::pair<const char*, const char*>, 9> frames{{{"j2000", "FK5"},
                                                                   {"fk5", "FK5"},
                                                                   {"b1950", "FK4"},
                                                                   {"fk4", "FK4"},
                                                                   {"b1950_vla", "B1950_VLA"},
                                                                   {"icrs", "ICRS"},
                                                                   {"galactic", "GALACTIC"},
                                                                   {"ecliptic", "ECLIPTIC"},
                                                                   {"supergal", "SUPERGAL"}}};
  for (const auto& [name, frame] : frames)
    if (small_letters(coord) == name) return frame;
  const bool of_a_date = small_letters(coord) == "bmean";
  refuse_keyword("coord", coord,
                 "J2000 (FK5), B1950 (FK4), B1950_VLA, ICRS, GALACTIC, ECLIPTIC or SUPERGAL" +
                     std::string(of_a_date ? ": a mean equinox is that of a date, which nothing names" : ""));
}

}  // namespace misfit::tools::regions
