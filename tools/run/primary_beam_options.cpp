#include "tools/run/primary_beam_options.h"

#include <CLI/CLI.hpp>
#include <cmath>

#include "tools/base/option_checks.h"
#include "tools/run/dish_beams.h"

namespace misfit::tools {

double TypedPrimaryBeam::limit() const {
  constexpr double usual = 0.2;
  return pblimit == 0 ? usual : std::abs(pblimit);
}

void declare(CLI::App& command, TypedPrimaryBeam& o) {
  mark(
      command.add_flag("--pbcor", o.pbcor,
                       "Write .image.pbcor too, the image divided by the antennas' primary beam, and .pb, the beam, for dishes "
                       "that point alike. With --nterms 2 or 3 each term is divided by the beam's own spectrum too: "
                       ".image.tt0.pbcor, "
                       ".image.tt1.pbcor, …, .alpha.pbcor and .beta.pbcor"),
      OptionMark::free_of_state);
  mark(command.add_option(
           "--pblimit", o.pblimit,
           "Where the primary beam is lower, .pb and .image.pbcor have no values; 0.2 when 0. Without --pbcor .pb "
           "alone is written. Above 0 it goes for the masks of CASA images .image and .residual too, whose pixels stay; the "
           "sign makes no other difference"),
       OptionMark::free_of_state);
  mark(command
           .add_option(
               "--beam", o.beam,
               "The primary beam in place of that of the antennas' telescope: a telescope's by its name, or airy, a uniformly "
               "lit "
               "dish of the antennas' diameter, airy:D of D metres, airy:D:B with a dark middle of B metres; or a FITS image "
               "of a "
               "power pattern, or a cube with its frequencies, which turns with the zenith; voltage:FILE of a voltage pattern. "
               "Writes .pb, as --pblimit does")
           ->type_name(name_or_file_type),
       OptionMark::free_of_state);
  mark(command.add_option(
           "--pbmask", o.pbmask,
           "CLEAN finds components only where the primary beam is this or more, in whatever mask; at least --pblimit; 0 = "
           "everywhere"),
       OptionMark::way_of_clean);
}

void check(const TypedPrimaryBeam& o) {
  check_beam(o.beam);
  if (!(std::abs(o.pblimit) < 1)) refuse_option("pblimit", typed(o.pblimit), "a number between 0 and 1, such as 0.2");
  if (o.pbmask != 0 && !(o.pbmask >= o.limit() && o.pbmask < 1))
    refuse_option("pbmask", typed(o.pbmask), "at least --pblimit, " + typed(o.limit()) + ", and below 1; or 0");
}

}  // namespace misfit::tools
