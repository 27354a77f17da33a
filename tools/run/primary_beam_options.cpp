#include "tools/run/primary_beam_options.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <utility>

#include "tools/base/option_checks.h"
#include "tools/run/dish_beams.h"

namespace misfit::tools {

double TypedPrimaryBeam::limit() const {
  constexpr double usual = 0.2;
  return pblimit == 0 ? usual : std::abs(pblimit);
}

std::string TypedPrimaryBeam::asked() const {
  std::string options;
  for (const auto& [option, given] :
       {std::pair("--pbcor", pbcor), {"--pblimit", pblimit != 0}, {"--pbmask", pbmask > 0}, {"--beam", !beam.empty()}})
    if (given) options += (options.empty() ? "" : ", ") + std::string(option);
  return options;
}

void declare(CLI::App& command, TypedPrimaryBeam& o) {
  mark(command.add_flag("--pbcor", o.pbcor,
                        "Also write .pb, the antennas' primary beam, and .image.pbcor, the image divided by it; dishes must "
                        "point alike. With --nterms 2 or 3, each term is also corrected for the spectrum of the beam: "
                        ".image.tt0.pbcor, .image.tt1.pbcor, …, .alpha.pbcor and .beta.pbcor"),
       OptionMark::free_of_state);
  mark(command.add_option(
           "--pblimit", o.pblimit,
           ".pb and .image.pbcor have no values where the primary beam is lower than this; 0 means 0.2. Without --pbcor, only "
           ".pb is written. A positive value also limits the masks of the CASA images .image and .residual, whose pixels stay. "
           "A mosaic is not cleaned where the beam is lower, unless the value is negative"),
       OptionMark::free_of_state);
  mark(command
           .add_option("--beam", o.beam,
                       "Primary beam to use instead of the beam of the antennas' telescope: a telescope's name; airy, a "
                       "uniformly lit dish of the antennas' diameter; airy:D, of D metres; airy:D:B, with a dark middle of B "
                       "metres; a FITS image of a power pattern, or a cube along frequency, which turns with the zenith; or "
                       "voltage:FILE, a voltage pattern. Writes .pb, as --pblimit does")
           ->type_name(name_or_file_type),
       OptionMark::free_of_state);
  mark(command.add_option("--pbmask", o.pbmask,
                          "Find components only where the primary beam is at least this, whatever the mask; not below "
                          "--pblimit; 0 means everywhere"),
       OptionMark::way_of_clean);
}

void check(const TypedPrimaryBeam& o) {
  check_beam(o.beam);
  if (!(std::abs(o.pblimit) < 1)) refuse_option("pblimit", typed(o.pblimit), "a number between -1 and 1, such as 0.2");
  if (o.pbmask != 0 && !(o.pbmask >= o.limit() && o.pbmask < 1))
    refuse_option("pbmask", typed(o.pbmask), "at least --pblimit, " + typed(o.limit()) + ", and below 1; or 0");
}

}  // namespace misfit::tools
