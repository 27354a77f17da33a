#pragma once

#include <string>
#include <vector>

namespace misfit::ms_io {

/// FITS SPECSYS of the frame that CASA's tasks call `name`, in capitals or not: "LSRK" for LSRK, "TOPOCENT" for TOPO,
/// "GEOCENTR" for GEO, "BARYCENT" for BARY, "LSRD" for LSRD, "GALACTOC" for GALACTO, "LOCALGRP" for LGROUP, "CMBDIPOL" for CMB.
/// Throws std::invalid_argument that lists them.
std::string parse_spectral_frame(const std::string& name);

/// The channels of one spectral window, in another frame at the time of its earliest selected row.
struct SpectralWindow {
  std::string set;  ///< path
  int id = 0;
  std::vector<double> frequency_hz;      ///< [selected channel]
  std::vector<double> channel_width_hz;  ///< [selected channel], positive
  std::vector<int> channel;              ///< [selected channel], its number in the window
};

}  // namespace misfit::ms_io
