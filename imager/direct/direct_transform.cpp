#include "imager/direct/direct_transform.h"

#include <algorithm>
#include <array>

#include "imager/data/horizon.h"
#include "imager/data/phase.h"
#include "imager/numerics/constants.h"
#include "imager/numerics/parallel.h"
#include "imager/numerics/phasors.h"
#include "imager/transform/sampling.h"
#include "imager/transform/span_sums.h"
#include "imager/transform/unit_source.h"

namespace misfit::imager {
namespace {

/// The position `at` as seen from `origin`: phases subtract.
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

constexpr std::size_t at_once = 256;

/// exp(2πi(ul+vm+w(n−1))) of consecutive samples [begin, begin + count).
struct Phasors {
  std::size_t begin;
  std::size_t count;
  double cosine[at_once], sine[at_once];
};

/// Calls visit(phasors) for the samples, some at a time.
template <typename Visit>
void for_phasors(const Wavelengths& at, const PhasePosition& to, const Visit& visit) {
  double turns[at_once];
  Phasors p;
  for (p.begin = 0; p.begin < at.size(); p.begin += at_once) {
    p.count = std::min(at_once, at.size() - p.begin);
    for (std::size_t i = 0; i < p.count; ++i)
      turns[i] = at.u[p.begin + i] * to.l + at.v[p.begin + i] * to.m + at.w[p.begin + i] * to.n_minus_1;
    phasors(turns, static_cast<int>(p.count), p.cosine, p.sine);
    visit(p);
  }
}

/// The samples of a block that take part in imaging, with w V of each set.
struct WeightedSamples {
  struct Values {
    std::vector<double> real, imaginary;
  };
  using Sums = std::array<double, most_stokes>;  ///< [set]

  Wavelengths at;
  std::vector<double> weight;
  std::vector<Values> values;          ///< [set]
  std::vector<std::size_t> of_sample;  ///< of the block

  WeightedSamples(const VisibilityBlock& block, const std::vector<float>& weights, const VisibilitySets& sets,
                  std::size_t begin, std::size_t end)
      : values(sets.size()) {
    for (std::size_t i = begin; i < end; ++i) {
      if (weights[i] == 0) continue;
      at.push_back(&block.uvw_m[3 * (i / block.channels())], block.frequency_hz[i % block.channels()]);
      weight.push_back(weights[i]);
      of_sample.push_back(i);
      for (std::size_t s = 0; s < sets.size(); ++s) {
        const auto v = std::visit([i](const auto* visibility) { return std::complex<double>(visibility[i]); }, sets[s]);
        values[s].real.push_back(weight.back() * v.real());
        values[s].imaginary.push_back(weight.back() * v.imag());
      }
    }
  }

