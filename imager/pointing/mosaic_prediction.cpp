#include "imager/pointing/mosaic_prediction.h"

#include <algorithm>
#include <mutex>
#include <optional>
#include <utility>

#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

constexpr std::size_t rows_of_a_task = 1024;  // that a thread takes at a time

/// What is asked of a prediction: where, and of which samples.
struct Asked {
  const SampleCoordinates* at;
  const std::vector<float>* weight;  ///< null: all
};

/// Samples of a block that lie in one window.
struct BlockPart {
  std::size_t block;
  WindowSamples samples;
};

/// What is asked of a window.
struct AskedWindow {
  std::shared_ptr<const SeenWindow> seen;
  const BeamSpan* span;
  std::vector<BlockPart> parts;
};

class MosaicPrediction : public Prediction {
 public:
  MosaicPrediction(std::shared_ptr<const MosaicWindows> windows, Image model)
      : windows_(std::move(windows)), model_(std::move(model)) {}

  std::vector<std::complex<double>> at(const SampleCoordinates& coordinates) const override {
    return std::move(predict({{&coordinates, nullptr}}).front());
  }
  std::vector<std::complex<double>> at_usable(const VisibilityBlock& block) const override {
    return std::move(predict({{&block, &block.weight}}).front());
  }
  std::vector<std::vector<std::complex<double>>> at_usable_of(
      const std::vector<const VisibilityBlock*>& blocks) const override {
    std::vector<Asked> asked;
    for (const VisibilityBlock* block : blocks) asked.push_back({block, &block->weight});
    return predict(asked);
  }
  std::size_t samples_at_once() const override { return windows_->options().samples_at_once; }
  double fft_s() const override {
    const std::lock_guard lock(mutex_);
    return fft_s_;
  }

 private:
  /// The windows, in the order in which samples ask for them.
  std::vector<AskedWindow> windows_of(const std::vector<Asked>& asked) const {
    std::vector<AskedWindow> all;
    for (std::size_t b = 0; b < asked.size(); ++b)
      for (const RowBeams::Group& group : windows_->beams().groups(*asked[b].at)) {
        const std::shared_ptr<const SeenWindow> seen = windows_->seen(group);
        if (!seen || !shines_in(seen->window)) continue;
        for (const BeamSpan* span : windows_->beams().spans(asked[b].at->frequency_hz)) {
          auto window =
              std::find_if(all.begin(), all.end(), [&](const AskedWindow& w) { return w.seen == seen && w.span == span; });
          if (window == all.end()) window = all.insert(all.end(), {seen, span, {}});
          window->parts.push_back({b, windows_->samples(*asked[b].at, group.rows, *span)});
        }
      }
    return all;
  }

  bool shines_in(const Window& window) const {
    for (int row = 0; row < window.geometry.height; ++row) {
      const double* const from = model_.row(window.first_row + row) + window.first_column;
      if (std::any_of(from, from + window.geometry.width, [](double pixel) { return pixel != 0; })) return true;
    }
    return false;
  }

  /// Windows have samples of their own, so that several can be predicted at a time.
  std::vector<std::vector<std::complex<double>>> predict(const std::vector<Asked>& asked) const {
    std::vector<std::vector<std::complex<double>>> visibilities;
    for (const Asked& one : asked) visibilities.emplace_back(one.at->samples());
    const std::vector<AskedWindow> windows = windows_of(asked);
    const int side_by_side = windows_->options().side_by_side;
    parallel_for(windows.size(), side_by_side, [&](std::size_t w) {
      const double fft_s =
          windows_->is_curved() ? add_curved(windows[w], asked, visibilities) : add_terms(windows[w], asked, visibilities);
      const std::lock_guard lock(mutex_);
      fft_s_ += fft_s / std::max<double>(1, std::min<double>(side_by_side, static_cast<double>(windows.size())));
    });
    return visibilities;
  }

