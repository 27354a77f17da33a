#pragma once

#include <casacore/measures/Measures/MDirection.h>
#include <casacore/measures/Measures/MEpoch.h>
#include <casacore/measures/Measures/MFrequency.h>
#include <casacore/measures/Measures/MeasFrame.h>

#include <memory>
#include <string>

#include "ms_io/ephemeris_internal.h"

namespace misfit::ms_io {

/// How fast a body recedes.
struct Recession {
  double m_s = 0;
  casacore::MFrequency::Types from = casacore::MFrequency::GEO;  ///< the middle of the Earth or, TOPO, the observer
};

/// The velocity that an ephemeris tells of. Throws what Ephemeris::recession_m_s() does.
Recession recession_of(const Ephemeris& ephemeris, double utc_mjd);

/// What moves over the sky by itself, whatever fields are phased to: a planet, the Sun, the Moon, or what the table of an
/// ephemeris tells of. All throw casacore::AipsError where it is not known where that is at a time.
class Body {
 public:
  Body() = default;
  Body(const Body&) = delete;
  Body& operator=(const Body&) = delete;
  virtual ~Body() = default;

  /// As an observer at the epoch and the position of `frame` has to phase to it: astrometric, so without aberration, which
  /// turns all directions of a field alike; seen from the place, and not from the middle of the Earth.
  casacore::MDirection seen_from(const casacore::MeasFrame& frame, const casacore::MEpoch& when) const;
  virtual Recession recession(const casacore::MEpoch& when) const = 0;

 protected:
  struct Place {
    casacore::MDirection direction;
    double distance_m = 0;  ///< from the middle of the Earth; 0: `direction` is the observer's
  };
  virtual Place place(const casacore::MEpoch& when) const = 0;
};

/// Whether casacore has a body of this name, such as "JUPITER", in capitals or not.
bool is_body_name(const std::string& name);

/// The body of such a name or, where it is none, of the table of an ephemeris at that path. Throws casacore::AipsError that
/// says what was expected where there is no such table, or casacore has none of where planets go.
std::shared_ptr<const Body> make_body(const std::string& name);

}  // namespace misfit::ms_io
