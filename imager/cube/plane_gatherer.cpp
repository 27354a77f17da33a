#include "imager/cube/plane_gatherer.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "imager/parallel.h"
#include "imager/prefetch.h"

namespace misfit::imager {
namespace {

constexpr std::size_t full_samples = std::size_t{1} << 20;

/// Rows that are dealt out to all planes before the next ones: few enough to stay in the cache.
constexpr std::size_t rows_at_once = 512;

/// Of an interpolated visibility; 0 where a sample that it needs is unusable.
float weight_of(const float* row_weight, const ChannelTap& tap) {
  const float one = row_weight[tap.channel];
  if (tap.part == 0) return one;
  const float two = row_weight[tap.other];
  if (one == 0 || two == 0) return 0;
  const double rest = 1 - tap.part;
  return static_cast<float>(1 / (rest * rest / one + tap.part * tap.part / two));
}

std::complex<float> visibility_of(const std::complex<float>* row, const ChannelTap& tap) {
  if (tap.part == 0) return row[tap.channel];
  const auto part = static_cast<float>(tap.part);
  return (1 - part) * row[tap.channel] + part * row[tap.other];
}

/// Appends the visibilities of rows, those of weight 0 as 0.
void append_visibilities(const VisibilityBlock& from, const std::vector<std::size_t>& rows, const std::vector<ChannelTap>& taps,
                         const float* weight, std::vector<std::complex<float>>& to) {
  const std::size_t old = to.size();
  to.resize(old + rows.size() * taps.size());
  std::complex<float>* out = to.data() + old;
  for (const std::size_t row : rows)
    for (const ChannelTap& tap : taps)
      *out++ = *weight++ == 0 ? std::complex<float>() : visibility_of(&from.visibility[row * from.channels()], tap);
}

/// A block of as many Stokes parameters as `like`, without rows.
std::shared_ptr<VisibilityBlock> empty_block(const VisibilityBlock& like, const std::vector<double>& frequency_hz) {
  auto block = std::make_shared<VisibilityBlock>();
  block->frequency_hz = frequency_hz;
  for (std::size_t i = 0; i < like.other_stokes.size(); ++i) block->other_stokes.push_back(std::make_shared<VisibilityBlock>());
  return block;
}

VisibilityBlock& other(VisibilityBlock& block, std::size_t i) {
  return const_cast<VisibilityBlock&>(*block.other_stokes[i]);  // nobody else holds it yet
}

/// The other Stokes parameters get what they share with the first.
std::shared_ptr<const VisibilityBlock> finished(const std::shared_ptr<VisibilityBlock>& block) {
  for (std::size_t i = 0; i < block->other_stokes.size(); ++i) {
    VisibilityBlock& one = other(*block, i);
    static_cast<SampleCoordinates&>(one) = *block;
    one.weight = block->weight;
    one.counts = block->counts;
  }
  return block;
}

/// Hands on the blocks of one plane.
class PlaneStream : public BlockStream {
 public:
  PlaneStream(std::unique_ptr<BlockStream> from, const CubeSampling& sampling, int plane)
      : from_(std::move(from)), gatherer_(sampling, {plane, 1}, 1) {}

