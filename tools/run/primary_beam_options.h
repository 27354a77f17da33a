#pragma once

#include <string>

namespace CLI {
class App;
}

namespace misfit::tools {

/// The options of the primary beam, as typed.
struct TypedPrimaryBeam {
  bool pbcor = false;
  double pblimit = 0;        ///< 0: not given; below 0 other images than .pb and .image.pbcor are not masked
  std::string beam{};        ///< see DishBeams; empty: those of the antennas
  double pbmask = 0;         ///< CLEAN keeps to where the beam is at least this; 0 = it does not
  bool where_known = false;  ///< .pb is wanted, but only where antennas have a simple beam: that of --products

  bool wanted() const { return where_known || required(); }
  /// True if a run without it is of no use: with --pbcor, --pbmask or --beam, or --pblimit alone.
  bool required() const { return pbcor || pbmask > 0 || !beam.empty() || (pblimit != 0 && !where_known); }
  /// The options in which it is asked for: "--pbcor, --beam".
  std::string asked() const;
  /// True if masks say where other images lie below the limit.
  bool masks_others() const { return wanted() && pblimit > 0; }
  /// The value below which images have no values.
  double limit() const;
};

void declare(CLI::App& command, TypedPrimaryBeam& options);

/// Throws as check(const ImageOptions&) does.
void check(const TypedPrimaryBeam& options);

}  // namespace misfit::tools
