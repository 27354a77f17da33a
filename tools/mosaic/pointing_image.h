#pragma once

#include <memory>
#include <optional>
#include <string>

#include "imager/files/image_reader.h"

namespace misfit::tools {

/// A plane of an image.
struct KnownPlane {
  imager::Image pixels;  ///< all that are stored, under masks too; NaN where there is none
  imager::Image shown;   ///< NaN where a mask leaves a pixel out
};

/// An image that a mosaic is made of, with what lies beside it by its name: of X.image.fits X.pb.fits and X.residual.fits, of
/// the CASA image X.image X.pb and X.residual, the same of X.image.tt0, and of WSClean's X-image.fits X-residual.fits.
class PointingImage {
 public:
  /// Opens it. Throws std::runtime_error that names the file and what was expected, where it cannot be read, is divided by the
  /// primary beam, a mosaic or a Taylor term above 0, is not in Jy/beam, does not say where it lies on the sky, has no
  /// restoring beam, or a residual beside it has other planes.
  explicit PointingImage(const std::string& path);

  const std::string& path() const { return path_; }
  const imager::ImageHeader& header() const { return reader_->header(); }
  const imager::ImageReader& reader() const { return *reader_; }
  const imager::SkyGrid& grid() const { return *reader_->grid(); }
  std::optional<imager::Beam> beam(const imager::PlaneIndex& at) const { return reader_->beam(at); }
  KnownPlane read(const imager::PlaneIndex& at) const;

  /// Where its .pb would lie; empty where its name does not tell.
  const std::string& beam_path() const { return beam_path_; }
  /// Where the residual lies; empty where there is none.
  const std::string& residual_path() const { return residual_path_; }
  imager::Image read_residual(const imager::PlaneIndex& at) const { return residual_->read(at); }
  const imager::SkyGrid& residual_grid() const { return *residual_->grid(); }

 private:
  void find_residual();

  std::string path_;
  std::string beam_path_;
  std::string residual_path_;
  std::unique_ptr<imager::ImageReader> reader_;
  std::unique_ptr<imager::ImageReader> stored_;  ///< without its mask; null where files have none
  std::unique_ptr<imager::ImageReader> residual_;
};

/// Throws std::runtime_error where an image cannot be added to the other: it has other frequencies or Stokes parameters.
void require_alike(const PointingImage& image, const PointingImage& other);

}  // namespace misfit::tools
