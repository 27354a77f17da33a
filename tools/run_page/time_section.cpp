#include "tools/run_page/time_section.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

#include "tools/base/numbers.h"
#include "tools/report/html.h"
#include "tools/report/html_elements.h"
#include "tools/report/report_values.h"

namespace misfit::tools {
namespace {

using html::Row;
using html::tag;
using nlohmann::json;

struct Stage {
  std::string name;
  double seconds = 0;
  std::string expected;
  std::size_t shade = 0;
};

/// The style has colours for so many stages; the last is for all shorter ones.
constexpr std::size_t shades = 8;

std::string expected_of(const json& expected, const std::string& name) {
  const json& seconds = member(expected, name);
  return seconds.is_number() ? duration(seconds.get<double>()) : "";
}

/// The stages of `measured`, and stages that were only expected; null has none.
std::vector<Stage> stages_of(const json& measured, const json& expected) {
  std::vector<Stage> stages;
  for (const auto& [name, seconds] : measured.items())
    if (seconds.is_number() && name != "total") stages.push_back({name, seconds.get<double>(), expected_of(expected, name)});
  for (const auto& [name, seconds] : expected.items())
    if (seconds.is_number() && name != "total" && !measured.contains(name)) stages.push_back({name, 0, duration(seconds)});
  std::stable_sort(stages.begin(), stages.end(), [](const Stage& a, const Stage& b) { return a.seconds > b.seconds; });
  for (std::size_t k = 0; k < stages.size(); ++k) stages[k].shade = std::min(k, shades - 1);
  return stages;
}

std::string label(const Stage& stage) {
  std::string name = stage.name;
  std::replace(name.begin(), name.end(), '_', ' ');
  return html_escaped(name);
}

std::string percent(double share) {
  return significant(100 * share, share < 0.1 ? 1 : 2) + " %";
}

std::string shade(const Stage& stage) {
  return "s" + std::to_string(stage.shade);
}

/// All stages side by side; each tells its name when pointed at.
std::string bar(const std::vector<Stage>& stages, double wall) {
  std::string parts;
  double from = 0;
  for (const Stage& stage : stages) {
    std::array<char, 64> place{};
    std::snprintf(place.data(), place.size(), "x=\"%.2f\" width=\"%.2f\"", 1000 * from / wall, 1000 * stage.seconds / wall);
    parts += "<rect class=\"" + shade(stage) + "\" " + place.data() + " height=\"20\">" +
             tag("title", label(stage) + ": " + duration(stage.seconds) + ", " + percent(stage.seconds / wall)) + "</rect>";
    from += stage.seconds;
  }
  return "<svg class=\"bar\" viewBox=\"0 0 1000 20\" preserveAspectRatio=\"none\" role=\"img\" aria-label=\"Stages by their "
         "time\">" +
         parts + "</svg>\n";
}

std::string stage_table(const std::vector<Stage>& stages, double wall, const json& expected) {
  std::vector<Row> rows;
  for (const Stage& stage : stages)
    rows.push_back({tag("i", "", "swatch " + shade(stage)) + label(stage), duration(stage.seconds), stage.expected,
                    percent(stage.seconds / wall)});
  rows.push_back({tag("b", "wall clock"), tag("b", duration(wall)), tag("b", expected_of(expected, "total")), ""});
  Row headings{"Stage", "#Measured", "#Expected", "#Share"};
  if (!expected.is_object()) {
    headings.erase(headings.begin() + 2);
    for (Row& row : rows) row.erase(row.begin() + 2);
  }
  return html::table(headings, rows);
}

}  // namespace

std::string time_section(const json& measured, const json& expected) {
  if (!measured.is_object()) return "";
  std::vector<Stage> stages = stages_of(measured, expected);
  double sum = 0;
  for (const Stage& stage : stages) sum += stage.seconds;
  const json& total = member(measured, "total");
  const double wall = total.is_number() ? std::max(total.get<double>(), sum) : sum;
  if (!(wall > 0)) return "";
  if (wall > sum) stages.push_back({"everything else", wall - sum, "", shades - 1});
  return bar(stages, wall) + stage_table(stages, wall, expected);
}

}  // namespace misfit::tools
