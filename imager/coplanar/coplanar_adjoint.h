#pragma once

#include <memory>

#include "imager/coplanar/coplanar_setup.h"
#include "imager/transform/transform.h"

namespace misfit::imager {

/// The adjoint of a plane transform; `setup` must outlive it.
template <typename Real>
std::unique_ptr<AdjointSum> make_coplanar_adjoint(const CoplanarSetup<Real>& setup, const AdjointOptions& options);

}  // namespace misfit::imager
