#pragma once

#include <cmath>
#include <optional>
#include <random>

#include "imager/beams/beam.h"
#include "imager/data/image.h"
#include "imager/files/image_header.h"
#include "imager/files/image_writer.h"

namespace misfit::testing {

/// A small image with something in every field of its header.
inline imager::ImageHeader example_header(int channels, const std::string& stokes = "I") {
  imager::ImageHeader header;
  const double degree = M_PI / 180;
  header.geometry = {7, 4, 0.2 / 3600 * degree, {187.7 * degree, -12.3 * degree, "FK5"}};
  header.spectral = {1.42e9, -15625.5, channels, "LSRK", 1.420405751786e9};
  header.observation = {"EVLA",
                        "me",
                        "M87",
                        "2026-01-31T12:00:00.0",
                        header.geometry.phase_centre,
                        header.spectral.frequency_hz(channels / 2),
                        channels * 15625.5,
                        "LSRK"};
  header.stokes = imager::parse_stokes(stokes);
  header.cards = {{"ERRASKED", 2.5e-7, "accuracy asked"}};
  header.history = {"misfit image " + std::string(200, 'x'), "done"};
  return header;
}

/// Pixels that tell their place and plane, as single precision holds them.
inline imager::Image example_plane(const imager::ImageHeader& header, const imager::PlaneIndex& at) {
  imager::Image image(header.geometry.width, header.geometry.height);
  std::minstd_rand random(static_cast<unsigned>(1 + at.channel * 100 + at.stokes));
  for (double& pixel : image.pixel) pixel = static_cast<float>(static_cast<double>(random()) / 1e9 - 1);
  return image;
}

/// Another beam for each plane.
inline imager::Beam example_beam(const imager::PlaneIndex& at) {
  return {(30 + at.channel) * 1e-6, (20 + at.stokes) * 1e-6, 0.1 * at.channel - 0.4};
}

}  // namespace misfit::testing
