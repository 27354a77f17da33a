#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "imager/files/image_header.h"
#include "imager/files/image_writer.h"
#include "tools/drawing/pictures.h"
#include "tools/run/image_options.h"
#include "tools/run/run_report.h"

namespace misfit::tools {

/// Header cards for the errors and the noise that are known; of errors the largest of all Stokes parameters.
std::vector<imager::HeaderCard> error_cards(const RunReport& report);

/// What one picture of a run shows.
struct ProductPicture {
  std::string name;  ///< the middle of its file's name
  std::string title;
  std::string unit = "Jy/beam";
  Shades shades = Shades::brightness;
  const imager::Image* image = nullptr;
  const Sketch* sketch = nullptr;       ///< in place of an image that is gone
  const imager::Image* mask = nullptr;  ///< outlined
};

/// The images of a run, as files and as pictures. What is set applies to those that come afterwards.
class ImageProducts {
 public:
  /// Files are of the format that --outformat names, see image_files.h, and 64-bit when the accuracy asked is below 1e-7,
  /// 32-bit otherwise.
  ImageProducts(const ImageOptions& options, const imager::ImageGeometry& geometry, const imager::Observation& observation);

  void set_stokes(const std::vector<imager::Stokes>& stokes) { header_.stokes = stokes; }
  void set_history(std::vector<std::string> lines) { header_.history = std::move(lines); }
  void set_cards(std::vector<imager::HeaderCard> cards) { header_.cards = std::move(cards); }
  /// What pixels are of, see imager::ImageHeader.
  void set_quantity(const std::string& quantity) { header_.quantity = quantity; }
  void set_taylor_term(const imager::TaylorTerm& term) { header_.taylor = term; }
  void set_beam(const imager::Beam& beam) { beam_ = beam; }

  /// Images for write(), as files of the name <imagename>.<name>: of the Stokes parameters in their order, or one that serves
  /// all.
  void add(const std::string& name, const std::string& unit, std::vector<imager::Image> images);
  void write() const;
  /// The paths that write() writes.
  std::vector<std::string> paths() const;

  /// Begins to draw <imagename>.<name>.png while the caller does other things; images are looked at until it returns.
  void draw(const std::vector<ProductPicture>& pictures);
  /// The same of where samples lie, as <imagename>.uv.png.
  void draw(const imager::UvCoverage& coverage);
  /// Returns what PictureDrawing::finish() does.
  std::string finish_pictures() { return drawing_.finish(); }
  /// Title and path of each picture, the last first.
  std::vector<std::pair<std::string, std::string>> pictures() const;

 private:
  struct File {
    std::string name;
    imager::ImageHeader header;
    std::vector<imager::Image> planes;  ///< [Stokes]
  };

  std::string imagename_;
  std::string outformat_;
  imager::PixelFormat format_;
  imager::ImageHeader header_;
  std::optional<imager::Beam> beam_;
  std::vector<File> files_;
  PictureDrawing drawing_;
  std::vector<std::pair<std::string, std::string>> titles_and_paths_;
};

}  // namespace misfit::tools
