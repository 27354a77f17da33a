#pragma once

#include "kernels/catalogue.h"

/// The families of the catalogue, one file each.
namespace misfit::kernels {

KernelFamily least_misfit_family();
KernelFamily minimax_family();
KernelFamily spheroidal_family();

}  // namespace misfit::kernels
