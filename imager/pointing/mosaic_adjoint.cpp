#include "imager/pointing/mosaic_adjoint.h"

#include <algorithm>
#include <list>
#include <utility>

#include "imager/data/horizon.h"
#include "imager/numerics/parallel.h"
#include "imager/transform/sampling.h"
#include "imager/transform/span_sums.h"

namespace misfit::imager {
namespace {

/// Samples of a window that were added, each at every node of its span.
struct AddedWindow {
  std::shared_ptr<const SeenWindow> seen;
  const FrequencySpan* span;
  std::vector<std::unique_ptr<AdjointSum>> sums;  ///< of most_stokes images each but the last: [node][image]
  std::vector<std::vector<double>> weight;        ///< Σ w x^k of shares [power k][node][node]
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
    while (!added_.empty()) finish_window(added_.front()), added_.pop_front();
    for (Image& image : result_.images) set_beyond_horizon(geometry(), no_value, image);
    if (options_.with_psf) set_beyond_horizon(geometry(), no_value, result_.psf);
    return std::move(result_);
  }

 protected:
  void add_sets(const VisibilityBlock& block, const VisibilitySets& sets) override {
    const int threads = windows_->options().threads;
    SampleSums counted;
    const std::vector<float> weight = imaging_weights(block, {geometry(), options_.beyond_grid, threads}, counted);
    for (std::size_t s = 0; s < sets.size(); ++s) {
      result_.sums[s] += counted;
      std::visit([&](const auto* v) { add_span_to_sums(weight.data(), v, weight.size(), result_.sums[s]); }, sets[s]);
    }
    for (const RowBeams::Group& group : windows_->beams().groups(block)) {
      const std::shared_ptr<const SeenWindow> seen = windows_->seen(group);
      if (!seen) continue;
      for (const FrequencySpan* span : windows_->beams().spans(block.frequency_hz))
        add({seen, span}, windows_->samples(*seen, block, group.rows, *span), block, weight, sets);
    }
  }

 private:
  struct Place {
    std::shared_ptr<const SeenWindow> seen;
    const FrequencySpan* span;
  };

  const ImageGeometry& geometry() const { return windows_->beams().geometry(); }
  std::size_t images_of_a_node() const { return images() + (options_.with_psf ? 1 : 0); }

  /// The window that is added to last comes last.
  AddedWindow& added(const Place& place) {
    const auto found = std::find_if(added_.begin(), added_.end(), [&](const AddedWindow& window) {
      return window.seen == place.seen && window.span == place.span;
    });
    if (found != added_.end()) {
      added_.splice(added_.end(), added_, found);
      return added_.back();
    }
    while (!added_.empty() && added_.size() >= windows_->options().windows_at_once)
      finish_window(added_.front()), added_.pop_front();
    const std::size_t nodes = place.span->node_hz.size();
    AddedWindow window{place.seen, place.span, {}, {}};
    window.weight.resize(1 + result_.further_sensitivity.size(), std::vector<double>(nodes * nodes));
    for (std::size_t left = nodes * images_of_a_node(); left > 0;) {
      const std::size_t some = std::min<std::size_t>(left, most_stokes);
      // Whether a sample counts was decided by its own u and v, which a plane changes.
      window.sums.push_back(place.seen->transform->adjoint({.images = static_cast<int>(some), .beyond_grid = true}));
      left -= some;
    }
    return added_.emplace_back(std::move(window));
  }

  void add(const Place& place, const WindowSamples& samples, const VisibilityBlock& block, const std::vector<float>& weight,
           const VisibilitySets& sets) {
    AddedWindow& window = added(place);
    const std::size_t nodes = place.span->node_hz.size(), channels = samples.channels.size();
    VisibilityBlock here;
    static_cast<SampleCoordinates&>(here) = samples.at;
    here.weight.resize(samples.size());
    std::vector<double> channel_weight(channels);
    for (std::size_t r = 0; r < samples.rows.size(); ++r)
      for (std::size_t c = 0; c < channels; ++c) {
        const float w = weight[samples.rows[r] * block.channels() + samples.channels[c]];
        here.weight[r * channels + c] = w;
        channel_weight[c] += double{w};
      }
    for (std::size_t c = 0; c < channels; ++c) {
      double weighed = channel_weight[c];
      for (std::vector<double>& of_power : window.weight) {
        for (std::size_t k = 0; k < nodes; ++k)
          for (std::size_t j = 0; j < nodes; ++j)
            of_power[k * nodes + j] += weighed * samples.share[c][k] * samples.share[c][j];
        weighed *= samples.at.frequency_hz[c] / options_.sensitivity_reference_hz - 1;
      }
    }
    const std::vector<std::vector<std::complex<double>>> values = values_of(place, samples, block, sets);
    for (std::size_t k = 0, first = 0; k < window.sums.size(); first += most_stokes, ++k) {
      VisibilitySets some;
      for (std::size_t i = first; i < std::min(values.size(), first + most_stokes); ++i) some.emplace_back(values[i].data());
      window.sums[k]->add(here, some);
    }
  }

