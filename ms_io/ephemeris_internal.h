#pragma once

#include <casacore/measures/Measures/MDirection.h>
#include <casacore/measures/Measures/MEpoch.h>
#include <casacore/ms/MeasurementSets/MSField.h>

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace misfit::ms_io {

/// Where a body of the solar system goes: a table of right ascensions and declinations such as CASA keeps beside FIELD. Between
/// its rows directions and other columns are cubic polynomials of time, through the four rows about it: where the body goes by
/// δ between rows, they err by some 0.02 δ⁴, and straight lines, as casacore draws them, by δ²/8.
class Ephemeris {
 public:
  /// Reads the table at `path`. Throws casacore::AipsError that names it and what was expected where it does not have two rows
  /// or more in the order of time, of finite numbers, in a frame that is known.
  explicit Ephemeris(const std::string& path);

  /// The direction as seen from the middle of the Earth, or from where the table says. Throws casacore::AipsError outside the
  /// table's times.
  casacore::MDirection at(double utc_mjd) const;
  /// True if it is seen from the middle of the Earth.
  bool geocentric() const { return geocentric_; }
  /// Rho, the distance from where it is seen. Throws what at() does, and where the table has no such column, or the place lies
  /// within the Earth.
  double distance_m(double utc_mjd) const;
  /// RadVel, positive away from where it is seen. Throws what distance_m() does, and where it is the speed of light or more.
  double recession_m_s(double utc_mjd) const;

 private:
  /// Rows about a time, and Lagrange's polynomials through them at that time.
  struct Stencil {
    std::size_t first = 0;
    std::vector<double> weight;
  };

  /// A column, with the unit that it has unless it states another, and the unit in which it is wanted.
  struct Column {
    const char* name;
    const char* usual_unit;
    const char* wanted_unit;
  };

  [[noreturn]] void fail(const std::string& what) const;
  Stencil stencil(double utc_mjd) const;
  std::vector<double> values_of(const casacore::Table& table, const Column& column) const;
  const std::vector<double>& values_of(const Column& column) const;
  double interpolated(const Column& column, double utc_mjd) const;

  std::string path_;
  casacore::MDirection::Types frame_;
  bool geocentric_ = true;
  std::vector<double> mjd_;                                    ///< [row], ascending
  std::vector<std::array<double, 3>> direction_;               ///< [row], unit vectors
  mutable std::map<std::string, std::vector<double>> others_;  ///< columns that were asked for, by name; [row]
};

/// Days, as an ephemeris counts them.
double utc_mjd(const casacore::MEpoch& when);

/// FIELD without EPHEMERIS_ID. casacore opens the tables of all its fields, selected or not, and gives up FIELD where one is
/// missing, or is not as it would have written it.
casacore::MSField without_ephemerides(const casacore::MSField& field);

/// The folder of the table that EPHEMERIS_ID means. Throws casacore::AipsError, which says what was expected, where there is
/// not one alone.
std::string ephemeris_path(const casacore::MSField& field, int ephemeris);

}  // namespace misfit::ms_io
