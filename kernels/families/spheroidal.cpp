#include "kernels/families/spheroidal.h"

#include <array>
#include <cmath>
#include <stdexcept>

#include "kernels/families/families.h"

namespace misfit::kernels {
namespace {

/// One rational approximation in η² − edge²: Σ p_k x^k / Σ q_k x^k.
struct Rational {
  double edge;
  std::array<double, 7> p;
  std::array<double, 3> q;

  double operator()(double eta) const {
    const double x = eta * eta - edge * edge;
    double numerator = 0;
    for (auto c = p.rbegin(); c != p.rend(); ++c) numerator = numerator * x + *c;
    return numerator / (q[0] + x * (q[1] + x * q[2]));
  }
};

/// Below inner.edge the inner form holds, beyond it the outer one.
struct Approximation {
  Rational inner;
  Rational outer;
};

constexpr int min_width = 4;
constexpr int max_width = 8;

constexpr Rational m4{1.0, {5.007900e-2, -1.971357e-1, 2.363775e-1, -1.215569e-1, 2.853104e-2}, {1, 4.228767e-1, 5.655715e-2}};
constexpr Rational m5{
    1.0, {1.466325e-2, -9.858686e-2, 2.180684e-1, -2.347118e-1, 1.464354e-1, -5.350728e-2, 1.624782e-2}, {1, 2.177793e-1}};

/// α = 1; m = 4…8.
constexpr std::array<Approximation, 5> approximations{
    {{m4, m4},
     {m5, m5},
     {{0.75, {8.203343e-2, -3.644705e-1, 6.278660e-1, -5.335581e-1, 2.312756e-1}, {1, 8.212018e-1, 2.078043e-1}},
      {1.0, {4.028559e-3, -3.697768e-2, 1.021332e-1, -1.201436e-1, 6.412774e-2}, {1, 9.599102e-1, 2.918724e-1}}},
     {{0.775, {3.770526e-2, -2.121608e-1, 4.746423e-1, -5.338058e-1, 3.417026e-1}, {1, 1.029374e+0, 3.181219e-1}},
      {1.0, {1.059406e-3, -1.343605e-2, 5.135360e-2, -8.386588e-2, 6.484517e-2}, {1, 1.269924e+0, 5.032139e-1}}},
     {{0.775, {2.121871e-2, -1.461891e-1, 4.185427e-1, -6.543539e-1, 5.904660e-1, -3.507098e-1}, {1, 9.978025e-1, 2.920529e-1}},
      {1.0,
       {2.698511e-4, -4.628815e-3, 2.470890e-2, -6.017759e-2, 7.566434e-2, -5.202678e-2},
       {1, 1.230436e+0, 4.593779e-1}}}}};

}  // namespace

TapFunction spheroidal_taps(int width) {
  if (width < min_width || width > max_width)
    throw std::invalid_argument("spheroidal kernel: width " + std::to_string(width) +
                                " not in [4, 8], where Schwab's approximations exist");
  const Approximation& psi = approximations[static_cast<std::size_t>(width - min_width)];
  return [&psi, width](double t) {
    Eigen::VectorXd taps(width);
    for (int r = 0; r < width; ++r) {
      const double eta = std::abs(r - (width - 1) / 2.0 - t) / (width / 2.0);
      taps[r] = (1 - eta * eta) * (eta < psi.inner.edge ? psi.inner : psi.outer)(eta);
    }
    return taps;
  };
}

KernelFamily spheroidal_family() {
  return {"spheroidal",
          "Schwab's approximation of the spheroidal function of order 1, as in AIPS and CASA",
          min_width,
          max_width,
          0.01,
          0.49,
          [](int width, double x0) { return make_kernel("spheroidal", x0, spheroidal_taps(width)); }};
}

}  // namespace misfit::kernels
