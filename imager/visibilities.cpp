#include "imager/visibilities.h"

namespace misfit::imager {

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

}  // namespace misfit::imager
