#include "tools/run/mosaic_options.h"

#include <CLI/CLI.hpp>

#include "tools/base/option_checks.h"

namespace misfit::tools {

void declare(CLI::App& command, TypedMosaic& o) {
  command
      .add_option("--normtype", o.normtype,
                  "flatnoise: a mosaic's images are the sky times .pb, and the noise is the same everywhere; flatsky: they are "
                  "the sky, and the noise is higher where the beams see less")
      ->check(CLI::IsMember({"flatnoise", "flatsky"}));
  command.add_option("--psfphasecenter", o.psfphasecenter,
                     "Compute a mosaic's PSF as the image of a source in this direction, given as for --phasecenter. When "
                     "empty: in the middle of the image, or at the nearest pointing if no beam exceeds half its peak there");
  command.add_option("--beam-cut", o.beam_cut,
                     "Set beams of a mosaic to 0 beyond the radius where the main lobe at the lowest frequency falls to this "
                     "part of its peak; the radius is the same at all frequencies");
  command.add_flag("--usepointing", o.usepointing,
                   "Take the directions in which a mosaic's antennas pointed from the table POINTING, at the time of each row, "
                   "instead of FIELD");
}

void refuse_beside_other_gridders(const TypedMosaic& o) {
  constexpr const char* mosaic = "--gridder mosaic beside it, or auto with pointings that make a mosaic";
  if (o.usepointing) refuse_option("usepointing", "true", mosaic);
  if (!o.psfphasecenter.empty()) refuse_option("psfphasecenter", o.psfphasecenter, mosaic);
  if (o.normtype != TypedMosaic().normtype) refuse_option("normtype", o.normtype, mosaic);
  if (o.beam_cut != TypedMosaic().beam_cut) refuse_option("beam-cut", typed(o.beam_cut), mosaic);
}

void check(const TypedMosaic& o) {
  if (!(o.beam_cut > 0 && o.beam_cut <= 0.5))
    refuse_option("beam-cut", typed(o.beam_cut), "a number above 0, 0.5 at most, such as 1e-3");
}

}  // namespace misfit::tools
