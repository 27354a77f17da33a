#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "imager/files/image_header.h"
#include "imager/files/image_reader.h"
#include "tools/formats/mask_placement.h"
#include "tools/formats/regions/region_text.h"

namespace misfit::tools {

/// A file that says where CLEAN may take components from in the planes of an image: a FITS or CASA image, whose pixels that are
/// neither 0 nor NaN are allowed, wherever they lie (see mask_placement.h), with one plane for all or one for each, along the
/// spectral axis and that of Stokes parameters alike; or region text, see regions/region_text.h.
class MaskFile {
 public:
  /// The masks of an image with these pixels, planes and Stokes parameters. `path` may be a line of region text itself, as in
  /// tclean, such as circle [[100pix, 80pix], 20pix], where no file has that name. Throws std::runtime_error that names the
  /// file and what was expected.
  MaskFile(const std::string& path, imager::ImageHeader image);

  const std::string& path() const { return path_; }
  /// Null where it is region text.
  const imager::ImageReader* file() const { return file_.get(); }
  bool one_for_all_channels() const;
  bool one_for_all_stokes() const;
  /// The mask of a plane of the image: 1 where CLEAN may take components from, 0 elsewhere.
  imager::Image mask(const imager::PlaneIndex& at) const;
  /// Sentences for the user on the mask's place, its Stokes parameter and band, and its regions without a pixel of the image.
  std::vector<std::string> doubts() const;

 private:
  /// These say that a mask of one plane is of another Stokes parameter than the image, or of another band; else empty.
  std::string stokes_doubt() const;
  std::string band_doubt() const;

  std::string path_;
  imager::ImageHeader image_;
  std::unique_ptr<imager::ImageReader> file_;  ///< null where the file is region text
  std::optional<MaskPlacement> placement_;     ///< of the file's image
  std::unique_ptr<RegionText> regions_;        ///< null where it is an image
};

/// The mask of an image of one plane.
imager::Image read_mask(const std::string& path, const imager::ImageGeometry& geometry);

/// The masks of an image of one frequency: one for all of these Stokes parameters, or one for each where the file has one of
/// each.
std::vector<imager::Image> read_masks(const std::string& path, const imager::ImageGeometry& geometry,
                                      const std::vector<imager::Stokes>& stokes);

}  // namespace misfit::tools
