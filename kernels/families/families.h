#pragma once

#include <optional>

#include "kernels/catalogue.h"

/// The families of the catalogue, one file each.
namespace misfit::kernels {

KernelFamily least_misfit_family();
KernelFamily minimax_family();
KernelFamily spheroidal_family(double alpha);  ///< Schwab's approximations: α = 0, ½, 1, 1½ or 2
KernelFamily spheroidal_exact_family();
KernelFamily prolate_family();
KernelFamily kaiser_bessel_family();
KernelFamily exp_semicircle_family();
KernelFamily nearest_family();
KernelFamily linear_family();
KernelFamily sinc_family();
KernelFamily gaussian_family();
KernelFamily gaussian_sinc_family();
/// The family of any order α, for a name like spheroidal-exact-0.5; none for names that do not begin so. std::invalid_argument
/// where the order is not a number in [0, 10].
std::optional<KernelFamily> spheroidal_exact_family(const std::string& name);

}  // namespace misfit::kernels
