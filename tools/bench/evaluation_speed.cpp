// Ways to evaluate a least-misfit function, as a markdown table: E over its optimum, bytes, nanoseconds a visibility.
// usage: evaluation_speed [WIDTH] [X0]
#include "tools/kernel_report/evaluation_speed.h"

#include <array>
#include <cstdio>
#include <cstdlib>

#include "kernels/cheapest_polynomial.h"

namespace {

using namespace misfit::kernels;

std::vector<Evaluation> ways_of(const LeastMisfit& solution, const Kernel& kernel) {
  constexpr double allowed = 0.005;
  constexpr std::array<TableOptions, 4> tables{{{65536, Interpolation::nearest},
                                                {2048, Interpolation::linear},
                                                {128, Interpolation::quadratic},
                                                {64, Interpolation::cubic}}};
  const PiecewisePolynomial cheapest = cheapest_polynomial(kernel, allowed);
  std::vector<Evaluation> ways;
  for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
    for (const PiecewisePolynomial& polynomial : {kernel.polynomial, cheapest}) {
      ways.push_back(evaluate_by_polynomial(polynomial, precision));
      ways.push_back(evaluate_by_halves(polynomial, precision));
    }
    for (const TableOptions& table : tables) ways.push_back(evaluate_by_table(kernel.polynomial, table, precision));
    ways.push_back(evaluate_directly(solution, precision));
  }
  return ways;
}

}  // namespace

int main(int argc, char** argv) {
  const int width = argc > 1 ? std::atoi(argv[1]) : 7;
  const double x0 = argc > 2 ? std::atof(argv[2]) : 0.25;
  const LeastMisfit solution = solve_least_misfit(width, x0);
  const Kernel kernel = make_kernel("least-misfit", x0, solution.taps, solution.origin);
  const std::vector<Evaluation> ways = ways_of(solution, kernel);
  const std::vector<double> nanoseconds = misfit::tools::nanoseconds_a_visibility(ways, {});
  std::printf("| way, W = %d, x0 = %g | E / optimum | bytes | ns a visibility |\n|---|---|---|---|\n", width, x0);
  for (std::size_t i = 0; i < ways.size(); ++i)
    std::printf("| %s | %.5g | %zu | %.1f |\n", ways[i].name.c_str(),
                judge(ways[i].taps, x0, ways[i].judging()).mean / solution.origin.mean_error, ways[i].bytes, nanoseconds[i]);
}
