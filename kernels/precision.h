#pragma once

namespace misfit::kernels {

/// The precision of positions, stored numbers and arithmetic.
enum class Precision { single_precision, double_precision };

}  // namespace misfit::kernels
