#include "kernels/families/spheroidal_exact.h"

#include <Eigen/Eigenvalues>
#include <charconv>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <system_error>

#include "kernels/families/even_taps.h"
#include "kernels/families/families.h"
#include "kernels/text_internal.h"

namespace misfit::kernels {
namespace {

constexpr const char* family_name = "spheroidal-exact";
constexpr double max_order = 10;
constexpr double max_bandwidth = 200;

/// ψ as a series in the even polynomials P_k, k = 0, 2, …, orthonormal with the weight (1 − η²)^α: Gegenbauer's C_k^(α+1/2),
/// normalised, for which η P_k = step_{k+1} P_{k+1} + step_k P_{k−1} and the equation's differential part is diagonal.
class Series {
 public:
  Series(double alpha, double bandwidth) : alpha_(alpha) {
    // A function of bandwidth c needs k up to about c, then a few more until the terms are rounding.
    const int terms = 20 + static_cast<int>(bandwidth / 2);
    step_.resize(2 * terms + 1);
    for (int k = 0; k <= 2 * terms; ++k) step_[k] = step(k);
    Eigen::VectorXd diagonal(terms);
    Eigen::VectorXd beside(terms - 1);
    const double c_square = bandwidth * bandwidth;
    for (int i = 0, k = 0; i < terms; ++i, k += 2) {
      diagonal[i] = k * (k + 2 * alpha + 1) + c_square * (step_[k] * step_[k] + step_[k + 1] * step_[k + 1]);
      if (i + 1 < terms) beside[i] = c_square * step_[k + 1] * step_[k + 2];
    }
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
    solver.computeFromTridiagonal(diagonal, beside);
    coefficient_ = solver.eigenvectors().col(0);  // of the smallest b
    coefficient_ /= sum(0);
  }

  double operator()(double eta) const { return std::pow(1 - eta * eta, alpha_) * sum(eta); }

 private:
  double step(int k) const {
    return k == 0 ? 0 : std::sqrt(k * (k + 2 * alpha_) / ((2 * k + 2 * alpha_ + 1) * (2 * k + 2 * alpha_ - 1)));
  }

  double sum(double eta) const {
    double even = 1;  // P_0 up to a factor that the scaling removes
    double odd = eta / step_[1];
    double total = coefficient_[0];
    for (Eigen::Index i = 1, k = 2; i < coefficient_.size(); ++i, k += 2) {
      even = (eta * odd - step_[k - 1] * even) / step_[k];
      odd = (eta * even - step_[k] * odd) / step_[k + 1];
      total += coefficient_[i] * even;
    }
    return total;
  }

  double alpha_;
  Eigen::VectorXd step_;
  Eigen::VectorXd coefficient_;
};

std::string range_up_to(double limit) {
  return "[0, " + text_of(limit) + "]";
}

KernelFamily family_of(const std::string& name, double alpha) {
  const std::string others = name == family_name ? "; " + name + "-<order> is that of any other" : "";
  return {name,
          "the spheroidal function of order " + text_of(alpha) + " itself" + others,
          1,
          20,
          0.01,
          0.49,
          [name, alpha](int width, double x0) {
            return make_kernel(name, x0, spheroidal_exact_taps(width, alpha, std::numbers::pi * width / 2));
          }};
}

}  // namespace

TapFunction spheroidal_exact_taps(int width, double alpha, double bandwidth) {
  if (width < 1) throw std::invalid_argument("spheroidal function: width " + std::to_string(width) + ", expected 1 or more");
  if (!(alpha >= 0 && alpha <= max_order))
    throw std::invalid_argument("spheroidal function: order " + text_of(alpha) + " not in " + range_up_to(max_order));
  if (!(bandwidth >= 0 && bandwidth <= max_bandwidth))
    throw std::invalid_argument("spheroidal function: bandwidth " + text_of(bandwidth) + " not in " +
                                range_up_to(max_bandwidth));
  return taps_over_support(width, Series(alpha, bandwidth));
}

KernelFamily spheroidal_exact_family() {
  return family_of(family_name, 1);
}

std::optional<KernelFamily> spheroidal_exact_family(const std::string& name) {
  const std::string prefix = std::string(family_name) + "-";
  if (name.rfind(prefix, 0) != 0) return {};
  const char* const end = name.data() + name.size();
  double alpha = 0;
  const auto [rest, error] = std::from_chars(name.data() + prefix.size(), end, alpha);
  if (error != std::errc() || rest != end || !(alpha >= 0 && alpha <= max_order))
    throw std::invalid_argument("kernel \"" + name + "\": order \"" + name.substr(prefix.size()) + "\" is not a number in " +
                                range_up_to(max_order));
  return family_of(name, alpha);
}

}  // namespace misfit::kernels
