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
/// their peak, dirty images by 1e-2 of their RMS, or ten times the accuracy where that is more, RMS over the middle. Returns
/// the middles of dirty images [Stokes] where those of a model are taken, which are not compared here. Throws UnlikeSamples, at
/// rank 0.
std::vector<Image> take(TakenImages taken, const GriddingRequest& request, const Ranks& ranks, DirtyImages& made);

/// A model, and what is known of its residual.
struct ModelResidual {
  std::vector<const Image*> model;  ///< Jy/pixel [term]
  std::vector<const Image*> psf;    ///< [k], see CleanInput; that of k = t is the response to term t
  const Image& dirty_middle;        ///< of the data
};

/// Compares a residual of a model with D − Σ_t P_t ⋆ I_t in its middle, which without w is what that model leaves, to the error
/// of the PSF times the model's flux and what take() bears. Throws UnlikeSamples.
void require_residual_of(const ModelResidual& of, const GriddingRequest& request, std::size_t stokes, const Image& residual);

}  // namespace misfit::imager
