#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "imager/outside/outside.h"
#include "imager/outside/wide_search.h"
#include "imager/plan/gridding_plan.h"
#include "imager/plan/plan.h"

namespace misfit::tools {

/// The findings of `misfit image --check-outside`.
struct OutsideReport {
  imager::ImageGeometry field;                  ///< searched, with the image in its middle
  bool searched = true;                         ///< false where no sample was left that its pixels can represent
  std::vector<imager::OutsideSource> sources;   ///< whose aliases may exceed the image's noise, the highest first
  std::vector<imager::OutsideSource> harmless;  ///< whose aliases do not, the brightest first
  std::size_t doubtful = 0;                     ///< others, which may be sidelobes of sources that the search did not find
  std::size_t found() const { return sources.size() + harmless.size(); }
  double least_jy = 0;          ///< fainter sources are not told from noise, or doubtful
  double highest_alias_jy = 0;  ///< the highest alias of one source found, Jy/beam
  double all_aliases_jy = 0;    ///< the sum of all aliases: those of an extended source's parts may add up
  double noise_jy = 0;          ///< of the image, Jy/beam
  bool noise_of_pixels = true;  ///< noise_jy is from pixels; else from visibilities
  double elsewhere_jy = 0;      ///< flux that is in no source found: at most, or where `elsewhere` about
  bool elsewhere = false;       ///< there certainly is some
};

/// The robust noise of an image's pixels, Jy/beam.
struct PixelNoise {
  double noise_jy = 0;
  bool alone = false;  ///< no other figure bounds the image's noise: its weights are not the data's
};

/// The noise to compare aliases with is what the image would have without a source, or the most that it can be. Two figures are
/// such bounds, and the lower one counts: the robust noise of the image's pixels, in which sidelobes count until CLEAN takes
/// them off; and the scatter of the visibilities about the sources found in the wider field, as far as neighbours in u and v do
/// not scatter alike (imager::Unexplained), which takes no CLEAN of the image. Weights tell nothing, since often their unit is
/// none. Where data have no noise both are small, and still above 0: an alias above is real, and one below is told with its
/// level.
///
/// `pixels` is the first of the two; `plan` and `images` are the image's, `wider` is the plan of the field to search.
/// Stages timed: those of imaging and CLEAN.
OutsideReport check_outside(const imager::VisibilitySource& source, const imager::GriddingPlan& plan,
                            const imager::GriddingPlan& wider, const imager::DirtyImages& images, const PixelNoise& pixels,
                            const imager::Context& context);

/// How a field is searched, why, and how long that is expected to take.
imager::Decision search_decision(const imager::WideField& field, double seconds);

/// The decision that nothing outside matters, or how much does.
imager::Decision outside_decision(const OutsideReport& report);

/// The places of the sources, a line each, the brightest first; beyond ten, the number of the others.
std::vector<std::string> outside_places(const OutsideReport& report);

/// A warning for each of the three sources with the highest aliases, the last of which says how many more there are; and one of
/// flux in no source found, where there is some for certain or it makes a detection doubtful. Or a warning that nothing was
/// looked for.
std::vector<std::string> outside_warnings(const OutsideReport& report);

/// `outside` and `outside_search` of report.json: the list of sources, and how they were looked for; null without a search.
nlohmann::json outside_json(const OutsideReport* report);
nlohmann::json outside_search_json(const OutsideReport* report);

}  // namespace misfit::tools
