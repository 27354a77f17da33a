#include "imager/clean/scaled_residual.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "imager/clean/gaussian_blur.h"
#include "imager/clean/mask.h"
#include "imager/data/noise.h"
#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

constexpr float none = std::numeric_limits<float>::quiet_NaN();

std::vector<int> steps_of(const std::vector<LookedAt>& scales) {
  std::vector<int> steps;
  for (const LookedAt& scale : scales) steps.push_back(scale.step);
  return steps;
}

/// The transform of a Gaussian's taps at waves 0 … n/2 of n pixels.
std::vector<float> transform_of(double fwhm_pixels, int n) {
  if (fwhm_pixels == 0) return {};
  const std::vector<double> taps = gaussian_taps(fwhm_pixels);
  std::vector<float> result;
  for (int k = 0; k <= n / 2; ++k) {
    double sum = taps[0];
    for (std::size_t x = 1; x < taps.size(); ++x)
      sum += 2 * taps[x] * std::cos(2 * M_PI * static_cast<double>(k) * static_cast<double>(x) / n);
    result.push_back(static_cast<float>(sum));
  }
  return result;
}

/// The unit of a residual: a power of two, so that it rounds nothing.
double unit_of(const Image& residual, int threads) {
  const double peak = statistics_of(residual, threads).largest_magnitude();
  return peak > 0 ? std::ldexp(1.0, std::ilogb(peak)) : 1;
}

}  // namespace

ScaledFft::ScaledFft(const std::vector<const Image*>& psf, const std::vector<LookedAt>& scales, int threads)
    : scale_(scales), fft_(psf.front()->width, psf.front()->height, steps_of(scales), threads) {
  for (const Image* image : psf)
    fft_.forward_psf([&](int row, float* pixels) { read_row(*image, row, pixels); }, psf_.emplace_back());
  for (const LookedAt& scale : scales) {
    along_u_.push_back(transform_of(scale.pixels, fft_.nu()));
    along_v_.push_back(transform_of(scale.pixels, fft_.nv()));
  }
}

void ScaledFft::filter(int u, std::size_t scale, std::complex<float>* value) const {
  if (along_u_[scale].empty()) return;
  const float by_u = along_u_[scale][static_cast<std::size_t>(u)];
  const float* const by_v = along_v_[scale].data();
  const int nv = fft_.nv();
  for (int v = 0; v <= nv / 2; ++v) value[v] *= by_u * by_v[v];
  for (int v = nv / 2 + 1; v < nv; ++v) value[v] *= by_u * by_v[nv - v];
}

void ScaledFft::convolve(const Half& image, std::size_t scale, const Write& write) const {
  const float by = static_cast<float>(1 / (double{1} * fft_.nu() * fft_.nv()));
  fft_.backward(
      {&image},
      [&](int u, const std::complex<float>* const* spectrum, std::complex<float>* result) {
        std::transform(spectrum[0], spectrum[0] + fft_.nv(), result, [by](std::complex<float> x) { return by * x; });
        filter(u, scale, result);
      },
      scale_[scale].step, write);
}

void ScaledFft::respond(const std::vector<const Half*>& model, std::size_t term, std::size_t scale, const Write& write) const {
  fft_.backward(
      model,
      [&](int u, const std::complex<float>* const* spectrum, std::complex<float>* result) {
        const auto psf = [&](std::size_t k) { return psf_[k].data() + static_cast<std::ptrdiff_t>(u) * fft_.nv(); };
        set_products(spectrum[0], psf(term), fft_.nv(), result);
        for (std::size_t t = 1; t < model.size(); ++t) add_products(spectrum[t], psf(term + t), fft_.nv(), result);
        filter(u, scale, result);
      },
      scale_[scale].step, write);
}

ScaledResidual::ScaledResidual(const std::vector<const Image*>& residual, const Image* mask, const ScaledPsf& psf,
                               const ScaledFft& fft, int threads)
    : psf_(psf),
      fft_(fft),
      threads_(threads),
      width_(residual.front()->width),
      height_(residual.front()->height),
      unit_jy_(unit_of(*residual.front(), threads)) {
  for (const ScaledPsf::Scale& scale : psf.scales()) {
    Plane& plane = plane_.emplace_back();
    plane.step = scale.looked_at.step;
    plane.width = (width_ + plane.step - 1) / plane.step;
    plane.height = (height_ + plane.step - 1) / plane.step;
    for (std::size_t t = 0; t < residual.size(); ++t)
      plane.residual.emplace_back().reserve(static_cast<std::size_t>(plane.width) * static_cast<std::size_t>(plane.height));
  }
  for (std::size_t t = 0; t < residual.size(); ++t) load(t, *residual[t]);
  forbid(residual, mask);
}