  std::shared_ptr<const VisibilityBlock> next() override {
    while (ready_.empty() && from_) {
      const auto block = from_->next();
      if (block) gatherer_.add(*block);
      ready_ = gatherer_.take(0, block == nullptr);
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
    : sampling_(sampling),
      range_(range),
      threads_(threads),
      planes_(static_cast<std::size_t>(range.count)),
      expected_samples_(std::min<std::size_t>(expected_samples, full_samples)) {}

std::shared_ptr<VisibilityBlock> PlaneGatherer::begin_block(const VisibilityBlock& like, const PlaneChannels& channels,
                                                            bool alone) const {
  auto block = empty_block(like, channels.frequency_hz);
  if (!alone) return block;
  block->uvw_m.reserve(3 * expected_samples_ / channels.tap.size());
  block->weight.reserve(expected_samples_);
  block->visibility.reserve(expected_samples_);
  return block;
}

std::vector<PlaneGatherer::Rows> PlaneGatherer::rows_of(const VisibilityBlock& block) const {
  const auto ratio = [&](std::size_t row) { return block.frame_ratio.empty() ? 1 : block.frame_ratio[row]; };
  std::vector<Rows> all;
  for (std::size_t row = 0; row < block.rows();) {
    std::size_t end = row + 1;
    while (end < block.rows() && end < row + rows_at_once && ratio(end) == ratio(row)) ++end;
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
  const std::vector<Rows> rows = rows_of(block);
  count_outside(block, rows);
  const std::size_t groups = std::min(planes_.size(), static_cast<std::size_t>(threads_));
  parallel_for(groups, threads_, [&](std::size_t g) {
    for (const Rows& some : rows)
      for (std::size_t p = planes_.size() * g / groups; p < planes_.size() * (g + 1) / groups; ++p)
        append(block, some, some.map->planes[p], planes_[p]);
  });
}

void PlaneGatherer::append(const VisibilityBlock& block, const Rows& rows, const PlaneChannels& channels, Plane& plane) const {
  if (channels.tap.empty()) return;
  std::shared_ptr<VisibilityBlock>& to = plane.growing[channels.frequency_hz];
  if (!to) to = begin_block(block, channels, plane.growing.size() == 1);
  const std::size_t taps = channels.tap.size(), old = to->weight.size();
  std::vector<std::size_t> used_rows;
  used_rows.reserve(rows.end - rows.first);
  to->weight.resize(old + (rows.end - rows.first) * taps);
  float* weight = to->weight.data() + old;
  std::uint64_t used = 0;
  for (std::size_t row = rows.first; row < rows.end; ++row) {
    std::uint64_t of_row = 0;
    for (std::size_t i = 0; i < taps; ++i) {
      weight[i] = weight_of(&block.weight[row * block.channels()], channels.tap[i]);
      of_row += weight[i] != 0;
    }
    if (of_row == 0) continue;
    used_rows.push_back(row);
    used += of_row;
    weight += taps;
  }
  to->weight.resize(old + used_rows.size() * taps);
  for (const std::size_t row : used_rows)
    for (int axis = 0; axis < 3; ++axis)
      to->uvw_m.push_back(block.uvw_m[3 * row + static_cast<std::size_t>(axis)] * rows.map->uvw_scale);
  append_visibilities(block, used_rows, channels.tap, to->weight.data() + old, to->visibility);
  for (std::size_t i = 0; i < block.other_stokes.size(); ++i)
    append_visibilities(*block.other_stokes[i], used_rows, channels.tap, to->weight.data() + old, other(*to, i).visibility);
  to->counts.rows_read += used_rows.size();
  to->counts.samples_read += used_rows.size() * taps;
  to->counts.used += used;
  if (to->samples() < full_samples) return;
  plane.full.push_back(finished(to));
  to = begin_block(block, channels, plane.growing.size() == 1);
}

void PlaneGatherer::count_outside(const VisibilityBlock& block, const std::vector<Rows>& rows) {
  const double low = -0.5, high = sampling_.axis.channels - 0.5;
  for (const Rows& some : rows) {
    const double ratio = block.frame_ratio.empty() ? 1 : block.frame_ratio[some.first];
    std::vector<bool> taken(block.channels());
    for (const PlaneChannels& plane : some.map->planes)
      for (const ChannelTap& tap : plane.tap) taken[tap.channel] = taken[tap.other] = true;
    for (std::size_t c = 0; c < block.channels(); ++c) {
      const double plane = sampling_.axis.plane_of(block.frequency_hz[c] * ratio);
      if ((plane >= low && plane < high) || taken[c]) continue;
      for (std::size_t row = some.first; row < some.end; ++row)
        outside_planes_ += block.weight[row * block.channels() + c] != 0;
    }
  }
}

std::vector<std::shared_ptr<const VisibilityBlock>> PlaneGatherer::take(int plane, bool all) {
  Plane& from = planes_[static_cast<std::size_t>(plane)];
  std::vector<std::shared_ptr<const VisibilityBlock>> taken = std::move(from.full);
  from.full.clear();
  if (!all) return taken;
  for (auto& [frequencies, block] : from.growing)
    if (block && block->rows() > 0) taken.push_back(finished(block));
  from.growing.clear();
  return taken;
}

GatheredPlanes gather_planes(const VisibilitySource& source, const CubeSampling& sampling, const PlaneRange& range, int threads,
                             const Progress& progress, StageTimes& times) {
  constexpr std::size_t ahead = 2;
  PlaneGatherer gatherer(sampling, range, threads, source.samples() / static_cast<std::uint64_t>(range.count));
  const auto stream = prefetched(source.open(), ahead);
  GatheredPlanes gathered;
  std::uint64_t done = 0;
  const auto next = [&] {
    const StageTimer timer(times, "read");
    return stream->next();
  };
  while (const auto block = next()) {
    const StageTimer timer(times, "planes");
    gatherer.add(*block);
    gathered.counts += block->counts;
    progress(done += block->samples(), source.samples());
  }
  const StageTimer timer(times, "planes");
  for (int plane = 0; plane < range.count; ++plane) {
    StoredVisibilities& stored = gathered.planes.emplace_back();
    for (auto& block : gatherer.take(plane, true)) stored.append(std::move(block));
  }
  gathered.outside_planes = gatherer.outside_planes();
  return gathered;
}

std::unique_ptr<BlockStream> PlaneView::open() const {
  return std::make_unique<PlaneStream>(from_.open(), sampling_, plane_);
}

}  // namespace misfit::imager
