#include "imager/data/visibilities.h"

#include <string>
#include <utility>

namespace misfit::imager {
namespace {

std::string nothing_usable(const SampleCounts& c) {
  std::string reasons;
  for (const auto& [count, reason] : {std::pair(c.autocorrelations, "auto-correlations"),
                                      {c.flagged, "flagged"},
                                      {c.nonfinite, "not finite"},
                                      {c.zero_weight, "of zero weight"},
                                      {c.outside_grid, "beyond 1/(2 cell)"}})
    if (count > 0) reasons += (reasons.empty() ? "" : ", ") + std::to_string(count) + " " + reason;
  return "none of " + std::to_string(c.samples_read) + " visibilities can be used: " + reasons + "; expected at least one";
}

}  // namespace

NothingUsable::NothingUsable(const SampleCounts& counts) : std::runtime_error(nothing_usable(counts)) {}

SampleCounts& SampleCounts::operator+=(const SampleCounts& other) {
  rows_read += other.rows_read;
  samples_read += other.samples_read;
  autocorrelations += other.autocorrelations;
  flagged += other.flagged;
  nonfinite += other.nonfinite;
  zero_weight += other.zero_weight;
  outside_grid += other.outside_grid;
  used += other.used;
  return *this;
}

const std::complex<float>* VisibilityBlock::visibility_of(std::size_t index) const {
  if (index >= stokes())
    throw std::invalid_argument("Stokes parameter " + std::to_string(index) + " of a block that carries " +
                                std::to_string(stokes()) + "; they count from 0");
  return visibility.data() + index * samples();
}

void SampleCounts::add_up(const Ranks& ranks) {
  sum_over(ranks, rows_read, samples_read, autocorrelations, flagged, nonfinite, zero_weight, outside_grid, used);
}

}  // namespace misfit::imager
