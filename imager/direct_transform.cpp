#include "imager/direct_transform.h"

#include <cmath>

#include "imager/constants.h"
#include "imager/parallel.h"
#include "imager/phase.h"
#include "imager/phasors.h"
#include "imager/sampling.h"

namespace misfit::imager {
namespace {

/// The same as `at` seen from `origin`: phases subtract.
PhasePosition relative(const PhasePosition& at, const PhasePosition& origin) {
  return {at.l - origin.l, at.m - origin.m, at.n_minus_1 - origin.n_minus_1};
}

/// Σ w Re[V exp(−i phase)] over one block, with `value(i)` = w V.
template <typename Value>
double direct_sum(const VisibilityBlock& block, const std::vector<char>& inside, const PhasePosition& at, const Value& value) {
  std::vector<double> turns(block.channels()), cosine(turns.size()), sine(turns.size());
  double sum = 0;
  std::size_t i = 0;
  for (std::size_t row = 0; row < block.rows(); ++row) {
    const double per_hz = turns_per_hz(&block.uvw_m[3 * row], at);
    for (std::size_t c = 0; c < turns.size(); ++c) turns[c] = per_hz * block.frequency_hz[c];
    phasors(turns.data(), static_cast<int>(turns.size()), cosine.data(), sine.data());
    for (std::size_t c = 0; c < turns.size(); ++c, ++i) {
      if (!inside[i]) continue;
      const std::complex<double> v = value(i);
      sum += v.real() * cosine[c] + v.imag() * sine[c];
    }
  }
  return sum;
}

class DirectAdjoint : public AdjointSum {
 public:
  DirectAdjoint(const ImageGeometry& geometry, int threads, bool with_psf) : geometry_(geometry), threads_(threads) {
    result_.image = Image(geometry.width, geometry.height);
    if (with_psf) result_.psf = Image(geometry.width, geometry.height);
  }

  void add(const VisibilityBlock& block) override {
    accumulate(block, [&](std::size_t i) { return std::complex<double>(block.visibility[i]); });
  }
  void add(const VisibilityBlock& block, const std::vector<std::complex<double>>& visibility) override {
    accumulate(block, [&](std::size_t i) { return visibility[i]; });
  }
  AdjointResult finish() override { return std::move(result_); }

 private:
  template <typename Visibility>
  void accumulate(const VisibilityBlock& block, const Visibility& visibility) {
    const std::vector<char> inside = samples_inside(block, geometry_.cell_rad, result_.sums);
    for (std::size_t i = 0; i < inside.size(); ++i)
      if (inside[i]) add_to_sums(result_.sums, block.weight[i], visibility(i));
    parallel_for(static_cast<std::size_t>(geometry_.height), threads_, [&](std::size_t r) {
      const int row = static_cast<int>(r);
      for (int column = 0; column < geometry_.width; ++column) {
        const PhasePosition at = phase_position(geometry_.at(row, column));
        result_.image.at(row, column) +=
            direct_sum(block, inside, at, [&](std::size_t i) { return double{block.weight[i]} * visibility(i); });
        if (!result_.psf.pixel.empty())
          result_.psf.at(row, column) += direct_sum(block, inside, relative(at, phase_position(geometry_.centre)),
                                                    [&](std::size_t i) { return std::complex<double>(block.weight[i]); });
      }
    });
  }

  ImageGeometry geometry_;
  int threads_;
  AdjointResult result_;
};

class DirectPrediction : public Prediction {
 public:
  DirectPrediction(std::vector<PointSource> sources, int threads) : sources_(std::move(sources)), threads_(threads) {}

  std::vector<std::complex<double>> at(const SampleCoordinates& coordinates) const override {
    return predict_sources(sources_, coordinates, threads_);
  }
  std::vector<std::complex<double>> at_usable(const VisibilityBlock& block) const override {
    std::vector<std::complex<double>> visibility = at(block);
    for (std::size_t i = 0; i < visibility.size(); ++i)
      if (block.weight[i] == 0) visibility[i] = 0;
    return visibility;
  }

 private:
  std::vector<PointSource> sources_;
  int threads_;
};

}  // namespace

std::unique_ptr<AdjointSum> DirectTransform::adjoint(bool with_psf) const {
  return std::make_unique<DirectAdjoint>(geometry_, threads_, with_psf);
}

std::unique_ptr<Prediction> DirectTransform::predict(const Image& model) const {
  std::vector<PointSource> sources;
  for (int row = 0; row < model.height; ++row)
    for (int column = 0; column < model.width; ++column)
      if (model.at(row, column) != 0 && !beyond_horizon(geometry_.at(row, column)))
        sources.push_back({geometry_.at(row, column), model.at(row, column)});
  return std::make_unique<DirectPrediction>(std::move(sources), threads_);
}

std::vector<std::complex<double>> predict_sources(const std::vector<PointSource>& sources, const SampleCoordinates& at,
                                                  int threads) {
  std::vector<std::complex<double>> visibility(at.samples());
  parallel_for(at.rows(), threads, [&](std::size_t row) {
    for (const PointSource& source : sources) {
      const double phase = 2 * pi * turns_per_hz(&at.uvw_m[3 * row], phase_position(source.position));
      for (std::size_t channel = 0; channel < at.channels(); ++channel)
        visibility[row * at.channels() + channel] += std::polar(source.flux_jy, phase * at.frequency_hz[channel]);
    }
  });
  return visibility;
}

void add_direct_pixels(const VisibilityBlock& block, const DirectPixels& at, std::vector<double>& sum) {
  SampleSums unused;
  const std::vector<char> inside = samples_inside(block, at.geometry.cell_rad, unused);
  parallel_for(at.pixel.size(), at.threads, [&](std::size_t k) {
    PhasePosition position = phase_position(at.geometry.at(at.pixel[k].row, at.pixel[k].column));
    if (!at.with_w) position.n_minus_1 = 0;
    sum[k] += direct_sum(block, inside, position,
                         [&](std::size_t i) { return double{block.weight[i]} * std::complex<double>(block.visibility[i]); });
  });
}

}  // namespace misfit::imager
