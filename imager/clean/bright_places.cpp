#include "imager/clean/bright_places.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

constexpr int side = bright_tile_side;
constexpr double deviations = 3;
constexpr float none = std::numeric_limits<float>::quiet_NaN();

int tiles_along(int pixels) {
  return (pixels + side - 1) / side;
}

}  // namespace

/// Places of one tile, by scale.
struct BrightPlaces::Found {
  std::vector<std::int32_t> offset;
  std::vector<float> value[most_taylor_terms];
  std::vector<std::size_t> first;  ///< [scale], one more than these
};

BrightPlaces::BrightPlaces(const ScaledResidual& residual, const ScaledPsf& psf, double brightness, int threads)
    : psf_(psf),
      threads_(threads),
      near_tiles_(psf.near_tiles()),
      tiles_u_(tiles_along(residual.width())),
      tiles_v_(tiles_along(residual.height())),
      width_(residual.width()),
      height_(residual.height()),
      brightness_(brightness),
      outstanding_flux_(width_, height_, psf.scales().size()),
      flux_(outstanding_flux_),
      flux_magnitude_(outstanding_flux_) {
  const auto tiles = static_cast<std::size_t>(tiles_u_) * static_cast<std::size_t>(tiles_v_);
  std::vector<Found> found(tiles);
  parallel_for(static_cast<std::size_t>(tiles_v_), threads, [&](std::size_t row) {
    find(residual, static_cast<float>(brightness * brightness), static_cast<int>(row), found);
  });
  keep(found);
  // Few places are brought up to date at once, wherever they lie.
  constexpr std::size_t few = 2048;
  if (psf.is_whole() && offset_.size() <= few) near_tiles_ = std::max(tiles_u_, tiles_v_);
  outstanding_at_.assign(offset_.size(), -1);
}

void BrightPlaces::find(const ScaledResidual& residual, float merit, int tile_row, std::vector<Found>& found) const {
  const auto terms = static_cast<std::size_t>(psf_.terms());
  for (int tile_column = 0; tile_column < tiles_u_; ++tile_column) {
    Found& of_tile =
        found[static_cast<std::size_t>(tile_row) * static_cast<std::size_t>(tiles_u_) + static_cast<std::size_t>(tile_column)];
    for (std::size_t s = 0; s < psf_.scales().size(); ++s) {
      of_tile.first.push_back(of_tile.offset.size());
      const ScaledResidual::Plane& plane = residual.plane(s);
      const MeritForm& form = psf_.scales()[s].form;
      const int step = plane.step, across = side / step;
      const int first_row = tile_row * across, last_row = std::min(first_row + across, plane.height);
      const int first_column = tile_column * across, last_column = std::min(first_column + across, plane.width);
      for (int r = first_row; r < last_row; ++r) {
        const float* row[most_taylor_terms];
        for (std::size_t t = 0; t < terms; ++t) row[t] = plane.row(t, r);
        float of_row[side];
        set_merits(form, psf_.terms(), row, first_column, last_column - first_column, of_row);
        for (int c = first_column; c < last_column; ++c) {
          if (!(of_row[c - first_column] >= merit)) continue;
          of_tile.offset.push_back((r - first_row) * step * psf_.stride() + (c - first_column) * step);
          for (std::size_t t = 0; t < terms; ++t) of_tile.value[t].push_back(row[t][c]);
        }
      }
      while (of_tile.offset.size() % BrightRange::multiple != 0) {
        of_tile.offset.push_back(0);
        for (std::size_t t = 0; t < terms; ++t) of_tile.value[t].push_back(none);
      }
    }
  }
}

void BrightPlaces::keep(std::vector<Found>& found) {
  const auto terms = static_cast<std::size_t>(psf_.terms());
  std::size_t places = 0;
  for (const Found& of_tile : found) places += of_tile.offset.size();
  offset_.reserve(places);
  for (std::size_t t = 0; t < terms; ++t) value_[t].reserve(places);
  for (std::size_t tile = 0; tile < found.size(); ++tile) {
    Found& of_tile = found[tile];
    tile_.push_back({static_cast<int>(tile) / tiles_u_ * side, static_cast<int>(tile) % tiles_u_ * side});
    for (const std::size_t first : of_tile.first) first_.push_back(offset_.size() + first);
    offset_.insert(offset_.end(), of_tile.offset.begin(), of_tile.offset.end());
    for (std::size_t t = 0; t < terms; ++t) value_[t].insert(value_[t].end(), of_tile.value[t].begin(), of_tile.value[t].end());
    of_tile = {};
  }
  first_.push_back(offset_.size());
  merit_.resize(places);
  brightest_in_row_.resize(static_cast<std::size_t>(tiles_v_));
  brightest_point_in_row_.resize(static_cast<std::size_t>(tiles_v_));
  for (std::size_t tile = 0; tile < tile_.size(); ++tile)
    for (std::size_t s = 0; s < psf_.scales().size(); ++s)
      look_at(tile, s, imager::subtract(nullptr, 0, psf_.scales()[s].form, psf_.terms(), range(tile, s)));
  for (int row = 0; row < tiles_v_; ++row) look_at_row(row);
}