  /// Σ w Re[V exp(−2πi(…))].
  Sums images_at(const PhasePosition& to) const {
    return images_at(to, [](Phasors&) {});
  }
  /// Σ w B Re[V exp(−2πi(…))], with the response B to a pixel.
  Sums images_at(const PhasePosition& to, const BlockResponse& response, std::size_t pixel) const {
    return images_at(to, [&](Phasors& p) {
      for (std::size_t i = 0; i < p.count; ++i) {
        const double seen = response.at(pixel, of_sample[p.begin + i]);
        p.cosine[i] *= seen;
        p.sine[i] *= seen;
      }
    });
  }
  template <typename Change>
  Sums images_at(const PhasePosition& to, const Change& change) const {
    Sums sums{};
    for_phasors(at, to, [&](Phasors& p) {
      change(p);
      for (std::size_t s = 0; s < values.size(); ++s) {
        const double* real = &values[s].real[p.begin];
        const double* imaginary = &values[s].imaginary[p.begin];
        double sum = sums[s];
        for (std::size_t i = 0; i < p.count; ++i) sum += real[i] * p.cosine[i] + imaginary[i] * p.sine[i];
        sums[s] = sum;
      }
    });
    return sums;
  }
  /// Σ w Re[exp(−2πi(…))], which is images_at() for V = 1.
  double beam_at(const PhasePosition& to) const {
    double sum = 0;
    for_phasors(at, to, [&](const Phasors& p) {
      for (std::size_t i = 0; i < p.count; ++i) sum += weight[p.begin + i] * p.cosine[i];
    });
    return sum;
  }
};

/// The weights of the samples that take part in imaging; adds to the sums of each set.
std::vector<float> counted_weights(const VisibilityBlock& block, const VisibilitySets& sets, const ImagedSamples& imaged,
                                   std::vector<SampleSums>& sums) {
  SampleSums counted;
  std::vector<float> weight = imaging_weights(block, imaged, counted);
  for (std::size_t s = 0; s < sets.size(); ++s) {
    sums[s] += counted;
    std::visit([&](const auto* v) { add_span_to_sums(weight.data(), v, weight.size(), sums[s]); }, sets[s]);
  }
  return weight;
}

class DirectAdjoint : public AdjointSum {
 public:
  DirectAdjoint(const DirectSums& o, const AdjointOptions& options) : AdjointSum(options), o_(o) {
    for (std::size_t i = 0; i < images(); ++i) result_.images.emplace_back(o.geometry.width, o.geometry.height);
    result_.sums.resize(sets());
    if (options.with_psf) result_.psf = Image(o.geometry.width, o.geometry.height);
  }

  AdjointResult finish() override {
    for (Image& image : result_.images) set_beyond_horizon(o_.geometry, no_value, image);
    if (options_.with_psf) set_beyond_horizon(o_.geometry, no_value, result_.psf);
    return std::move(result_);
  }

 protected:
  void add_sets(const VisibilityBlock& block, const VisibilitySets& sets) override {
    const std::vector<float> weight =
        counted_weights(block, sets, {o_.geometry, options_.beyond_grid, o_.threads}, result_.sums);
    VisibilitySets imaged = sets;
    imaged.resize(images());
    const WeightedSamples samples(block, weight, imaged, 0, weight.size());
    const PhasePosition middle = position_of(o_.geometry.centre, o_.with_w);
    parallel_for(static_cast<std::size_t>(o_.geometry.height), o_.threads, [&](std::size_t r) {
      const int row = static_cast<int>(r);
      for (int column = 0; column < o_.geometry.width; ++column) {
        const PhasePosition at = position_of(o_.geometry.at(row, column), o_.with_w);
        if (!imaged.empty()) {
          const WeightedSamples::Sums sums = samples.images_at(at);
          for (std::size_t s = 0; s < imaged.size(); ++s) result_.images[s].at(row, column) += sums[s];
        }
        if (options_.with_psf) result_.psf.at(row, column) += samples.beam_at(relative(at, middle));
      }
    });
  }

