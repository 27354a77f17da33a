#pragma once

#include <memory>

#include "imager/coplanar/coplanar_setup.h"
#include "imager/transform/transform.h"

namespace misfit::imager {

/// The visibilities of `model`; `setup` must outlive them.
template <typename Real>
std::unique_ptr<Prediction> make_coplanar_prediction(const CoplanarSetup<Real>& setup, const Image& model);

}  // namespace misfit::imager
