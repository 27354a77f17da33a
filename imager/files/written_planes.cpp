#include "imager/files/written_planes.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

namespace misfit::imager {
namespace {

std::string by(int width, int height) {
  return std::to_string(width) + " × " + std::to_string(height);
}

}  // namespace

WrittenPlanes::WrittenPlanes(const ImageHeader& header)
    : width_(header.geometry.width),
      height_(header.geometry.height),
      beams_(header.spectral.channels, static_cast<int>(header.stokes.size())),
      written_(static_cast<std::size_t>(header.spectral.channels) * header.stokes.size()) {
  if (width_ < 1 || height_ < 1 || written_.empty())
    throw std::invalid_argument("an image of " + by(width_, height_) + " pixels, " + std::to_string(header.spectral.channels) +
                                " channels and " + std::to_string(header.stokes.size()) +
                                " Stokes parameters; expected one of each at least");
}

void WrittenPlanes::add(const PlaneIndex& at, const Image& image, const std::optional<Beam>& beam) {
  const std::string which =
      "plane of channel " + std::to_string(at.channel) + ", Stokes parameter " + std::to_string(at.stokes);
  if (at.channel < 0 || at.channel >= beams_.channels() || at.stokes < 0 || at.stokes >= beams_.stokes())
    throw std::invalid_argument(which + " of an image of " + std::to_string(beams_.channels()) + " channels and " +
                                std::to_string(beams_.stokes()) + " Stokes parameters, counted from 0");
  if (image.width != width_ || image.height != height_)
    throw std::invalid_argument(which + " has " + by(image.width, image.height) + " pixels; expected " + by(width_, height_));
  if (written_[place(at)]) throw std::invalid_argument(which + " written twice; expected each plane once");
  written_[place(at)] = true;
  beams_.at(at) = beam;
}

std::size_t WrittenPlanes::place(const PlaneIndex& at) const {
  return static_cast<std::size_t>(at.channel) * static_cast<std::size_t>(beams_.stokes()) + static_cast<std::size_t>(at.stokes);
}

std::vector<PlaneIndex> WrittenPlanes::missing() const {
  std::vector<PlaneIndex> planes;
  for (int channel = 0; channel < beams_.channels(); ++channel)
    for (int stokes = 0; stokes < beams_.stokes(); ++stokes)
      if (!written_[place({channel, stokes})]) planes.push_back({channel, stokes});
  return planes;
}

Image WrittenPlanes::blank() const {
  Image image(width_, height_);
  std::fill(image.pixel.begin(), image.pixel.end(), std::numeric_limits<double>::quiet_NaN());
  return image;
}

}  // namespace misfit::imager
