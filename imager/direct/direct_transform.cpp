#include "imager/direct/direct_transform.h"

#include <algorithm>

#include "imager/constants.h"
#include "imager/horizon.h"
#include "imager/parallel.h"
#include "imager/phase.h"
#include "imager/phasors.h"
#include "imager/sampling.h"
#include "imager/span_sums.h"

namespace misfit::imager {
namespace {

/// The same as `at` seen from `origin`: phases subtract.
PhasePosition relative(const PhasePosition& at, const PhasePosition& origin) {
  return {at.l - origin.l, at.m - origin.m, at.n_minus_1 - origin.n_minus_1};
}

PhasePosition position_of(DirectionCosines at, bool with_w) {
  PhasePosition position = phase_position(at);
  if (!with_w) position.n_minus_1 = 0;
  return position;
}

/// Samples of a block in wavelengths.
struct Wavelengths {
  std::vector<double> u, v, w;

  void push_back(const double* uvw_m, double frequency_hz) {
    const double per_m = frequency_hz / speed_of_light_m_s;
    u.push_back(uvw_m[0] * per_m);
    v.push_back(uvw_m[1] * per_m);
    w.push_back(uvw_m[2] * per_m);
  }
  std::size_t size() const { return u.size(); }
};

/// Calls visit(i, cosine, sine) for each sample, with exp(2πi(ul+vm+w(n−1))).
template <typename Visit>
void for_phasors(const Wavelengths& at, const PhasePosition& to, const Visit& visit) {
  constexpr std::size_t at_once = 256;
  double turns[at_once], cosine[at_once], sine[at_once];
  for (std::size_t begin = 0; begin < at.size(); begin += at_once) {
    const std::size_t some = std::min(at_once, at.size() - begin);
    for (std::size_t i = 0; i < some; ++i)
      turns[i] = at.u[begin + i] * to.l + at.v[begin + i] * to.m + at.w[begin + i] * to.n_minus_1;
    phasors(turns, static_cast<int>(some), cosine, sine);
    for (std::size_t i = 0; i < some; ++i) visit(begin + i, cosine[i], sine[i]);
  }
}

/// The samples of a block that take part in imaging, with w V.
struct WeightedSamples {
  Wavelengths at;
  std::vector<double> weight, real, imaginary;

  template <typename Visibility>
  WeightedSamples(const VisibilityBlock& block, const std::vector<float>& weights, const Visibility& visibility,
                  std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (weights[i] == 0) continue;
      const std::complex<double> v(visibility[i]);
      at.push_back(&block.uvw_m[3 * (i / block.channels())], block.frequency_hz[i % block.channels()]);
      weight.push_back(weights[i]);
      real.push_back(weight.back() * v.real());
      imaginary.push_back(weight.back() * v.imag());
    }
  }

  /// Σ w Re[V exp(−2πi(…))].
  double image_at(const PhasePosition& to) const {
    double sum = 0;
    for_phasors(at, to, [&](std::size_t i, double cosine, double sine) { sum += real[i] * cosine + imaginary[i] * sine; });
    return sum;
  }
  /// The same for V = 1.
  double beam_at(const PhasePosition& to) const {
    double sum = 0;
    for_phasors(at, to, [&](std::size_t i, double cosine, double) { sum += weight[i] * cosine; });
    return sum;
  }
};

class DirectAdjoint : public AdjointSum {
 public:
  DirectAdjoint(const DirectSums& o, bool with_psf) : o_(o) {
    result_.image = Image(o.geometry.width, o.geometry.height);
    if (with_psf) result_.psf = Image(o.geometry.width, o.geometry.height);
  }

  void add(const VisibilityBlock& block) override { accumulate(block, block.visibility); }
  void add(const VisibilityBlock& block, const std::vector<std::complex<double>>& visibility) override {
    accumulate(block, visibility);
  }
  AdjointResult finish() override {
    set_beyond_horizon(o_.geometry, no_value, result_.image);
    if (!result_.psf.pixel.empty()) set_beyond_horizon(o_.geometry, no_value, result_.psf);
    return std::move(result_);
  }

 private:
  template <typename Visibility>
  void accumulate(const VisibilityBlock& block, const Visibility& visibility) {
    const std::vector<float> weight = imaging_weights(block, o_.geometry.cell_rad, o_.threads, result_.sums);
    add_span_to_sums(weight.data(), visibility.data(), weight.size(), result_.sums);
    const WeightedSamples samples(block, weight, visibility, 0, weight.size());
    const PhasePosition middle = position_of(o_.geometry.centre, o_.with_w);
    parallel_for(static_cast<std::size_t>(o_.geometry.height), o_.threads, [&](std::size_t r) {
      const int row = static_cast<int>(r);
      for (int column = 0; column < o_.geometry.width; ++column) {
        const PhasePosition at = position_of(o_.geometry.at(row, column), o_.with_w);
        result_.image.at(row, column) += samples.image_at(at);
        if (!result_.psf.pixel.empty()) result_.psf.at(row, column) += samples.beam_at(relative(at, middle));
      }
    });
  }

  DirectSums o_;
  AdjointResult result_;
};

class DirectPrediction : public Prediction {
 public:
  DirectPrediction(std::vector<Source> sources, bool with_w, int threads)
      : sources_(std::move(sources)), with_w_(with_w), threads_(threads) {}

  std::vector<std::complex<double>> at(const SampleCoordinates& coordinates) const override {
    return predict_sources(sources_, coordinates, threads_, with_w_);
  }
  std::vector<std::complex<double>> at_usable(const VisibilityBlock& block) const override {
    std::vector<std::complex<double>> visibility = at(block);
    for (std::size_t i = 0; i < visibility.size(); ++i)
      if (block.weight[i] == 0) visibility[i] = 0;
    return visibility;
  }

 private:
  std::vector<Source> sources_;
  bool with_w_;
  int threads_;
};

}  // namespace

std::unique_ptr<AdjointSum> DirectTransform::adjoint(bool with_psf) const {
  return std::make_unique<DirectAdjoint>(sums_, with_psf);
}

std::unique_ptr<Prediction> DirectTransform::predict(const Image& model) const {
  std::vector<Source> sources;
  for (int row = 0; row < model.height; ++row)
    for (int column = 0; column < model.width; ++column)
      if (model.at(row, column) != 0 && !beyond_horizon(sums_.geometry.at(row, column)))
        sources.push_back({sums_.geometry.at(row, column), model.at(row, column)});
  return std::make_unique<DirectPrediction>(std::move(sources), sums_.with_w, sums_.threads);
}

void add_direct_pixels(const VisibilityBlock& block, const DirectPixels& at, std::vector<double>& sum) {
  SampleSums unused;
  const std::vector<float> weight = imaging_weights(block, at.geometry.cell_rad, at.threads, unused);
  constexpr std::size_t samples_a_piece = 1 << 14;
  const std::size_t pieces = (weight.size() + samples_a_piece - 1) / samples_a_piece;
  std::vector<double> part(pieces * at.pixel.size());  // [piece][pixel]
  parallel_for(pieces, at.threads, [&](std::size_t p) {
    const std::size_t begin = p * samples_a_piece;
    const WeightedSamples samples(block, weight, block.visibility, begin, std::min(begin + samples_a_piece, weight.size()));
    for (std::size_t k = 0; k < at.pixel.size(); ++k)
      part[p * at.pixel.size() + k] =
          samples.image_at(position_of(at.geometry.at(at.pixel[k].row, at.pixel[k].column), at.with_w));
  });
  for (std::size_t i = 0; i < part.size(); ++i) sum[i % at.pixel.size()] += part[i];
}

}  // namespace misfit::imager
