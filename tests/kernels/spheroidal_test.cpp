#include "kernels/families/spheroidal.h"

#include <Eigen/Eigenvalues>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "kernels/catalogue.h"
#include "kernels/quadrature.h"
#include "tests/kernels/kernels.h"

using namespace misfit::kernels;
using misfit::kernels::testing::normalised;
namespace bdata = boost::unit_test::data;

namespace {

const auto orders = bdata::make({0.0, 0.5, 1.0, 1.5, 2.0});

/// (1 − η²)^α ψ(η) of bandwidth c = πm/2, from the definition of ψ: the eigenfunction of the finite Fourier transform
/// ∫ exp(icηt) (1 − t²)^α ψ(t) dt = λ ψ(η) that belongs to the largest |λ| (Schwab 1984). With t = sin θ the integrand is
/// smooth.
class ExactSpheroidal {
 public:
  ExactSpheroidal(int m, double alpha) : alpha_(alpha), c_(std::acos(-1.0) * m / 2) {
    const Quadrature angle = gauss_legendre(60, 0, std::acos(-1.0) / 2);
    node_ = angle.node.array().sin();
    const Eigen::ArrayXd root = (angle.weight.array() * angle.node.array().cos().pow(2 * alpha + 1)).sqrt();
    const Eigen::MatrixXd kernel = (c_ * node_ * node_.transpose()).array().cos();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(root.matrix().asDiagonal() * kernel *
                                                                root.matrix().asDiagonal());
    Eigen::Index largest = 0;
    solver.eigenvalues().cwiseAbs().maxCoeff(&largest);
    mode_ = root * solver.eigenvectors().col(largest).array();
    scale_ = 1 / at(0);
  }
  double operator()(double eta) const { return std::pow(1 - eta * eta, alpha_) * scale_ * at(eta); }

 private:
  double at(double eta) const { return ((c_ * eta * node_).array().cos() * mode_).sum(); }
  double alpha_;
  double c_;
  Eigen::VectorXd node_;
  Eigen::ArrayXd mode_;
  double scale_ = 1;
};

}  // namespace

BOOST_AUTO_TEST_SUITE(spheroidal)

BOOST_DATA_TEST_CASE(schwabs_approximation_agrees_with_the_eigenfunction, bdata::xrange(4, 9) * orders, m, alpha) {
  const ExactSpheroidal exact(m, alpha);
  const TapFunction approximation = spheroidal_taps(m, alpha);
  for (int i = -20; i <= 20; ++i) {
    const double t = i / 40.0;
    const Eigen::VectorXd taps = approximation(t);
    for (int r = 0; r < m; ++r) {
      const double eta = (r - (m - 1) / 2.0 - t) / (m / 2.0);
      BOOST_TEST(std::abs(taps[r] - exact(eta)) < 5e-6);  // the approximations ripple, by up to 4.3e-6 at m = 7, α = 0
    }
  }
}

BOOST_AUTO_TEST_CASE(only_order_0_ends_above_zero) {
  for (int m = 4; m <= 8; ++m)
    for (const double alpha : {0.0, 0.5, 1.0, 1.5, 2.0}) BOOST_TEST((spheroidal_taps(m, alpha)(0.5)[0] > 0) == (alpha == 0));
}

BOOST_AUTO_TEST_CASE(least_misfit_is_315_times_better_at_width_7) {
  // The project's independent figure, to the percent it is given to.
  const double ratio = std::sqrt(kernel_family("spheroidal").make(7, 0.25).misfit.mean /
                                 kernel_family("least-misfit").make(7, 0.25).misfit.mean);
  BOOST_TEST(std::abs(ratio / 315 - 1) < 0.02);
}

BOOST_AUTO_TEST_CASE(each_order_is_a_family_and_order_1_the_usual_one) {
  for (const std::string order : {"0", "0.5", "1.5", "2"}) {
    const Kernel kernel = kernel_family("spheroidal-" + order).make(6, 0.25);
    BOOST_TEST(kernel.name == "spheroidal-" + order);
    const double t = 0.2;
    BOOST_TEST((kernel.polynomial(t) - normalised(spheroidal_taps(6, std::stod(order)))(t)).cwiseAbs().maxCoeff() < 1e-5);
  }
  BOOST_TEST((kernel_family("spheroidal").make(6, 0.25).polynomial(0.2) - normalised(spheroidal_taps(6))(0.2)).norm() < 1e-5);
}

BOOST_AUTO_TEST_CASE(what_has_no_approximation_is_refused) {
  BOOST_CHECK_THROW(spheroidal_taps(3), std::invalid_argument);
  BOOST_CHECK_THROW(spheroidal_taps(9), std::invalid_argument);
  for (const double alpha : {-0.5, 0.25, 2.5, std::nan("")})
    BOOST_CHECK_THROW(spheroidal_taps(6, alpha), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
