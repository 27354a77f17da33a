#pragma once

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "imager/plan/gridding_plan.h"
#include "imager/transform/imaging.h"

namespace misfit::imager {

/// Images of a run before that are taken instead of new ones. Ranks but the first, which have no images, have empty ones.
struct TakenImages {
  std::optional<std::vector<Image>> dirty;  ///< [Stokes], Jy/beam; none: they are made
  std::optional<Image> psf;                 ///< none: it is made
  bool of_model = false;                    ///< `dirty` are what a model leaves, which the samples alone do not tell
};

/// Thrown where an image that was to be taken is not that of the samples.
struct UnlikeSamples : std::runtime_error {
  UnlikeSamples(std::optional<std::size_t> of_stokes, const std::string& what) : std::runtime_error(what), stokes(of_stokes) {}
  std::optional<std::size_t> stokes;  ///< of the dirty image; none: the PSF
};

/// Makes the middle pixels of images by direct sums, a few to many so that they take about a tenth of a second, for images
/// of this plan.
std::unique_ptr<Transform> middle_transform(const GriddingPlan& plan);

/// Puts the images taken into the place of their middles in `made`, which middle_transform() made, with which they are
/// compared. What selects or weighs other samples changes the main lobe, or what is seen with it: PSFs may differ by 1e-3 of
/// their peak, dirty images by 1e-2 of their RMS, or ten times the accuracy where that is more, RMS over the middle. Those of a
/// model are not compared. Throws UnlikeSamples, at rank 0.
void take(TakenImages taken, const GriddingRequest& request, const Ranks& ranks, DirtyImages& made);

}  // namespace misfit::imager
