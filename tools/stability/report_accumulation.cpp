#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "tools/base/numbers.h"
#include "tools/stability/stability_report.h"

namespace misfit::tools {
namespace {

constexpr std::uint64_t most_equal = 1000000000;
constexpr std::uint64_t most_random = 100000000;

/// Adds one value over and over as a plain loop would, bit for bit, in a few steps: as long as the sum stays between two powers
/// of 2 each addition raises it by the same rounded amount, so that whole runs of them are one multiplication, itself exact.
template <typename Real>
class EqualSum {
 public:
  explicit EqualSum(Real value) : value_(value) {}

  void advance(std::uint64_t additions) {
    while (additions > 0) {
      const Real next = sum_ + value_;
      const Real step = next - sum_;
      if (step == 0) return;  // stagnated
      const Real end = std::ldexp(Real(1), std::ilogb(next) + 1);
      const bool steady = sum_ > 0 && std::ilogb(sum_) == std::ilogb(next) && (next + value_) - next == step;
      std::uint64_t run = 1;
      if (steady) run = std::max<std::uint64_t>(1, static_cast<std::uint64_t>((end - sum_) / step) - 1);
      run = std::min(run, additions);
      sum_ = run == 1 ? next : sum_ + static_cast<Real>(run) * step;
      additions -= run;
    }
  }
  Real sum() const { return sum_; }

 private:
  Real value_;
  Real sum_ = 0;
};

/// Compensated summation (Kahan 1965, Comm. ACM 8, 40).
template <typename Real>
class CompensatedSum {
 public:
  void add(Real value) {
    const Real corrected = value - lost_;
    const Real next = sum_ + corrected;
    lost_ = (next - sum_) - corrected;
    sum_ = next;
  }
  Real sum() const { return sum_; }

 private:
  Real sum_ = 0;
  Real lost_ = 0;
};

std::vector<std::uint64_t> counts_to(std::uint64_t most) {
  std::vector<std::uint64_t> counts;
  for (std::uint64_t decade = 1; decade <= most; decade *= 10)
    for (const std::uint64_t factor : {1, 2, 5})
      if (factor * decade <= most) counts.push_back(factor * decade);
  return counts;
}

void add_point(Series& series, std::uint64_t count, long double sum, long double exact) {
  series.x.push_back(static_cast<double>(count));
  series.y.push_back(static_cast<double>(std::abs(sum / exact - 1)));
}

/// The value that is added, 0.1 as `Real` holds it, is exact in long double: so is the sum it should have.
template <typename Real>
Series equal_curve(const std::string& label) {
  const Real value = static_cast<Real>(0.1L);
  EqualSum<Real> sum(value);
  Series series{.label = label, .x = {}, .y = {}, .points = true};
  std::uint64_t added = 0;
  for (const std::uint64_t count : counts_to(most_equal)) {
    sum.advance(count - added);
    added = count;
    add_point(series, count, sum.sum(), static_cast<long double>(count) * value);
  }
  return series;
}

/// The curves of random terms, 0 to 1, all of one stream.
std::vector<Series> random_curves() {
  std::vector<Series> curves{{.label = "single", .x = {}, .y = {}, .points = true},
                             {.label = "single, compensated", .x = {}, .y = {}, .points = true},
                             {.label = "double", .x = {}, .y = {}, .points = true},
                             {.label = "extended", .x = {}, .y = {}, .points = true}};
  constexpr double tenth = 0.1;  // double and extended would add the terms themselves without rounding
  float single = 0;
  CompensatedSum<float> compensated;
  double twice = 0;
  long double extended = 0;
  std::uint64_t exact = 0;  // terms are multiples of 2⁻²⁴: integers sum them exactly
  std::uint64_t state = 1;
  std::uint64_t added = 0;
  for (const std::uint64_t count : counts_to(most_random)) {
    for (; added < count; ++added) {
      state = state * 6364136223846793005U + 1442695040888963407U;  // Knuth's MMIX generator, of period 2⁶⁴
      const std::uint64_t bits = state >> 40U;
      const float term = static_cast<float>(bits) * 0x1p-24F;
      exact += bits;
      single += term;
      compensated.add(term);
      twice += static_cast<double>(term) * tenth;
      extended += static_cast<long double>(term) * tenth;
    }
    const long double truth = static_cast<long double>(exact) * 0x1p-24L;
    add_point(curves[0], count, single, truth);
    add_point(curves[1], count, compensated.sum(), truth);
    add_point(curves[2], count, twice, truth * tenth);
    add_point(curves[3], count, extended, truth * tenth);
  }
  return curves;
}

/// The largest whole number of ones that a sum in `Real` counts.
template <typename Real>
std::string ones_counted(std::uint64_t additions) {
  EqualSum<Real> sum(1);
  sum.advance(additions);
  return grouped(static_cast<long long>(sum.sum()));
}

Figure sum_figure(Figure figure) {
  figure.x = {.label = "terms", .logarithmic = true};
  figure.y = {.label = "relative error of the sum", .logarithmic = true, .from = 1e-20, .to = 1};
  return figure;
}

}  // namespace

ReportSection accumulation_section() {
  Figure equal = sum_figure(
      {.name = "equal-sums",
       .title = "Sums of equal terms, one after the other",
       .caption = "The term is 0.1, rounded to the arithmetic that adds it; the rounding of the term itself is "
                  "not counted. Gaps are sums without an error.",
       .x = {},
       .y = {},
       .series = {equal_curve<float>("single"), equal_curve<double>("double"), equal_curve<long double>("extended")}});
  Figure random = sum_figure({.name = "random-sums",
                              .title = "Sums of random positive terms",
                              .caption = "Uniform between 0 and 1, multiples of 2⁻²⁴, so that integers sum them exactly; "
                                         "double and extended, which would too, add a tenth of each.",
                              .x = {},
                              .y = {},
                              .series = random_curves()});
  const double single_end = equal.series[0].y.back();
  const double double_end = equal.series[1].y.back();
  const std::string ones =
      "Of " + grouped(static_cast<long long>(most_equal)) + " ones a single-precision sum counts " +
      ones_counted<float>(most_equal) + " and stays there, since 2²⁴ + 1 is rounded to 2²⁴; in doubles it counts " +
      ones_counted<double>(most_equal) + ". Of as many tenths the sum is off by " + power_of_ten(single_end, 2) +
      " of itself in single and by " + power_of_ten(double_end, 2) + " in double.";
  const std::string others =
      "While a sum of equal terms stays between two powers of 2, all its roundings have one sign. Those of random terms "
      "differ, until "
      "the sum is so large that single precision loses most of each term: at " +
      grouped(static_cast<long long>(most_random)) + " terms by " + power_of_ten(random.series[0].y.back(), 2) +
      ". A compensated sum in single precision errs by " + power_of_ten(random.series[1].y.back(), 2) +
      " there, the rounding of its result.";
  return {.heading = "Long sums", .paragraphs = {ones, others}, .figures = {equal, random}, .tables = {}};
}

}  // namespace misfit::tools
