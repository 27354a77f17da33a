#include "imager/pointing/mosaic_adjoint.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "imager/data/horizon.h"
#include "imager/numerics/parallel.h"
#include "imager/transform/sampling.h"
#include "imager/transform/span_sums.h"

namespace misfit::imager {
namespace {

constexpr std::size_t rows_a_piece = 1024;  // that a thread takes at a time

using Values = std::variant<std::vector<std::complex<float>>, std::vector<std::complex<double>>>;

/// Samples of a block that wait for their window to be computed.
struct Waiting {
  WindowSamples samples;
  std::vector<float> weight;   ///< [row][channel]
  std::vector<Values> values;  ///< [image]: of the block's precision. [row][channel]
};

/// All that waits for a window, in the order in which it came.
struct WaitingWindow {
  std::shared_ptr<const SeenWindow> seen;
  const BeamSpan* span;
  std::vector<Waiting> parts;
};

/// The images that are made of a window, which are then added to the whole.
struct WindowImages {
  std::vector<Image> images;       ///< last the PSF, where the window's beam sees its source
  std::vector<Image> sensitivity;  ///< [power of x]
  double fft_s = 0;
};

/// Some images that are made at once.
struct Together {
  std::size_t first;  ///< image
  std::unique_ptr<AdjointSum> sum;
};

class MosaicAdjoint : public AdjointSum {
 public:
  MosaicAdjoint(std::shared_ptr<const MosaicWindows> windows, const AdjointOptions& options)
      : AdjointSum(options), windows_(std::move(windows)) {
    const ImageGeometry& g = geometry();
    for (std::size_t i = 0; i < images(); ++i) result_.images.emplace_back(g.width, g.height);
    if (options.with_psf) result_.psf = Image(g.width, g.height);
    if (options.with_sensitivity) result_.sensitivity = Image(g.width, g.height);
    for (int k = 0; options.with_sensitivity && k < options.sensitivity_powers; ++k)
      result_.further_sensitivity.emplace_back(g.width, g.height);
    result_.sums.resize(sets());
  }

  AdjointResult finish() override {
    add_windows();
    for (Image& image : result_.images) set_beyond_horizon(geometry(), no_value, image);
    if (options_.with_psf) set_beyond_horizon(geometry(), no_value, result_.psf);
    return std::move(result_);
  }

 protected:
  void add_sets(const VisibilityBlock& block, const VisibilitySets& sets) override {
    SampleSums counted;
    const std::vector<float> weight = imaging_weights(block, {geometry(), options_.beyond_grid, o().threads}, counted);
    for (std::size_t s = 0; s < sets.size(); ++s) {
      result_.sums[s] += counted;
      std::visit([&](const auto* v) { add_span_to_sums(weight.data(), v, weight.size(), result_.sums[s]); }, sets[s]);
    }
    for (const RowBeams::Group& group : windows_->beams().groups(block)) {
      const std::shared_ptr<const SeenWindow> seen = windows_->seen(group);
      if (!seen || !is_wanted(*seen)) continue;
      for (const BeamSpan* span : windows_->beams().spans(block.frequency_hz))
        keep(waiting(seen, span), windows_->samples(block, group.rows, *span), block.channels(), weight, sets);
    }
    if (samples_ >= o().samples_at_once) add_windows();
  }

 private:
  const ImageGeometry& geometry() const { return windows_->beams().geometry(); }
  const MosaicOptions& o() const { return windows_->options(); }
  /// Powers of x of which sensitivities are made.
  std::size_t powers() const { return options_.with_sensitivity ? 1 + result_.further_sensitivity.size() : 0; }
  bool has_psf(const SeenWindow& seen) const { return options_.with_psf && windows_->sees_psf(seen); }
  bool is_wanted(const SeenWindow& seen) const { return images() > 0 || powers() > 0 || has_psf(seen); }

  WaitingWindow& waiting(const std::shared_ptr<const SeenWindow>& seen, const BeamSpan* span) {
    const auto found = std::find_if(waiting_.begin(), waiting_.end(),
                                    [&](const WaitingWindow& window) { return window.seen == seen && window.span == span; });
    return found != waiting_.end() ? *found : waiting_.emplace_back(WaitingWindow{seen, span, {}});
  }

