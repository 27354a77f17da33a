#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "imager/files/fits_file.h"

namespace misfit::tools::testing {

/// A beam's FITS file of 121 by 121 pixels, and its cards.
struct BeamFile {
  static constexpr int side = 121;

  std::string type = "X";
  std::string unit = "deg";
  double step = 0.02;
  double east = 1;  ///< sign of CDELT1
  double reference = 61;
  double rotation = 0;
  std::vector<double> frequencies_hz{1.4e9};  ///< evenly spaced; none: no axis
  std::string frequency_unit = "Hz";          ///< in which they are
};

/// The second axis' type.
inline std::string second_type(const std::string& first) {
  return first.rfind("RA", 0) == 0 ? "DEC--SIN" : first == "AZ" ? "EL" : first == "L" ? "M" : "Y";
}

/// Of a function of what axes count to the east and to the north, in their unit, and the frequency.
inline void write_beam_file(const std::string& path, const BeamFile& beam,
                            const std::function<double(double east, double north, double hz)>& value) {
  imager::FitsFile file("write", path);
  std::filesystem::remove(path);
  file.create(path);
  std::vector<long> size{BeamFile::side, BeamFile::side};
  const auto planes = static_cast<long>(beam.frequencies_hz.size());
  if (planes > 0) size.push_back(planes);
  file.create_image(size, imager::PixelFormat::float64);
  for (const char* axis : {"1", "2"}) {
    file.write_text("CTYPE" + std::string(axis), *axis == '1' ? beam.type : second_type(beam.type));
    file.write_text("CUNIT" + std::string(axis), beam.unit);
    file.write_number("CRPIX" + std::string(axis), beam.reference);
    file.write_number("CRVAL" + std::string(axis), 0);
  }
  if (beam.rotation != 0) file.write_number("CROTA2", beam.rotation);
  file.write_number("CDELT1", beam.east * beam.step);
  file.write_number("CDELT2", beam.step);
  if (planes > 0) {
    file.write_text("CTYPE3", "FREQ");
    file.write_text("CUNIT3", beam.frequency_unit);
    file.write_number("CRPIX3", 1);
    file.write_number("CRVAL3", beam.frequencies_hz.front());
    file.write_number("CDELT3", planes > 1 ? beam.frequencies_hz[1] - beam.frequencies_hz[0] : 1e6);
  }
  std::vector<double> pixels;
  for (std::size_t k = 0; k < std::max<std::size_t>(1, beam.frequencies_hz.size()); ++k)
    for (int r = 0; r < BeamFile::side; ++r)
      for (int c = 0; c < BeamFile::side; ++c)
        pixels.push_back(value(beam.east * beam.step * (c + 1 - beam.reference), beam.step * (r + 1 - beam.reference),
                               planes > 0 ? beam.frequencies_hz[k] : 0));
  file.write_pixels(std::vector<long>(size.size(), 1), pixels);
  file.close();
}

}  // namespace misfit::tools::testing
