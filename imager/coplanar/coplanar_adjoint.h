#pragma once

#include <memory>

#include "imager/coplanar/coplanar_setup.h"
#include "imager/coplanar/shared_transform.h"
#include "imager/transform/transform.h"

namespace misfit::imager {

/// The adjoint of a plane transform; `setup` must outlive it.
template <typename Real>
std::unique_ptr<AdjointSum> make_coplanar_adjoint(const CoplanarSetup<Real>& setup, const AdjointOptions& options);

/// See SharedTransform.
template <typename Real>
std::unique_ptr<SharedAdjoint> make_shared_adjoint(const CoplanarSetup<Real>& setup, std::size_t sets, std::size_t images);

}  // namespace misfit::imager