BrightRange BrightPlaces::range(std::size_t tile, std::size_t scale) {
  const std::size_t first = first_[range_at(tile, scale)], end = first_[range_at(tile, scale) + 1];
  BrightRange result{offset_.data() + first, {}, merit_.data() + first, static_cast<int>(end - first)};
  for (std::size_t t = 0; t < static_cast<std::size_t>(psf_.terms()); ++t) result.value[t] = value_[t].data() + first;
  return result;
}

/// To be called for the scales of a tile in their order.
void BrightPlaces::look_at(std::size_t tile, std::size_t scale, float merit) {
  Tile& t = tile_[tile];
  if (scale == 0) t.brightest_point = merit;
  if (scale == 0) t.brightest = -1;
  if (psf_.scales()[scale].looked_at.index >= 0) t.brightest = std::max(t.brightest, merit);
}

void BrightPlaces::look_at_row(int tile_row) {
  const auto row = static_cast<std::size_t>(tile_row);
  const Tile* const first = tile_.data() + row * static_cast<std::size_t>(tiles_u_);
  float brightest = -1, point = -1;
  for (const Tile* tile = first; tile != first + tiles_u_; ++tile) {
    brightest = std::max(brightest, tile->brightest);
    point = std::max(point, tile->brightest_point);
  }
  brightest_in_row_[row] = brightest;
  brightest_point_in_row_[row] = point;
}

double BrightPlaces::brightness() const {
  return std::sqrt(std::max(0.0F, *std::max_element(brightest_in_row_.begin(), brightest_in_row_.end())));
}

double BrightPlaces::point_brightness() const {
  const float merit = *std::max_element(brightest_point_in_row_.begin(), brightest_point_in_row_.end());
  return std::sqrt(psf_.scales().front().basis.peak() * std::max(0.0F, merit));
}

BrightPlaces::Place BrightPlaces::brightest() const {
  const auto row = std::max_element(brightest_in_row_.begin(), brightest_in_row_.end());
  Place place;
  place.tile = static_cast<std::size_t>(row - brightest_in_row_.begin()) * static_cast<std::size_t>(tiles_u_);
  while (tile_[place.tile].brightest != *row) ++place.tile;
  const Tile& tile = tile_[place.tile];
  for (; place.scale + 1 < psf_.scales().size(); ++place.scale) {
    if (psf_.scales()[place.scale].looked_at.index < 0) continue;
    const auto end = merit_.begin() + static_cast<std::ptrdiff_t>(first_[range_at(place.tile, place.scale) + 1]);
    if (std::find(merit_.begin() + static_cast<std::ptrdiff_t>(first_[range_at(place.tile, place.scale)]), end, *row) != end)
      break;
  }
  place.index = first_[range_at(place.tile, place.scale)];
  while (merit_[place.index] != *row) ++place.index;
  place.row = tile.row + offset_[place.index] / psf_.stride();
  place.column = tile.column + offset_[place.index] % psf_.stride();
  for (std::size_t t = 0; t < static_cast<std::size_t>(psf_.terms()); ++t) place.residual[t] = double{value_[t][place.index]};
  return place;
}

ReachingComponent BrightPlaces::component(const Place& from, const TaylorValues& coefficient, std::size_t to_scale,
                                          const Tile& tile) const {
  ReachingComponent result{};
  for (int k = 0; k < 2 * psf_.terms() - 1; ++k)
    result.psf[k] = psf_.at(from.scale, to_scale, k, tile.row - from.row, tile.column - from.column);
  for (std::size_t t = 0; t < most_taylor_terms; ++t) result.coefficient[t] = static_cast<float>(coefficient[t]);
  return result;
}

void BrightPlaces::subtract(const Place& at, const TaylorValues& coefficient, std::size_t tile) {
  Tile& t = tile_[tile];
  const std::size_t scales = psf_.scales().size();
  if (first_[range_at(tile, 0)] == first_[range_at(tile, scales)]) return;
  if (!psf_.reaches(t.row - at.row, t.column - at.column)) return;
  for (std::size_t s = 0; s < scales; ++s) {
    const ReachingComponent reaching = component(at, coefficient, s, t);
    look_at(tile, s, imager::subtract(&reaching, 1, psf_.scales()[s].form, psf_.terms(), range(tile, s)));
  }
}

