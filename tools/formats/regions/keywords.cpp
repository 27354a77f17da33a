#include "tools/formats/regions/keywords.h"

#include <algorithm>
#include <array>

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

/// True if `text` begins with the next keyword and its equals sign.
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

std::string value_of(const RegionKeywords& keywords, const std::string& name) {
  const auto found = keywords.find(name);
  return found == keywords.end() ? "" : found->second;
}

void refuse_value(const RegionKeywords& keywords, const std::string& name, const std::string& expected) {
  refuse(name + "=" + value_of(keywords, name), expected);
}

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

std::vector<bool> stokes_of_corr(const RegionKeywords& keywords, const std::vector<imager::Stokes>& image) {
  const std::string corr = value_of(keywords, "corr");
  std::vector<bool> named(image.size(), corr.empty());
  if (corr.empty()) return named;
  std::string_view list = corr;
  if (list.starts_with('[')) list = list.substr(1, list.size() - 2);
  for (const std::string_view name : split_at_commas(list)) {
    if (!contains(correlations, name)) refuse_value(keywords, "corr", "some of " + listed(correlations) + ", such as [I, Q]");
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
  refuse_value(keywords, "coord",
               "J2000 (FK5), B1950 (FK4), B1950_VLA, ICRS, GALACTIC, ECLIPTIC or SUPERGAL" +
                   std::string(of_a_date ? ": a mean equinox is that of a date, which nothing names" : ""));
}

}  // namespace misfit::tools::regions
