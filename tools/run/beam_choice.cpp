#include "tools/run/beam_choice.h"

#include <stdexcept>

#include "tools/base/numbers.h"

namespace misfit::tools {
namespace {

/// The fitted beam of the main lobe into `choice`, or nothing and why.
void fit(const imager::Image& psf, double cell_rad, BeamChoice& choice) {
  try {
    choice.main_lobe = imager::fit_beam(psf, cell_rad);
    choice.how = "fitted";
  } catch (const std::runtime_error& error) {
    choice.warnings.emplace_back(error.what());
  }
  if (choice.main_lobe) {
    choice.quadrant = imager::fit_beam(psf, cell_rad, imager::BeamRegion::quadrant);
    return;
  }
  try {
    choice.main_lobe = imager::fit_circular_beam(psf, cell_rad);
    choice.how = "fitted round";
    choice.warnings.emplace_back(
        "the beam is the round Gaussian that fits best: it does not tell how wide the PSF is along each "
        "axis; --restoringbeam sets another");
  } catch (const std::runtime_error&) {  // as the first
  }
}

}  // namespace

BeamChoice choose_beam(const imager::Image& psf, double cell_rad, const std::optional<imager::Beam>& given, bool needed) {
  constexpr double bad = 0.1;
  BeamChoice choice;
  fit(psf, cell_rad, choice);
  choice.restoring = choice.main_lobe;
  if (given) {
    choice.restoring = given;
    choice.how = "given";
    if (!choice.main_lobe) choice.main_lobe = given;
  }
  if (!choice.restoring) {
    if (needed) throw std::runtime_error(choice.warnings.front() + "; or give --restoringbeam");
    return choice;
  }
  choice.misfit = imager::beam_misfit(psf, *choice.restoring, cell_rad);
  if (choice.misfit >= bad && !given)
    choice.warnings.emplace_back("the beam fits the PSF's main lobe badly: they differ by " + significant(choice.misfit, 2) +
                                 " of the peak, RMS");
  return choice;
}

}  // namespace misfit::tools
