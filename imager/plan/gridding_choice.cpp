#include "imager/plan/gridding_choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "imager/data/extent.h"
#include "imager/numerics/fft.h"

namespace misfit::imager {
namespace {

constexpr int smallest_fft = 64;

/// Paddings from the one that needs the narrowest kernel down: an accuracy that the widest padding cannot reach, no other can.
constexpr std::array<double, 5> usual_paddings{2.0, 1.6, 1.4, 1.25, 1.15};
constexpr std::array<double, 6> usual_paddings_with_w{2.0, 1.75, 1.6, 1.4, 1.25, 1.15};  // taps cost more there, FFTs less
constexpr std::array<double, 7> usual_w_paddings{40, 10, 4, 2.5, 2.0, 1.6, 1.3};

/// The search for the cheapest candidate, precision by precision and padding by padding.
class Search {
 public:
  /// With a w axis over one of the facetings, or without where there are none.
  Search(const GriddingRequest& request, double target, std::vector<Faceting> ways)
      : request_(request), shelf_(request.kernel, request.lookup), target_(target), ways_(std::move(ways)) {
    if (has_w_axis()) {
      usual_.assign(usual_paddings_with_w.begin(), usual_paddings_with_w.end());
    } else {
      usual_.assign(usual_paddings.begin(), usual_paddings.end());
    }
  }

  GriddingChoice run() {
    for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
      if (request_.precision
              ? precision != *request_.precision
              : precision == Precision::single_precision && request_.accuracy != 0 && request_.accuracy < request_.single_from)
        continue;
      search(precision);
      if (best_ && request_.accuracy == 0) break;
    }
    GriddingChoice choice;
    choice.best = simplified(best_ ? made_exactly(*best_) : *most_exact_);
    choice.reached = best_ || choice.best.worst_error <= target_;  // short polynomials may err less
    choice.rejected = neighbours(choice.best);
    return choice;
  }

 private:
  std::vector<double> paddings() const {
    if (request_.padding != 0) return {request_.padding};
    if (request_.accuracy == 0) return {least_padding()};  // what the given kernel is made for
    std::vector<double> found;
    for (const double usual : usual_) {
      if (usual < request_.least_padding || usual > request_.most_padding) continue;
      found.push_back(std::max(usual, least_padding()));
      if (usual <= least_padding()) break;
    }
    if (found.empty() || request_.most_padding < usual_.front())
      found.insert(found.begin(), std::max(request_.most_padding, least_padding()));
    return found;
  }
  int narrowest() const { return request_.kernel_width != 0 ? request_.kernel_width : request_.kernel.min_width; }
  int widest() const { return request_.kernel_width != 0 ? request_.kernel_width : request_.kernel.max_width; }

  /// The padding of the family's widest x0, which came from a padding, and is rounded.
  double least_padding() const { return 0.5 / request_.kernel.max_x0 * (1 - 1e-12); }

  /// At least four widths, so that a kernel never meets its own periodic copy.
  int fft_size(int pixels, double padding, int width) const {
    const double needed = std::max(padding, least_padding()) * pixels;
    return fast_fft_size(std::max({smallest_fft, 4 * width, static_cast<int>(std::ceil(needed))}));
  }

  /// A candidate with sizes and cost, which need no kernel.
  GriddingCandidate sized(int width, double padding_u, double padding_v, Precision precision) const {
    GriddingCandidate c;
    c.padding_u = padding_u;
    c.padding_v = padding_v;
    const ImageGeometry& g = request_.geometry;
    c.work = {static_cast<double>(request_.samples),
              width,
              width,  // close to the degree that will do
              fft_size(g.width, padding_u, width),
              fft_size(g.height, padding_v, width),
              g.width,
              precision};
    c.work.stokes = request_.stokes;
    c.work.psf = request_.psf;
    c.faceting.width = g.width;
    c.faceting.height = g.height;
    c.turns = std::abs(g.centre.l) / (2 * g.cell_rad) + std::abs(g.centre.m) / (2 * g.cell_height_rad());
    if (has_w_axis()) {
      c.turns += request_.max_abs_w * largest_drop(g);
      const std::uint64_t at_once = std::max<std::size_t>(1, request_.samples_at_once);
      constexpr std::uint64_t most = std::numeric_limits<int>::max();
      c.work.gathers = static_cast<int>(std::clamp<std::uint64_t>((request_.samples + at_once - 1) / at_once, 1, most));
    }
    c.cost_s = CostModel().seconds(c.work);
    if (has_w_axis()) split(c, 1, request_.kernel.min_width);  // the least that a w axis costs
    return c;
  }

