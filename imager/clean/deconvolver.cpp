#include "imager/clean/deconvolver.h"

#include <algorithm>
#include <stdexcept>

#include "imager/clean/joint_clean.h"

namespace misfit::imager {

std::vector<std::string> deconvolver_names() {
  return {"hogbom", "clark", "multiscale"};
}

std::unique_ptr<MinorCycle> make_deconvolver(const DeconvolverChoice& choice, const std::vector<const Image*>& psf) {
  const std::vector<std::string> names = deconvolver_names();
  if (std::find(names.begin(), names.end(), choice.name) == names.end())
    throw std::invalid_argument("deconvolver " + choice.name + ": expected hogbom, clark or multiscale");
  MultiscaleOptions options;  // points
  if (choice.name == "multiscale") options = {choice.scale_pixels, choice.small_scale_bias};
  options.threads = choice.threads;
  return std::make_unique<JointClean>(psf, options);
}

}  // namespace misfit::imager
