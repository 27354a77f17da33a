#include "imager/direct/source_sums.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <utility>

#include "imager/data/phase.h"
#include "imager/direct/source_loops.h"
#include "imager/numerics/constants.h"
#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

void append(const Source& source, bool with_w, SourceArrays& to) {
  const PhasePosition at = phase_position(source.position);
  to.l.push_back(at.l);
  to.m.push_back(at.m);
  to.n_minus_1.push_back(with_w ? at.n_minus_1 : 0);
  to.flux_jy.push_back(source.flux_jy);
  to.decay.push_back(std::pow(pi * source.fwhm_rad, 2) / (4 * std::log(2.0)));
}

/// The points, or the Gaussians, among `all`.
SourceArrays chosen(const std::vector<Source>& all, bool points, bool with_w) {
  SourceArrays arrays;
  for (const Source& source : all)
    if ((source.fwhm_rad == 0) == points) append(source, with_w, arrays);
  while (arrays.size() % SourceArrays::together != 0) append({}, with_w, arrays);
  return arrays;
}

/// Channels in the order of their frequency, cut into runs that are evenly spaced.
class OrderedChannels {
 public:
  struct Run : EvenChannels {
    std::size_t begin = 0;
  };

  explicit OrderedChannels(const std::vector<double>& frequency_hz) : channel_(frequency_hz.size()) {
    std::iota(channel_.begin(), channel_.end(), 0);
    std::stable_sort(channel_.begin(), channel_.end(),
                     [&](std::size_t a, std::size_t b) { return frequency_hz[a] < frequency_hz[b]; });
    for (const std::size_t channel : channel_) hz_.push_back(frequency_hz[channel]);
    for (std::size_t begin = 0; begin < hz_.size(); begin += runs_.back().count) runs_.push_back(longest_from(begin));
  }

  const std::vector<Run>& runs() const { return runs_; }
  /// The channel at `place` of the order.
  std::size_t channel(std::size_t place) const { return channel_[place]; }

 private:
  /// The longest evenly spaced run that differs from the frequencies by no more than rounding.
  Run longest_from(std::size_t begin) const {
    Run run;
    run.begin = begin;
    run.first_hz = hz_[begin];
    for (run.count = std::min(EvenChannels::most, hz_.size() - begin); run.count > 1; run.count /= 2) {
      run.step_hz = (hz_[begin + run.count - 1] - run.first_hz) / static_cast<double>(run.count - 1);
      if (even(run)) break;
    }
    return run;
  }
  bool even(const Run& run) const {
    constexpr double rounding = 2 * std::numeric_limits<double>::epsilon();
    for (std::size_t c = 0; c < run.count; ++c) {
      const double f = hz_[run.begin + c];
      if (std::abs(run.first_hz + static_cast<double>(c) * run.step_hz - f) > rounding * f) return false;
    }
    return true;
  }

  std::vector<std::size_t> channel_;
  std::vector<double> hz_;  ///< ascending
  std::vector<Run> runs_;
};

/// Sums over all sources, for some rows and channels at a time.
class SourceSums {
 public:
  SourceSums(const std::vector<Source>& sources, const SampleCoordinates& at, bool with_w)
      : points_(chosen(sources, true, with_w)), gaussians_(chosen(sources, false, with_w)), at_(at), order_(at.frequency_hz) {}

  static constexpr std::size_t rows_a_piece = 8 * RowGroup::rows;
  std::size_t pieces() const { return (at_.rows() + rows_a_piece - 1) / rows_a_piece * order_.runs().size(); }

