#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "imager/gridding_plan.h"
#include "imager/outside.h"
#include "imager/plan.h"
#include "imager/wide_search.h"

namespace misfit::tools {

/// What `misfit image --check-outside` found.
struct OutsideReport {
  imager::ImageGeometry field;                 ///< searched, with the image in its middle
  std::vector<imager::OutsideSource> sources;  ///< whose aliases may exceed the image's noise, the highest first
  std::size_t found = 0;                       ///< sources outside, with those whose aliases do not
  double least_jy = 0;                         ///< fainter sources were not looked for
  double noise_jy = 0;                         ///< of the image, Jy/beam
};

/// Looks for sources outside the image of `plan`, which has this PSF and noise. Stages timed: those of imaging and CLEAN.
OutsideReport check_outside(const imager::VisibilitySource& source, const imager::GriddingPlan& plan, const imager::Image& psf,
                            double noise_jy, const imager::Progress& progress, imager::StageTimes& times);

/// That nothing outside matters, or how much does.
imager::Decision outside_decision(const OutsideReport& report);

/// One for each of the three with the highest aliases; the last says how many more there are.
std::vector<std::string> outside_warnings(const OutsideReport& report);

/// `outside` and `outside_search` of report.json: the list of sources, and how they were looked for; null without a search.
nlohmann::json outside_json(const OutsideReport* report);
nlohmann::json outside_search_json(const OutsideReport* report);

}  // namespace misfit::tools