void ScaledResidual::load(std::size_t term, const Image& residual) {
  parallel_for(static_cast<std::size_t>(height_), threads_, [&](std::size_t row) {
    const int r = static_cast<int>(row);
    std::transform(residual.row(r), residual.row(r) + width_, plane_.front().row(term, r),
                   [this](double x) { return std::isnan(x) ? 0 : static_cast<float>(x / unit_jy_); });
  });
  if (plane_.size() == 1) return;
  ScaledFft::Half half;
  fft_.forward([&](int row, float* pixels) { std::copy_n(plane_.front().row(term, row), width_, pixels); }, half);
  for (std::size_t s = 1; s < plane_.size(); ++s)
    fft_.convolve(half, s,
                  [&](int row, const float* pixels) { std::copy_n(pixels, plane_[s].width, plane_[s].row(term, row)); });
}

/// Forbids Gaussians that have less than nine tenths of themselves on allowed pixels, or less than two of their widths within
/// the image: beyond these lies a millionth.
void ScaledResidual::forbid(const std::vector<const Image*>& residual, const Image* mask) {
  constexpr float enough = 0.9F;
  const auto is_allowed = [&](int row, int column) {
    if (mask != nullptr && !mask_allows(mask->at(row, column))) return false;
    return std::none_of(residual.begin(), residual.end(), [&](const Image* r) { return std::isnan(r->at(row, column)); });
  };
  const auto forbid_at = [&](Plane& plane, int row, int column) {
    for (std::size_t t = 0; t < plane.residual.size(); ++t) plane.row(t, row)[column] = none;
  };
  std::vector<char> all_allowed(static_cast<std::size_t>(height_), 1);
  parallel_for(static_cast<std::size_t>(height_), threads_, [&](std::size_t row) {
    const int r = static_cast<int>(row);
    for (int c = 0; c < width_; ++c)
      if (!is_allowed(r, c)) {
        all_allowed[row] = 0;
        forbid_at(plane_.front(), r, c);
      }
  });
  if (plane_.size() == 1) return;
  const bool everywhere = std::all_of(all_allowed.begin(), all_allowed.end(), [](char x) { return x != 0; });
  ScaledFft::Half allowed;
  if (!everywhere)
    fft_.forward(
        [&](int row, float* pixels) {
          for (int c = 0; c < width_; ++c) pixels[c] = is_allowed(row, c) ? 1 : 0;
        },
        allowed);
  for (std::size_t s = 1; s < plane_.size(); ++s) {
    Plane& plane = plane_[s];
    const int border = static_cast<int>(std::ceil(2 * psf_.scales()[s].looked_at.pixels));
    const auto forbid_row = [&](int row, const float* part) {
      const int r = row * plane.step;
      for (int column = 0; column < plane.width; ++column) {
        const int c = column * plane.step;
        const bool inside = r >= border && r < height_ - border && c >= border && c < width_ - border;
        if (!inside || !(part == nullptr || (part[column] >= enough && is_allowed(r, c)))) forbid_at(plane, row, column);
      }
    };
    if (everywhere)
      for (int row = 0; row < plane.height; ++row) forbid_row(row, nullptr);
    else
      fft_.convolve(allowed, s, forbid_row);
  }
}

/// Points are read from the list, since few lie in a row; Gaussians are drawn first.
void ScaledResidual::transform(const ComponentModel& found, int term, ScaledFft::Half& to) const {
  const std::vector<Component>& component = found.components();
  if (std::all_of(component.begin(), component.end(),
                  [&](const Component& c) { return found.scale_pixels()[static_cast<std::size_t>(c.scale)] == 0; })) {
    const auto above = [](const Component& c, int row) { return c.row < row; };
    return fft_.forward(
        [&](int row, float* pixels) {
          for (auto c = std::lower_bound(component.begin(), component.end(), row, above); c != component.end() && c->row == row;
               ++c)
            pixels[c->column] = static_cast<float>(c->coefficient_jy(term) / unit_jy_);
        },
        to);
  }
  const Image image = found.image(threads_, term);
  fft_.forward(
      [&](int row, float* pixels) {
        std::transform(image.row(row), image.row(row) + width_, pixels,
                       [this](double x) { return static_cast<float>(x / unit_jy_); });
      },
      to);
}

double ScaledResidual::noise_jy() const {
  const std::size_t pixels = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  return unit_jy_ * sampled_noise(plane_.front().row(0, 0), pixels);
}

void ScaledResidual::subtract(const ComponentModel& found) {
  const std::size_t terms = plane_.front().residual.size();
  std::deque<ScaledFft::Half> halves;
  std::vector<const ScaledFft::Half*> model;
  for (std::size_t t = 0; t < terms; ++t) {
    transform(found, static_cast<int>(t), halves.emplace_back());
    model.push_back(&halves.back());
  }
  for (std::size_t s = 0; s < plane_.size(); ++s)
    for (std::size_t q = 0; q < terms; ++q)
      fft_.respond(model, q, s, [&](int row, const float* pixels) {
        float* const to = plane_[s].row(q, row);
        for (int c = 0; c < plane_[s].width; ++c) to[c] -= pixels[c];
      });
}

}  // namespace misfit::imager