  void sum(std::size_t piece, std::vector<std::complex<double>>& visibility) const {
    const OrderedChannels::Run& run = order_.runs()[piece % order_.runs().size()];
    const std::size_t first_row = piece / order_.runs().size() * rows_a_piece;
    const std::size_t end_row = std::min(first_row + rows_a_piece, at_.rows());
    std::vector<RowGroup> groups;
    for (std::size_t row = first_row; row < end_row; row += RowGroup::rows) groups.push_back(group_at(row));
    std::vector<GroupSums> sums(groups.size());
    add(add_points, points_, groups, run, sums);
    add(add_gaussians, gaussians_, groups, run, sums);
    for (std::size_t row = first_row; row < end_row; ++row) {
      const GroupSums& of = sums[(row - first_row) / RowGroup::rows];
      for (std::size_t c = 0; c < run.count; ++c) {
        const std::size_t i = c * RowGroup::rows + (row - first_row) % RowGroup::rows;
        visibility[row * at_.channels() + order_.channel(run.begin + c)] = {of.real[i], of.imaginary[i]};
      }
    }
  }

 private:
  /// Rows beyond the last lie at 0.
  RowGroup group_at(std::size_t row) const {
    RowGroup group;
    for (std::size_t r = 0; r < std::min(RowGroup::rows, at_.rows() - row); ++r) {
      const double* const uvw_m = &at_.uvw_m[3 * (row + r)];
      group.u_s[r] = uvw_m[0] / speed_of_light_m_s;
      group.v_s[r] = uvw_m[1] / speed_of_light_m_s;
      group.w_s[r] = uvw_m[2] / speed_of_light_m_s;
    }
    return group;
  }

  /// Adds so many sources at a time that caches hold them for all groups.
  template <typename Add>
  static void add(const Add& add_some, const SourceArrays& sources, const std::vector<RowGroup>& groups,
                  const EvenChannels& channels, std::vector<GroupSums>& sums) {
    constexpr std::size_t sources_at_once = 512;
    for (std::size_t begin = 0; begin < sources.size(); begin += sources_at_once)
      for (std::size_t g = 0; g < groups.size(); ++g)
        add_some(sources, {begin, std::min(begin + sources_at_once, sources.size())}, groups[g], channels, sums[g]);
  }

  SourceArrays points_, gaussians_;
  const SampleCoordinates& at_;
  OrderedChannels order_;
};

/// Predicts as if α were 0.
std::vector<std::complex<double>> predict_flat(const std::vector<Source>& sources, const SampleCoordinates& at, int threads,
                                               bool with_w) {
  std::vector<std::complex<double>> visibility(at.samples());
  if (visibility.empty()) return visibility;
  const SourceSums sums(sources, at, with_w);
  parallel_for(sums.pieces(), threads, [&](std::size_t piece) { sums.sum(piece, visibility); });
  return visibility;
}

/// α and ν_0; both 0 where the flux is the same at all frequencies.
std::pair<double, double> spectrum_of(const Source& source) {
  return source.spectral_index == 0 ? std::pair(0.0, 0.0) : std::pair(source.spectral_index, source.reference_hz);
}

}  // namespace

std::vector<std::complex<double>> predict_sources(const std::vector<Source>& sources, const SampleCoordinates& at, int threads,
                                                  bool with_w) {
  const auto is_flat = [](const Source& source) { return source.spectral_index == 0; };
  if (std::all_of(sources.begin(), sources.end(), is_flat)) return predict_flat(sources, at, threads, with_w);
  std::map<std::pair<double, double>, std::vector<Source>> by_spectrum;
  for (const Source& source : sources) by_spectrum[spectrum_of(source)].push_back(source);
  std::vector<std::complex<double>> sum(at.samples());
  for (const auto& [spectrum, alike] : by_spectrum) {
    const std::vector<std::complex<double>> flat = predict_flat(alike, at, threads, with_w);
    for (std::size_t c = 0; c < at.channels(); ++c) {
      const double factor = spectrum.first == 0 ? 1 : std::pow(at.frequency_hz[c] / spectrum.second, spectrum.first);
      for (std::size_t i = c; i < sum.size(); i += at.channels()) sum[i] += factor * flat[i];
    }
  }
  return sum;
}

}  // namespace misfit::imager
