#include "imager/transform/transform.h"

#include <string>

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

void SampleSums::add_up(const Ranks& ranks) {
  sum_over(ranks, used, outside_grid, weight, weight_abs, weight_square, weight2_square);
}

AdjointSum::AdjointSum(const AdjointOptions& options) : options_(options) {
  const int least = options.with_psf ? 0 : 1;
  if (options.images < least || options.images > most_stokes)
    throw std::invalid_argument(std::to_string(options.images) + " images of one adjoint not in [" + std::to_string(least) +
                                ", " + std::to_string(most_stokes) + "]");
}

void AdjointSum::add(const VisibilityBlock& block, const VisibilitySets& visibility) {
  if (visibility.size() != images())
    throw std::invalid_argument(std::to_string(visibility.size()) + (visibility.size() == 1 ? " set" : " sets") +
                                " of visibilities for " + std::to_string(images()) + " images; expected one for each");
  add_sets(block, visibility);
}

std::vector<std::vector<std::complex<double>>> Prediction::at_usable_of(
    const std::vector<const VisibilityBlock*>& blocks) const {
  std::vector<std::vector<std::complex<double>>> visibility;
  for (const VisibilityBlock* block : blocks) visibility.push_back(at_usable(*block));
  return visibility;
}

}  // namespace misfit::imager