  void keep(WaitingWindow& window, WindowSamples samples, std::size_t block_channels, const std::vector<float>& block_weight,
            const VisibilitySets& sets) {
    const auto of_block = [&](const auto* from, auto& to) {
      const std::size_t channels = samples.channels.size();
      to.resize(samples.size());
      parallel_for((samples.rows.size() + rows_a_piece - 1) / rows_a_piece, o().threads, [&](std::size_t p) {
        for (std::size_t r = p * rows_a_piece; r < std::min((p + 1) * rows_a_piece, samples.rows.size()); ++r)
          for (std::size_t c = 0; c < channels; ++c)
            to[r * channels + c] = from[samples.rows[r] * block_channels + samples.channels[c]];
      });
    };
    Waiting kept;
    of_block(block_weight.data(), kept.weight);
    for (std::size_t i = 0; i < images(); ++i)
      std::visit(
          [&](const auto* from) {
            std::vector<std::remove_cv_t<std::remove_pointer_t<decltype(from)>>> values;
            of_block(from, values);
            kept.values.emplace_back(std::move(values));
          },
          sets[i]);
    samples_ += samples.size();
    kept.samples = std::move(samples);
    window.parts.push_back(std::move(kept));
  }

  /// Computes all windows that wait, some at a time, and adds them to the images in the order in which they came.
  void add_windows() {
    std::vector<WindowImages> made(waiting_.size());
    parallel_in_order(
        waiting_.size(), o().side_by_side,
        [&](std::size_t i) {
          made[i] = images_of(waiting_[i]);
          waiting_[i].parts = {};
        },
        [&](std::size_t i) {
          add(waiting_[i].seen->window, made[i]);
          made[i] = {};
        });
    waiting_.clear();
    samples_ = 0;
  }

  void add(const Window& window, const WindowImages& of_window) {
    result_.fft_s += of_window.fft_s / std::min<double>(o().side_by_side, static_cast<double>(waiting_.size()));
    for (std::size_t i = 0; i < of_window.images.size(); ++i)
      add_window(window, of_window.images[i], i < images() ? result_.images[i] : result_.psf);
    for (std::size_t p = 0; p < of_window.sensitivity.size(); ++p)
      add_window(window, of_window.sensitivity[p], p == 0 ? result_.sensitivity : result_.further_sensitivity[p - 1]);
  }

  void add_window(const Window& window, const Image& part, Image& image) const {
    parallel_for(static_cast<std::size_t>(part.height), o().threads_of_each(), [&](std::size_t r) {
      const int row = static_cast<int>(r);
      const double* const from = part.row(row);
      double* const to = image.row(window.first_row + row) + window.first_column;
      for (int column = 0; column < part.width; ++column) to[column] += from[column];
    });
  }

  WindowImages images_of(WaitingWindow& window) const {
    const ImageGeometry& g = window.seen->window.geometry;
    WindowImages made{std::vector<Image>(images() + (has_psf(*window.seen) ? 1 : 0), Image(g.width, g.height)), {}, 0};
    for (std::size_t power = 0; power < powers(); ++power) made.sensitivity.push_back(sensitivity_of(window, power));
    if (made.images.empty()) return made;
    std::vector<std::vector<std::complex<double>>> psf;  // [part]
    if (has_psf(*window.seen))
      for (const Waiting& part : window.parts) psf.push_back(windows_->psf_source(*window.seen, *window.span, part.samples));
    if (windows_->is_curved()) {
      add_curved(window, psf, made);
      return made;
    }
    const std::vector<Image> terms = windows_->beam_terms(*window.seen, *window.span);
    for (std::size_t k = 0; k < windows_->terms(*window.span); ++k) add_term(window, psf, k, terms[k], made);
    return made;
  }

  /// Adds what the samples make of all curved terms of the beams.
  void add_curved(WaitingWindow& window, const std::vector<std::vector<std::complex<double>>>& psf, WindowImages& made) const {
    const std::size_t terms = windows_->terms(*window.span);
    const std::shared_ptr<const SharedTransform> transform = windows_->curved_transform(window.seen->window);
    std::vector<CurvedSamples> samples;
    for (Waiting& part : window.parts)
      samples.push_back(windows_->curved_samples(*window.seen, *window.span, part.samples.at, std::move(part.weight)));
    const std::size_t at_once = std::min(terms, windows_->curved_at_once()), sets = made.images.size();
    const std::size_t together = std::clamp<std::size_t>(windows_->curved_at_once() / at_once, 1, most_stokes);
    for (std::size_t term = 0; term < terms; term += at_once) {
      const std::size_t count = std::min(at_once, terms - term);
      const std::vector<Image> beams = windows_->curved_images(*window.seen, *window.span, term, count);
      for (std::size_t first = 0; first < sets; first += together) {
        const std::size_t some = std::min(together, sets - first);
        const auto sum = transform->adjoint(some, count);
        for (std::size_t p = 0; p < window.parts.size(); ++p) {
          VisibilitySets values;
          for (std::size_t i = first; i < first + some; ++i)
            if (i < images())
              std::visit([&](const auto& of) { values.push_back(of.data()); }, window.parts[p].values[i]);
            else
              values.push_back(psf[p].data());
          sum->add(samples[p].at, values, samples[p].shares(term, count));
        }
        sum->finish([&](std::size_t set, std::size_t k, const Image& image) {
          add_product(beams[k], image, made.images[first + set]);
        });
        made.fft_s += sum->fft_s();
      }
    }
  }

