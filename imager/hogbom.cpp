#include "imager/hogbom.h"

#include <algorithm>
#include <barrier>
#include <cmath>
#include <stdexcept>
#include <thread>
#include <vector>

#include "imager/hogbom_loops.h"

namespace misfit::imager {
namespace {

/// The working state of a minor cycle, shared by threads that each own a band of rows.
class Search {
 public:
  Search(const Image& residual, const Image& psf)
      : width_(residual.width),
        height_(residual.height),
        residual_(residual.pixel.begin(), residual.pixel.end()),
        psf_(psf.pixel.begin(), psf.pixel.end()),
        row_peak_(static_cast<std::size_t>(height_)) {
    for (float& value : psf_)
      if (std::isnan(value)) value = 0;
    for (int r = 0; r < height_; ++r) row_peak_[static_cast<std::size_t>(r)] = peak_magnitude(&residual_[at(r, 0)], width_);
    find();
  }

  double value() const { return double{residual_[at(row_, column_)]}; }
  double magnitude() const { return double{row_peak_[static_cast<std::size_t>(row_)]}; }
  int row() const { return row_; }
  int column() const { return column_; }

  /// Subtracts factor × PSF centred on (row, column) from the rows [first, last).
  void subtract(int row, int column, float factor, int first, int last) {
    const int shift_rows = row - height_ / 2;
    const int shift_columns = column - width_ / 2;
    const int c0 = std::max(0, shift_columns);
    const int c1 = std::min(width_, width_ + shift_columns);
    for (int r = std::max(first, shift_rows); r < std::min(last, height_ + shift_rows); ++r) {
      const float peak =
          subtract_and_peak(&residual_[at(r, c0)], &psf_[at(r - shift_rows, c0 - shift_columns)], c1 - c0, factor);
      row_peak_[static_cast<std::size_t>(r)] =
          std::max({peak, peak_magnitude(&residual_[at(r, 0)], c0), peak_magnitude(residual_.data() + at(r, c1), width_ - c1)});
    }
  }

  /// Locates the brightest pixel, the first in row-major order among equals.
  void find() {
    row_ = static_cast<int>(std::max_element(row_peak_.begin(), row_peak_.end()) - row_peak_.begin());
    const float peak = row_peak_[static_cast<std::size_t>(row_)];
    column_ = 0;
    while (column_ + 1 < width_ && std::abs(residual_[at(row_, column_)]) != peak) ++column_;
  }

 private:
  std::size_t at(int r, int c) const {
    return static_cast<std::size_t>(r) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(c);
  }
  int width_;
  int height_;
  std::vector<float> residual_;
  std::vector<float> psf_;
  std::vector<float> row_peak_;  ///< largest magnitude in each row
  int row_ = 0;
  int column_ = 0;
};

}  // namespace

MinorCycleReport hogbom(const Image& residual, const Image& psf, const MinorCycleOptions& options, Image& model) {
  if (residual.width != psf.width || residual.height != psf.height || residual.width != model.width ||
      residual.height != model.height)
    throw std::invalid_argument("residual of " + std::to_string(residual.width) + " × " + std::to_string(residual.height) +
                                " pixels: PSF and model are expected to have the same size");
  constexpr double divergence = 3;  // as clean() judges major cycles
  Search search(residual, psf);
  const double first_peak = search.magnitude();
  MinorCycleReport report;
  bool done = false;
  float factor = 0;  // what all threads subtract; the peak itself changes while they do
  // Runs in one thread while the others wait: take the peak, or end.
  const auto take = [&]() noexcept {
    report.peak_jy = search.magnitude();
    const bool stopped = options.stop_requested && report.iterations % 64 == 0 && options.stop_requested();
    done = stopped || report.iterations >= options.max_iterations || !(report.peak_jy > options.threshold_jy) ||
           !(report.peak_jy <= divergence * first_peak);
    if (done) return;
    const double component = options.gain * search.value();
    model.at(search.row(), search.column()) += component;
    report.flux_jy += component;
    ++report.iterations;
    factor = static_cast<float>(component);
  };
  const auto next = [&]() noexcept {
    search.find();
    take();
  };

  take();
  const int threads = std::clamp(options.threads, 1, std::max(1, residual.height / 64));
  std::barrier barrier(threads, next);
  const auto work = [&](int thread) {
    const int first = residual.height * thread / threads;
    const int last = residual.height * (thread + 1) / threads;
    while (!done) {
      search.subtract(search.row(), search.column(), factor, first, last);
      barrier.arrive_and_wait();
    }
  };
  std::vector<std::thread> others;
  for (int thread = 1; thread < threads; ++thread) others.emplace_back(work, thread);
  work(0);
  for (std::thread& other : others) other.join();
  return report;
}

}  // namespace misfit::imager
