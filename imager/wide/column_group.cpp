#include "imager/wide/column_group.h"

#include <algorithm>
#include <cmath>

#include "imager/numerics/phasors.h"

namespace misfit::imager {

ColumnGroup::ColumnGroup(const StackedFacet& facet) : height_(facet.facet.geometry.height) {
  const std::size_t pixels = static_cast<std::size_t>(columns_at_once) * static_cast<std::size_t>(height_);
  for (auto* values : {&h_, &step_re_, &step_im_, &sum_re_, &sum_im_, &q_}) values->resize(pixels);
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
    phasors(q, height_, step_re_.data() + at(c), step_im_.data() + at(c));
  }
}

void ColumnGroup::clear() {
  std::fill(sum_re_.begin(), sum_re_.end(), 0);
  std::fill(sum_im_.begin(), sum_im_.end(), 0);
}

void ColumnGroup::load(const Image& image, const Facet& facet, int first_plane) {
  for (int c = begin_; c < end_; ++c) {
    first_phasors(c, first_plane);
    for (std::size_t i = at(c), r = 0; i < at(c + 1); ++i, ++r) {
      const double pixel = image.at(facet.first_row + static_cast<int>(r), facet.first_column + c) * h_[i];
      const bool seen = !std::isnan(h_[i]);
      sum_re_[i] = seen ? pixel * first_re_[r] : 0;
      sum_im_[i] = seen ? -pixel * first_im_[r] : 0;
      if (!seen) step_re_[i] = step_im_[i] = 0;
    }
  }
}

void ColumnGroup::store(const Facet& facet, int first_plane, Image& image) {
  for (int c = begin_; c < end_; ++c) {
    first_phasors(c, first_plane);
    for (std::size_t i = at(c), r = 0; i < at(c + 1); ++i, ++r)
      sum_re_[i] = h_[i] * (sum_re_[i] * first_re_[r] - sum_im_[i] * first_im_[r]);
  }
  for (int r = 0; r < height_; ++r) {
    double* row = &image.at(facet.first_row + r, facet.first_column);
    for (int c = begin_; c < end_; ++c) row[c] += sum_re_[at(c) + static_cast<std::size_t>(r)];
  }
}

void ColumnGroup::first_phasors(int c, int first_plane) {
  turns_.resize(static_cast<std::size_t>(height_));
  first_re_.resize(turns_.size());
  first_im_.resize(turns_.size());
  for (std::size_t r = 0; r < turns_.size(); ++r) turns_[r] = (first_plane + 0.5) * q_[at(c) + r];
  phasors(turns_.data(), height_, first_re_.data(), first_im_.data());
}

}  // namespace misfit::imager
