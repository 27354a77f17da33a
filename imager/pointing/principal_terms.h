#pragma once

#include <Eigen/Dense>
#include <vector>

namespace misfit::imager {

/// Few terms of which all columns of a matrix are sums, to a tolerance: principal components of some of its columns, the nodes,
/// which were found one by one, each where what the others explain leaves most. Terms come by what they explain of all columns,
/// and fall fast; shares are 1 in magnitude at most.
struct PrincipalTerms {
  std::vector<Eigen::Index> node;  ///< the columns that terms are made of
  Eigen::MatrixXd of_nodes;        ///< [node][term]: by how much a node counts in a term
  Eigen::MatrixXd share_of_value;  ///< [value][term]: by how much a value of a column counts in its share
  Eigen::MatrixXd share;           ///< [term][column]
  Eigen::VectorXd size;            ///< [term]: the RMS of its values
  bool enough = false;             ///< whether all columns follow

  Eigen::Index terms() const { return of_nodes.cols(); }
};

/// With `most` terms at most; none where those are not enough.
PrincipalTerms principal_terms(const Eigen::MatrixXd& values, double tolerance, Eigen::Index most);

}  // namespace misfit::imager
