#include "tools/mosaic/pointing_image.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "tools/base/numbers.h"
#include "tools/formats/image_file.h"
#include "tools/run/image_files.h"

namespace misfit::tools {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& has, const std::string& expected) {
  throw std::runtime_error(path + " " + has + "; expected " + expected);
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

std::string without_slash(std::string path) {
  while (path.size() > 1 && path.back() == '/') path.pop_back();
  return path;
}

bool is_there(const std::string& path) {
  std::error_code absent;
  return !path.empty() && std::filesystem::exists(path, absent);
}

/// The path of a product of the same run; empty where the image's name does not tell, or the program makes none.
std::string beside(const std::string& path, const std::string& product) {
  for (const std::string end : {"", ".fits", ".tt0", ".tt0.fits"})
    if (const std::string image = ".image" + end; path.ends_with(image))
      return path.substr(0, path.size() - image.size()) + "." + product + end;
  const std::string of_wsclean = "-image.fits";
  if (product == "residual" && path.ends_with(of_wsclean))
    return path.substr(0, path.size() - of_wsclean.size()) + "-residual.fits";
  return "";
}

/// Checks an image by its name, and by the files beside it.
void check_name(const std::string& path) {
  const std::string name = path.substr(path.rfind('/') == std::string::npos ? 0 : path.rfind('/') + 1);
  const bool of_wsclean = name.ends_with("-image-pb.fits");
  if (lower(name).find("pbcor") != std::string::npos || of_wsclean)
    refuse(path, "is divided by the primary beam, by its name", "the image before that, such as X.image.fits");
  if (const std::string weight = beside(path, "weight"); is_there(weight) && is_own_image(path))
    refuse(path, "is a mosaic already, as " + weight + " beside it says", "the images that it was made of");
}

void check_alone(const imager::ImageReader& file, const std::string& path) {
  const imager::ImageHeader& header = file.header();
  if (lower(header.unit) != "jy/beam") refuse(path, "has the unit " + (header.unit.empty() ? "none" : header.unit), "Jy/beam");
  if (header.taylor.order > 0)
    refuse(path, "is Taylor term " + std::to_string(header.taylor.order) + " by its header, which is no brightness", "term 0");
  if (!file.grid()) refuse(path, "does not say where its pixels lie on the sky", "right ascension and declination");
  if (!header.observation.moving_at.empty())
    refuse(path, "moves along with its field (TRACKFLD is " + header.observation.moving_at + ")", "one that stands still");
  for (int channel = 0; channel < header.spectral.channels; ++channel)
    for (int stokes = 0; stokes < static_cast<int>(header.stokes.size()); ++stokes)
      if (file.beam({channel, stokes})) return;
  refuse(path, "has no restoring beam in its header", "BMAJ, BMIN and BPA, or those of each plane");
}

}  // namespace

PointingImage::PointingImage(const std::string& path) : path_(without_slash(path)), beam_path_(beside(path_, "pb")) {
  check_name(path_);
  reader_ = open_image_file(path_, imager::Grids::any);
  check_alone(*reader_, path_);
  std::error_code absent;
  if (std::filesystem::is_directory(path_, absent)) stored_ = open_image_file(path_, imager::Grids::any, ms_io::Masks::ignored);
  find_residual();
}

void PointingImage::find_residual() {
  const std::string path = beside(path_, "residual");
  if (!is_there(path)) return;
  residual_ = open_image_file(path, imager::Grids::any);
  residual_path_ = path;
  const imager::ImageHeader &has = residual_->header(), &image = header();
  if (!residual_->grid()) refuse(path, "does not say where its pixels lie on the sky", "right ascension and declination");
  if (has.spectral.channels != image.spectral.channels || has.stokes != image.stokes)
    refuse(
        path,
        "has " + std::to_string(has.spectral.channels) + " planes of frequency, of Stokes " + imager::stokes_names(has.stokes),
        std::to_string(image.spectral.channels) + " of " + imager::stokes_names(image.stokes) + " as " + path_ +
            " has, to measure its noise; or --rms");
}

KnownPlane PointingImage::read(const imager::PlaneIndex& at) const {
  KnownPlane plane{reader_->read(at), {}};
  plane.shown = plane.pixels;
  if (stored_ != nullptr) plane.pixels = stored_->read(at);
  return plane;
}

void require_alike(const PointingImage& image, const PointingImage& other) {
  const imager::ImageHeader &has = image.header(), &first = other.header();
  if (has.stokes != first.stokes)
    refuse(image.path(), "has Stokes " + imager::stokes_names(has.stokes),
           imager::stokes_names(first.stokes) + " as " + other.path() + " has");
  if (has.spectral.channels != first.spectral.channels)
    refuse(image.path(), "has " + std::to_string(has.spectral.channels) + " planes of frequency",
           std::to_string(first.spectral.channels) + " as " + other.path() + " has");
  if (has.spectral.channels > 1) channel_for(image.reader(), image.path(), first.spectral, 0);
  if (bands_apart(has.observation, first.observation))
    refuse(image.path(), "is of " + frequency_text(has.observation.frequency_hz, 6),
           frequency_text(first.observation.frequency_hz, 6) + " as " + other.path() + " is");
}

}  // namespace misfit::tools
