#include "imager/cube/gathered_rows.h"

#include <algorithm>
#include <utility>

#include "imager/cube/row_order.h"
#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

/// The weight of an interpolated visibility; 0 where a sample that it needs is unusable.
float weight_of(const float* row_weight, const ChannelTap& tap) {
  const double one = row_weight[tap.channel];
  if (tap.part == 0) return row_weight[tap.channel];
  const double two = row_weight[tap.other], rest = 1 - tap.part;
  if (one == 0 || two == 0) return 0;
  return static_cast<float>(one * two / (rest * rest * two + tap.part * tap.part * one));
}

std::complex<float> visibility_of(const std::complex<float>* row, const ChannelTap& tap) {
  if (tap.part == 0) return row[tap.channel];
  const auto part = static_cast<float>(tap.part);
  return (1 - part) * row[tap.channel] + part * row[tap.other];
}

/// Makes room for as many more and returns where they begin.
template <typename T>
T* extend(std::vector<T>& list, std::size_t more) {
  list.resize(list.size() + more);
  return list.data() + (list.size() - more);
}

/// Calls visit(row, tap) for every tap of every row.
template <typename Visit>
void for_each_tap(const MappedRows& rows, const std::vector<ChannelTap>& taps, const Visit& visit) {
  if (taps.size() == 1) {  // mostly; what is so of all rows is then worked out once
    const ChannelTap tap = taps.front();
    for (std::size_t row = rows.first; row < rows.end; ++row) visit(row, tap);
    return;
  }
  for (std::size_t row = rows.first; row < rows.end; ++row)
    for (const ChannelTap& tap : taps) visit(row, tap);
}

/// Appends the weights of rows; returns where they begin.
const float* append_weights(const VisibilityBlock& from, const MappedRows& rows, const std::vector<ChannelTap>& taps,
                            std::vector<float>& to) {
  float* const weight = extend(to, (rows.end - rows.first) * taps.size());
  float* next = weight;
  const auto append = [&](std::size_t row, const ChannelTap& tap) {
    *next++ = weight_of(&from.weight[row * from.channels()], tap);
  };
  for_each_tap(rows, taps, append);
  return weight;
}

/// Appends the visibilities of rows, those of weight 0 as 0.
void append_visibilities(const VisibilityBlock& from, std::size_t stokes, const MappedRows& rows,
                         const std::vector<ChannelTap>& taps, const float* weight, std::vector<std::complex<float>>& to) {
  const std::complex<float>* const visibility = from.visibility_of(stokes);
  std::complex<float>* next = extend(to, (rows.end - rows.first) * taps.size());
  const auto append = [&](std::size_t row, const ChannelTap& tap) {
    *next++ = *weight++ == 0 ? std::complex<float>() : visibility_of(&visibility[row * from.channels()], tap);
  };
  for_each_tap(rows, taps, append);
}

}  // namespace

GatheredRows::GatheredRows(int planes, std::size_t expected_rows)
    : planes_(static_cast<std::size_t>(planes)), expected_rows_(expected_rows) {
  uvw_m_.edit().reserve(3 * expected_rows);
}

GatheredRows::Piece& GatheredRows::piece_of(std::vector<Piece>& plane, const std::vector<double>& frequency_hz,
                                            std::size_t stokes) const {
  for (Piece& piece : plane)
    if (piece.frequency_hz == frequency_hz) return piece;
  Piece& piece = plane.emplace_back();
  piece.frequency_hz = frequency_hz;
  piece.visibility.resize(stokes);
  if (plane.size() > 1) return piece;
  piece.weight.reserve(expected_rows_ * frequency_hz.size());
  for (auto& of_stokes : piece.visibility) of_stokes.reserve(expected_rows_ * frequency_hz.size());
  return piece;
}

