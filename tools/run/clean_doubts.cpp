#include "tools/run/clean_doubts.h"

#include <algorithm>
#include <utility>

#include "tools/base/numbers.h"

namespace misfit::tools {
namespace {

constexpr const char* against_divergence = ": a lower --gain, a --mask around the sources, or more scales may help";

bool diverged(const imager::CleanReport& report) {
  return report.stop == imager::CleanStop::diverging || report.stop == imager::CleanStop::diverging_from_best;
}

std::string divergence(const imager::CleanReport& report, const CleanedImage& image) {
  if (!diverged(report)) return "";
  const std::string sidelobe =
      "; the largest sidelobe is " + significant(100 * report.max_sidelobe, 2) + " % of the PSF's peak";
  return std::string("CLEAN diverged") + against_divergence + (image.one_of_many ? "" : sidelobe);
}

/// Returns the cycles that were taken back because the residual had grown.
std::vector<const imager::MajorCycle*> cycles_taken_back(const imager::CleanReport& report) {
  std::vector<const imager::MajorCycle*> taken_back;
  std::size_t kept = report.kept;
  for (std::size_t cycle = report.cycles.size(); cycle-- > 1;) {
    if (cycle == kept)
      kept = report.cycles[cycle].from;
    else
      taken_back.push_back(&report.cycles[cycle]);
  }
  return taken_back;
}

/// Nothing where coarser transforms alone misled CLEAN: it then goes on by exact ones.
std::string growth(const imager::CleanReport& report, const CleanedImage& image) {
  const std::vector<const imager::MajorCycle*> taken_back = cycles_taken_back(report);
  const auto is_exact = [](const imager::MajorCycle* cycle) { return cycle->accuracy == 0; };
  if (diverged(report) || std::none_of(taken_back.begin(), taken_back.end(), is_exact)) return "";
  const std::string figures = std::to_string(taken_back.size()) + " of " + std::to_string(report.cycles.size() - 1);
  return "the residual grew in " + (image.one_of_many ? "some" : figures) + " major cycles, which were taken back" +
         against_divergence;
}

/// A component has a flux and a place, three numbers, and a visibility has two. Neighbouring visibilities see alike of the
/// sources, so that these need far fewer components, but noise does not: more components than visibilities fit noise, or are
/// arbitrary. Components of a start model are not judged, since they were not found here.
std::string excess(const TypedClean& options, const CleanedImage& image) {
  if (image.components <= image.visibilities || !options.startmodel.empty()) return "";
  const auto count = [](std::uint64_t number) { return grouped(static_cast<long long>(number)); };
  const std::string figures =
      count(image.components) + " distinct components in " + count(image.visibilities) + " visibilities";
  const bool masked = !options.mask.empty() || options.usemask == "auto";
  return "CLEAN found " + (image.one_of_many ? "more distinct components than there are visibilities" : figures) +
         ", more than these determine: it fits noise, and the noise found is too low; expected " +
         (masked ? "a smaller mask" : "a --mask around the sources, --usemask auto") + " or a larger --nsigma";
}

/// Says which threshold kept an automatic mask empty, and which option lets more in.
std::string mask_threshold_words(const imager::CleanReport& report, const TypedClean& o, const CleanedImage& image) {
  const imager::MaskExtension& masked = report.cycles.front().masked;
  const std::string regions =
      o.minbeamfrac > 0 ? " of --minbeamfrac " + significant(o.minbeamfrac, 3) + " of the beam or more" : "";
  const std::string level = image.one_of_many ? "" : with_prefix(masked.threshold_jy, "Jy/beam", 4) + ", ";
  const std::string takes = "it takes regions" + regions + " above " + level;
  const double part_of_peak = masked.by_sidelobes ? o.sidelobethreshold * report.max_sidelobe : 0;
  std::string expected = masked.by_sidelobes ? "a lower --sidelobethreshold" : "a lower --noisethreshold";
  if (masked.regions == 0 && part_of_peak < 1 && report.cycles.front().peak_residual_jy > masked.threshold_jy)
    expected = "a --negativethreshold, since the brightest pixel is negative";
  else if (masked.regions > 0 && masked.pruned == masked.regions && part_of_peak < 0.5)
    expected = "a smaller --minbeamfrac";
  else if (masked.by_sidelobes && !image.one_of_many)  // half the peak, or half of what was asked where regions were too small
    expected += ", such as " + significant(std::min(0.5 / report.max_sidelobe, o.sidelobethreshold / 2), 2);
  const std::string threshold =
      masked.by_sidelobes ? "--sidelobethreshold " + significant(o.sidelobethreshold, 3) + " times the PSF's largest sidelobe" +
                                (image.one_of_many ? "" : " " + significant(report.max_sidelobe, 3)) + " times the peak"
                          : "--noisethreshold " + significant(o.noisethreshold, 3) + " times the noise";
  return takes + threshold + "; expected " + expected;
}

/// An empty mask is right where there is noise alone, which reaches 6 σ in an image of 10⁹ pixels.
std::string emptiness(const imager::CleanReport& report, const TypedClean& o, const CleanedImage& image) {
  constexpr double certain = 7;
  const imager::MajorCycle& start = report.cycles.front();
  const bool automatic = start.masked.threshold_jy > 0;
  if (!automatic || report.stop != imager::CleanStop::empty_mask || report.cycles.size() > 1) return "";
  const double anywhere_jy = image.limited ? 0 : start.peak_residual_jy;  // else of pixels that no mask takes, too
  const double peak_jy =
      start.masked.by_sidelobes ? start.masked.threshold_jy / (o.sidelobethreshold * report.max_sidelobe) : anywhere_jy;
  if (!(peak_jy > certain * start.rms_jy)) return "";
  return "the automatic mask is empty, and nothing is cleaned: " + mask_threshold_words(report, o, image);
}

}  // namespace

std::vector<std::string> clean_doubts(const imager::CleanReport& report, const TypedClean& options, const CleanedImage& image) {
  std::vector<std::string> doubts;
  for (std::string& doubt :
       std::vector{divergence(report, image), growth(report, image), excess(options, image), emptiness(report, options, image)})
    if (!doubt.empty()) doubts.push_back(std::move(doubt));
  return doubts;
}

}  // namespace misfit::tools
