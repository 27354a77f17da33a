#pragma once

#include <Eigen/Core>

namespace misfit::kernels {

/// Nodes and weights: ∫ f ≈ Σ weight_i f(node_i).
struct Quadrature {
  Eigen::VectorXd node;
  Eigen::VectorXd weight;
};

/// The Gauss–Legendre rule of `points` points on [from, to], exact for polynomials of degree 2·points − 1
/// (Abramowitz & Stegun 1964, eq. 25.4.29).
Quadrature gauss_legendre(int points, double from, double to);

}  // namespace misfit::kernels
