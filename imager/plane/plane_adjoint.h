#pragma once

#include <memory>

#include "imager/plane/plane_setup.h"
#include "imager/transform.h"

namespace misfit::imager {

/// The adjoint of a plane transform; `setup` must outlive it.
template <typename Real>
std::unique_ptr<AdjointSum> make_plane_adjoint(const PlaneSetup<Real>& setup, const AdjointOptions& options);

}  // namespace misfit::imager
