#include "imager/clean/clean.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "imager/numerics/parallel.h"

namespace misfit::imager {
void check(const CleanOptions& o, const std::string& prefix) {
  const auto text_of = [](double value) {
    std::ostringstream typed;
    typed << value;
    return typed.str();
  };
  const auto expect = [&](bool holds, const char* name, double value, const std::string& expected) {
    if (!holds) throw std::invalid_argument(prefix + name + " " + text_of(value) + ": expected " + expected);
  };
  expect(o.max_iterations >= 0, "niter", o.max_iterations, "0 or more");
  expect(o.gain > 0 && o.gain <= 1, "gain", o.gain, "more than 0 and at most 1");
  expect(o.threshold_jy >= 0, "threshold", o.threshold_jy, "0 or more");
  expect(o.nsigma >= 0, "nsigma", o.nsigma, "0 or more");
  expect(o.cycle_factor > 0, "cyclefactor", o.cycle_factor, "more than 0");
  expect(o.min_psf_fraction > 0 && o.min_psf_fraction <= 1, "minpsffraction", o.min_psf_fraction, "more than 0 and at most 1");
  expect(o.max_psf_fraction >= o.min_psf_fraction && o.max_psf_fraction <= 1, "maxpsffraction", o.max_psf_fraction,
         "at most 1, and at least minpsffraction, " + text_of(o.min_psf_fraction));
  expect(o.cycle_iterations == -1 || o.cycle_iterations >= 1, "cycleniter", o.cycle_iterations, "-1 (no limit), 1 or more");
  expect(o.max_major_cycles >= -1, "nmajor", o.max_major_cycles, "-1 (no limit) or more");
}

double largest_sidelobe(const Image& psf, const Image& beam) {
  double largest = 0;
  for (std::size_t i = 0; i < psf.pixel.size(); ++i) largest = std::max(largest, std::abs(psf.pixel[i] - beam.pixel[i]));
  return largest;
}

/// The beam counts as 0 where it is below 1e-8.
double largest_sidelobe(const Image& psf, const Beam& beam, double cell_rad, int threads) {
  const int reach = static_cast<int>(std::ceil(2.6 * beam.major_rad / cell_rad)) + 1;
  const int row = psf.height / 2, column = psf.width / 2;
  const int first_row = std::max(0, row - reach), last_row = std::min(psf.height - 1, row + reach);
  const int first_column = std::max(0, column - reach), last_column = std::min(psf.width - 1, column + reach);
  Image middle(last_column - first_column + 1, last_row - first_row + 1), point(middle.width, middle.height);
  point.at(row - first_row, column - first_column) = 1;
  for (int r = 0; r < middle.height; ++r) std::copy_n(psf.row(first_row + r) + first_column, middle.width, middle.row(r));
  std::vector<double> largest(static_cast<std::size_t>(psf.height));
  parallel_for(largest.size(), threads, [&](std::size_t at) {
    const int r = static_cast<int>(at);
    const bool beside = r >= first_row && r <= last_row;
    for (int c = 0; c < psf.width; ++c)
      if (!beside || c < first_column || c > last_column) largest[at] = std::max(largest[at], std::abs(psf.at(r, c)));
  });
  return std::max(largest_sidelobe(middle, convolve_with_beam(point, beam, cell_rad, 1)),
                  *std::max_element(largest.begin(), largest.end()));
}

FarSidelobes far_sidelobes(const Image& psf, double from_part) {
  double square_sum = 0, count = 0, largest = 0;
  for (int r = 0; r < psf.height; ++r) {
    const bool far_row = std::abs(r - psf.height / 2) >= from_part * psf.height;
    for (int c = 0; c < psf.width; ++c) {
      const double value = psf.at(r, c);
      if (!(far_row || std::abs(c - psf.width / 2) >= from_part * psf.width) || std::isnan(value)) continue;
      square_sum += value * value;
      count += 1;
      largest = std::max(largest, std::abs(value));
    }
  }
  return {std::sqrt(square_sum / std::max(1.0, count)), largest};
}

CleanState first_state(const ComponentModel& model) {
  CleanState state;
  state.model = state.best_model = model;
  return state;
}

}  // namespace misfit::imager
