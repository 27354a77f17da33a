#pragma once

#include <memory>

#include "imager/pointing/mosaic_windows.h"

namespace misfit::imager {

/// The prediction of a model by a mosaic's transform.
std::unique_ptr<Prediction> make_mosaic_prediction(std::shared_ptr<const MosaicWindows> windows, Image model);

}  // namespace misfit::imager
