#include "imager/files/fits_spectral.h"

#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "imager/numerics/constants.h"

namespace misfit::imager {
namespace {

/// The quantity in which a spectral axis counts.
enum class Quantity { frequency, radio, optical, relativistic, redshift, wavelength };

struct Named {
  std::string_view name;  ///< the first four letters of CTYPE
  Quantity quantity;
};
constexpr std::array<Named, 7> quantities{{{"FREQ", Quantity::frequency},
                                           {"VRAD", Quantity::radio},
                                           {"VELO", Quantity::relativistic},
                                           {"VOPT", Quantity::optical},
                                           {"FELO", Quantity::optical},
                                           {"ZOPT", Quantity::redshift},
                                           {"WAVE", Quantity::wavelength}}};

/// AIPS's names of frames, VELREF's numbers of them, and FITS's names.
struct Frame {
  std::string_view aips;
  int velref;
  const char* specsys;
};
constexpr std::array<Frame, 8> frames{{{"LSR", 1, "LSRK"},
                                       {"LSRK", 1, "LSRK"},
                                       {"HEL", 2, "BARYCENT"},
                                       {"OBS", 3, "TOPOCENT"},
                                       {"LSD", 4, "LSRD"},
                                       {"GEO", 5, "GEOCENTR"},
                                       {"SOU", 6, "SOURCE"},
                                       {"GAL", 7, "GALACTOC"}}};

/// "VELO" and "HEL" of VELO-HEL.
std::pair<std::string_view, std::string_view> parts_of(std::string_view type) {
  return {type.substr(0, 4), type.substr(type.size() > 5 ? 5 : type.size())};
}

const Frame* frame_named(std::string_view aips) {
  for (const Frame& frame : frames)
    if (frame.aips == aips) return &frame;
  return nullptr;
}

/// The frequencies that one axis states.
class Spectral {
 public:
  Spectral(const FitsFile& file, FitsAxis axis, double rest_hz) : file_(file), axis_(std::move(axis)), rest_hz_(rest_hz) {
    const auto [name, behind] = parts_of(axis_.type);
    for (const Named& known : quantities)
      if (known.name == name) quantity_ = known.quantity;
    const int velref = static_cast<int>(file.number("VELREF").value_or(0));
    if ((name == "VELO" || name == "FELO") && velref != 0) quantity_ = velref > 256 ? Quantity::radio : Quantity::optical;
    in_frequency_ = behind == "F2W" || behind == "F2V" || name == "FELO";
    const double unit = unit_of();
    axis_.reference_value *= unit;
    axis_.increment *= unit;
    const bool rest_counts = quantity_ != Quantity::frequency && quantity_ != Quantity::wavelength;
    if (rest_counts && !(rest_hz > 0))
      file.fail("its " + axis_.type + " axis has no RESTFRQ; expected the rest frequency of the line whose velocity it is");
  }

  void set(SpectralAxis& spectral) const {
    const bool even = in_frequency_ || quantity_ == Quantity::frequency || quantity_ == Quantity::radio;
    spectral.in_wavelength = spectral.channels > 1 && !even;
    if (spectral.in_wavelength && quantity_ == Quantity::relativistic)
      file_.fail(
          "its " + std::to_string(spectral.channels) + " planes of " + axis_.type +
          " are evenly spaced neither in frequency nor in wavelength; expected an axis of FREQ, VRAD, VOPT, ZOPT or WAVE");
    const double pixels = 1 - axis_.reference_pixel;  // from the reference to the first plane
    if (even) {
      spectral.increment_hz = axis_.increment * slope_at(axis_.reference_value);
      spectral.reference_hz = frequency_hz(axis_.reference_value) + pixels * spectral.increment_hz;
    } else {
      const double value = axis_.reference_value + pixels * axis_.increment;
      spectral.increment_hz = axis_.increment * slope_at(value);
      spectral.reference_hz = frequency_hz(value);
    }
    const bool finite = std::isfinite(spectral.reference_hz) && std::isfinite(spectral.frequency_hz(spectral.channels - 1));
    if (!finite) file_.fail("its " + axis_.type + " axis has frequencies that are not finite");
  }

