#include "imager/clean/minor_cycle.h"

#include <stdexcept>
#include <string>

namespace misfit::imager {

MinorCycleReport MinorCycle::clean(const std::vector<const Image*>& residual, const MinorCycleOptions& options) const {
  if (residual.size() != static_cast<std::size_t>(terms_))
    throw std::invalid_argument(std::to_string(residual.size()) + " residuals of " + std::to_string(terms_) +
                                " Taylor terms; expected one for each");
  const auto require = [this](const std::string& name, const Image& image) {
    if (image.width != width_ || image.height != height_)
      throw std::invalid_argument(name + " of " + std::to_string(image.width) + " × " + std::to_string(image.height) +
                                  " pixels: expected the size of the PSF, " + std::to_string(width_) + " × " +
                                  std::to_string(height_));
  };
  for (const Image* image : residual) require("residual", *image);
  if (options.mask != nullptr) require("mask", *options.mask);
  return find(residual, options);
}

bool MinorCycleWatch::ends(double peak_jy, MinorCycleReport& report) const {
  report.peak_jy = peak_jy;
  if (!(peak_jy > depth_jy()))
    report.end = MinorCycleEnd::threshold;
  else if (!(peak_jy <= minor_cycle_divergence * first_peak_jy_))
    report.end = MinorCycleEnd::diverging;
  else
    return is_at_limit(report);
  return true;
}

bool MinorCycleWatch::is_at_limit(MinorCycleReport& report) const {
  if (report.iterations() >= options_.max_iterations)
    report.end = MinorCycleEnd::iterations;
  else if (options_.stop_requested && options_.stop_requested())
    report.end = MinorCycleEnd::stopped;
  else
    return false;
  return true;
}

}  // namespace misfit::imager
