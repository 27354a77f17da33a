#pragma once

#include <memory>

#include "imager/wide/wide_setup.h"

namespace misfit::imager {

/// The adjoint of a wide transform; `setup` must outlive it.
template <typename Real>
std::unique_ptr<AdjointSum> make_wide_adjoint(const WideSetup<Real>& setup, const AdjointOptions& options);

}  // namespace misfit::imager
