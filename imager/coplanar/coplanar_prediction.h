#pragma once

#include <memory>

#include "imager/coplanar/coplanar_setup.h"
#include "imager/coplanar/shared_transform.h"
#include "imager/transform/transform.h"

namespace misfit::imager {

/// The visibilities of `model`; `setup` must outlive them.
template <typename Real>
std::unique_ptr<Prediction> make_coplanar_prediction(const CoplanarSetup<Real>& setup, const Image& model);

/// See SharedTransform.
template <typename Real>
std::unique_ptr<SharedPrediction> make_shared_prediction(const CoplanarSetup<Real>& setup, const std::vector<Image>& images);

}  // namespace misfit::imager
