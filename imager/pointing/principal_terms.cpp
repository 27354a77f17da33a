#include "imager/pointing/principal_terms.h"

#include <algorithm>
#include <cmath>

namespace misfit::imager {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// An orthonormal basis of columns of a matrix that explain all others to a tolerance.
struct Explained {
  std::vector<Index> column;  ///< that were taken
  MatrixXd basis;             ///< [row][taken]
  bool all = false;           ///< whether they explain enough
};

Explained explain(const MatrixXd& values, double tolerance, Index most) {
  Explained found{{}, MatrixXd(values.rows(), 0), false};
  MatrixXd left = values;
  for (;;) {
    found.all = !found.column.empty() && left.cwiseAbs().maxCoeff() <= tolerance;
    if (found.all || static_cast<Index>(found.column.size()) == std::min({most, values.rows(), values.cols()})) return found;
    Index next = 0;
    left.colwise().squaredNorm().maxCoeff(&next);
    VectorXd direction = left.col(next);
    direction -= found.basis * (found.basis.transpose() * direction);  // again, for what rounding left
    direction.normalize();
    found.column.push_back(next);
    found.basis.conservativeResize(Eigen::NoChange, found.basis.cols() + 1);
    found.basis.rightCols(1) = direction;
    left -= direction * (direction.transpose() * left);
  }
}

}  // namespace

PrincipalTerms principal_terms(const MatrixXd& values, double tolerance, Index most) {
  const Explained found = explain(values, tolerance, most);
  if (!found.all) return {};
  const auto terms = static_cast<Index>(found.column.size());
  const MatrixXd in_basis = found.basis.transpose() * values;  // [taken][column]
  const Eigen::JacobiSVD<MatrixXd> parts(in_basis, Eigen::ComputeThinU);
  const MatrixXd along = parts.matrixU().transpose() * in_basis;  // [term][column], of orthonormal terms
  const VectorXd largest = along.cwiseAbs().rowwise().maxCoeff();
  MatrixXd nodes(terms, terms);  // [term][node]
  for (Index j = 0; j < terms; ++j) nodes.col(j) = along.col(found.column[static_cast<std::size_t>(j)]);
  PrincipalTerms made;
  made.node = found.column;
  made.of_nodes = nodes.inverse() * largest.asDiagonal();  // orthonormal terms are nodes · inverse
  made.share_of_value = found.basis * parts.matrixU() * largest.cwiseInverse().asDiagonal();
  made.share = largest.cwiseInverse().asDiagonal() * along;
  made.size = largest / std::sqrt(static_cast<double>(values.rows()));
  made.enough = true;
  return made;
}

}  // namespace misfit::imager