  /// Takes the faceting that costs least with planes of this padding and width.
  void split(GriddingCandidate& c, double padding_w, int width_w) const {
    c.cost_s = HUGE_VAL;
    for (const Faceting& way : ways_) {
      GriddingWork work = c.work;
      work.width_w = width_w;
      work.facets = static_cast<int>(way.turns.size());
      work.planes = way.planes(padding_w, width_w);
      work.nu = fft_size(way.width, c.padding_u, work.width);
      work.nv = fft_size(way.height, c.padding_v, work.width);
      work.columns = way.width;
      const double cost_s = CostModel().seconds(work);
      if (cost_s >= c.cost_s) continue;
      c.work = work;
      c.cost_s = cost_s;
      c.faceting = way;
    }
    c.padding_w = padding_w;
  }

  bool has_w_axis() const { return !ways_.empty(); }
  static bool small(int pixels) { return pixels < continuum; }

  void judge_plane(GriddingCandidate& c) {
    const auto axis = [&](int pixels, double padding) {
      return small(pixels) ? shelf_.axis(c.work.width, pixels, fft_size(pixels, padding, c.work.width))
                           : shelf_.axis(c.work.width, padding);
    };
    c.u = axis(request_.geometry.width, c.padding_u);
    c.v = axis(request_.geometry.height, c.padding_v);
    judge(c);
  }
  void remember(const GriddingCandidate& c) {
    if (!most_exact_ || c.worst_error < most_exact_->worst_error) most_exact_ = c;
  }

  /// The candidate with kernels for its true FFT sizes, which are a little larger than the paddings ask for.
  GriddingCandidate made_exactly(const GriddingCandidate& nominal) {
    GriddingCandidate c = nominal;
    c.u = shelf_.axis(c.work.width, c.faceting.width, c.work.nu);
    c.v = shelf_.axis(c.work.width, c.faceting.height, c.work.nv);
    judge(c);
    return c.worst_error <= std::max(target_, nominal.worst_error) ? c : nominal;
  }

  /// True if a wider kernel would only gather rounding.
  static bool exhausted(const GriddingCandidate& c) { return c.worst_error < 2 * c.rounding; }
  bool costs_less(const GriddingCandidate& c) const { return !best_ || c.cost_s < best_->cost_s; }
  /// True if a candidate may be taken: where no accuracy is asked, single precision must not limit it.
  bool trusted(const GriddingCandidate& c) const {
    if (c.work.precision == Precision::double_precision || request_.accuracy != 0 || request_.precision) return true;
    return c.worst_error >= request_.single_from && c.rounding < 0.1 * c.worst_error;
  }
  void offer(const GriddingCandidate& c) {
    if (trusted(c) && costs_less(c)) best_ = c;
  }

  /// Padding falls, so that the width needed only grows, and what one padding cannot reach, no smaller one can. One axis alone
  /// may do with the next smaller padding at the same width.
  void search(Precision precision) {
    int width = narrowest();
    for (const double padding : paddings()) {
      const std::optional<int> needed = narrowest_reaching(width, padding, padding, precision);
      if (!needed) break;
      width = *needed;
    }
    if (!best_ || request_.padding != 0 || best_->work.precision != precision) return;
    const GriddingCandidate square = *best_;
    const auto smaller = std::find_if(usual_.begin(), usual_.end(), [&](double usual) { return usual < square.padding_u; });
    if (smaller == usual_.end() || *smaller < std::max(least_padding(), request_.least_padding)) return;
    for (const auto& [u, v] : {std::pair(*smaller, square.padding_v), std::pair(square.padding_u, *smaller)})
      consider(sized(square.work.width, u, v, precision));
  }

