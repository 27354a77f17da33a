#pragma once

#include <array>
#include <string>
#include <vector>

namespace misfit::testing {

/// Right ascension and declination, in the frame of the field: ICRS of ephemerides, J2000 of all others.
struct SkyPoint {
  double ra_rad = 0;
  double dec_rad = 0;
};

/// Ways in which FIELD lets a phase centre move: an ephemeris; NUM_POLY 1 and 2; frames that turn with the Earth; a frame of
/// date.
enum class Path { ephemeris, rate, acceleration, azimuth, hour_angle, apparent };
constexpr std::array<Path, 6> all_paths{Path::ephemeris, Path::rate,       Path::acceleration,
                                        Path::azimuth,   Path::hour_angle, Path::apparent};

const char* name_of(Path path);
/// FITS RADESYS.
const char* frame_of(Path path);

/// What moves, and how, without anything of the project: by formulas, or by casacore's conversions of directions.
class MovingField {
 public:
  /// Writes into FIELD of `set` that `field` passes `about` in the middle of the set's times, by 2 degrees a day in right
  /// ascension and 0.5 in declination where the path lets it choose. Another field of the set may go the same way.
  MovingField(const std::string& set, int field, Path path, const SkyPoint& about);

  int field() const { return field_; }
  /// Where the field is phased to at TIME.
  SkyPoint at(double time_s) const;
  double middle_s() const { return middle_s_; }

 private:
  void write_polynomial(const std::string& set, int powers) const;
  void write_ephemeris(const std::string& set) const;
  void write_direction(const std::string& set) const;

  int field_;
  Path path_;
  SkyPoint about_;
  double middle_s_ = 0;
};

/// A further row of FIELD, phased to a direction in J2000, whose rows are every second integration of the set.
void add_still_field(const std::string& set, const SkyPoint& at);

/// The MeasurementSet's DATA become, and MODEL_DATA where there are, those of a source that stands still on the sky. Fields
/// that are not among those that move are at their PHASE_DIR.
void put_fixed_source(const std::string& set, const std::vector<MovingField>& moving, const SkyPoint& source, double flux_jy);

/// Moves all times of the set by so many seconds.
void move_times(const std::string& set, double by_s);

/// The first and the last TIME.
std::array<double, 2> time_range_s(const std::string& set);

}  // namespace misfit::testing
