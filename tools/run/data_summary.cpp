#include "tools/run/data_summary.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "tools/base/numbers.h"

namespace misfit::tools {
namespace {

constexpr std::size_t most_in_list = 10;

std::string counted(std::size_t count, const char* thing) {
  return grouped(static_cast<long long>(count)) + " " + thing + (count == 1 ? "" : "s");
}

/// "of 5 in the set", for a number of these that are selected.
std::string of_all(std::size_t selected, std::uint64_t all) {
  return std::to_string(selected) + " of " + std::to_string(all) + " in the set";
}

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < std::min(words.size(), most_in_list); ++i) text += (i == 0 ? "" : ", ") + words[i];
  return words.size() > most_in_list ? text + " and " + std::to_string(words.size() - most_in_list) + " more" : text;
}

/// "ALMA, 43 antennas"
std::string telescope_words(const ms_io::SetSummary& set) {
  return (set.telescope.empty() ? "not named" : set.telescope) + ", " + counted(set.antennas, "antenna");
}

/// "2012-06-03 01:35:12 to 02:14:50 UTC, 39 min 38 s"
std::string time_words(const ms_io::SetSummary& set) {
  if (set.start_utc.empty() || set.end_utc.empty()) return "at times that are not known";
  constexpr std::size_t date = 10, seconds = 19;  // letters of ISO 8601 up to the day, and up to the second
  std::string start = set.start_utc.substr(0, seconds), end = set.end_utc.substr(0, seconds);
  const bool same_day = start.compare(0, date, end, 0, date) == 0;
  for (std::string* time : {&start, &end})
    if (time->size() > date) (*time)[date] = ' ';
  return start + " to " + (same_day && end.size() > date ? end.substr(date + 1) : end) + " UTC, " + duration(set.length_s);
}

/// "0 'M31', 2 'M33'"
std::string field_list(const ms_io::SetSummary& set) {
  std::vector<std::string> words;
  for (const ms_io::NamedField& field : set.fields) words.push_back(std::to_string(field.id) + " '" + field.name + "'");
  return listed(words);
}

/// The range from edge to edge of the channels, with as many digits as tell a hundredth of its width.
std::string window_words(const ms_io::SpectralWindow& window) {
  double low_hz = window.frequency_hz.front(), high_hz = low_hz;
  for (std::size_t c = 0; c < window.frequency_hz.size(); ++c) {
    const double half_hz = window.channel_width_hz[c] / 2;
    low_hz = std::min(low_hz, window.frequency_hz[c] - half_hz);
    high_hz = std::max(high_hz, window.frequency_hz[c] + half_hz);
  }
  const double parts = high_hz > low_hz ? high_hz / (high_hz - low_hz) : 1;
  const int digits = std::clamp(2 + static_cast<int>(std::ceil(std::log10(parts))), 3, 10);
  const ScaledUnit unit = high_hz < 1e9 ? ScaledUnit{1e6, " MHz, "} : ScaledUnit{1e9, " GHz, "};
  return std::to_string(window.id) + " (" + significant(low_hz / unit.size, digits) + " to " +
         significant(high_hz / unit.size, digits) + unit.name + counted(window.frequency_hz.size(), "channel") + ")";
}

/// The windows of one set, each once.
std::vector<std::string> windows_of(const std::vector<ms_io::SpectralWindow>& all, const std::string& path) {
  std::vector<std::string> words;
  std::set<int> seen;
  for (const ms_io::SpectralWindow& window : all)
    if (window.set == path && !window.frequency_hz.empty() && seen.insert(window.id).second)
      words.push_back(window_words(window));
  return words;
}

imager::Decision baselines_decision(const ms_io::SetReach& reach) {
  const ScaledUnit metres = scaled_unit(reach.longest_m, "m"), lambda = uv_unit(reach.longest_lambda);
  const auto range = [](double shortest, double longest, const ScaledUnit& unit) {
    return significant(shortest / unit.size, 4) + " to " + significant(longest / unit.size, 4) + " " + unit.name;
  };
  return {"baselines", range(reach.shortest_m, reach.longest_m, metres),
          range(reach.shortest_lambda, reach.longest_lambda, lambda) + ", projected, of rows that are not flagged"};
}

imager::Plan lines_of(const ms_io::SetSummary& set, const std::vector<std::string>& windows, const std::string& frame) {
  return {{"telescope", telescope_words(set), "observed " + time_words(set)},
          {"fields", field_list(set), of_all(set.fields.size(), set.all_fields)},
          {"spectral windows", listed(windows),
           of_all(windows.size(), set.all_windows) + (frame.empty() ? "" : ", frequencies in " + frame)}};
}

/// The line of one set among several.
imager::Decision line_of(const ms_io::SetSummary& set, const std::vector<std::string>& windows) {
  return {"set " + set.path, telescope_words(set) + ", observed " + time_words(set),
          "fields " + field_list(set) + "; spectral windows " + listed(windows)};
}

}  // namespace

imager::Plan data_decisions(const ms_io::MeasurementSet& set, const ms_io::SetReach& reach) {
  const std::vector<ms_io::SetSummary> sets = set.summaries();
  const std::vector<ms_io::SpectralWindow> windows = set.spectral_windows();
  const std::string& asked = set.selection().spectral_frame;
  const std::string& frame = asked.empty() ? set.observation().spectral_frame : asked;
  imager::Plan plan;
  if (sets.size() == 1) plan = lines_of(sets.front(), windows_of(windows, sets.front().path), frame);
  for (std::size_t i = 0; sets.size() > 1 && i < std::min(sets.size(), most_in_list); ++i)
    plan.push_back(line_of(sets[i], windows_of(windows, sets[i].path)));
  if (sets.size() > most_in_list)
    plan.push_back({"further sets", std::to_string(sets.size() - most_in_list), "the first ten are listed, in order of time"});
  if (reach.longest_m > 0) plan.push_back(baselines_decision(reach));
  return plan;
}

}  // namespace misfit::tools