  /// The visibilities of each node's images, as the window has them. [node · images + image][row][channel]
  std::vector<std::vector<std::complex<double>>> values_of(const Place& place, const WindowSamples& samples,
                                                           const VisibilityBlock& block, const VisibilitySets& sets) const {
    const std::size_t nodes = place.span->node_hz.size(), channels = samples.channels.size(), each = images_of_a_node();
    std::vector<std::complex<double>> psf;
    if (options_.with_psf) psf = windows_->psf_source(*place.seen, *place.span, samples, block);
    std::vector<std::vector<std::complex<double>>> values(nodes * each, std::vector<std::complex<double>>(samples.size()));
    constexpr std::size_t rows_a_piece = 1024;
    parallel_for((samples.rows.size() + rows_a_piece - 1) / rows_a_piece, windows_->options().threads, [&](std::size_t p) {
      const std::size_t begin = p * rows_a_piece, end = std::min(begin + rows_a_piece, samples.rows.size());
      for (std::size_t i = 0; i < each; ++i) {
        const auto fill = [&](const auto& value) {
          for (std::size_t r = begin; r < end; ++r)
            for (std::size_t c = 0; c < channels; ++c) {
              const std::size_t at = r * channels + c;
              std::complex<double> v = value(r, c, at);
              if (!samples.phase.empty()) v *= std::conj(samples.phase[at]);
              for (std::size_t k = 0; k < nodes; ++k) values[k * each + i][at] = samples.share[c][k] * v;
            }
        };
        if (i == images())
          fill([&](std::size_t, std::size_t, std::size_t at) { return psf[at]; });
        else
          std::visit(
              [&](const auto* from) {
                fill([&](std::size_t r, std::size_t c, std::size_t) {
                  return std::complex<double>(from[samples.rows[r] * block.channels() + samples.channels[c]]);
                });
              },
              sets[i]);
      }
    });
    return values;
  }

  /// Adds what came of a window to the images.
  void finish_window(AddedWindow& added) {
    const int threads = windows_->options().threads;
    const SeenWindow& seen = *added.seen;
    const std::vector<double>& node_hz = added.span->node_hz;
    std::vector<Image> of_beam;
    for (const double hz : node_hz) of_beam.push_back(windows_->beams().image(seen.beam, seen.window, hz, threads));
    std::size_t number = 0;
    for (auto& sum : added.sums) {
      AdjointResult result = sum->finish();
      sum.reset();
      result_.fft_s += result.fft_s;
      for (const Image& image : result.images) {
        const std::size_t node = number / images_of_a_node(), which = number % images_of_a_node();
        add_window(seen.window, which < images() ? result_.images[which] : result_.psf, [&](int row, int column) {
          const double beam = of_beam[node].at(row, column);
          return beam == 0 ? 0 : beam * image.at(row, column);
        });
        ++number;
      }
    }
    if (!options_.with_sensitivity) return;
    const std::size_t nodes = node_hz.size();
    for (std::size_t power = 0; power < added.weight.size(); ++power)
      add_window(seen.window, power == 0 ? result_.sensitivity : result_.further_sensitivity[power - 1],
                 [&](int row, int column) {
                   double sum = 0;
                   for (std::size_t k = 0; k < nodes; ++k)
                     for (std::size_t j = 0; j < nodes; ++j)
                       sum += added.weight[power][k * nodes + j] * of_beam[k].at(row, column) * of_beam[j].at(row, column);
                   return sum;
                 });
  }

  template <typename Value>
  void add_window(const Window& window, Image& image, const Value& value) const {
    parallel_for(static_cast<std::size_t>(window.geometry.height), windows_->options().threads, [&](std::size_t r) {
      const int row = static_cast<int>(r);
      double* const to = image.row(window.first_row + row) + window.first_column;
      for (int column = 0; column < window.geometry.width; ++column) to[column] += value(row, column);
    });
  }

  std::shared_ptr<const MosaicWindows> windows_;
  AdjointResult result_;
  std::list<AddedWindow> added_;
};

}  // namespace

std::unique_ptr<AdjointSum> make_mosaic_adjoint(std::shared_ptr<const MosaicWindows> windows, const AdjointOptions& options) {
  return std::make_unique<MosaicAdjoint>(std::move(windows), options);
}

}  // namespace misfit::imager
