#include "tools/run_page/clean_section.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "tools/base/numbers.h"
#include "tools/report/html_elements.h"
#include "tools/report/report_values.h"
#include "tools/run_page/clean_curve.h"

namespace misfit::tools {
namespace {

using html::Row;
using html::tag;
using nlohmann::json;

/// The list of states; the first is the state before all cycles.
const json& log_of(const json& clean) {
  static const json none = json::array();
  const json& log = member(clean, "major_cycles_log");
  return log.is_array() ? log : none;
}

std::vector<double> magnitudes(const json& log, const std::vector<const char*>& keys) {
  std::vector<double> values;
  for (const json& cycle : log) {
    for (const char* key : keys) {
      const double magnitude = std::abs(number(cycle, key));
      if (magnitude > 0 && std::isfinite(magnitude)) values.push_back(magnitude);
    }
  }
  return values;
}

/// One unit for residuals, noise and depths, so that they compare at a glance: it suits their geometric mean, since they fall
/// by orders of magnitude.
ScaledUnit residual_unit(const json& log) {
  double logarithms = 0;
  const std::vector<double> values = magnitudes(log, {"peak_residual_jy", "rms_jy"});
  for (const double value : values) logarithms += std::log(value);
  return scaled_unit(values.empty() ? 0 : std::exp(logarithms / static_cast<double>(values.size())), "Jy/beam");
}

ScaledUnit flux_unit(const json& log) {
  const std::vector<double> values = magnitudes(log, {"model_flux_jy"});
  return scaled_unit(values.empty() ? 0 : *std::max_element(values.begin(), values.end()), "Jy");
}

std::string in_unit(double value, const ScaledUnit& unit, int digits) {
  return std::isfinite(value) ? significant(value / unit.size, digits) : not_measured;
}

/// A row without the reason why its cycle ended. Nothing is said of a cycle before the first.
Row cycle_row(const json& log, std::size_t k, const ScaledUnit& residual, const ScaledUnit& flux) {
  const json& cycle = log[k];
  const bool start = k == 0;
  const json& from = member(cycle, "from");
  const json& before =
      from.is_number_unsigned() && from.get<std::size_t>() < k ? log[from.get<std::size_t>()] : log[k - !start];
  const auto gained = [&](const char* key) { return start ? 0 : number(cycle, key) - number(before, key); };
  const double found = gained("iterations");
  return {start ? "start" : std::to_string(k),
          whole(member(cycle, "iterations")),
          start                  ? ""
          : std::isfinite(found) ? grouped(std::llround(found))
                                 : not_measured,
          start ? "" : in_unit(number(cycle, "cycle_threshold_jy"), residual, 3),
          in_unit(std::abs(number(cycle, "peak_residual_jy")), residual, 3),
          in_unit(number(cycle, "rms_jy"), residual, 3),
          in_unit(number(cycle, "model_flux_jy"), flux, 5),
          start ? "" : in_unit(gained("model_flux_jy"), flux, 3)};
}

std::string cycle_table(const json& clean) {
  const json& log = log_of(clean);
  const ScaledUnit residual = residual_unit(log);
  const ScaledUnit flux = flux_unit(log);
  const json& kept = member(clean, "kept_cycle");
  std::vector<Row> rows;
  bool reasons = false;
  for (std::size_t k = 0; k < log.size(); ++k) {
    const json& ended = member(log[k], "ended");
    reasons = reasons || (ended.is_string() && !ended.get<std::string>().empty());
    rows.push_back(cycle_row(log, k, residual, flux));
    rows.back().push_back(ended.is_string() ? plain(ended) : "");
    if (kept == k && k + 1 < log.size()) rows.back().front().append(" ").append(tag("b", "kept"));
  }
  const auto heading = [](const std::string& name, const std::string& small) { return name + tag("small", small); };
  Row headings{"#Cycle",
               heading("#Iterations", "in all"),
               heading("#Found", "in the cycle"),
               heading("#Depth", residual.name),
               heading("#Peak residual", residual.name),
               heading("#Noise", residual.name),
               heading("#Model flux", flux.name),
               heading("#Cleaned", flux.name),
               "Its minor cycle ended because"};
  if (!reasons) {
    headings.pop_back();
    for (Row& row : rows) row.pop_back();
  }
  return html::table(headings, rows);
}

}  // namespace

std::string clean_progress(const json& clean) {
  std::vector<CurvePoint> points;
  for (const json& cycle : log_of(clean)) {
    const double iterations = number(cycle, "iterations");
    if (!std::isfinite(iterations)) continue;
    points.push_back({.iterations = iterations,
                      .peak_jy = std::abs(number(cycle, "peak_residual_jy")),
                      .noise_jy = number(cycle, "rms_jy"),
                      .depth_jy = number(cycle, "cycle_threshold_jy"),
                      .flux_jy = number(cycle, "model_flux_jy")});
  }
  return clean_curve(points);
}

std::string clean_section(const json& clean) {
  if (!clean.is_object()) return "";
  return tag("p", whole(member(clean, "iterations")) + " iterations in " + whole(member(clean, "major_cycles")) +
                      " major cycles. CLEAN ended with code " + plain(member(clean, "stop_code")) + ": " +
                      plain(member(clean, "stop_reason")) + ". Model flux " +
                      with_unit(member(clean, "model_flux_jy"), "Jy", 5) + ".") +
         "\n" + cycle_table(clean);
}

}  // namespace misfit::tools
