#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "imager/files/fits_image.h"
#include "imager/plan/gridding_choice.h"
#include "imager/taylor/taylor_expansion.h"
#include "imager/transform/transform.h"
#include "ms_io/measurement_set.h"
#include "ms_io/model_writer.h"

namespace misfit::tools {

/// Throws std::runtime_error where an image is one of several Taylor terms, which alone is half a model: by its header, see
/// imager::TaylorTerm, or by its name or the name behind a link: x.model.tt0.fits, x_tt0.fits, or as a CASA image x.model.tt1.
/// The error names other terms that lie beside it, and says what can be done.
void refuse_taylor_term(const imager::ImageReader& file, const std::string& path);

/// Throws std::runtime_error where an image states, by its header or name, that it is another Taylor term than the one of this
/// order in this expansion, or a term about another frequency.
void require_taylor_term(const imager::ImageReader& file, const std::string& path, int order,
                         const imager::TaylorExpansion& expansion);

/// A model of one frequency, an image in Jy/pixel with a finite number in every pixel above the horizon and nothing beyond,
/// from the file at `path`: a plane for each Stokes parameter that it holds. Throws std::runtime_error that names the file and
/// what was expected; so does refuse_taylor_term(), which it calls.
std::vector<imager::SkyImage> read_stokes_model(const imager::ImageReader& file, const std::string& path);

/// A channel of the file at `path`.
struct ModelChannel {
  std::string path;
  int channel = 0;
};

/// The model in one channel of a file with several, a plane for each Stokes parameter; see channel_for() in image_file.h.
std::vector<imager::SkyImage> read_model_channel(const imager::ImageReader& file, const ModelChannel& of);

/// Makes a model of the sky from a mosaic's model, whose header says that it is the sky times the mosaic's primary beam:
/// divides its pixels by √(W / max W) of the .weight W beside it. Throws std::runtime_error where there is no such .weight.
void divide_by_sensitivity(std::vector<imager::SkyImage>& planes, const ModelChannel& of);

/// A sentence where the model at `path` is of other frequencies than the data, see bands_apart(); else empty.
std::string band_warning(const imager::Observation& model, const imager::Observation& data, const std::string& path);

/// The largest error, in words, of visibilities of `set` that are predicted from the file's pixels, where these lie not on, but
/// near enough to an upright grid in SIN (see imager::UprightGeometry): 2π · baseline · distance, as a part of the model's
/// flux. Empty where that is far below the accuracy asked.
std::string misplacement_warning(const imager::ImageReader& file, const std::string& path, const ms_io::MeasurementSet& set,
                                 double accuracy);

/// A model as an operator from coordinates to visibilities.
struct ModelVisibilities {
  std::unique_ptr<imager::Transform> transform;                    // outlives the prediction
  std::array<std::unique_ptr<imager::Prediction>, 4> predictions;  ///< of I, Q, U, V; null where the plane is 0
  ms_io::Predict predict;
  std::uint64_t samples_at_once = ms_io::MeasurementSet::usual_block_samples;
};

/// The planes of a model, I, Q, U and V; null where one is 0.
using StokesPlanes = std::array<const imager::Image*, 4>;

/// The Taylor terms of a model after the first term, which is its planes.
struct TaylorTerms {
  imager::TaylorExpansion expansion;
  std::array<std::vector<const imager::Image*>, 4> further;  ///< [plane][term − 1]; empty where there is one term
};

/// `request` for a prediction of an image at all selected samples of `set`, flagged or not.
imager::GriddingRequest prediction_request(imager::GriddingRequest request, const imager::ImageGeometry& geometry,
                                           const ms_io::MeasurementSet& set);

/// The visibilities of a model at all selected samples of `set`, flagged or not, as `request` would have them gridded.
ModelVisibilities image_visibilities(const StokesPlanes& model, const imager::ImageGeometry& geometry,
                                     const imager::GriddingRequest& request, const ms_io::MeasurementSet& set,
                                     const TaylorTerms& taylor = {});

}  // namespace misfit::tools