  /// Adds what the samples make of a term of the beams.
  void add_term(const WaitingWindow& window, const std::vector<std::vector<std::complex<double>>>& psf, std::size_t term,
                const Image& beam, WindowImages& made) const {
    const std::shared_ptr<const Transform> transform = windows_->transform(window.seen->window, term);
    std::vector<Together> all;
    for (std::size_t first = 0; first < made.images.size(); first += most_stokes) {
      const std::size_t some = std::min<std::size_t>(made.images.size() - first, most_stokes);
      // The samples were chosen by the u and v that they have about the phase centre.
      all.push_back({first, transform->adjoint({.images = static_cast<int>(some), .beyond_grid = true})});
    }
    for (std::size_t p = 0; p < window.parts.size(); ++p) {
      const Waiting& part = window.parts[p];
      VisibilityBlock here;
      static_cast<SampleCoordinates&>(here) = part.samples.at;
      here.weight = part.weight;
      for (const Together& some : all) {
        const std::size_t end = std::min<std::size_t>(made.images.size(), some.first + most_stokes);
        std::vector<std::vector<std::complex<double>>> values;
        for (std::size_t i = some.first; i < end; ++i) {
          const auto share_of = [&](const auto& of) { return shares(part.samples, of, term); };
          values.push_back(i < images() ? std::visit(share_of, part.values[i]) : share_of(psf[p]));
        }
        some.sum->add(here, values);
      }
    }
    for (const Together& some : all) {
      const AdjointResult result = some.sum->finish();
      made.fft_s += result.fft_s;
      for (std::size_t i = 0; i < result.images.size(); ++i) add_product(beam, result.images[i], made.images[some.first + i]);
    }
  }

  /// What the samples give to a term. [row][channel]
  template <typename Value>
  std::vector<std::complex<double>> shares(const WindowSamples& samples, const std::vector<Value>& of, std::size_t term) const {
    std::vector<std::complex<double>> values(samples.size());
    const std::size_t channels = samples.channels.size();
    parallel_for((samples.rows.size() + rows_a_piece - 1) / rows_a_piece, o().threads_of_each(), [&](std::size_t p) {
      for (std::size_t r = p * rows_a_piece; r < std::min((p + 1) * rows_a_piece, samples.rows.size()); ++r)
        for (std::size_t c = 0; c < channels; ++c)
          values[r * channels + c] = samples.share[c][term] * std::complex<double>(of[r * channels + c]);
    });
    return values;
  }

  /// Where the beam is 0 no window has a value that counts, nor beyond the horizon one at all.
  void add_product(const Image& beam, const Image& image, Image& sum) const {
    parallel_for(static_cast<std::size_t>(sum.height), o().threads_of_each(), [&](std::size_t r) {
      const int row = static_cast<int>(r);
      for (int column = 0; column < sum.width; ++column)
        if (beam.at(row, column) != 0) sum.at(row, column) += beam.at(row, column) * image.at(row, column);
    });
  }

  /// Σ w x^power B².
  Image sensitivity_of(const WaitingWindow& window, std::size_t power) const {
    const std::size_t count = window.span->terms();
    std::vector<double> weight(count * count);  // Σ w x^power of the products of shares
    for (const Waiting& part : window.parts)
      for (std::size_t c = 0, channels = part.samples.channels.size(); c < channels; ++c) {
        double sum = 0;
        for (std::size_t r = 0; r < part.samples.rows.size(); ++r) sum += double{part.weight[r * channels + c]};
        for (std::size_t p = 0; p < power; ++p) sum *= part.samples.at.frequency_hz[c] / options_.sensitivity_reference_hz - 1;
        for (std::size_t k = 0; k < count; ++k)
          for (std::size_t j = 0; j <= k; ++j)
            weight[k * count + j] += (j < k ? 2 : 1) * sum * part.samples.share[c][k] * part.samples.share[c][j];
      }
    return windows_->beams().squares(window.seen->beam, window.seen->window, *window.span, weight, o().threads_of_each());
  }

  std::shared_ptr<const MosaicWindows> windows_;
  AdjointResult result_;
  std::vector<WaitingWindow> waiting_;
  std::size_t samples_ = 0;  ///< that wait
};

}  // namespace

std::unique_ptr<AdjointSum> make_mosaic_adjoint(std::shared_ptr<const MosaicWindows> windows, const AdjointOptions& options) {
  return std::make_unique<MosaicAdjoint>(std::move(windows), options);
}

}  // namespace misfit::imager
