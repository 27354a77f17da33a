#pragma once

#include "kernels/kernel.h"

namespace misfit::kernels {

/// The spheroidal gridding function (1 − η²)^α ψ(η), η = 2u/W, scaled to 1 at η = 0. ψ is the solution without a zero in
/// [−1, 1] of
///
///     (1 − η²) ψ″ − 2(α + 1) η ψ′ + (b − c²η²) ψ = 0,
///
/// the eigenfunction of ∫ exp(icηt) (1 − t²)^α ψ(t) dt with the largest eigenvalue (F. R. Schwab 1984, "Optimal gridding of
/// visibility data in radio interferometry", in Indirect Imaging, ed. J. A. Roberts, Cambridge University Press, p. 333). α = 0
/// is the prolate function of order 0. `bandwidth` is c; c = πW/2 is the usual one.
/// Right to 1e-12 of the peak. Width must be 1 or more, `alpha` lie in [0, 10] and `bandwidth` in [0, 200]
/// (std::invalid_argument).
TapFunction spheroidal_exact_taps(int width, double alpha, double bandwidth);

}  // namespace misfit::kernels
