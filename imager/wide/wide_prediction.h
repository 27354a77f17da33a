#pragma once

#include <memory>

#include "imager/wide/wide_setup.h"

namespace misfit::imager {

/// The prediction of a wide transform of a model; `setup` must outlive it.
template <typename Real>
std::unique_ptr<Prediction> make_wide_prediction(const WideSetup<Real>& setup, Image model);

}  // namespace misfit::imager
