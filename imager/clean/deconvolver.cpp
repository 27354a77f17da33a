#include "imager/clean/deconvolver.h"

#include <stdexcept>

#include "imager/clean/clark.h"
#include "imager/clean/hogbom.h"
#include "imager/clean/multiscale.h"

namespace misfit::imager {

std::vector<std::string> deconvolver_names() {
  return {"hogbom", "clark", "multiscale"};
}

std::unique_ptr<MinorCycle> make_deconvolver(const DeconvolverChoice& choice, const Image& psf) {
  if (choice.name == "hogbom") return std::make_unique<Hogbom>(psf, choice.threads);
  if (choice.name == "clark") return std::make_unique<Clark>(psf, choice.threads);
  if (choice.name == "multiscale")
    return std::make_unique<Multiscale>(
        psf, MultiscaleOptions{
                 .scale_pixels = choice.scale_pixels, .small_scale_bias = choice.small_scale_bias, .threads = choice.threads});
  throw std::invalid_argument("deconvolver " + choice.name + ": expected hogbom, clark or multiscale");
}

}  // namespace misfit::imager
