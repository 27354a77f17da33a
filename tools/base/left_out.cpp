#include "tools/base/left_out.h"

#include "tools/base/numbers.h"

namespace misfit::tools {
namespace {

std::string text(std::uint64_t count) {
  return grouped(static_cast<long long>(count));
}

}  // namespace

std::string left_out_of_all(const imager::SampleCounts& counts) {
  return text(counts.samples_read - counts.used) + " of " + text(counts.samples_read);
}

std::string left_out_reasons(const imager::SampleCounts& counts) {
  std::string reasons;
  const auto add = [&](std::uint64_t count, const char* reason) {
    if (count > 0) reasons += (reasons.empty() ? "" : ", ") + text(count) + " " + reason;
  };
  add(counts.autocorrelations, "auto-correlations");
  add(counts.flagged, "flagged");
  add(counts.nonfinite, "not finite");
  add(counts.zero_weight, "of zero or negative weight");
  add(counts.outside_grid, "outside the grid");
  return reasons.empty() ? "all can be imaged" : reasons;
}

}  // namespace misfit::tools
