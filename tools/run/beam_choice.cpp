#include "tools/run/beam_choice.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <stdexcept>

#include "tools/base/numbers.h"
#include "tools/base/option_checks.h"
#include "tools/base/quantity.h"
#include "tools/base/text.h"

namespace misfit::tools {
namespace {

/// Puts the fitted beam of the main lobe into `choice`, or nothing and the reason.
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

void declare_restoring_beam(CLI::App& command, std::string& typed_beam) {
  mark(command
           .add_option(
               "--restoringbeam", typed_beam,
               "Beam of the restored image: MAJ, or MAJ,MIN,PA such as 0.5arcsec,0.4arcsec,30deg; circular, with the width of "
               "the fitted beam's major axis; or common, one beam for all planes of a cube. When empty: the fitted beam")
           ->check(values_are({"common", "circular"}, Others::possible)),
       OptionMark::free_of_state);
}

WantedBeam restoring_beam(const std::string& typed_beam) {
  if (typed_beam.empty() || typed_beam == "common") return {};
  if (typed_beam == "circular") return {.circular = true};
  const auto expect = [&](bool holds) {
    if (!holds)
      refuse_option(
          "restoringbeam", typed_beam,
          "common, circular, MAJ, or MAJ,MIN,PA such as 0.5arcsec,0.4arcsec,30deg with MAJ at least MIN, and MIN above 0");
  };
  const auto angle = [&](std::string_view part) {
    const std::string text(part);
    expect(has_unit(text) && quantity(parse_angle_rad)(text).empty());
    return parse_angle_rad(text);
  };
  const std::vector<std::string_view> parts = split_at_commas(typed_beam);
  expect(parts.size() == 1 || parts.size() == 3);
  imager::Beam beam;
  beam.major_rad = angle(parts[0]);
  beam.minor_rad = parts.size() == 1 ? beam.major_rad : angle(parts[1]);
  // Half a turn leaves the ellipse as it is.
  beam.position_angle_rad = parts.size() == 1 ? 0 : std::remainder(angle(parts[2]), M_PI);
  expect(beam.minor_rad > 0 && beam.major_rad >= beam.minor_rad && beam.major_rad < 1);
  return {.given = beam};
}

BeamChoice choose_beam(const imager::Image& psf, double cell_rad, const WantedBeam& wanted, bool needed) {
  constexpr double bad = 0.1;
  BeamChoice choice;
  fit(psf, cell_rad, choice);
  choice.restoring = choice.main_lobe;
  if (wanted.given) {
    choice.restoring = wanted.given;
    choice.how = "given";
    if (!choice.main_lobe) choice.main_lobe = wanted.given;
  }
  if (!choice.restoring) {
    if (needed) throw std::runtime_error(choice.warnings.front() + "; or give --restoringbeam");
    return choice;
  }
  const double misfit = imager::beam_misfit(psf, *choice.restoring, cell_rad);
  if (misfit >= bad && !wanted.given)
    choice.warnings.emplace_back("the beam fits the PSF's main lobe badly: they differ by " + significant(misfit, 2) +
                                 " of the peak, RMS");
  if (wanted.circular) {
    choice.restoring = imager::Beam{choice.main_lobe->major_rad, choice.main_lobe->major_rad, 0};
    choice.how += ", made circular";
  }
  choice.misfit = wanted.circular ? imager::beam_misfit(psf, *choice.restoring, cell_rad) : misfit;
  return choice;
}

}  // namespace misfit::tools
