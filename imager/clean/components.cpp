#include "imager/clean/components.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "imager/clean/gaussian_blur.h"
#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

bool before(const Component& a, const Component& b) {
  return std::tie(a.scale, a.row, a.column) < std::tie(b.scale, b.row, b.column);
}

void add(const Component& c, Component& to) {
  to.flux_jy += c.flux_jy;
  for (std::size_t t = 0; t < c.further_jy.size(); ++t) to.further_jy[t] += c.further_jy[t];
}

/// Adds up neighbours at one place, in their order.
std::vector<Component> with_one_at_a_place(const std::vector<Component>& sorted) {
  std::vector<Component> result;
  for (const Component& c : sorted) {
    const bool same = !result.empty() && !before(result.back(), c);
    if (same)
      add(c, result.back());
    else
      result.push_back(c);
  }
  std::erase_if(result, [](const Component& c) { return c.flux_jy == 0 && c.further_jy == Component{}.further_jy; });
  return result;
}

/// Gaussians of the flux that components have in a Taylor term.
struct GaussianTerm {
  int term = 0;
  std::vector<double> taps;
};

/// Adds the Gaussians of components, which are in the order of rows, to an image.
template <typename Iterator>
void add_gaussians(Iterator begin, Iterator end, const GaussianTerm& of, int threads, Image& image) {
  const std::vector<double>& taps = of.taps;
  const int reach = static_cast<int>(taps.size()) - 1;
  const auto tap = [&taps](int k) { return taps[static_cast<std::size_t>(std::abs(k))]; };
  std::vector<double> along_row;  // columns −reach … reach
  for (int k = -reach; k <= reach; ++k) along_row.push_back(tap(k));
  parallel_for(static_cast<std::size_t>(image.height), threads, [&](std::size_t at) {
    const int r = static_cast<int>(at);
    const auto above = [](const Component& c, int row) { return c.row < row; };
    for (auto c = std::lower_bound(begin, end, r - reach, above); c != end && c->row <= r + reach; ++c) {
      const double flux = c->coefficient_jy(of.term) * tap(r - c->row);
      const int first = std::max(0, c->column - reach), last = std::min(image.width - 1, c->column + reach);
      const double* const from = along_row.data() + (first - c->column + reach);
      double* const to = image.row(r) + first;
      for (int k = 0; k <= last - first; ++k) to[k] += flux * from[k];
    }
  });
}

}  // namespace

ComponentModel::ComponentModel(int width, int height, std::vector<double> scale_pixels)
    : width_(width), height_(height), scale_pixels_(std::move(scale_pixels)) {}

void ComponentModel::add(const std::vector<Component>& found) {
  for (const Component& c : found)
    if (c.row < 0 || c.row >= height_ || c.column < 0 || c.column >= width_ || c.scale < 0 ||
        c.scale >= static_cast<int>(scale_pixels_.size()))
      throw std::invalid_argument("component of scale " + std::to_string(c.scale) + " at row " + std::to_string(c.row) +
                                  ", column " + std::to_string(c.column) + ": expected one of " +
                                  std::to_string(scale_pixels_.size()) + " scales in an image of " + std::to_string(width_) +
                                  " × " + std::to_string(height_) + " pixels");
  const auto old = static_cast<std::ptrdiff_t>(components_.size());
  components_.insert(components_.end(), found.begin(), found.end());
  std::stable_sort(components_.begin() + old, components_.end(), before);
  std::inplace_merge(components_.begin(), components_.begin() + old, components_.end(), before);  // stable
  components_ = with_one_at_a_place(components_);
}

double ComponentModel::flux_jy() const {
  double sum = 0;
  for (const Component& c : components_) sum += c.flux_jy;
  return sum;
}

Image ComponentModel::image(int threads, int term) const {
  Image result(width_, height_);
  for (auto c = components_.begin(); c != components_.end();) {
    const int scale = c->scale;
    const double fwhm = scale_pixels_[static_cast<std::size_t>(scale)];
    if (fwhm == 0) {
      for (; c != components_.end() && c->scale == scale; ++c) result.at(c->row, c->column) += c->coefficient_jy(term);
      continue;
    }
    const auto first = c;
    while (c != components_.end() && c->scale == scale) ++c;
    add_gaussians(first, c, {term, gaussian_taps(fwhm)}, threads, result);
  }
  return result;
}

std::vector<Component> components_of(const Image& image) {
  return components_of(std::vector{&image});
}

std::vector<Component> components_of(const std::vector<const Image*>& terms) {
  std::vector<Component> result;
  for (int r = 0; r < terms.front()->height; ++r)
    for (int c = 0; c < terms.front()->width; ++c) {
      Component component{0, r, c};
      for (std::size_t t = 0; t < terms.size(); ++t)
        if (const double flux_jy = terms[t]->at(r, c); !std::isnan(flux_jy))
          (t == 0 ? component.flux_jy : component.further_jy[t - 1]) = flux_jy;
      const auto& further = component.further_jy;
      if (component.flux_jy != 0 || std::any_of(further.begin(), further.end(), [](double x) { return x != 0; }))
        result.push_back(component);
    }
  return result;
}

}  // namespace misfit::imager
