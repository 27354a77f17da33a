#pragma once

#include "tools/emit/host.h"

/// The hosts of the catalogue, one file each.
namespace misfit::tools {

Host casacore_host();
Host wsclean_host();
Host ducc_host();
Host finufft_host();
Host yandasoft_host();
Host c_header_host();
Host csv_host();

}  // namespace misfit::tools
