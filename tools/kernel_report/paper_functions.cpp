#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "kernels/catalogue.h"
#include "kernels/map_error.h"
#include "tools/base/numbers.h"
#include "tools/kernel_report/paper_statements.h"

namespace misfit::tools {
namespace {

std::string number(double value, int digits = 3) {
  return power_of_ten(value, digits);
}

kernels::Kernel spheroidal(int width, double x0) {
  return kernels::kernel_family("spheroidal-exact").make(width, x0);
}

double map_error_at(const kernels::TapFunction& taps, double x) {
  return kernels::map_error(taps, Eigen::VectorXd::Constant(1, x))[0];
}

double largest_map_error(const kernels::TapFunction& taps, double x0) {
  return kernels::map_error(taps, places(x0)).maxCoeff();
}

/// The x from which on ℓ lies above `level`, for functions whose ℓ rises there.
double reach(const kernels::TapFunction& taps, double level) {
  double low = paper_x0;
  double high = 0.5;
  for (int halving = 0; halving < 40; ++halving) {
    const double middle = (low + high) / 2;
    (map_error_at(taps, middle) < level ? low : high) = middle;
  }
  return low;
}

Statement largest_error(const kernels::LeastMisfit& seven) {
  const kernels::Origin minimax = kernels::kernel_family("minimax").make(7, paper_x0).origin;
  return {"§2.2", "W = 7, x₀ = 0.25: largest ℓ over |x| ≤ x₀", "below 10⁻¹⁴ everywhere",
          number(seven.origin.max_error) + ", at x = x₀; the smallest possible for W = 7 lies between " +
              number(minimax.max_error_bound) + " and " + number(minimax.max_error) + " (minimax)",
          verdict(seven.origin.max_error < 1e-14, "no function of this width can reach it")};
}

Statement spheroidal_for_small_errors() {
  constexpr double level = 1e-14, x0 = 0.2;
  std::string numbers;
  int enough = 0;
  for (int width = 9; width <= 12; ++width) {
    const double largest = largest_map_error(spheroidal(width, x0).polynomial, x0);
    if (enough == 0 && largest <= level) enough = width;
    numbers += (numbers.empty() ? "" : ", ") + number(largest, 2) + " (" + width_label(width) + ")";
  }
  return {"§2.2", "Spheroidal function: width for ℓ ≤ 10⁻¹⁴ at |x| ≤ 0.2", "W = 10", "largest ℓ there: " + numbers,
          verdict(enough == 10, enough == 0 ? "none of these reaches it" : "it is W = " + std::to_string(enough))};
}

/// The smallest ratio of both ℓ at any |x| ≤ x0.
Statement map_error_ratio(SolvedKernels& solved) {
  std::map<int, double> smallest;
  const Eigen::VectorXd x = places(paper_x0);
  for (int width = 6; width <= 10; ++width)
    smallest[width] = (kernels::map_error(spheroidal(width, paper_x0).polynomial, x).array() /
                       kernels::map_error(solved(width, paper_x0).taps, x).array())
                          .minCoeff();
  return hundredfold("§2.2", "ℓ(x) of the spheroidal function over that of the least-misfit function, at every |x| ≤ 0.25",
                     smallest);
}

Statement two_corrections() {
  const kernels::TapFunction six = spheroidal(6, paper_x0).polynomial;
  const double inside = map_error_at(six, paper_x0);  // h c = 1 − ℓ
  return {"§3", "Spheroidal, W = 6: relative difference of h and 1/c, which is ℓ",
          "10⁻⁸ inside x₀; visible from x ≈ 0.45, ℓ ≈ 10⁻³",
          number(inside, 2) + " at x = 0.25, " + number(map_error_at(six, 0.2), 2) +
              " at 0.2; 10⁻³ at x = " + significant(reach(six, 1e-3), 3),
          verdict(std::abs(reach(six, 1e-3) - 0.45) < 0.03, "ℓ reaches 10⁻³ elsewhere") + "; at the very edge it is more"};
}

Statement rising_corrections(SolvedKernels& solved) {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(501, 0, 0.5);
  double first = 0.5, last = 0;  // places of the first maximum
  for (int width = 2; width <= 12; ++width) {
    const Eigen::VectorXd h = kernels::optimal_correction(solved(width, paper_x0).taps, x);
    Eigen::Index top = 0;
    while (top + 1 < h.size() && h[top + 1] > h[top]) ++top;
    first = std::min(first, x[top]);
    last = std::max(last, x[top]);
  }
  return {"§3", "h(x) of least-misfit functions, W ≥ 2", "rises to x₀ = 0.25 and falls beyond",
          "rises from 0, for W = 2…12, and falls from x = " + significant(first, 3) + "…" + significant(last, 3) + " on",
          verdict(first >= paper_x0 - 1e-3 && last < 0.3, "it rises further, beyond x₀, where no image is")};
}

Statement single_precision(SolvedKernels& solved) {
  const double seven = std::sqrt(solved(7, paper_x0).origin.mean_error);
  std::string others;
  for (const int width : {9, 10, 11})
    others +=
        (others.empty() ? "" : ", ") + number(std::sqrt(spheroidal(width, 0.2).misfit.mean)) + " (" + width_label(width) + ")";
  const bool ten = std::sqrt(spheroidal(10, 0.2).misfit.mean) < 1.1 * std::numeric_limits<float>::epsilon();
  return {"§4.1", "√E of single precision, 1.19 × 10⁻⁷", "W = 7 at x₀ = 0.25; spheroidal W = 10 at x₀ = 0.2",
          number(seven) + " for W = 7; spheroidal at x₀ = 0.2: " + others,
          verdict(seven < 1.1 * std::numeric_limits<float>::epsilon() && ten,
                  ten ? "W = 7 errs more" : "the spheroidal W = 10 errs twice as much")};
}

Statement spheroidal_of_seven(const kernels::LeastMisfit& seven) {
  const kernels::Kernel other = spheroidal(7, paper_x0);
  const double rms = std::sqrt(other.misfit.mean / seven.origin.mean_error);
  const double max = std::sqrt(other.misfit.max / seven.origin.max_error);
  return {"Abstract", "Spheroidal over least-misfit, W = 7", "more than 100 times",
          number(rms) + " times in RMS, " + number(max) + " times at the worst place", verdict(rms > 100 && max > 100, "less")};
}

Statement arithmetic(SolvedKernels& solved) {
  std::map<std::string, int> widest;
  for (int width = 1; width <= 20; ++width) widest[solved(width, paper_x0).origin.precision] = width;
  return {"App. A, B", "Arithmetic that the solution needs at x₀ = 0.25",
          "h on 33 points, ν on 16; doubles and normal equations to W = 11, QR to 14, more digits beyond",
          "Gauss nodes for both, W + W/2 + 14 of them; doubles to W = " + std::to_string(widest["double"]) + ", 113 bits to " +
              std::to_string(widest["quadruple"]) + (widest.count("256 bits") > 0 ? ", 256 bits beyond" : ""),
          "another way: it solves for h too until E is right to 10⁻⁶ of itself, and widens the arithmetic where that needs it"};
}

Statement widest(const kernels::LeastMisfit& twenty) {
  constexpr double stated = 6.62e-43;
  const double mean = twenty.origin.mean_error;
  return {"App. B", "W = 20, x₀ = 0.25: misfit E", number(stated),
          number(mean, 4) + " as the mean over |x| ≤ x₀; its integral from 0 to x₀ is " + number(mean * paper_x0) +
              ", of which the paper's number is " + number(stated / (mean * paper_x0)) + " times",
          "differs: an integral, not a mean"};
}

/// The largest jump of C where cells meet and at its ends, over C(0).
double largest_jump(const kernels::TapFunction& taps) {
  // Tap r is C at r − (W−1)/2 − t: where cell r ends, at t = −½, cell r + 1 begins, at t = ½.
  const Eigen::VectorXd ends = taps(-0.5), begins = taps(0.5);
  const Eigen::Index width = ends.size();
  const double centre = width % 2 == 1 ? taps(0)[width / 2] : begins[width / 2];
  const double inside = width > 1 ? (ends.head(width - 1) - begins.tail(width - 1)).cwiseAbs().maxCoeff() : 0;
  return std::max(inside, std::abs(ends[width - 1])) / std::abs(centre);
}

Statement jumps(SolvedKernels& solved) {
  std::string numbers = "C(0) = " + significant(solved(1, paper_x0).taps(0)[0], 4) + " for W = 1; largest jump, in C(0):";
  for (int width = 2; width <= 7; ++width)
    numbers += (width == 2 ? " " : ", ") + significant(largest_jump(solved(width, paper_x0).taps), 2) + " (" +
               width_label(width) + ")";
  return {"App. C", "Where C jumps", "C(0) slightly above 1 for W = 1; jumps to be seen for W = 2 and 3, not from W = 4 on",
          numbers,
          verdict(solved(1, paper_x0).taps(0)[0] > 1 && largest_jump(solved(4, paper_x0).taps) < 0.01,
                  "W = 4 still jumps visibly")};
}

Statement machine_precision(SolvedKernels& solved) {
  int width = 1;
  while (std::sqrt(solved(width, paper_x0).origin.mean_error) > std::numeric_limits<double>::epsilon()) ++width;
  return {"Abstract", "Errors down to machine precision", "can be reached",
          "√E is below that of doubles, " + number(std::numeric_limits<double>::epsilon()) + ", from W = " +
              std::to_string(width) + " at x₀ = 0.25: " + number(std::sqrt(solved(width, paper_x0).origin.mean_error)),
          verdict(true, "")};
}

}  // namespace

std::vector<Statement> function_statements(SolvedKernels& solved) {
  const kernels::LeastMisfit& seven = solved(7, paper_x0);
  return {spheroidal_of_seven(seven),
          machine_precision(solved),
          largest_error(seven),
          spheroidal_for_small_errors(),
          map_error_ratio(solved),
          two_corrections(),
          rising_corrections(solved),
          {"§3", "Tan's rational approximation, W = 6, x₀ = 0.25", "its ℓ is 100 times that of the least-misfit function", "",
           "not compared: its coefficients are in a thesis (Tan 1986) that is not at hand"},
          single_precision(solved),
          arithmetic(solved),
          widest(solved(20, paper_x0)),
          jumps(solved)};
}

}  // namespace misfit::tools
