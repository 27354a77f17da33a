#include "kernels/families/spheroidal.h"

#include <Eigen/Eigenvalues>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "kernels/catalogue.h"
#include "kernels/quadrature.h"

using namespace misfit::kernels;
namespace bdata = boost::unit_test::data;

namespace {

/// (1 − η²) ψ(η) with ψ the spheroidal function of order α = 1 and bandwidth c = πm/2, from its definition: ψ is the
/// eigenfunction of the finite Fourier transform ∫ exp(icηt) (1 − t²) ψ(t) dt = λ ψ(η) that belongs to the largest |λ| (Schwab
/// 1984).
class ExactSpheroidal {
 public:
  explicit ExactSpheroidal(int m) : rule_(gauss_legendre(60, 0, 1)), c_(std::acos(-1.0) * m / 2) {
    const Eigen::ArrayXd root = (rule_.weight.array() * (1 - rule_.node.array().square())).sqrt();
    const Eigen::MatrixXd kernel = (c_ * rule_.node * rule_.node.transpose()).array().cos();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(root.matrix().asDiagonal() * kernel *
                                                                root.matrix().asDiagonal());
    Eigen::Index largest = 0;
    solver.eigenvalues().cwiseAbs().maxCoeff(&largest);
    mode_ = (rule_.weight.array() * (1 - rule_.node.array().square())) * solver.eigenvectors().col(largest).array() / root;
    scale_ = 1 / at(0);
  }
  double operator()(double eta) const { return (1 - eta * eta) * scale_ * at(eta); }

 private:
  double at(double eta) const { return ((c_ * eta * rule_.node).array().cos() * mode_).sum(); }
  Quadrature rule_;
  double c_;
  Eigen::ArrayXd mode_;
  double scale_ = 1;
};

}  // namespace

BOOST_AUTO_TEST_SUITE(spheroidal)

BOOST_DATA_TEST_CASE(schwabs_approximation_agrees_with_the_eigenfunction, bdata::xrange(4, 9), m) {
  const ExactSpheroidal exact(m);
  const TapFunction approximation = spheroidal_taps(m);
  const double peak = m % 2 == 1 ? approximation(0)[m / 2] : approximation(0.5)[m / 2];
  for (const double t : {-0.4, -0.1, 0.0, 0.3}) {
    const Eigen::VectorXd taps = approximation(t) / peak;
    for (int r = 0; r < m; ++r) {
      const double eta = (r - (m - 1) / 2.0 - t) / (m / 2.0);
      BOOST_TEST(std::abs(taps[r] - exact(eta)) < 5e-6);  // the approximation ripples by 2e-6 at m = 7
    }
  }
}

BOOST_AUTO_TEST_CASE(least_misfit_is_315_times_better_at_width_7) {
  // The project's independent figure, to the percent it is given to.
  const double ratio = std::sqrt(kernel_family("spheroidal").make(7, 0.25).misfit.mean /
                                 kernel_family("least-misfit").make(7, 0.25).misfit.mean);
  BOOST_TEST(std::abs(ratio / 315 - 1) < 0.02);
}

BOOST_AUTO_TEST_CASE(widths_without_an_approximation_are_refused) {
  BOOST_CHECK_THROW(spheroidal_taps(3), std::invalid_argument);
  BOOST_CHECK_THROW(spheroidal_taps(9), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
