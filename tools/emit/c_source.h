#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/emit/emission.h"

namespace misfit::tools {

/// Pieces of a header that C99 and C++ both take.

/// A comment of these lines.
std::string c_comment(const std::vector<std::string>& lines);

/// `static const double misfit_<name>[…] = {…};`, `comment` above it; every double comes back as it was.
std::string c_array(const std::string& comment, const std::string& name, const Eigen::VectorXd& values);

/// `enum { misfit_<name> = value };`
std::string c_integer(const std::string& name, int value);

/// `misfit_divisor(x)`: what an image is divided by along an axis, x = (pixel − centre) / FFT size.
std::string c_divisor(const DivisorSeries& divisor);

/// A whole header for `emission`: its statement, `steps` (how to put it into the host), and `body`.
std::string c_header(const Emission& emission, const std::vector<std::string>& steps, const std::string& body);

/// A symmetric function's integrals as sums: c(x) = Σ weight_i cos(2π u_i x), Gauss nodes in each cell, so that jumps between
/// cells do no harm.
struct TaperNodes {
  Eigen::VectorXd u;       ///< in cells, above 0
  Eigen::VectorXd weight;  ///< times the function, both signs of u together
};
TaperNodes taper_nodes(const kernels::PiecewisePolynomial& function);

/// Coefficients of powers of z = −2t in [−1, 1], which ducc0 and FINUFFT evaluate: [power, descending][cell], of degree
/// `least_degree` at least, with zeros above the function's degree.
Eigen::VectorXd horner_coefficients(const kernels::PiecewisePolynomial& function, int least_degree);

}  // namespace misfit::tools
