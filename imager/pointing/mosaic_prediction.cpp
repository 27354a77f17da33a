#include "imager/pointing/mosaic_prediction.h"

#include <algorithm>
#include <list>
#include <utility>

#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

/// A model as a window's beam shows it at each node of a span.
struct PredictedWindow {
  std::shared_ptr<const SeenWindow> seen;
  const FrequencySpan* span;
  std::vector<std::unique_ptr<Prediction>> at_node;  ///< null where it shows nothing
};

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
    double sum = past_fft_s_;
    for (const PredictedWindow& window : kept_) sum += fft_s(window);
    return sum;
  }

 private:
  struct Work {
    std::shared_ptr<const SeenWindow> seen;
    const FrequencySpan* span;
    std::vector<BlockPart> parts;
  };

  static double fft_s(const PredictedWindow& window) {
    double sum = 0;
    for (const auto& prediction : window.at_node)
      if (prediction) sum += prediction->fft_s();
    return sum;
  }

  /// The work of each window, in the order in which samples ask for it.
  std::vector<Work> work_of(const std::vector<Asked>& asked) const {
    std::vector<Work> all;
    for (std::size_t b = 0; b < asked.size(); ++b)
      for (const RowBeams::Group& group : windows_->beams().groups(*asked[b].at)) {
        const std::shared_ptr<const SeenWindow> seen = windows_->seen(group);
        if (!seen) continue;
        for (const FrequencySpan* span : windows_->beams().spans(asked[b].at->frequency_hz)) {
          auto work = std::find_if(all.begin(), all.end(), [&](const Work& w) { return w.seen == seen && w.span == span; });
          if (work == all.end()) work = all.insert(all.end(), {seen, span, {}});
          work->parts.push_back({b, windows_->samples(*seen, *asked[b].at, group.rows, *span)});
        }
      }
    return all;
  }

  std::vector<std::vector<std::complex<double>>> predict(const std::vector<Asked>& asked) const {
    const std::lock_guard lock(mutex_);
    std::vector<std::vector<std::complex<double>>> visibilities;
    for (const Asked& one : asked) visibilities.emplace_back(one.at->samples());
    for (const Work& work : work_of(asked)) {
      const PredictedWindow& window = predicted(work);
      const std::vector<VisibilityBlock> blocks = blocks_of(work, asked);
      std::vector<const VisibilityBlock*> pointers;
      for (const VisibilityBlock& block : blocks) pointers.push_back(&block);
      for (std::size_t k = 0; k < window.at_node.size(); ++k) {
        if (!window.at_node[k]) continue;
        const auto found = window.at_node[k]->at_usable_of(pointers);
        for (std::size_t p = 0; p < work.parts.size(); ++p)
          add(work.parts[p].samples, k, found[p], *asked[work.parts[p].block].at, visibilities[work.parts[p].block]);
      }
    }
    return visibilities;
  }

  /// The samples as the window's transform takes them; those that are not wanted without weight.
  static std::vector<VisibilityBlock> blocks_of(const Work& work, const std::vector<Asked>& asked) {
    std::vector<VisibilityBlock> blocks;
    for (const BlockPart& part : work.parts) {
      const WindowSamples& s = part.samples;
      const Asked& of = asked[part.block];
      VisibilityBlock& block = blocks.emplace_back();
      static_cast<SampleCoordinates&>(block) = s.at;
      block.weight.assign(s.size(), 1);
      if (of.weight == nullptr) continue;
      for (std::size_t r = 0; r < s.rows.size(); ++r)
        for (std::size_t c = 0; c < s.channels.size(); ++c)
          block.weight[r * s.channels.size() + c] = (*of.weight)[s.rows[r] * of.at->channels() + s.channels[c]];
    }
    return blocks;
  }

  void add(const WindowSamples& s, std::size_t node, const std::vector<std::complex<double>>& found,
           const SampleCoordinates& block, std::vector<std::complex<double>>& to) const {
    constexpr std::size_t rows_a_piece = 1024;
    const std::size_t channels = s.channels.size();
    parallel_for((s.rows.size() + rows_a_piece - 1) / rows_a_piece, windows_->options().threads, [&](std::size_t p) {
      for (std::size_t r = p * rows_a_piece; r < std::min((p + 1) * rows_a_piece, s.rows.size()); ++r)
        for (std::size_t c = 0; c < channels; ++c) {
          const std::size_t at = r * channels + c;
          const std::complex<double> seen = s.share[c][node] * found[at];
          to[s.rows[r] * block.channels() + s.channels[c]] += s.phase.empty() ? seen : s.phase[at] * seen;
        }
    });
  }

  /// The window that is asked last comes last.
  const PredictedWindow& predicted(const Work& work) const {
    const auto found = std::find_if(kept_.begin(), kept_.end(), [&](const PredictedWindow& window) {
      return window.seen == work.seen && window.span == work.span;
    });
    if (found != kept_.end()) {
      kept_.splice(kept_.end(), kept_, found);
      return kept_.back();
    }
    while (!kept_.empty() && kept_.size() >= windows_->options().windows_at_once) {
      past_fft_s_ += fft_s(kept_.front());
      kept_.pop_front();
    }
    PredictedWindow window{work.seen, work.span, {}};
    for (const double hz : work.span->node_hz) {
      Image shown = windows_->beams().image(work.seen->beam, work.seen->window, hz, windows_->options().threads);
      bool shows = false;
      for (int row = 0; row < shown.height; ++row) {
        const double* const from = model_.row(work.seen->window.first_row + row) + work.seen->window.first_column;
        for (int column = 0; column < shown.width; ++column) {
          double& pixel = shown.at(row, column);
          pixel = from[column] == 0 ? 0 : pixel * from[column];
          shows = shows || pixel != 0;
        }
      }
      window.at_node.push_back(shows ? work.seen->transform->predict(std::move(shown)) : nullptr);
    }
    return kept_.emplace_back(std::move(window));
  }

  std::shared_ptr<const MosaicWindows> windows_;
  Image model_;
  mutable std::mutex mutex_;  ///< of what follows
  mutable std::list<PredictedWindow> kept_;
  mutable double past_fft_s_ = 0;
};

}  // namespace

std::unique_ptr<Prediction> make_mosaic_prediction(std::shared_ptr<const MosaicWindows> windows, Image model) {
  return std::make_unique<MosaicPrediction>(std::move(windows), std::move(model));
}

}  // namespace misfit::imager
