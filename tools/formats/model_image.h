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

/// Throws std::runtime_error where an image is one of several Taylor terms: by its header, see imager::TaylorTerm, or by its
/// name, that of a file which a link leads to included: x.model.tt0.fits, x_tt0.fits, or as a CASA image x.model.tt1. Models of
/// one term alone are read, and without the others it is half a model. Says which are left out, as far as they lie beside it,
/// and what can be done.
void refuse_taylor_term(const imager::ImageReader& file, const std::string& path);

/// Throws std::runtime_error where an image states, the same ways, that it is another Taylor term of this expansion than the
/// one of this order, or one about another frequency.
void require_taylor_term(const imager::ImageReader& file, const std::string& path, int order,
                         const imager::TaylorExpansion& expansion);

/// A model of one frequency, an image in Jy/pixel with a finite number in every pixel above the horizon and nothing beyond,
/// from the file at `path`: a plane for each Stokes parameter that it holds. Throws std::runtime_error that names the file and
/// what was expected, and what refuse_taylor_term() does.
std::vector<imager::SkyImage> read_stokes_model(const imager::ImageReader& file, const std::string& path);

/// A channel of a file of this name.
struct ModelChannel {
  std::string path;
  int channel = 0;
};

/// The same of one channel of a model with several; see channel_for() in image_file.h.
std::vector<imager::SkyImage> read_model_channel(const imager::ImageReader& file, const ModelChannel& of);

/// A mosaic's model, whose header says that it is the sky times the mosaic's primary beam, becomes that of the sky: its pixels
/// are divided by √(W / max W) of the .weight W beside it. Throws std::runtime_error where there is none such.
void divide_by_sensitivity(std::vector<imager::SkyImage>& planes, const ModelChannel& of);

/// That the model at `path` is of other frequencies than the data, in words; empty where it is not, see bands_apart().
std::string band_warning(const imager::Observation& model, const imager::Observation& data, const std::string& path);

/// What is wrong by at most with visibilities of `set` that are predicted from the file's pixels, in words, where they do not
/// lie on an upright grid in SIN (see imager::UprightGeometry) but near enough to be taken for that: 2π · baseline · distance,
/// as a part of the model's flux. Empty where that is far below the accuracy asked.
std::string misplacement_warning(const imager::ImageReader& file, const std::string& path, const ms_io::MeasurementSet& set,
                                 double accuracy);

/// A model as an operator from coordinates to visibilities.
struct ModelVisibilities {
  std::unique_ptr<imager::Transform> transform;                    // outlives the prediction
  std::array<std::unique_ptr<imager::Prediction>, 4> predictions;  ///< of I, Q, U, V; null where that is 0
  ms_io::Predict predict;
  std::uint64_t samples_at_once = ms_io::MeasurementSet::usual_block_samples;
};

/// The planes of a model, I, Q, U and V; null where one is 0.
using StokesPlanes = std::array<const imager::Image*, 4>;

/// The Taylor terms of a model after the first, which its planes are.
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
