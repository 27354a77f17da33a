#pragma once

#include <string>
#include <vector>

#include "imager/files/image_header.h"
#include "imager/transform/transform.h"
#include "tools/run/image_options.h"

namespace misfit::tools {

/// Which images a run leaves.
struct ProductChoice {
  int terms = 1;
  bool cleaned = false;
  bool masked = false;    ///< there is a mask, if only one of ones
  bool restored = false;  ///< there is an image with the beam of the PSF, if only the dirty one
  bool primary_beam = false;
  bool corrected = false;  ///< for the primary beam
  bool weights = false;    ///< sums of weights
  bool mosaic = false;     ///< of several pointings: with its sensitivity, and one primary beam for all Taylor terms

  static ProductChoice of(const ImageOptions& options);
};

/// When the file of an image is complete.
enum class Completed {
  first,      ///< others take their masks from it
  as_usual,   ///< with the last channel
  with_beam,  ///< once it is restored, which may wait for a beam that is common to all channels
};

/// One of the images of a run.
struct ProductKind {
  std::string name;  ///< between <imagename> and .fits: psf, residual, image.tt1.pbcor
  std::string unit = "Jy/beam";
  bool each_stokes = true;  ///< or one for all
  bool beam = true;         ///< whether its pixels are seen with the restoring beam
  bool one_pixel = false;   ///< or all of the image's
  Completed completed = Completed::as_usual;
  bool masked_by_beam = false;  ///< where --pblimit is above 0: the primary beam's
  imager::TaylorTerm term{};
  std::string quantity = imager::ImageHeader().quantity;
};

/// The kinds of images that a run leaves. The names are tclean's; of several Taylor terms they say which: psf.tt0, …
std::vector<ProductKind> product_kinds(const ProductChoice& choice);

std::vector<std::string> product_names(const ProductChoice& choice);

/// The names of all images that runs may leave.
std::vector<std::string> all_product_names();

/// Planes of one channel in all images.
int product_planes(const ProductChoice& choice, int stokes);

/// The sum of weights that .sumwt states of samples with these sums: as in tclean natural weights are 1/σ², where ours are 1/(4
/// σ²).
inline double sumwt_of(const imager::SampleSums& sums) {
  return 4 * sums.weight;
}

/// A kind's name of a Taylor term: "image.tt1.pbcor"; "image.pbcor" of one.
std::string product_name(const std::string& kind, const imager::TaylorTerm& term, const std::string& end = "");

}  // namespace misfit::tools
