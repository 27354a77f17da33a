#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tools/base/numbers.h"
#include "tools/kernel_report/paper_statements.h"

namespace misfit::tools {
namespace {

/// A pair of W and x0 that the paper names as reaching single precision.
struct NamedPair {
  int width;
  double x0;
};
constexpr std::array<NamedPair, 3> named{{{6, 0.2}, {7, 0.25}, {8, 0.3}}};
constexpr std::array<double, 5> visibilities{1e4, 1e5, 1e6, 1e7, 1e8};

/// The paper's count for an image of 2048² pixels: (5 W² + 2) N_v + 5 N log₂ N, N = N_x N_y / (4 x0²).
double operations(const NamedPair& pair, double count) {
  constexpr double pixels = 2048.0 * 2048.0;
  const double cells = pixels / (4 * pair.x0 * pair.x0);
  return (5.0 * pair.width * pair.width + 2) * count + 5 * cells * std::log2(cells);
}

/// The number of visibilities from which on `few`, with the larger FFT, costs less than `many`.
double crossing(const NamedPair& few, const NamedPair& many) {
  return (operations(few, 0) - operations(many, 0)) / (5.0 * (many.width * many.width - few.width * few.width));
}

const NamedPair& cheapest(double count) {
  return *std::min_element(named.begin(), named.end(),
                           [=](const NamedPair& a, const NamedPair& b) { return operations(a, count) < operations(b, count); });
}

std::string label(const NamedPair& pair) {
  return "(" + std::to_string(pair.width) + ", " + significant(pair.x0, 3) + ")";
}

double rms(const NamedPair& pair, SolvedKernels& solved) {
  return std::sqrt(solved(pair.width, pair.x0).origin.mean_error);
}

DataTable operations_table(SolvedKernels& solved) {
  DataTable table{
      .name = "paper-operations",
      .title = "The paper's pairs of W and x₀, and its operation count",
      .caption =
          "(5 W² + 2) N_v + 5 N log₂ N for N_v visibilities and an image of 2048² pixels, whose FFT has N = 2048² / "
          "(4 x₀²) cells.",
      .columns = {"W", "x₀", "√E"},
      .rows = {}};
  for (const double count : visibilities) table.columns.push_back("N_v = " + power_of_ten(count, 1));
  for (const NamedPair& pair : named) {
    table.rows.push_back({static_cast<double>(pair.width), pair.x0, rms(pair, solved)});
    for (const double count : visibilities) table.rows.back().emplace_back(operations(pair, count));
  }
  return table;
}

Statement equal_pairs(SolvedKernels& solved) {
  std::string numbers;
  double largest = 0;
  for (const NamedPair& pair : named) {
    numbers += (numbers.empty() ? "√E = " : ", ") + power_of_ten(rms(pair, solved), 3) + " " + label(pair);
    largest = std::max(largest, rms(pair, solved));
  }
  return {"§6.3", "Pairs (W, x₀) that reach single precision", "(6, 0.2), (7, 0.25), (8, 0.3), and two in a figure",
          numbers + "; pairs of equal accuracy are under Cost",
          verdict(largest < 1.1 * std::numeric_limits<float>::epsilon(),
                  power_of_ten(std::numeric_limits<float>::epsilon(), 3) + " is single precision, and (6, 0.2) is " +
                      significant(largest / std::numeric_limits<float>::epsilon(), 2) + " times that")};
}

Statement dominating_width() {
  const double from = std::max(crossing(named[0], named[1]), crossing(named[0], named[2]));
  std::string numbers;
  for (const double count : visibilities)
    numbers += (numbers.empty() ? "" : ", ") + label(cheapest(count)) + " at " + power_of_ten(count, 1);
  return {"§6.3", "The pair with the fewest operations, 2048² pixels, by N_v", "(6, 0.2) above 10⁷",
          numbers + "; (6, 0.2) from " + power_of_ten(from, 2) + " on",
          verdict(from > 1e6 && from < 1e8, "at another number of visibilities")};
}

}  // namespace

PaperCosts paper_costs(SolvedKernels& solved) {
  return {operations_table(solved), {equal_pairs(solved), dominating_width()}};
}

}  // namespace misfit::tools
