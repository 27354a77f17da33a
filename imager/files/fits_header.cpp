#include "imager/files/fits_header.h"

#include <array>
#include <cmath>
#include <optional>

#include "imager/files/fits_spectral.h"
#include "imager/numerics/constants.h"
#include "imager/numerics/julian_date.h"

namespace misfit::imager {
namespace {

constexpr double rad_per_deg = pi / 180;
constexpr const char* moving_key = "TRACKFLD";

/// The frequency axis. Planes that are evenly spaced in wavelength are evenly spaced in optical velocity, which needs a line's
/// rest frequency.
FitsAxis frequency_axis(const SpectralAxis& axis) {
  if (!axis.in_wavelength) return {"FREQ", "Hz", 1, axis.reference_hz, axis.step_hz()};
  const double wavelength_m = speed_of_light_m_s / axis.reference_hz;
  if (!(axis.rest_frequency_hz > 0))
    return {"WAVE", "m", 1, wavelength_m, -wavelength_m * axis.increment_hz / axis.reference_hz};
  const double of_line = axis.rest_frequency_hz / axis.reference_hz;
  return {"VOPT", "m/s", 1, speed_of_light_m_s * (of_line - 1),
          -speed_of_light_m_s * of_line * axis.increment_hz / axis.reference_hz};
}

void write_axes(FitsFile& file, const ImageHeader& header) {
  const ImageGeometry& g = header.geometry;
  const std::array<FitsAxis, 4> axes{{
      {"RA---SIN", "deg", g.centre_column() + 1 + g.centre.l / g.cell_rad, g.phase_centre.ra_rad / rad_per_deg,
       -g.cell_rad / rad_per_deg},
      {"DEC--SIN", "deg", g.centre_row() + 1 - g.centre.m / g.cell_height_rad(), g.phase_centre.dec_rad / rad_per_deg,
       g.cell_height_rad() / rad_per_deg},
      frequency_axis(header.spectral),
      stokes_axis(header.stokes),
  }};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const std::string n = std::to_string(i + 1);
    file.write_text("CTYPE" + n, axes[i].type);
    file.write_text("CUNIT" + n, axes[i].unit);
    file.write_number("CRPIX" + n, axes[i].reference_pixel);
    file.write_number("CRVAL" + n, axes[i].reference_value);
    file.write_number("CDELT" + n, axes[i].increment);
  }
  file.write_number("LONPOLE", 180);
  file.write_number("LATPOLE", g.phase_centre.dec_rad / rad_per_deg);
  file.write_text("RADESYS", g.phase_centre.frame);
  file.write_number("EQUINOX", g.phase_centre.frame == "FK4" ? 1950 : 2000);
}

/// Greisen et al. 2006, section 7; the frame is that of the phase centre's planes, and holds for it alone unless SSYSOBS says
/// the same.
void write_spectral_frame(FitsFile& file, const ImageHeader& header) {
  const SpectralAxis& axis = header.spectral;
  file.write_text("SPECSYS", axis.frame);
  if (!axis.frame.empty() && axis.frame != "TOPOCENT") file.write_text("SSYSOBS", "TOPOCENT", "away from the phase centre too");
  const double rest_hz = axis.rest_frequency_hz > 0 ? axis.rest_frequency_hz : header.observation.frequency_hz;
  file.write_number("RESTFRQ", rest_hz, "Hz");
  const int frame = axis.frame == "LSRK" ? 1 : axis.frame == "BARYCENT" ? 2 : axis.frame == "TOPOCENT" ? 3 : 0;
  if (axis.channels == 1 || axis.in_wavelength || frame == 0 || !(rest_hz > 0)) return;
  file.write_integer("VELREF", 256 + frame, "1 LSR, 2 HEL, 3 OBS; + 256 radio");
  file.write_number("ALTRVAL", speed_of_light_m_s * (1 - axis.reference_hz / rest_hz), "m/s, radio velocity of plane 1");
  file.write_number("ALTRPIX", 1);
}

void write_observation(FitsFile& file, const Observation& observation) {
  file.write_text("TELESCOP", observation.telescope);
  file.write_text("OBSERVER", observation.observer);
  file.write_text("OBJECT", observation.object);
  file.write_text("TIMESYS", "UTC");
  file.write_text("DATE-OBS", observation.date_obs);
  if (const std::optional<double> date = modified_julian_date(observation.date_obs)) file.write_number("MJD-OBS", *date, "d");
  if (!observation.moving_at.empty())
    file.write_text(moving_key, observation.moving_at, "UTC of CRVAL1 and CRVAL2: the image moves with its target");
  file.write_text("ORIGIN", "misfit");
}

Observation read_observation(const FitsFile& file, const SpectralAxis& axis) {
  Observation observation;
  observation.telescope = file.text("TELESCOP");
  observation.observer = file.text("OBSERVER");
  observation.object = file.text("OBJECT");
  observation.date_obs = file.text("DATE-OBS");
  observation.moving_at = file.text(moving_key);
  observation.spectral_frame = axis.frame;
  observation.frequency_hz = axis.band().middle_hz();
  observation.bandwidth_hz = axis.band().width_hz();
  return observation;
}

}  // namespace

void write_header(FitsFile& file, const ImageHeader& header) {
  file.write_text("BUNIT", header.unit);
  file.write_text("BTYPE", header.quantity);
  write_axes(file, header);
  write_spectral_frame(file, header);
  write_observation(file, header.observation);
  if (header.taylor.several()) {
    file.write_integer(taylor_order_key, header.taylor.order, "Taylor term, counted from 0, of");
    file.write_integer(taylor_terms_key, header.taylor.terms, "terms of spectra");
  }
  if (header.flat_noise) file.write_integer(flat_noise_key, 1, "pixels are the sky times sqrt(.weight / its maximum)");
  write_cards(file, header.cards);
}

void write_cards(FitsFile& file, const std::vector<HeaderCard>& cards) {
  for (const HeaderCard& card : cards) file.write_number(card.keyword, card.value, card.comment);
}

ImageHeader read_header(const FitsFile& file, const FitsPlanes& planes) {
  ImageHeader header;
  header.spectral = read_spectral_axis(file, planes);
  header.stokes = read_stokes(file, planes);
  header.observation = read_observation(file, header.spectral);
  header.unit = file.text("BUNIT");
  header.quantity = file.text("BTYPE");
  header.taylor = stated_taylor_term(file.number(taylor_order_key).value_or(0), file.number(taylor_terms_key).value_or(1));
  header.flat_noise = file.number(flat_noise_key).value_or(0) == 1;
  return header;
}

}  // namespace misfit::imager
