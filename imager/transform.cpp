#include "imager/transform.h"

namespace misfit::imager {

SampleSums& SampleSums::operator+=(const SampleSums& other) {
  used += other.used;
  outside_grid += other.outside_grid;
  weight += other.weight;
  weight_abs += other.weight_abs;
  weight_square += other.weight_square;
  weight2_square += other.weight2_square;
  return *this;
}

std::vector<std::vector<std::complex<double>>> Prediction::at_usable_of(
    const std::vector<const VisibilityBlock*>& blocks) const {
  std::vector<std::vector<std::complex<double>>> visibility;
  for (const VisibilityBlock* block : blocks) visibility.push_back(at_usable(*block));
  return visibility;
}

}  // namespace misfit::imager
