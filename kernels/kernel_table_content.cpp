#include <cmath>
#include <stdexcept>

#include "kernels/kernel_table_content_internal.h"
#include "kernels/map_error.h"
#include "kernels/sampled_function.h"

namespace misfit::kernels {
namespace {

constexpr int rows_in_x = 1025;

}  // namespace

std::array<Fact, 10> facts_of(Kernel& k) {
  return {{{"X0", &k.x0, "half the retained fraction of the FFT image"},
           {"E", &k.misfit.mean, "mean map error over |x| <= X0, of POLY"},
           {"MAXELL", &k.misfit.max, "largest map error over |x| <= X0, of POLY"},
           {"WORSTMN", &k.misfit.worst_mean, "mean square error, worst place in a cell"},
           {"WORST", &k.misfit.worst, "largest square error, any place in a cell"},
           {"EOPT", &k.origin.mean_error, "mean map error before it was stored"},
           {"MAXOPT", &k.origin.max_error, "largest map error before it was stored"},
           {"MAXBOUND", &k.origin.max_error_bound, "no function's MAXELL lies below", true},
           {"COND", &k.origin.condition, "condition number of the normal equations", true},
           {"PARAM", &k.origin.parameter, "beta or bandwidth of the family", true}}};
}

std::vector<HostTable> host_tables(const Kernel& kernel, int per_cell) {
  const PiecewisePolynomial& taps = kernel.polynomial;
  const Eigen::VectorXd c = sampled_function(taps, per_cell);
  const Eigen::VectorXd step = Eigen::VectorXd::LinSpaced(c.size(), 0, static_cast<double>(c.size() - 1));
  const Eigen::VectorXd part = Eigen::VectorXd::LinSpaced(rows_in_x, 0, rows_in_x - 1) / (rows_in_x - 1);
  const Eigen::VectorXd x = kernel.x0 * part;
  return {
      {"CONVFUNC",
       {{"U", step / per_cell}, {"C", c}},
       {"C at |u| = U in cells, from POLY. C may jump where two cells meet, at",
        "whole U for even W and at halves for odd W. There the mean of both",
        "sides is given, and at U = W/2 the limit from inside."}},
      {"CORRECT",
       {{"X", x}, {"H", optimal_correction(taps, x)}, {"ONE_OVER_C", image_taper(taps, x).cwiseInverse()}},
       {"What an image is multiplied by along each axis. X is the offset from",
        "the phase centre over the size of the FFT. H makes the map error",
        "least; ONE_OVER_C undoes the taper c(x), C's Fourier transform, and", "is what is usual."}},
      {"MAPERROR",
       {{"X", part / 2}, {"ELL", map_error(taps, part / 2)}},
       {"Mean square error relative to the exact transform, corrected with H."}},
  };
}

void check_storable(const Kernel& kernel, const std::optional<TableSampling>& sampling) {
  const auto expect = [](bool good, const std::string& what) {
    if (!good) throw std::invalid_argument("kernel table: " + what);
  };
  expect(!kernel.name.empty() && kernel.name.size() <= longest_name,
         "name '" + kernel.name + "', expected 1 to " + std::to_string(longest_name) + " characters");
  expect(kernel.width() >= 1 && kernel.width() <= kernel_table_max_width,
         "width " + std::to_string(kernel.width()) + ", expected 1 to " + std::to_string(kernel_table_max_width));
  expect(kernel.polynomial.degree() >= 0 && kernel.polynomial.degree() <= highest_degree,
         "degree " + std::to_string(kernel.polynomial.degree()) + ", expected 0 to " + std::to_string(highest_degree));
  expect(kernel.polynomial.coefficient.allFinite(), "a coefficient is not finite");
  expect(kernel.x0 > 0 && kernel.x0 < 0.5, "x0 = " + std::to_string(kernel.x0) + ", expected more than 0 and less than 0.5");
  Kernel copy = kernel;
  for (const Fact& fact : facts_of(copy))
    expect(std::isfinite(*fact.value) || (fact.may_lack && std::isnan(*fact.value)), std::string(fact.key) + " is not finite");
  if (!sampling) return;
  expect(sampling->per_cell >= 1 && sampling->per_cell <= kernel_table_max_per_cell,
         "sampling " + std::to_string(sampling->per_cell) + ", expected 1 to " + std::to_string(kernel_table_max_per_cell));
  expect(sampling->interpolation >= 0 && sampling->interpolation <= 3,
         "interpolation " + std::to_string(sampling->interpolation) + ", expected 0 to 3");
}

}  // namespace misfit::kernels