void GatheredRows::add(const VisibilityBlock& block, const std::vector<MappedRows>& rows, int threads) {
  const std::size_t before = this->rows();
  for (const MappedRows& some : rows) {
    const double scale = some.map->uvw_scale;
    const double* const from = block.uvw_m.data();
    std::transform(from + 3 * some.first, from + 3 * some.end, extend(uvw_m_.edit(), 3 * (some.end - some.first)),
                   [scale](double metres) { return metres * scale; });
    if (!block.sights.empty())
      std::copy_n(&block.sights[some.first], some.end - some.first, extend(sights_, some.end - some.first));
  }
  const auto append = [&](const MappedRows& some, const PlaneChannels& channels, std::vector<Piece>& plane) {
    if (channels.tap.empty()) return;
    Piece& piece = piece_of(plane, channels.frequency_hz, block.stokes());
    const Span span{before + some.first, before + some.end};
    if (!piece.spans.empty() && piece.spans.back().end == span.first)
      piece.spans.back().end = span.end;
    else
      piece.spans.push_back(span);
    const float* const weight = append_weights(block, some, channels.tap, piece.weight);
    for (std::size_t s = 0; s < block.stokes(); ++s)
      append_visibilities(block, s, some, channels.tap, weight, piece.visibility[s]);
  };
  const std::size_t groups = std::min(planes_.size(), static_cast<std::size_t>(threads));
  parallel_for(groups, threads, [&](std::size_t g) {
    for (const MappedRows& some : rows)
      for (std::size_t p = planes_.size() * g / groups; p < planes_.size() * (g + 1) / groups; ++p)
        append(some, some.map->planes[p], planes_[p]);
  });
}

void GatheredRows::set_order() {
  order_ = order_in_uv(uvw_m_.edit());
  std::vector<double> ordered(uvw_m_.size());
  for (std::size_t i = 0; i < order_.size(); ++i) std::copy_n(&uvw_m_[std::size_t{3} * order_[i]], 3, &ordered[3 * i]);
  uvw_m_ = std::move(ordered);
  if (sights_.empty()) return;
  std::vector<RowSight> of_ordered;
  of_ordered.reserve(order_.size());
  for (const std::uint32_t row : order_) of_ordered.push_back(sights_.at(row));
  sights_ = std::move(of_ordered);
}

std::vector<GatheredRows::Place> GatheredRows::places_of(const Piece& piece) const {
  constexpr auto none = static_cast<std::uint32_t>(-1);
  const std::size_t channels = piece.frequency_hz.size();
  std::vector<std::uint32_t> in_piece(rows(), none);
  std::uint32_t next = 0;
  for (const Span& span : piece.spans)
    for (std::size_t row = span.first; row < span.end; ++row, ++next) {
      const float* const weight = &piece.weight[next * channels];
      if (*weight != 0 || std::any_of(weight, weight + channels, [](float w) { return w != 0; })) in_piece[row] = next;
    }
  std::vector<Place> places;
  places.reserve(next);
  for (std::uint32_t i = 0; i < order_.size(); ++i)
    if (const std::uint32_t at = in_piece[order_[i]]; at != none) places.push_back({i, at});
  return places;
}

std::shared_ptr<const VisibilityBlock> GatheredRows::block_of(const Piece& piece, const std::vector<Place>& places) const {
  const std::size_t channels = piece.frequency_hz.size();
  const auto of_rows = [&](const auto& from, auto& to) {
    if (channels == 1) {
      for (const Place& place : places) to.push_back(from[place.in_piece]);
      return;
    }
    for (const Place& place : places) {
      const auto first = from.begin() + static_cast<std::ptrdiff_t>(place.in_piece * channels);
      to.insert(to.end(), first, first + static_cast<std::ptrdiff_t>(channels));
    }
  };
  auto block = std::make_shared<VisibilityBlock>();
  block->frequency_hz = piece.frequency_hz;
  if (places.size() == rows()) {
    block->uvw_m = uvw_m_;
  } else {
    std::vector<double> uvw_m(3 * places.size());
    for (std::size_t i = 0; i < places.size(); ++i) std::copy_n(&uvw_m_[std::size_t{3} * places[i].ordered], 3, &uvw_m[3 * i]);
    block->uvw_m = std::move(uvw_m);
  }
  if (!sights_.empty()) {
    block->sights.reserve(places.size());
    for (const Place& place : places) block->sights.push_back(sights_[place.ordered]);
  }
  block->weight.reserve(block->samples());
  of_rows(piece.weight, block->weight);
  block->visibility.reserve(piece.visibility.size() * block->samples());
  for (const auto& of_stokes : piece.visibility) of_rows(of_stokes, block->visibility);
  block->counts.rows_read = places.size();
  block->counts.samples_read = block->samples();
  block->counts.used =
      block->samples() - static_cast<std::size_t>(std::count(block->weight.begin(), block->weight.end(), 0.0F));
  return block;
}

std::vector<std::shared_ptr<const VisibilityBlock>> GatheredRows::blocks(int plane) const {
  std::vector<std::shared_ptr<const VisibilityBlock>> made;
  for (const Piece& piece : planes_[static_cast<std::size_t>(plane)])
    if (const std::vector<Place> places = places_of(piece); !places.empty()) made.push_back(block_of(piece, places));
  return made;
}

}  // namespace misfit::imager
