#include "kernels/conditioning.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <cmath>
#include <memory>

#include "kernels/least_misfit_solver_internal.h"

namespace misfit::kernels {
namespace {

/// As many nodes in x as integrate products of the widest waves over |x| ≤ x0 to rounding.
constexpr int nodes = 60;

/// The least-squares problem that C solves: rows for the cosines, then for the sines, at every node.
class Design {
 public:
  Design(int width, double x0, const Correction& h) : node_(misfit_nodes(nodes, x0)) {
    const Eigen::VectorXd amplitude = node_.weight.cwiseSqrt().cwiseProduct(h(node_.x));
    matrix_.resize(2 * nodes, width);
    for (int r = 0; r < width; ++r) matrix_.col(r) = wave(r - (width - 1) / 2.0, amplitude);
  }
  const Eigen::MatrixXd& matrix() const { return matrix_; }
  /// exp(2πitx), weighted.
  Eigen::VectorXd target(double t) const { return wave(t, node_.weight.cwiseSqrt()); }

 private:
  Eigen::VectorXd wave(double s, const Eigen::VectorXd& amplitude) const {
    const Eigen::ArrayXd phase = 2 * std::acos(-1.0) * s * node_.x.array();
    Eigen::VectorXd rows(2 * nodes);
    rows << amplitude.array() * phase.cos(), amplitude.array() * phase.sin();
    return rows;
  }

  MisfitNodes node_;
  Eigen::MatrixXd matrix_;
};

}  // namespace

TapFunction solve_by_normal_equations(int width, double x0, const Correction& h) {
  const auto design = std::make_shared<const Design>(width, x0, h);
  const Eigen::MatrixXd& matrix = design->matrix();
  const auto factors = std::make_shared<const Eigen::LDLT<Eigen::MatrixXd>>(matrix.transpose() * matrix);
  return [design, factors](double t) -> Eigen::VectorXd {
    return factors->solve(design->matrix().transpose() * design->target(t));
  };
}

TapFunction solve_by_orthogonal_factors(int width, double x0, const Correction& h) {
  const auto design = std::make_shared<const Design>(width, x0, h);
  const auto factors = std::make_shared<const Eigen::HouseholderQR<Eigen::MatrixXd>>(design->matrix());
  return [design, factors](double t) -> Eigen::VectorXd { return factors->solve(design->target(t)); };
}

TapFunction stored_in_single(const TapFunction& taps) {
  return [taps](double t) -> Eigen::VectorXd { return taps(t).cast<float>().cast<double>(); };
}

}  // namespace misfit::kernels
