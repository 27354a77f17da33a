#pragma once

#include <string>

namespace CLI {
class App;
}

namespace misfit::tools {

/// How pointings become one image, as typed.
struct TypedMosaic {
  std::string normtype = "flatnoise";
  std::string psfphasecenter{};  ///< as --phasecenter; empty: the middle of the image, or the nearest pointing
  double beam_cut = 1e-3;
  bool usepointing = false;
};

void declare(CLI::App& command, TypedMosaic& options);

/// Throws as check(const ImageOptions&) does.
void check(const TypedMosaic& options);

/// Throws as check() does for any of these options that is given where no mosaic is made.
void refuse_beside_other_gridders(const TypedMosaic& options);

}  // namespace misfit::tools
