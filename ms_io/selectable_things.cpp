#include <casacore/casa/Quanta/MVTime.h>
#include <casacore/tables/Tables/ArrayColumn.h>
#include <casacore/tables/Tables/ScalarColumn.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <set>
#include <vector>

#include "ms_io/selectable_things_internal.h"
#include "ms_io/table_access_internal.h"

namespace misfit::ms_io {
namespace {

using Words = std::vector<std::string>;

/// "1.4 to 1.5 GHz", or "1.4 GHz" where they are one.
std::string range_words(double low_hz, double high_hz) {
  const double unit_hz = high_hz < 1e9 ? 1e6 : 1e9;
  char low[32], high[32];
  std::snprintf(low, sizeof low, "%.7g to ", low_hz / unit_hz);
  std::snprintf(high, sizeof high, "%.7g ", high_hz / unit_hz);
  return (low_hz < high_hz ? low : std::string()) + high + (high_hz < 1e9 ? "MHz" : "GHz");
}

/// "0 'M31'"
Words list_named(const casacore::Table& table) {
  const casacore::ScalarColumn<casacore::String> names(table, "NAME");
  Words words;
  for (casacore::rownr_t id = 0; id < table.nrow(); ++id)
    words.push_back(std::to_string(id) + " '" + one_line(names(id)) + "'");
  return words;
}

Words list_fields(const casacore::MeasurementSet& set) {
  return list_named(set.field());
}

Words list_antennas(const casacore::MeasurementSet& set) {
  return list_named(set.antenna());
}

/// "0 (1.4 to 1.5 GHz, 64 channels)", between the middles of the outermost channels.
Words list_windows(const casacore::MeasurementSet& set) {
  const casacore::ArrayColumn<double> frequencies(set.spectralWindow(), "CHAN_FREQ");
  Words words;
  for (casacore::rownr_t id = 0; id < set.spectralWindow().nrow(); ++id) {
    const std::vector<double> hz = frequencies(id).tovector();
    if (hz.empty()) continue;
    const auto [low, high] = std::minmax_element(hz.begin(), hz.end());
    words.push_back(std::to_string(id) + " (" + range_words(*low, *high) + ", " + std::to_string(hz.size()) +
                    (hz.size() == 1 ? " channel)" : " channels)"));
  }
  return words;
}

Words list_scans(const casacore::MeasurementSet& set) {
  const std::vector<int> of_rows = casacore::ScalarColumn<int>(set, "SCAN_NUMBER").getColumn().tovector();
  Words words;
  for (const int scan : std::set<int>(of_rows.begin(), of_rows.end())) words.push_back(std::to_string(scan));
  return words;
}

Words list_intents(const casacore::MeasurementSet& set) {
  const auto of_rows = casacore::ScalarColumn<casacore::String>(set.state(), "OBS_MODE").getColumn().tovector();
  Words words;
  for (const std::string& intent : std::set<std::string>(of_rows.begin(), of_rows.end()))
    words.push_back("'" + one_line(intent) + "'");
  return words;
}

Words list_observations(const casacore::MeasurementSet& set) {
  Words words;
  for (casacore::rownr_t id = 0; id < set.observation().nrow(); ++id) words.push_back(std::to_string(id));
  return words;
}

/// The range of all times, as an expression has it.
Words list_times(const casacore::MeasurementSet& set) {
  double first_s = std::numeric_limits<double>::infinity(), last_s = 0;
  for (const double time_s : casacore::ScalarColumn<double>(set, "TIME").getColumn().tovector()) {
    if (!std::isfinite(time_s) || time_s <= 0) continue;
    first_s = std::min(first_s, time_s);
    last_s = std::max(last_s, time_s);
  }
  const auto text = [](double time_s) {
    return casacore::MVTime(casacore::Quantity(time_s, "s")).string(casacore::MVTime::YMD, 6);
  };
  return last_s > 0 ? Words{text(first_s) + "~" + text(last_s)} : Words{};
}

struct Lister {
  PerSet Selection::*expression;
  const char* singular;
  const char* plural;
  Words (*list)(const casacore::MeasurementSet&);
};

constexpr std::array<Lister, 7> listers{{{&Selection::field, "field", "fields", list_fields},
                                         {&Selection::spectral_window, "spectral window", "spectral windows", list_windows},
                                         {&Selection::time_range, "time", "times", list_times},
                                         {&Selection::antenna, "antenna", "antennas", list_antennas},
                                         {&Selection::scan, "scan", "scans", list_scans},
                                         {&Selection::intent, "intent", "intents", list_intents},
                                         {&Selection::observation, "observation", "observations", list_observations}}};

std::string first_of(const Words& words) {
  constexpr std::size_t most_listed = 10;
  std::string list;
  for (std::size_t i = 0; i < std::min(words.size(), most_listed); ++i) list += (i == 0 ? "" : ", ") + words[i];
  return words.size() > most_listed ? list + " and " + std::to_string(words.size() - most_listed) + " more" : list;
}

}  // namespace

SelectableThings selectable_things(const casacore::MeasurementSet& set, const SelectionKind& kind) {
  for (const Lister& lister : listers)
    if (lister.expression == kind.expression) return {lister.singular, lister.plural, first_of(lister.list(set))};
  return {};
}

std::string things_there(const casacore::MeasurementSet& set, const Selection& selection) {
  std::string text;
  for (const SelectionKind& kind : selection_kinds) {
    if ((selection.*kind.expression).empty()) continue;
    try {
      const SelectableThings there = selectable_things(set, kind);
      if (!there.list.empty()) text += (text.empty() ? "" : "; ") + there.plural + " " + there.list;
    } catch (const casacore::AipsError&) {  // the selection is refused all the same
    }
  }
  return text;
}

bool says_no_match(const std::string& casacore_words) {
  // "No match found for name", "Partial or no match for Field ID list", "No matching SPW found".
  return casacore_words.find("No match") != std::string::npos || casacore_words.find("no match") != std::string::npos;
}

}  // namespace misfit::ms_io
