#pragma once

#include <string>
#include <vector>

#include "imager/data/geometry.h"

namespace misfit::tools {

/// Throws std::invalid_argument that says what was expected unless `text` is "hex,N,SPACING", with 1 to 10000 pointings, or
/// names a file.
void check_pointings(const std::string& text);

/// The pointings that `text` asks for: "hex,N,SPACING" are the N nearest to `centre` of a hexagonal lattice about it,
/// neighbours SPACING apart in direction cosines, by distance; else those of a CSV file, whose first line is ra_deg,dec_deg, in
/// the frame of `centre`. Throws std::runtime_error that names the file, the line, the value and what was expected.
std::vector<imager::SkyDirection> pointings(const std::string& text, const imager::SkyDirection& centre);

}  // namespace misfit::tools
