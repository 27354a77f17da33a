#include "tools/base/numbers.h"
#include "tools/stability/stability_runs.h"

namespace misfit::tools {
namespace {

std::string statement(const StabilityOutcome& o) {
  if (!o.finite) return "broken: not finite";
  if (!o.refusal.empty()) return "refused";
  if (!o.within_bounds()) return "broken: above its strict bound";
  if (!o.promise_kept) return "missed, said";
  return o.honest() ? "kept" : "broken";
}

/// The words on a CLEAN that was cut at its limit of components; and on the model that was kept, if an earlier one left less.
std::string cut(const StabilityOutcome& o) {
  const imager::CleanReport& clean = o.clean;
  const bool earlier = clean.kept + 1 != clean.cycles.size();
  return "at the limit given, of " + grouped(o.max_iterations) + " components" +
         (earlier ? "; the best model, of " + grouped(clean.iterations) + ", kept" : "");
}

std::string ending(const StabilityOutcome& o) {
  switch (o.clean.stop) {
    case imager::CleanStop::iteration_limit:
      return cut(o);
    case imager::CleanStop::threshold:
      return "threshold";
    case imager::CleanStop::user:
      return "user";
    case imager::CleanStop::no_change:
      return "no change";
    case imager::CleanStop::diverging:
    case imager::CleanStop::diverging_from_best:
      return "diverging";
    case imager::CleanStop::empty_mask:
      return "empty mask";
    case imager::CleanStop::nsigma:
      return "noise";
    case imager::CleanStop::major_cycle_limit:
      return "major cycles";
  }
  return "";
}

std::vector<DataTable::Cell> row_of(const StabilityOutcome& o) {
  std::vector<DataTable::Cell> row{o.name, power_of_ten(o.accuracy, 1), std::string(o.single ? "single" : "double"),
                                   statement(o)};
  if (!o.finite) return row.resize(13, std::string()), row;
  const double e = o.accuracy;
  row.insert(row.end(), {o.measured.rms / e, o.measured.predict_rms / e, o.theory.expected_rms / e, o.theory.bound_rms / e,
                         o.measured.max / o.theory.bound_max});
  row.insert(row.end(), {ending(o), static_cast<double>(o.clean.iterations), o.peak_before_jy(), o.peak_after_jy()});
  return row;
}

}  // namespace

DataTable outcome_table(const std::string& name, const std::string& title, const std::vector<StabilityOutcome>& outcomes) {
  DataTable table{
      .name = name,
      .title = title,
      .caption =
          "RMS errors over the accuracy asked; the worst pixel over its strict bound, which holds up to 1. What the plan "
          "refuses is measured with the most exact way there is. Peaks before and after CLEAN in Jy/beam.",
      .columns = {"case", "accuracy", "grid", "promise", "measured", "predicted", "expected", "bound", "worst pixel",
                  "CLEAN ended", "components", "before", "after"},
      .rows = {}};
  for (const StabilityOutcome& outcome : outcomes) table.rows.push_back(row_of(outcome));
  return table;
}

}  // namespace misfit::tools
