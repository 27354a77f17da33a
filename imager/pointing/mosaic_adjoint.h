#pragma once

#include <memory>

#include "imager/pointing/mosaic_windows.h"

namespace misfit::imager {

/// The adjoint of a mosaic's transform.
std::unique_ptr<AdjointSum> make_mosaic_adjoint(std::shared_ptr<const MosaicWindows> windows, const AdjointOptions& options);

}  // namespace misfit::imager
