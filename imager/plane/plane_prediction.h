#pragma once

#include <memory>

#include "imager/plane/plane_setup.h"
#include "imager/transform.h"

namespace misfit::imager {

/// The visibilities of `model`; `setup` must outlive them.
template <typename Real>
std::unique_ptr<Prediction> make_plane_prediction(const PlaneSetup<Real>& setup, const Image& model);

}  // namespace misfit::imager
