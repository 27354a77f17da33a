#pragma once

#include <optional>
#include <string>
#include <vector>

#include "imager/fits_image.h"
#include "tools/pictures.h"
#include "tools/run_report.h"

namespace misfit::tools {

/// Header cards for the errors that are known.
std::vector<imager::HeaderCard> error_cards(const RunReport& report);

/// What one image of a run is.
struct ProductKind {
  std::string name;   ///< the middle of its files' names
  std::string title;  ///< of its picture; without one it is not drawn
  std::string unit;
  Shades shades = Shades::brightness;
};

/// The images of a run, as files and as pictures. What is set applies to images added afterwards.
class ImageProducts {
 public:
  /// Files are 64-bit when the accuracy asked is below 1e-7, 32-bit otherwise.
  ImageProducts(std::string imagename, const imager::ImageGeometry& geometry, const imager::Observation& observation,
                double accuracy);

  void set_history(const std::string& line) { common_.history = {line}; }
  void set_cards(std::vector<imager::HeaderCard> cards) { common_.cards = std::move(cards); }
  void set_beam(const imager::Beam& beam);
  void add(const ProductKind& kind, imager::Image image);
  /// A picture of an image that is gone, and has no file.
  void add_picture(const ProductKind& kind, Sketch sketch);

  /// Writes <imagename>.<kind>.fits for each image.
  void write() const;
  /// Pictures to draw as <imagename>.<kind>.png, the last added first; they last as long as these products.
  /// An image of kind "mask" is outlined in all of them but the PSF.
  std::vector<Picture> pictures() const;

 private:
  struct Product {
    ProductKind kind;
    imager::SkyImage image;
    std::optional<Sketch> sketch;  ///< where there is no image
  };
  std::string path(const Product& product, const std::string& extension) const {
    return imagename_ + "." + product.kind.name + "." + extension;
  }

  std::string imagename_;
  imager::PixelFormat format_;
  imager::SkyImage common_;
  std::vector<Product> products_;
};

}  // namespace misfit::tools