  enum class Outcome { reaches, costs_too_much, not_exact_enough };

  Outcome consider(GriddingCandidate c) {
    if (!costs_less(c)) {
      considered_.push_back({c, Rejection::costs_more});
      return Outcome::costs_too_much;
    }
    judge_plane(c);
    if (has_w_axis()) c = with_w(c);
    remember(c);
    const bool reaches = c.worst_error <= target_;
    considered_.push_back({c, reaches ? Rejection::costs_more : Rejection::not_exact_enough});
    if (!reaches) return Outcome::not_exact_enough;
    offer(c);
    return Outcome::reaches;
  }

  /// How the kernel's error falls with width at these paddings.
  struct Forecast {
    double log_error = 0;  ///< at `width`
    double log_rate = 0;   ///< change for one more cell, negative
    int width = 0;

    double at(int other) const { return std::exp(log_error + log_rate * (other - width)); }
  };
  /// A forecast from two narrow kernels, which are quickly solved; wide ones take extended arithmetic. None where all are
  /// quickly made.
  std::optional<Forecast> forecast(double padding_u, double padding_v, Precision precision) {
    const int width = std::max(narrowest(), 5);
    const int pixels = std::min(request_.geometry.width, request_.geometry.height);
    if (!request_.kernel.costly || small(pixels) || width + 2 > widest()) return {};
    double log_error[2];
    for (int i = 0; i < 2; ++i) {
      GriddingCandidate c = sized(width + i, padding_u, padding_v, precision);
      judge_plane(c);
      log_error[i] = std::log(std::max(c.worst_error * c.worst_error - c.rounding * c.rounding, 1e-40)) / 2;
      remember(has_w_axis() ? with_w(c) : c);
    }
    return Forecast{log_error[1], std::min(-0.1, log_error[1] - log_error[0]), width + 1};
  }

  /// The narrowest width from `least` on that reaches the accuracy, which is offered; or a width that costs too much, not
  /// judged; or none.
  std::optional<int> narrowest_reaching(int least, double padding_u, double padding_v, Precision precision) {
    const std::optional<Forecast> expected = forecast(padding_u, padding_v, precision);
    const auto hopeful = [&](int width) { return !expected || expected->at(width) < 10 * target_; };
    int width = least;
    while (width < widest() && !hopeful(width)) ++width;
    double narrower = HUGE_VAL;
    for (; width <= widest() && hopeful(width); ++width) {
      const Outcome outcome = consider(sized(width, padding_u, padding_v, precision));
      if (outcome != Outcome::not_exact_enough) return width;
      const GriddingCandidate& c = considered_.back().candidate;
      if (exhausted(c) || (c.worst_error < stored && c.worst_error > narrower / 2)) return {};
      if (request_.lookup && c.worst_error > falling * narrower) return {};
      narrower = c.worst_error;
    }
    return {};
  }

  /// The candidate with the cheapest w axis that keeps the accuracy or, where the plane alone misses it, with a w axis as exact
  /// as the plane.
  GriddingCandidate with_w(const GriddingCandidate& plane) {
    const double goal = plane.worst_error < target_ && target_ < HUGE_VAL ? target_ : std::max(1.2 * plane.worst_error, stored);
    std::optional<GriddingCandidate> cheapest, most_exact;
    int least = request_.kernel.min_width;
    for (const double usual : usual_w_paddings) {
      double narrower = HUGE_VAL;
      for (int width = least; width <= request_.kernel.max_width; ++width) {
        const double padding = std::max(usual, least_padding());
        GriddingCandidate c = plane;
        split(c, padding, width);
        if (cheapest && c.cost_s >= cheapest->cost_s) break;
        c.w = shelf_.axis(width, padding);
        judge(c);
        if (!most_exact || c.worst_error < most_exact->worst_error) most_exact = c;
        const double alone = std::sqrt(c.w.misfit.worst);
        const bool limited = request_.lookup && alone > falling * narrower;
        narrower = alone;
        if (c.worst_error > goal && !exhausted(c) && !limited) continue;
        if (c.worst_error <= goal) cheapest = c;
        least = width;
        break;
      }
    }
    return cheapest ? *cheapest : *most_exact;
  }

