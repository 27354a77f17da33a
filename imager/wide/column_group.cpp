#include "imager/wide/column_group.h"

#include <hwy/cache_control.h>

#include <algorithm>
#include <cmath>

#include "imager/numerics/phasors.h"
#include "imager/wide/image_planes.h"

namespace misfit::imager {
namespace {

/// Some rows of a group's pixels, on their way between rows of the image and columns of the group.
struct PixelTile {
  static constexpr int rows = 64;
  double pixel[rows][columns_at_once];
};

/// Columns [begin, end) of a facet.
struct ColumnRange {
  int begin;
  int end;
};

/// Calls visit(r, row) for a facet's rows [begin, end) in an image. Rows are prefetched, since they lie pages apart.
template <typename AnyImage, typename Visit>
void for_facet_rows(AnyImage& image, const Facet& facet, ColumnRange columns, int begin, int end, const Visit& visit) {
  auto* const first = image.pixel.data() + facet.first_column;
  const auto row = [&](int r) { return first + static_cast<std::ptrdiff_t>(facet.first_row + r) * image.width; };
  const int later = std::min(PixelTile::rows, facet.geometry.height - end);
  for (int r = end; r < end + later; ++r)
    for (int c = columns.begin; c < columns.end; c += 8) hwy::Prefetch(row(r) + c);
  for (int r = begin; r < end; ++r) visit(r, row(r));
}

}  // namespace

ColumnGroup::ColumnGroup(const StackedFacet& facet)
    : height_(facet.facet.geometry.height), half_(static_cast<std::size_t>(height_)) {
  const std::size_t pixels = static_cast<std::size_t>(columns_at_once) * static_cast<std::size_t>(height_);
  for (auto* values : {&h_, &half_step_re_, &half_step_im_, &sum_re_, &sum_im_, &q_}) values->resize(pixels);
}

void ColumnGroup::begin(const StackedFacet& facet, int begin, int end) {
  begin_ = begin;
  end_ = end;
  for (int c = begin; c < end; ++c) {
    double* q = q_.data() + at(c);
    curvature_of_column(facet.facet, c, q);
    if (crosses_horizon(facet.facet.geometry))  // where a last bit decides, every part of the transform decides alike
      for (int r = 0; r < height_; ++r) q[r] = facet.facet.curvature(c, r);
    for (int r = 0; r < height_; ++r) q[r] *= facet.plane_step;
    correction_of_column(facet.h_w, 1, q, height_, h_.data() + at(c));
    const double h_u = facet.h_u[static_cast<std::size_t>(c)];
    for (int r = 0; r < height_; ++r) h_[at(c) + static_cast<std::size_t>(r)] *= h_u * facet.h_v[static_cast<std::size_t>(r)];
    std::transform(q, q + height_, half_.begin(), [](double turns) { return 0.5 * turns; });
    phasors(half_.data(), height_, half_step_re_.data() + at(c), half_step_im_.data() + at(c));
  }
}

void ColumnGroup::clear() {
  std::fill(sum_re_.begin(), sum_re_.end(), 0);
  std::fill(sum_im_.begin(), sum_im_.end(), 0);
}

void ColumnGroup::load(const Image& image, const Facet& facet, int first_plane) {
  PixelTile tile;
  for (int begin = 0; begin < height_; begin += PixelTile::rows) {
    const int end = std::min(begin + PixelTile::rows, height_);
    for_facet_rows(image, facet, {begin_, end_}, begin, end,
                   [&](int r, const double* row) { std::copy(row + begin_, row + end_, tile.pixel[r - begin]); });
    for (int c = begin_; c < end_; ++c)
      for (int r = begin; r < end; ++r) {
        const std::size_t i = at(c) + static_cast<std::size_t>(r);
        const double pixel = tile.pixel[r - begin][c - begin_] * h_[i];
        const bool seen = !std::isnan(h_[i]);
        sum_re_[i] = seen ? pixel * half_step_re_[i] : 0;
        sum_im_[i] = seen ? -pixel * half_step_im_[i] : 0;
        if (!seen) half_step_re_[i] = half_step_im_[i] = 0;
      }
  }
  turn(-first_plane);
}

void ColumnGroup::store(const Facet& facet, int first_plane, Image& image) {
  turn(first_plane);
  PixelTile tile;
  for (int begin = 0; begin < height_; begin += PixelTile::rows) {
    const int end = std::min(begin + PixelTile::rows, height_);
    for (int c = begin_; c < end_; ++c)
      for (int r = begin; r < end; ++r) {
        const std::size_t i = at(c) + static_cast<std::size_t>(r);
        tile.pixel[r - begin][c - begin_] = h_[i] * (sum_re_[i] * half_step_re_[i] - sum_im_[i] * half_step_im_[i]);
      }
    for_facet_rows(image, facet, {begin_, end_}, begin, end, [&](int r, double* row) {
      for (int c = begin_; c < end_; ++c) row[c] += tile.pixel[r - begin][c - begin_];
    });
  }
}

void ColumnGroup::turn(int planes) {
  if (planes == 0) return;
  std::vector<double> turns(static_cast<std::size_t>(height_)), re(turns.size()), im(turns.size());
  for (int c = begin_; c < end_; ++c) {
    const double* const q = q_.data() + at(c);
    std::transform(q, q + height_, turns.begin(), [planes](double step) { return std::isnan(step) ? 0 : planes * step; });
    phasors(turns.data(), height_, re.data(), im.data());
    for (std::size_t i = at(c), r = 0; i < at(c + 1); ++i, ++r) {
      const double sum_re = sum_re_[i];
      sum_re_[i] = sum_re * re[r] - sum_im_[i] * im[r];
      sum_im_[i] = sum_re * im[r] + sum_im_[i] * re[r];
    }
  }
}

}  // namespace misfit::imager
