#include "imager/clean/region.h"

#include <cmath>
#include <cstring>

namespace misfit::imager {
namespace {

/// A region ⊗ beam, near the region. Runs of pixels have fewer ends than pixels: along rows, the beam is added where a run
/// begins, and taken off behind its end; the running sum along rows is then the region ⊗ beam, up to rounding.
class Smoothing {
 public:
  /// `stamp` is the beam about its middle, of as many rows as columns, an odd number.
  Smoothing(const Region& region, const Image& stamp, int threads)
      : stamp_(stamp),
        reach_(stamp.width / 2),
        width_(region.width),
        runs_(static_cast<std::size_t>(region.height)),
        rows_(runs_.size()) {
    parallel_for(runs_.size(), threads, [&](std::size_t r) { runs_[r] = runs_of(region, r); });
    parallel_for(rows_.size(), threads, [&](std::size_t r) { smooth_row(static_cast<int>(r)); });
  }

  double largest() const {
    double largest = 0;
    for (const Row& row : rows_) largest = std::max(largest, row.largest);
    return largest;
  }

  /// 1 where a row exceeds a level above 0, else 0.
  void cut_row(std::size_t r, double level, char* in) const {
    std::fill_n(in, width_, 0);
    if (rows_[r].largest <= level) return;
    const double* sum = rows_[r].sum.data();
    for (const Run& near : rows_[r].near)
      for (int c = near.begin; c < near.end; ++c) in[c] = *sum++ > level ? 1 : 0;
  }

 private:
  /// Columns [begin, end).
  struct Run {
    int begin = 0;
    int end = 0;
  };
  struct Row {
    std::vector<Run> near;    ///< where the beam reaches, in order and apart
    std::vector<double> sum;  ///< one after the other
    double largest = 0;
  };

  static std::vector<Run> runs_of(const Region& region, std::size_t r) {
    const char* const first = region.in.data() + r * static_cast<std::size_t>(region.width);
    const char* const last = first + region.width;
    std::vector<Run> runs;
    for (const char* at = first; (at = static_cast<const char*>(std::memchr(at, 1, static_cast<std::size_t>(last - at))));) {
      const char* const end = std::find(at, last, 0);
      runs.push_back({static_cast<int>(at - first), static_cast<int>(end - first)});
      if ((at = end) == last) break;
    }
    return runs;
  }

  void smooth_row(int r) {
    std::vector<double> line;  // from reach_ pixels before the row to as many behind
    std::vector<Run> near;
    for (int other = std::max(0, r - reach_); other <= std::min(static_cast<int>(runs_.size()) - 1, r + reach_); ++other) {
      const double* const beam = stamp_.row(r - other + reach_);
      int first = 0, last = stamp_.width;
      while (first < last && beam[first] == 0) ++first;
      while (first < last && beam[last - 1] == 0) --last;
      for (const Run& run : runs_[static_cast<std::size_t>(other)]) {
        line.resize(static_cast<std::size_t>(width_) + static_cast<std::size_t>(stamp_.width));
        double* const begin = line.data() + run.begin;
        double* const end = line.data() + run.end;
        for (int k = first; k < last; ++k) begin[k] += beam[k];
        for (int k = first; k < last; ++k) end[k] -= beam[k];
        near.push_back({run.begin - reach_, run.end + reach_});
      }
    }
    std::sort(near.begin(), near.end(), [](const Run& a, const Run& b) { return a.begin < b.begin; });
    Row& row = rows_[static_cast<std::size_t>(r)];
    for (std::size_t i = 0; i < near.size();) {
      Run all = near[i];
      while (++i < near.size() && near[i].begin <= all.end) all.end = std::max(all.end, near[i].end);
      sum_up(line, all, row);
    }
  }

  void sum_up(const std::vector<double>& line, const Run& near, Row& row) const {
    row.near.push_back({std::max(near.begin, 0), std::min(near.end, width_)});
    double sum = 0;
    for (int c = near.begin; c < row.near.back().end; ++c) {
      const int at = c + reach_;
      sum += line[static_cast<std::size_t>(at)];
      if (c < 0) continue;
      row.sum.push_back(sum);
      row.largest = std::max(row.largest, sum);
    }
  }

  const Image& stamp_;
  int reach_;
  int width_;
  std::vector<std::vector<Run>> runs_;  ///< [row], of the region
  std::vector<Row> rows_;
};

/// A beam about its middle, as far as convolve_with_beam() takes it.
Image stamp(const Beam& beam, double cell_rad, int threads) {
  constexpr double reach = 3;  // full widths at half maximum
  const int pixels = static_cast<int>(std::ceil(reach * beam.major_rad / cell_rad));
  Image middle(2 * pixels + 1, 2 * pixels + 1);
  middle.at(pixels, pixels) = 1;
  return convolve_with_beam(middle, beam, cell_rad, threads);
}

}  // namespace

void smooth_and_cut(const RegionSmoothing& by, Region& region) {
  if (region.empty()) return;
  const Image beam = stamp(by.beam, by.cell_rad, by.threads);
  const Smoothing smoothing(region, beam, by.threads);
  constexpr double rounding = 5e-9;  // half of convolve_with_beam()'s least beam: what no beam reaches is below, all else above
  const double level = std::max(by.cut * smoothing.largest(), rounding);
  parallel_for(static_cast<std::size_t>(region.height), by.threads, [&](std::size_t r) {
    smoothing.cut_row(r, level, region.in.data() + r * static_cast<std::size_t>(region.width));
  });
}

}  // namespace misfit::imager
