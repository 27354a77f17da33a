#include "imager/taylor/taylor_prediction.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace misfit::imager {
namespace {

using Visibilities = std::vector<std::complex<double>>;

/// x [channel].
std::vector<double> distances(const TaylorExpansion& expansion, const SampleCoordinates& coordinates) {
  std::vector<double> x;
  for (const double frequency : coordinates.frequency_hz) x.push_back(expansion.x(frequency));
  return x;
}

void multiply(const std::vector<double>& factor, Visibilities& visibility) {
  for (std::size_t i = 0; i < visibility.size();)
    for (const double f : factor) visibility[i++] *= f;
}

/// One step of Horner's rule: sum ← x sum + next.
void horner_step(const std::vector<double>& x, const Visibilities& next, Visibilities& sum) {
  multiply(x, sum);
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += next[i];
}

}  // namespace

TaylorPrediction::TaylorPrediction(const Transform& transform, std::vector<Image> models, const TaylorExpansion& expansion)
    : expansion_(expansion) {
  if (expansion.terms < 1 || models.size() != static_cast<std::size_t>(expansion.terms))
    throw std::invalid_argument(std::to_string(models.size()) + " models of " + std::to_string(expansion.terms) +
                                " Taylor terms; expected one for each");
  for (Image& model : models) term_.push_back(transform.predict(std::move(model)));
}

std::vector<std::complex<double>> TaylorPrediction::at(const SampleCoordinates& coordinates) const {
  const std::vector<double> x = distances(expansion_, coordinates);
  Visibilities sum = term_.back()->at(coordinates);
  for (std::size_t t = term_.size() - 1; t-- > 0;) horner_step(x, term_[t]->at(coordinates), sum);
  return sum;
}

std::vector<std::complex<double>> TaylorPrediction::at_usable(const VisibilityBlock& block) const {
  return at_usable_of({&block}).front();
}

std::vector<std::vector<std::complex<double>>> TaylorPrediction::at_usable_of(
    const std::vector<const VisibilityBlock*>& blocks) const {
  std::vector<Visibilities> sum = term_.back()->at_usable_of(blocks);
  for (std::size_t t = term_.size() - 1; t-- > 0;) {
    const std::vector<Visibilities> next = term_[t]->at_usable_of(blocks);
    for (std::size_t b = 0; b < blocks.size(); ++b) horner_step(distances(expansion_, *blocks[b]), next[b], sum[b]);
  }
  return sum;
}

std::size_t TaylorPrediction::samples_at_once() const {
  std::size_t most = 0;
  for (const auto& term : term_) most = std::max(most, term->samples_at_once());
  return most;
}

double TaylorPrediction::fft_s() const {
  double sum = 0;
  for (const auto& term : term_) sum += term->fft_s();
  return sum;
}

std::vector<Visibilities> taylor_sets(const TaylorExpansion& expansion, const SampleCoordinates& coordinates,
                                      const Visibilities& visibility, const TaylorPowers& powers) {
  const std::vector<double> x = distances(expansion, coordinates);
  std::vector<Visibilities> sets;
  Visibilities set = visibility;
  for (int k = 0; k <= powers.last; ++k) {
    if (k > 0) multiply(x, set);
    if (k >= powers.first) sets.push_back(set);
  }
  return sets;
}

}  // namespace misfit::imager
