#pragma once

#include <memory>
#include <string>
#include <vector>

#include "imager/clean/components.h"
#include "imager/files/image_header.h"
#include "imager/files/image_reader.h"
#include "imager/transform/normalisation.h"
#include "tools/run/image_options.h"

namespace misfit::tools {

/// The model that CLEAN begins with, --startmodel: an image in Jy/pixel of the pixels of the image, or one for each Taylor
/// term.
class StartModel {
 public:
  /// Opens the files of --startmodel, for an image with these planes and Stokes parameters. Throws std::runtime_error that
  /// names the file and what was expected.
  StartModel(const ImageOptions& options, const imager::ImageHeader& image);

  /// Sentences for the user on the files.
  std::vector<std::string> remarks() const;
  /// Reads a channel of the image's. Throws as the constructor does.
  void read(int channel);
  /// The images of a Stokes parameter, [term].
  std::vector<const imager::Image*> images(std::size_t stokes) const;
  /// Turns the images of a Stokes parameter, of the sky, into what a mosaic of this view has for the sky; what no beam sees
  /// becomes 0.
  void see_through(const imager::MosaicView& view, std::size_t stokes);
  /// The components of a Stokes parameter; its images are then freed.
  std::vector<imager::Component> take(std::size_t stokes);

 private:
  struct File {
    std::string path;
    std::string name;  ///< "start model a.fits"
    std::unique_ptr<imager::ImageReader> reader;
  };

  std::vector<imager::Image> planes_of(const File& file, int channel) const;

  const ImageOptions& o_;
  imager::ImageHeader image_;
  std::vector<File> files_;                         ///< [term]
  std::vector<std::vector<imager::Image>> images_;  ///< [term][Stokes]
};

}  // namespace misfit::tools
