#pragma once

#include <optional>
#include <string>
#include <vector>

#include "imager/data/geometry.h"

namespace CLI {
class App;
}

namespace misfit::tools {

/// `misfit mosaic` as typed.
struct MosaicOptions {
  std::vector<std::string> images;
  std::string output;
  std::string beam;  ///< see DishBeams; empty: that of each image
  double pblimit = 0.2;
  std::string rms;          ///< flux densities between commas; empty: measured
  std::string phasecenter;  ///< empty: the middle of the pointings
  std::vector<int> imsize;  ///< width, or width and height; empty: as the beams reach
  std::string cell;         ///< empty: the images' smallest
  std::string outformat = "fits";
  int threads = 0;
  bool quiet = false;

  std::optional<imager::SkyDirection> centre() const;
  std::optional<double> cell_rad() const;
  /// σ of each image, Jy/beam; empty where noises are measured.
  std::vector<double> noises_jy() const;
};

void declare(CLI::App& command, MosaicOptions& options);

/// Throws std::invalid_argument that names the option, its value and what was expected.
void check(const MosaicOptions& options);

}  // namespace misfit::tools