 private:
  /// Hz, m/s, m or 1 in one of the axis's unit.
  double unit_of() const {
    using Units = std::pair<std::string_view, double>;
    static constexpr std::array<Units, 4> hz{{{"Hz", 1}, {"kHz", 1e3}, {"MHz", 1e6}, {"GHz", 1e9}}};
    static constexpr std::array<Units, 4> m_s{{{"m/s", 1}, {"m s-1", 1}, {"km/s", 1e3}, {"km s-1", 1e3}}};
    static constexpr std::array<Units, 4> m{{{"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}}};
    const auto among = [&](const std::array<Units, 4>& units, const std::string& expected) {
      for (const auto& [name, value] : units)
        if (axis_.unit == name) return value;
      if (axis_.unit.empty()) return 1.0;
      file_.fail("its " + axis_.type + " axis has the unit " + axis_.unit + "; expected " + expected);
    };
    if (quantity_ == Quantity::frequency) return among(hz, "Hz, kHz, MHz or GHz");
    if (quantity_ == Quantity::wavelength) return among(m, "m, cm, mm or um");
    if (quantity_ != Quantity::redshift) return among(m_s, "m/s or km/s");
    if (!axis_.unit.empty()) file_.fail("its " + axis_.type + " axis has the unit " + axis_.unit + "; expected none");
    return 1;
  }

  double frequency_hz(double value) const {
    const double beta = value / speed_of_light_m_s;
    switch (quantity_) {
      case Quantity::radio:
        return rest_hz_ * (1 - beta);
      case Quantity::optical:
        return rest_hz_ / (1 + beta);
      case Quantity::relativistic:
        return rest_hz_ * std::sqrt((1 - beta) / (1 + beta));
      case Quantity::redshift:
        return rest_hz_ / (1 + value);
      case Quantity::wavelength:
        return speed_of_light_m_s / value;
      default:
        return value;
    }
  }

  /// dν/dx at x.
  double slope_at(double value) const {
    const double c = speed_of_light_m_s, beta = value / c;
    switch (quantity_) {
      case Quantity::radio:
        return -rest_hz_ / c;
      case Quantity::optical:
        return -rest_hz_ / c / ((1 + beta) * (1 + beta));
      case Quantity::relativistic:
        return -rest_hz_ / c / ((1 + beta) * std::sqrt(1 - beta * beta));
      case Quantity::redshift:
        return -rest_hz_ / ((1 + value) * (1 + value));
      case Quantity::wavelength:
        return -c / (value * value);
      default:
        return 1;
    }
  }

  const FitsFile& file_;
  FitsAxis axis_;
  double rest_hz_;
  Quantity quantity_ = Quantity::frequency;
  bool in_frequency_ = false;  ///< whether planes are evenly spaced in frequency, whatever the axis counts
};

std::string stated_frame(const FitsFile& file, const std::string& type) {
  if (std::string stated = file.text("SPECSYS"); !stated.empty()) return stated;
  if (const Frame* const named = frame_named(parts_of(type).second)) return named->specsys;
  const int velref = static_cast<int>(file.number("VELREF").value_or(0)) % 256;
  for (const Frame& frame : frames)
    if (velref == frame.velref) return frame.specsys;
  return "";
}

}  // namespace

bool is_spectral(const std::string& type) {
  const auto [name, behind] = parts_of(type);
  bool known = false;
  for (const Named& quantity : quantities) known = known || quantity.name == name;
  if (!known || (type.size() > 4 && type[4] != '-') || type.size() == 5) return false;
  const bool sampled = behind == "F2W" ? name == "VOPT" || name == "ZOPT" || name == "WAVE" : behind == "F2V" && name == "VELO";
  return behind.empty() || sampled || frame_named(behind) != nullptr;
}

SpectralAxis read_spectral_axis(const FitsFile& file, const FitsPlanes& planes) {
  const std::optional<FitsAxis> axis =
      planes.spectral ? std::optional(read_axis(file, planes, *planes.spectral)) : std::nullopt;
  SpectralAxis spectral;
  spectral.frame = stated_frame(file, axis ? axis->type : "");
  const std::optional<double> rest_hz = file.number("RESTFRQ");
  spectral.rest_frequency_hz = rest_hz ? *rest_hz : file.number("RESTFREQ").value_or(0);
  spectral.reference_hz = spectral.rest_frequency_hz;
  if (!axis) return spectral;
  spectral.channels = static_cast<int>(planes.lengths[*planes.spectral]);
  Spectral(file, *axis, spectral.rest_frequency_hz).set(spectral);
  return spectral;
}

}  // namespace misfit::imager
