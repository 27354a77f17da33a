#include "tools/run/mosaic_options.h"

#include <CLI/CLI.hpp>

#include "tools/base/option_checks.h"

namespace misfit::tools {

void declare(CLI::App& command, TypedMosaic& o) {
  command
      .add_option("--normtype", o.normtype,
                  "Images of mosaics are: flatnoise, the sky times .pb, with the same noise everywhere; or flatsky, the sky, "
                  "with more noise where beams see less")
      ->check(CLI::IsMember({"flatnoise", "flatsky"}));
  command.add_option("--psfphasecenter", o.psfphasecenter,
                     "The PSF of a mosaic is that of a source in this direction, given as --phasecenter; without it in the "
                     "middle of the image, or where the nearest pointing is if no beam sees that");
  command.add_option(
      "--beam-cut", o.beam_cut,
      "Beams of a mosaic are taken as 0 beyond where their main lobe falls to this part of its peak at the lowest "
      "frequency, at the same radius at all frequencies");
  command.add_flag("--usepointing", o.usepointing,
                   "Antennas of a mosaic pointed where the table POINTING says at the time of each row, not where FIELD does");
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