  /// The candidate with the shortest polynomials, unless they are the user's own, or the accuracy would be lost.
  GriddingCandidate simplified(const GriddingCandidate& exact) const {
    const bool somebodys_own = request_.kernel.min_width == request_.kernel.max_width;
    GriddingCandidate result = exact;
    if (!somebodys_own && !request_.lookup && request_.shortest_polynomials) {
      const GriddingCandidate simple = with_shortest_polynomials(exact);
      const bool lost = simple.worst_error > std::max(target_, exact.worst_error);
      if (!lost) result = simple;
    }
    result.work.degree = result.u.kernel.polynomial.degree();  // costs stay comparable: all by the degree assumed
    return result;
  }

  /// The cheapest at each other padding, and the next narrower width at the best one.
  std::vector<RejectedCandidate> neighbours(const GriddingCandidate& best) const {
    std::map<double, RejectedCandidate> cheapest;
    std::vector<RejectedCandidate> found;
    for (const RejectedCandidate& r : considered_) {
      const GriddingCandidate& c = r.candidate;
      if (c.work.precision != best.work.precision) continue;
      const bool same = c.padding_u == best.padding_u && c.padding_v == best.padding_v;
      if (same && r.reason == Rejection::not_exact_enough && c.work.width == best.work.width - 1) found.push_back(r);
      if (same || c.padding_u != c.padding_v || r.reason == Rejection::not_exact_enough) continue;
      const auto [at, first] = cheapest.emplace(c.padding_u, r);
      if (!first && c.cost_s < at->second.candidate.cost_s) at->second = r;
    }
    for (const auto& [padding, rejected] : cheapest) found.push_back(rejected);
    return found;
  }

  static constexpr double stored = 1e-13;  ///< below, the rounding of the stored kernel may hold the error up
  static constexpr double falling = 0.99;  ///< from width to width: where tables limit it, no wider kernel helps

  GriddingRequest request_;
  KernelShelf shelf_;
  double target_;
  std::vector<Faceting> ways_;
  std::vector<double> usual_;  ///< paddings, the widest first
  std::optional<GriddingCandidate> best_;
  std::optional<GriddingCandidate> most_exact_;
  std::vector<RejectedCandidate> considered_;
};

}  // namespace

GriddingChoice choose_gridding(const GriddingRequest& request) {
  const double phase = max_w_phase_rad(request.max_abs_w, request.geometry);
  const bool automatic = request.gridder == Gridder::automatic;
  const double target = request.accuracy == 0 ? HUGE_VAL : request.accuracy;
  const auto search = [&](bool wide) {
    const double neglected = automatic && !wide && target < HUGE_VAL ? phase : 0;
    std::vector<Faceting> ways;
    if (wide) ways = facetings(request.geometry, request.max_abs_w, request.facets ? most_facets : 1);
    GriddingChoice choice = Search(request, target - neglected, ways).run();
    choice.w_phase_rad = phase;
    choice.borne_phase_rad = neglected;
    return choice;
  };
  if (!automatic) return search(request.gridder == Gridder::wide);
  if (phase > neglected_part * request.accuracy && request.accuracy != 0) return search(true);
  GriddingChoice plane = search(false);
  if (request.accuracy == 0) return phase > neglected_part * plane.best.worst_error ? search(true) : plane;
  if (plane.reached || phase == 0) return plane;
  GriddingChoice wide = search(true);
  return wide.best.worst_error < plane.best.worst_error + phase ? wide : plane;
}

}  // namespace misfit::imager
