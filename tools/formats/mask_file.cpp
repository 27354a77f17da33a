#include "tools/formats/mask_file.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "imager/files/fits_text.h"
#include "tools/base/files.h"
#include "tools/base/numbers.h"
#include "tools/base/text.h"
#include "tools/formats/image_file.h"

namespace misfit::tools {
namespace {

bool is_image(const std::string& path) {
  std::error_code absent;
  if (std::filesystem::is_directory(path, absent)) return true;
  if (std::filesystem::exists(path, absent) && !std::filesystem::is_regular_file(path, absent))
    throw std::runtime_error("cannot read mask " + path + ": it is no regular file");  // a pipe would give its beginning once
  if (path.ends_with(".fits") || path.ends_with(".fit")) return true;
  std::ifstream file(path, std::ios::binary);
  std::string begin(6, '\0');
  return file.read(begin.data(), 6) && (begin == "SIMPLE" || !imager::compression_of(begin).empty());
}

/// True if a mask is region text in place of a path: as in tclean, where no file has that name.
bool is_text_itself(const std::string& mask) {
  std::error_code reason;
  if (std::filesystem::exists(mask, reason)) return false;
  if (begins_regions(mask)) return true;
  if (!reason) reason = std::make_error_code(std::errc::no_such_file_or_directory);
  throw std::runtime_error("cannot read mask " + mask + ": " + reason.message() +
                           "; expected a FITS or CASA image, a region file, or region text such as circle [[100pix, 80pix], "
                           "20pix]");
}

}  // namespace

MaskFile::MaskFile(const std::string& path, imager::ImageHeader image) : path_(path), image_(std::move(image)) {
  if (is_text_itself(path)) {
    if (path.find_first_of("\r\n") != std::string::npos)
      throw std::runtime_error("mask " + legible(path) + " has several lines; expected one of region text, or a file of them");
    regions_ = std::make_unique<RegionText>("--mask", path, image_);
    return;
  }
  if (!is_image(path)) {
    regions_ = std::make_unique<RegionText>(path, read_file(path), image_);
    return;
  }
  file_ = open_image_file(path, imager::Grids::any);
  const imager::ImageHeader& has = file_->header();
  placement_.emplace(*file_, path, image_);
  channel_for(*file_, "mask " + path, image_.spectral, 0);
  for (const imager::Stokes wanted : image_.stokes)
    if (has.stokes.size() > 1 && std::find(has.stokes.begin(), has.stokes.end(), wanted) == has.stokes.end())
      throw std::runtime_error("mask " + path + " has several planes but none of " + stokes_name(wanted) +
                               "; expected one plane, or one of each of " + stokes_names(image_.stokes));
}

bool MaskFile::one_for_all_channels() const {
  return regions_ ? regions_->one_for_all_channels() : file_->header().spectral.channels == 1;
}

bool MaskFile::one_for_all_stokes() const {
  return regions_ ? regions_->one_for_all_stokes() : file_->header().stokes.size() == 1;
}

imager::Image MaskFile::mask(const imager::PlaneIndex& at) const {
  if (regions_) return regions_->mask(at);
  const std::vector<imager::Stokes>& has = file_->header().stokes;
  const auto plane = std::find(has.begin(), has.end(), image_.stokes.at(static_cast<std::size_t>(at.stokes)));
  return placement_->lay(
      *file_, {one_for_all_channels() ? 0 : at.channel, has.size() == 1 ? 0 : static_cast<int>(plane - has.begin())});
}

std::vector<std::string> MaskFile::doubts() const {
  if (regions_) return regions_->doubts();
  std::vector<std::string> sentences{placement_->sentence(), stokes_doubt(), band_doubt()};
  sentences.erase(std::remove(sentences.begin(), sentences.end(), ""), sentences.end());
  return sentences;
}

std::string MaskFile::stokes_doubt() const {
  const std::vector<imager::Stokes>& has = file_->header().stokes;
  if (has.size() > 1 || has.front() == imager::Stokes::I || image_.stokes == has) return "";
  return "the mask " + path_ + " is of " + stokes_name(has.front()) + ", and is laid on " + stokes_names(image_.stokes);
}

std::string MaskFile::band_doubt() const {
  const imager::Observation &has = file_->header().observation, &image = image_.observation;
  if (!one_for_all_channels() || !bands_apart(has, image)) return "";
  return "the mask " + path_ + " is of " + frequency_text(has.frequency_hz, 6) + ", and the image of " +
         frequency_text(image.frequency_hz, 6) + ": it is laid as it is";
}

imager::Image read_mask(const std::string& path, const imager::ImageGeometry& geometry) {
  return read_masks(path, geometry, {imager::Stokes::I}).front();
}

std::vector<imager::Image> read_masks(const std::string& path, const imager::ImageGeometry& geometry,
                                      const std::vector<imager::Stokes>& stokes) {
  imager::ImageHeader image;
  image.geometry = geometry;
  image.stokes = stokes;
  const MaskFile file(path, image);
  std::vector<imager::Image> masks;
  const int count = file.one_for_all_stokes() ? 1 : static_cast<int>(stokes.size());
  for (int s = 0; s < count; ++s) masks.push_back(file.mask({0, s}));
  return masks;
}

}  // namespace misfit::tools
