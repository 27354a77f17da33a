#include "imager/clean/deconvolver.h"

#include <stdexcept>

#include "imager/clean/clark.h"
#include "imager/clean/hogbom.h"
#include "imager/clean/multi_term.h"
#include "imager/clean/multiscale.h"

namespace misfit::imager {

std::vector<std::string> deconvolver_names() {
  return {"hogbom", "clark", "multiscale"};
}

std::unique_ptr<MinorCycle> make_deconvolver(const DeconvolverChoice& choice, const std::vector<const Image*>& psf) {
  const bool multiscale = choice.name == "multiscale";
  MultiscaleOptions options;  // points
  if (multiscale) options = {choice.scale_pixels, choice.small_scale_bias};
  options.threads = choice.threads;
  if (psf.size() > 1) return std::make_unique<MultiTerm>(psf, options);
  if (choice.name == "hogbom") return std::make_unique<Hogbom>(*psf.front(), choice.threads);
  if (choice.name == "clark") return std::make_unique<Clark>(*psf.front(), choice.threads);
  if (multiscale) return std::make_unique<Multiscale>(*psf.front(), options);
  throw std::invalid_argument("deconvolver " + choice.name + ": expected hogbom, clark or multiscale");
}

}  // namespace misfit::imager