  /// Adds what a window shows of all curved terms of its beam. Returns the seconds of FFTs.
  double add_curved(const AskedWindow& window, const std::vector<Asked>& asked,
                    std::vector<std::vector<std::complex<double>>>& visibilities) const {
    const std::size_t terms = windows_->terms(*window.span);
    const std::shared_ptr<const SharedTransform> transform = windows_->curved_transform(window.seen->window);
    std::vector<CurvedSamples> samples;
    for (const BlockPart& part : window.parts)
      samples.push_back(
          windows_->curved_samples(*window.seen, *window.span, part.samples.at, weights_of(part.samples, asked[part.block])));
    double fft_s = 0;
    for (std::size_t term = 0; term < terms; term += windows_->curved_at_once()) {
      const std::size_t count = std::min(windows_->curved_at_once(), terms - term);
      std::vector<Image> images = windows_->curved_images(*window.seen, *window.span, term, count);
      for (Image& image : images) image = shown(window.seen->window, std::move(image));
      const auto prediction = transform->predict(images);
      fft_s += prediction->fft_s();
      for (std::size_t p = 0; p < window.parts.size(); ++p) {
        const BlockPart& part = window.parts[p];
        add(part.samples, {}, prediction->at_usable(samples[p].at, samples[p].shares(term, count)),
            asked[part.block].at->channels(), visibilities[part.block]);
      }
    }
    return fft_s;
  }

  /// Adds what a window shows of each term of its beam. Returns the seconds of FFTs.
  double add_terms(const AskedWindow& window, const std::vector<Asked>& asked,
                   std::vector<std::vector<std::complex<double>>>& visibilities) const {
    std::vector<Image> terms = windows_->beam_terms(*window.seen, *window.span);
    std::vector<VisibilityBlock> blocks;
    for (const BlockPart& part : window.parts) {
      VisibilityBlock& block = blocks.emplace_back();
      block.weight = weights_of(part.samples, asked[part.block]);
      static_cast<SampleCoordinates&>(block) = part.samples.at;
    }
    std::vector<const VisibilityBlock*> pointers;
    for (const VisibilityBlock& block : blocks) pointers.push_back(&block);
    double fft_s = 0;
    for (std::size_t k = 0; k < windows_->terms(*window.span); ++k) {
      const auto prediction =
          windows_->transform(window.seen->window, k)->predict(shown(window.seen->window, std::move(terms[k])));
      const auto found = prediction->at_usable_of(pointers);
      for (std::size_t p = 0; p < window.parts.size(); ++p) {
        const BlockPart& part = window.parts[p];
        add(part.samples, k, found[p], asked[part.block].at->channels(), visibilities[part.block]);
      }
      fft_s += prediction->fft_s();
    }
    return fft_s;
  }

  /// The model as a term of a window's beam shows it.
  Image shown(const Window& window, Image shown) const {
    parallel_for(static_cast<std::size_t>(shown.height), windows_->options().threads_of_each(), [&](std::size_t r) {
      const int row = static_cast<int>(r);
      const double* const from = model_.row(window.first_row + row) + window.first_column;
      for (int column = 0; column < shown.width; ++column) {
        double& pixel = shown.at(row, column);
        pixel = from[column] == 0 ? 0 : pixel * from[column];
      }
    });
    return shown;
  }

  /// Those of samples that are not wanted are 0.
  static std::vector<float> weights_of(const WindowSamples& s, const Asked& of) {
    std::vector<float> weight(s.size(), 1);
    if (of.weight == nullptr) return weight;
    for (std::size_t r = 0; r < s.rows.size(); ++r)
      for (std::size_t c = 0; c < s.channels.size(); ++c)
        weight[r * s.channels.size() + c] = (*of.weight)[s.rows[r] * of.at->channels() + s.channels[c]];
    return weight;
  }

  /// With the shares of a term, or in full.
  void add(const WindowSamples& s, std::optional<std::size_t> term, const std::vector<std::complex<double>>& found,
           std::size_t block_channels, std::vector<std::complex<double>>& to) const {
    const std::size_t channels = s.channels.size();
    parallel_for(
        (s.rows.size() + rows_of_a_task - 1) / rows_of_a_task, windows_->options().threads_of_each(), [&](std::size_t p) {
          for (std::size_t r = p * rows_of_a_task; r < std::min((p + 1) * rows_of_a_task, s.rows.size()); ++r)
            for (std::size_t c = 0; c < channels; ++c)
              to[s.rows[r] * block_channels + s.channels[c]] += (term ? s.share[c][*term] : 1) * found[r * channels + c];
        });
  }

  std::shared_ptr<const MosaicWindows> windows_;
  Image model_;
  mutable std::mutex mutex_;  ///< of what follows
  mutable double fft_s_ = 0;
};

}  // namespace

std::unique_ptr<Prediction> make_mosaic_prediction(std::shared_ptr<const MosaicWindows> windows, Image model) {
  return std::make_unique<MosaicPrediction>(std::move(windows), std::move(model));
}

}  // namespace misfit::imager
