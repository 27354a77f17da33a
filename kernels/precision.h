#pragma once

namespace misfit::kernels {

/// What positions, stored numbers and arithmetic are in.
enum class Precision { single_precision, double_precision };

}  // namespace misfit::kernels