void BrightPlaces::subtract(const Place& at, const TaylorValues& coefficient) {
  flux_.add(at.row, at.column, at.scale, coefficient[0]);
  flux_magnitude_.add(at.row, at.column, at.scale, std::abs(coefficient[0]));
  const int tile_row = at.row / side, tile_column = at.column / side;
  const int first_row = std::max(0, tile_row - near_tiles_), last_row = std::min(tiles_v_ - 1, tile_row + near_tiles_);
  const int first = std::max(0, tile_column - near_tiles_), last = std::min(tiles_u_ - 1, tile_column + near_tiles_);
  for (int r = first_row; r <= last_row; ++r) {
    for (int c = first; c <= last; ++c)
      subtract(at, coefficient, static_cast<std::size_t>(r) * static_cast<std::size_t>(tiles_u_) + static_cast<std::size_t>(c));
    look_at_row(r);
  }
  if (first_row == 0 && last_row == tiles_v_ - 1 && first == 0 && last == tiles_u_ - 1) return;  // nothing lies farther
  std::int32_t& known = outstanding_at_[at.index];
  if (known < 0) {
    known = static_cast<std::int32_t>(outstanding_.size());
    outstanding_.push_back({at, {}});
  }
  for (std::size_t t = 0; t < most_taylor_terms; ++t)
    outstanding_[static_cast<std::size_t>(known)].coefficient[t] += coefficient[t];
  outstanding_flux_.add(at.row, at.column, at.scale, coefficient[0]);
}

double BrightPlaces::outstanding() const {
  const std::size_t scales = psf_.scales().size();
  double most = 0;
  for (std::size_t to = 0; to < scales; ++to) {
    double variance = 0;
    for (std::size_t from = 0; from < scales; ++from) {
      const ScaledPsf::Strength& s = psf_.strength(from, to);
      variance += s.rms_beyond * s.rms_beyond * outstanding_flux_.square(from);
      most = std::max(most, s.largest_beyond * outstanding_flux_.largest(from));
    }
    most = std::max(most, deviations * std::sqrt(variance));
  }
  return most;
}

double BrightPlaces::change(const FoundFlux& flux) const {
  const std::size_t scales = psf_.scales().size();
  double most = 0;
  for (std::size_t to = 0; to < scales; ++to) {
    double variance = 0;
    for (std::size_t from = 0; from < scales; ++from) variance += std::pow(psf_.strength(from, to).rms, 2) * flux.square(from);
    most = std::max(most, variance);
  }
  return std::sqrt(most);
}

double BrightPlaces::of_others() const {
  return brightness_ + deviations * change(flux_);
}

bool BrightPlaces::sees_all_above(double brightness) const {
  constexpr double surer = 3;  // than of_others() is
  return outstanding_.empty() && brightness_ + surer * deviations * change(flux_magnitude_) <= brightness;
}

bool BrightPlaces::is_near(const Tile& a, const Tile& b) const {
  return std::abs(a.row - b.row) <= near_tiles_ * side && std::abs(a.column - b.column) <= near_tiles_ * side;
}

bool BrightPlaces::subtract_outstanding() {
  constexpr double convolution_cost = 16;  // of a pixel, over that of a place and a component, as measured
  const double pairs = static_cast<double>(outstanding_.size()) * static_cast<double>(offset_.size());
  if (!psf_.is_whole() || pairs > convolution_cost * width_ * height_) return false;
  std::sort(outstanding_.begin(), outstanding_.end(),
            [](const Outstanding& a, const Outstanding& b) { return a.place.index < b.place.index; });
  parallel_for(tile_.size(), threads_, [&](std::size_t tile) {
    constexpr int together = 64;
    const Tile& t = tile_[tile];
    const BrightRange places = range(tile, 0);
    if (places.count == 0) return;
    ReachingComponent reaching[together];
    int count = 0;
    const auto take_off = [&] {
      look_at(tile, 0, imager::subtract(reaching, count, psf_.scales().front().form, psf_.terms(), places));
      count = 0;
    };
    for (const Outstanding& o : outstanding_) {
      if (is_near(tile_[o.place.tile], t) || !psf_.reaches(t.row - o.place.row, t.column - o.place.column)) continue;
      reaching[count++] = component(o.place, o.coefficient, 0, t);
      if (count == together) take_off();
    }
    if (count > 0) take_off();
  });
  for (int row = 0; row < tiles_v_; ++row) look_at_row(row);
  for (const Outstanding& o : outstanding_) outstanding_at_[o.place.index] = -1;
  outstanding_.clear();
  outstanding_flux_ = FoundFlux(width_, height_, psf_.scales().size());
  return true;
}

}  // namespace misfit::imager
