#include "tools/numbers.h"
#include "tools/stability_runs.h"

namespace misfit::tools {
namespace {

std::string statement(const StabilityOutcome& o) {
  if (!o.finite) return "broken: not finite";
  if (!o.refusal.empty()) return "refused; measured with the most exact";
  if (!o.promise_kept) return "said to be missed";
  return o.honest() ? "kept" : "broken";
}

std::vector<DataTable::Cell> row_of(const StabilityOutcome& o) {
  std::vector<DataTable::Cell> row{o.name, power_of_ten(o.accuracy, 1), std::string(o.single ? "single" : "double"),
                                   statement(o)};
  if (!o.finite) return row.resize(13, std::string()), row;
  const double e = o.accuracy;
  row.insert(row.end(), {o.measured.rms / e, o.measured.predict_rms / e, o.theory.expected_rms / e, o.theory.bound_rms / e,
                         o.measured.max / o.theory.bound_max});
  row.insert(row.end(), {o.clean.stop_reason, static_cast<double>(o.clean.iterations), o.peak_before_jy(), o.peak_after_jy()});
  return row;
}

}  // namespace

DataTable outcome_table(const std::string& name, const std::string& title, const std::vector<StabilityOutcome>& outcomes) {
  DataTable table{.name = name,
                  .title = title,
                  .caption =
                      "Errors are RMS over the accuracy asked; the worst pixel is that over the strict bound, which holds "
                      "up to 1.",
                  .columns = {"case", "accuracy", "grid", "promise", "measured", "of prediction", "expected", "bound",
                              "worst pixel / bound", "CLEAN ended", "components", "peak before, Jy/beam", "after"},
                  .rows = {}};
  for (const StabilityOutcome& outcome : outcomes) table.rows.push_back(row_of(outcome));
  return table;
}

}  // namespace misfit::tools
