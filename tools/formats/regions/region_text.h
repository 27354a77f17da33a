#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "imager/data/image.h"
#include "imager/files/image_header.h"
#include "imager/files/image_reader.h"
#include "tools/formats/regions/region.h"

namespace misfit::tools {

/// The regions of a text in CASA's format or DS9's (see regions/crtf.h, regions/ds9.h), as masks of an image. A text is DS9's
/// if its header says so, or its first region has no square brackets.
///
/// A region adds the pixels whose centres lie within it or on its border, in the planes that it names. A region that is taken
/// away takes them from the regions before it, or, if it is the first, from the whole image; DS9's are taken away last.
class RegionText {
 public:
  /// Throws std::runtime_error that names the file `path`, the line and what was expected; so, too, where there is no region,
  /// or none of a plane of the image.
  RegionText(const std::string& path, std::string_view text, const imager::ImageHeader& image);

  /// True if no region is of some planes alone.
  bool one_for_all_channels() const;
  bool one_for_all_stokes() const;
  /// 1 in pixels of a plane that the regions allow, 0 elsewhere.
  imager::Image mask(const imager::PlaneIndex& at) const;
  /// Sentences on the parts of the text without a pixel of the image, with their lines.
  const std::vector<std::string>& doubts() const { return doubts_; }

 private:
  void read_lines(const std::string& path, std::string_view text, regions::RegionReader& reader);
  void look_for_pixels(const std::string& path, const std::vector<imager::Stokes>& stokes);

  using Lines = std::map<std::string, std::vector<int>>;

  int width_;
  int height_;
  int channels_;
  std::vector<regions::Region> regions_;
  Lines passed_over_;  ///< of shapes without an area, by name
  std::vector<std::string> doubts_;
};

/// True if `text` begins as regions do and paths do not: with one of the formats' first lines, a shape and a bracket, or a
/// frame of DS9's, or `global`, and a semicolon.
bool begins_regions(std::string_view text);

}  // namespace misfit::tools
