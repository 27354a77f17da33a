#include "imager/files/fits_beams.h"

#include <cmath>
#include <vector>

namespace misfit::imager {
namespace {

constexpr double degree = M_PI / 180;
constexpr double arcsec = degree / 3600;

bool need_table(const PlaneBeams& beams) {
  return beams.any() && !beams.shared();
}

void read_table(FitsFile& file, PlaneBeams& beams) {
  const std::size_t planes = static_cast<std::size_t>(beams.channels()) * static_cast<std::size_t>(beams.stokes());
  const auto column = [&](const char* name) { return file.column(name, planes); };
  const std::vector<double> major = column("BMAJ"), minor = column("BMIN"), angle = column("BPA"), channel = column("CHAN"),
                            stokes = column("POL");
  for (std::size_t row = 0; row < major.size(); ++row) {
    if (stands_for_no_beam(major[row])) continue;
    if (!(channel[row] >= 0 && channel[row] < beams.channels() && stokes[row] >= 0 && stokes[row] < beams.stokes()))
      file.fail("row " + std::to_string(row + 1) + " of its table BEAMS is of channel " + std::to_string(channel[row]) +
                ", polarisation " + std::to_string(stokes[row]) + ", which its image does not have");
    beams.at({static_cast<int>(channel[row]), static_cast<int>(stokes[row])}) =
        Beam{major[row] * arcsec, minor[row] * arcsec, angle[row] * degree};
  }
}

}  // namespace

void write_beams(FitsFile& file, const PlaneBeams& beams) {
  if (const std::optional<Beam> beam = beams.shared()) {
    file.write_number("BMAJ", beam->major_rad / degree, "major axis of the beam, FWHM, deg");
    file.write_number("BMIN", beam->minor_rad / degree, "minor axis of the beam, FWHM, deg");
    file.write_number("BPA", beam->position_angle_rad / degree, "position angle, north through east, deg");
  } else if (need_table(beams)) {
    file.write_flag("CASAMBM", true, "the table BEAMS holds the beam of each plane");
  }
}

void write_beam_table(FitsFile& file, const PlaneBeams& beams) {
  if (!need_table(beams)) return;
  std::vector<FitsColumn> table{{"BMAJ", "arcsec", false, {}},
                                {"BMIN", "arcsec", false, {}},
                                {"BPA", "deg", false, {}},
                                {"CHAN", "", true, {}},
                                {"POL", "", true, {}}};
  for (int stokes = 0; stokes < beams.stokes(); ++stokes)
    for (int channel = 0; channel < beams.channels(); ++channel) {
      const Beam beam = beams.at({channel, stokes}).value_or(Beam{no_beam_arcsec * arcsec, no_beam_arcsec * arcsec, 0});
      table[0].values.push_back(beam.major_rad / arcsec);
      table[1].values.push_back(beam.minor_rad / arcsec);
      table[2].values.push_back(beam.position_angle_rad / degree);
      table[3].values.push_back(channel);
      table[4].values.push_back(stokes);
    }
  file.append_table("BEAMS", table);
  file.write_integer("NCHAN", beams.channels(), "channels");
  file.write_integer("NPOL", beams.stokes(), "polarisations");
}

PlaneBeams read_beams(FitsFile& file, int channels, int stokes) {
  PlaneBeams beams(channels, stokes);
  const double major_deg = file.number("BMAJ").value_or(0);
  if (major_deg > 0) {
    const Beam beam{major_deg * degree, file.needed_number("BMIN") * degree, file.number("BPA").value_or(0) * degree};
    for (int channel = 0; channel < channels; ++channel)
      for (int plane = 0; plane < stokes; ++plane) beams.at({channel, plane}) = beam;
  }
  if (file.open_table("BEAMS")) read_table(file, beams);
  file.open_image();
  return beams;
}

}  // namespace misfit::imager
