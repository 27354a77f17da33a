#include "imager/cube/plane_gatherer.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "imager/numerics/parallel.h"
#include "imager/streaming/prefetch.h"

namespace misfit::imager {
namespace {

/// Rows that are dealt out to all planes before the next ones: few enough to stay in the cache.
constexpr std::size_t rows_dealt_at_once = 256;

/// The rows that are gridded together, for a window: fewer where a plane takes several channels.
std::size_t rows_at_once_of(const CubeSampling& sampling, const std::vector<double>& channel_width_hz) {
  constexpr auto rows = static_cast<double>(samples_gathered_at_once);
  const SpectralAxis& axis = sampling.axis;
  const double plane_hz = std::max(axis.width_hz(), axis.width_hz(axis.channels - 1));
  double narrowest_hz = plane_hz;
  for (const double width_hz : channel_width_hz) narrowest_hz = std::min(narrowest_hz, width_hz);
  return static_cast<std::size_t>(plane_hz > 0 ? std::max(1.0, rows * narrowest_hz / plane_hz) : rows);
}

/// Hands on the blocks of one plane.
class PlaneStream : public BlockStream {
 public:
  PlaneStream(const VisibilitySource& from, const CubeSampling& sampling, int plane)
      : from_(from.open()), gatherer_(sampling, {plane, 1}, 1, from.samples()) {}

  std::shared_ptr<const VisibilityBlock> next() override {
    while (ready_.empty() && from_) {
      const auto block = from_->next();
      if (block) gatherer_.add(*block);
      for (const auto& rows : gatherer_.take(block == nullptr))
        for (auto& made : rows->blocks(0)) ready_.push_back(std::move(made));
      std::reverse(ready_.begin(), ready_.end());
      if (!block) from_.reset();
    }
    if (ready_.empty()) return nullptr;
    auto block = std::move(ready_.back());
    ready_.pop_back();
    return block;
  }

 private:
  std::unique_ptr<BlockStream> from_;  ///< null at its end
  PlaneGatherer gatherer_;
  std::vector<std::shared_ptr<const VisibilityBlock>> ready_;  ///< the next at the end
};

}  // namespace

PlaneGatherer::PlaneGatherer(const CubeSampling& sampling, const PlaneRange& range, int threads, std::uint64_t expected_samples)
    : sampling_(sampling), range_(range), threads_(threads), expected_samples_(expected_samples) {}

std::vector<MappedRows> PlaneGatherer::rows_of(const VisibilityBlock& block) const {
  const auto ratio = [&](std::size_t row) { return block.frame_ratio.empty() ? 1 : block.frame_ratio[row]; };
  std::vector<MappedRows> all;
  for (std::size_t row = 0; row < block.rows();) {
    std::size_t end = row + 1;
    while (end < block.rows() && end < row + rows_dealt_at_once && ratio(end) == ratio(row)) ++end;
    const bool again = !all.empty() && ratio(row) == ratio(row - 1);
    all.push_back({row, end,
                   again ? all.back().map
                         : std::make_shared<const ChannelMap>(
                               map_channels(sampling_, range_, {block.frequency_hz, block.channel_width_hz}, ratio(row)))});
    row = end;
  }
  return all;
}

void PlaneGatherer::add(const VisibilityBlock& block) {
  if (block.channel_width_hz.size() != block.channels())
    throw std::invalid_argument("a block of " + std::to_string(block.channels()) + " channels with " +
                                std::to_string(block.channel_width_hz.size()) + " widths; expected one for each");
  const std::vector<MappedRows> rows = rows_of(block);
  count_outside(block, rows);
  std::unique_ptr<GatheredRows>& to = window_of(block).growing;
  const std::size_t most = rows_at_once_of(sampling_, block.channel_width_hz);
  if (!to) to = std::make_unique<GatheredRows>(range_.count, std::min<std::size_t>(expected_samples_ / block.channels(), most));
  to->add(block, rows, threads_);
  if (to->rows() >= most) full_.push_back(std::move(to));
}

PlaneGatherer::Window& PlaneGatherer::window_of(const VisibilityBlock& block) {
  for (Window& window : windows_)
    if (window.frequency_hz == block.frequency_hz) return window;
  return windows_.emplace_back(Window{block.frequency_hz, nullptr});
}

std::vector<std::unique_ptr<GatheredRows>> PlaneGatherer::take(bool all) {
  std::vector<std::unique_ptr<GatheredRows>> taken = std::exchange(full_, {});
  if (all) {
    for (Window& window : windows_)
      if (window.growing) taken.push_back(std::move(window.growing));
    windows_.clear();
  }
  for (const auto& rows : taken) rows->set_order();
  return taken;
}

void PlaneGatherer::count_outside(const VisibilityBlock& block, const std::vector<MappedRows>& rows) {
  const double low = -0.5, high = sampling_.axis.channels - 0.5;
  // Ranges of planes share channels: the first range counts those below all planes, the last range those above.
  const bool first = range_.first == 0, last = range_.first + range_.count == sampling_.axis.channels;
  for (const MappedRows& some : rows) {
    const double ratio = block.frame_ratio.empty() ? 1 : block.frame_ratio[some.first];
    std::vector<bool> taken(block.channels());
    for (const PlaneChannels& plane : some.map->planes)
      for (const ChannelTap& tap : plane.tap) taken[tap.channel] = taken[tap.other] = true;
    for (std::size_t c = 0; c < block.channels(); ++c) {
      const double plane = sampling_.axis.plane_of(block.frequency_hz[c] * ratio);
      const bool counted = (plane < low && first) || (plane >= high && last);
      if (!counted || taken[c]) continue;
      for (std::size_t row = some.first; row < some.end; ++row)
        outside_planes_ += block.weight[row * block.channels() + c] != 0;
    }
  }
}

StoredVisibilities GatheredPlanes::plane(int plane) const {
  StoredVisibilities stored;
  for (const auto& rows : rows_)
    for (auto& block : rows->blocks(plane)) stored.append(std::move(block));
  return stored;
}

StoredVisibilities GatheredPlanes::take(int plane) {
  StoredVisibilities stored = this->plane(plane);
  for (const auto& rows : rows_) rows->release(plane);
  return stored;
}

GatheredPlanes gather_planes(const VisibilitySource& source, const CubeSampling& sampling, const PlaneRange& range,
                             const Context& context) {
  constexpr std::size_t ahead = 2;
  PlaneGatherer gatherer(sampling, range, context.threads, source.samples());
  const auto stream = prefetched(source.open(), ahead);
  GatheredPlanes::Counts counts;
  std::uint64_t done = 0;
  const auto next = [&] {
    const StageTimer timer(context.times, stage::read);
    return stream->next();
  };
  while (const auto block = next()) {
    const StageTimer timer(context.times, stage::planes);
    gatherer.add(*block);
    counts.read += block->counts;
    context.tell(done += block->samples(), source.samples());
  }
  const StageTimer timer(context.times, stage::planes);
  std::vector<std::unique_ptr<GatheredRows>> rows = gatherer.take(true);
  counts.outside_planes = gatherer.outside_planes();
  return {std::move(rows), counts};
}

std::unique_ptr<BlockStream> PlaneView::open() const {
  return std::make_unique<PlaneStream>(from_, sampling_, plane_);
}

}  // namespace misfit::imager