 private:
  DirectSums o_;
  AdjointResult result_;
};

/// The sums that the samples of a block add at some pixels. Threads share the samples in pieces of one size, so that any number
/// of threads gives the same bits.
struct PixelSums {
  std::vector<WeightedSamples::Sums> of_sets;  ///< [pixel]
  std::vector<double> of_psf;                  ///< [pixel], where it was wanted
};

PixelSums sums_at_pixels(const VisibilityBlock& block, const std::vector<float>& weight, const VisibilitySets& sets,
                         const DirectPixels& at, bool with_psf) {
  constexpr std::size_t samples_a_piece = 1 << 14;
  const std::size_t pixels = at.pixel.size(), pieces = (weight.size() + samples_a_piece - 1) / samples_a_piece;
  const PhasePosition middle = position_of(at.geometry.centre, at.with_w);
  BlockResponse response;
  if (at.response) {
    std::vector<DirectionCosines> directions;
    for (const Pixel& pixel : at.pixel) directions.push_back(at.geometry.at(pixel.row, pixel.column));
    response = at.response->of(block, directions);
  }
  std::vector<PixelSums> part(pieces, {std::vector<WeightedSamples::Sums>(pixels), std::vector<double>(pixels)});
  parallel_for(pieces, at.threads, [&](std::size_t p) {
    const std::size_t begin = p * samples_a_piece;
    const WeightedSamples samples(block, weight, sets, begin, std::min(begin + samples_a_piece, weight.size()));
    for (std::size_t k = 0; k < pixels; ++k) {
      const PhasePosition to = position_of(at.geometry.at(at.pixel[k].row, at.pixel[k].column), at.with_w);
      if (!sets.empty()) part[p].of_sets[k] = at.response ? samples.images_at(to, response, k) : samples.images_at(to);
      if (with_psf) part[p].of_psf[k] = samples.beam_at(relative(to, middle));
    }
  });
  PixelSums all{std::vector<WeightedSamples::Sums>(pixels), std::vector<double>(pixels)};
  for (const PixelSums& one : part)
    for (std::size_t k = 0; k < pixels; ++k) {
      for (std::size_t s = 0; s < sets.size(); ++s) all.of_sets[k][s] += one.of_sets[k][s];
      all.of_psf[k] += one.of_psf[k];
    }
  return all;
}

class PixelAdjoint : public AdjointSum {
 public:
  PixelAdjoint(const DirectPixels& at, const AdjointOptions& options) : AdjointSum(options), at_(at) {
    const Image none(static_cast<int>(at.pixel.size()), 1);
    result_.images.assign(images(), none);
    result_.sums.resize(sets());
    if (options.with_psf) result_.psf = none;
  }

  AdjointResult finish() override { return std::move(result_); }

 protected:
  void add_sets(const VisibilityBlock& block, const VisibilitySets& sets) override {
    const std::vector<float> weight =
        counted_weights(block, sets, {at_.geometry, options_.beyond_grid, at_.threads}, result_.sums);
    VisibilitySets imaged = sets;
    imaged.resize(images());
    const PixelSums sums = sums_at_pixels(block, weight, imaged, at_, options_.with_psf);
    for (std::size_t k = 0; k < at_.pixel.size(); ++k) {
      for (std::size_t s = 0; s < imaged.size(); ++s) result_.images[s].pixel[k] += sums.of_sets[k][s];
      if (options_.with_psf) result_.psf.pixel[k] += sums.of_psf[k];
    }
  }

 private:
  const DirectPixels& at_;
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

std::unique_ptr<AdjointSum> DirectTransform::adjoint(const AdjointOptions& options) const {
  return std::make_unique<DirectAdjoint>(sums_, options);
}

std::unique_ptr<Prediction> DirectTransform::predict(Image model) const {
  std::vector<Source> sources;
  for (int row = 0; row < model.height; ++row)
    for (int column = 0; column < model.width; ++column)
      if (model.at(row, column) != 0 && !beyond_horizon(sums_.geometry.at(row, column)))
        sources.push_back({sums_.geometry.at(row, column), model.at(row, column)});
  return std::make_unique<DirectPrediction>(std::move(sources), sums_.with_w, sums_.threads);
}

std::vector<std::complex<double>> DirectTransform::psf_source(const SampleCoordinates& at) const {
  return unit_source(at, position_of(sums_.geometry.centre, sums_.with_w), sums_.threads);
}

std::unique_ptr<AdjointSum> PixelTransform::adjoint(const AdjointOptions& options) const {
  return std::make_unique<PixelAdjoint>(at_, options);
}

void add_direct_pixels(const VisibilityBlock& block, const DirectPixels& at, std::vector<std::vector<double>>& sum) {
  SampleSums unused;
  const std::vector<float> weight = imaging_weights(block, {at.geometry, false, at.threads}, unused);
  const VisibilitySets sets(block, static_cast<int>(sum.size()));
  const PixelSums added = sums_at_pixels(block, weight, sets, at, false);
  for (std::size_t image = 0; image < sum.size(); ++image)
    for (std::size_t k = 0; k < at.pixel.size(); ++k) sum[image][k] += added.of_sets[k][image];
}

}  // namespace misfit::imager
