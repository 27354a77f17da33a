#pragma once

#include <casacore/measures/Measures/MDirection.h>
#include <casacore/measures/Measures/MEpoch.h>
#include <casacore/measures/Measures/MFrequency.h>
#include <casacore/measures/Measures/MeasFrame.h>

#include <memory>
#include <string>

#include "ms_io/ephemeris_internal.h"

namespace misfit::ms_io {

/// The frame of frequencies in which velocities of an ephemeris are: GEO, or TOPO where it is seen from the telescope.
casacore::MFrequency::Types velocity_frame(const Ephemeris& ephemeris);

/// Something that moves over the sky by itself, whatever fields are phased to: a planet, the Sun, the Moon, or the target of an
/// ephemeris' table. All functions throw casacore::AipsError at times at which its place is not known.
class Body {
 public:
  Body() = default;
  Body(const Body&) = delete;
  Body& operator=(const Body&) = delete;
  virtual ~Body() = default;

  /// The direction that an observer at the epoch and the position of `frame` has to phase to: astrometric, without aberration,
  /// which turns all directions of a field alike; seen from that position, and not from the middle of the Earth.
  casacore::MDirection seen_from(const casacore::MeasFrame& frame, const casacore::MEpoch& when) const;
  /// The velocity, positive away from the middle of the Earth or, where velocity_frame() is TOPO, from the observer.
  virtual double recession_m_s(const casacore::MEpoch& when) const = 0;
  virtual casacore::MFrequency::Types velocity_frame() const { return casacore::MFrequency::GEO; }

 protected:
  struct Place {
    casacore::MDirection direction;
    double distance_m = 0;  ///< from the middle of the Earth; 0: `direction` is the observer's
  };
  virtual Place place(const casacore::MEpoch& when) const = 0;
};

/// True if casacore has a body of this name, such as "JUPITER", in capitals or not.
bool is_body_name(const std::string& name);

/// The body of this name or, where casacore has none, of the table of an ephemeris at that path. CASA's tables beside FIELD
/// (FIELD/EPHEM*.tab) list directions to which telescopes phased, and are taken as they are; other tables are seen from the
/// middle of the Earth unless they say otherwise. Throws casacore::AipsError that says what was expected where there is no such
/// table.
std::shared_ptr<const Body> make_body(const std::string& name);

}  // namespace misfit::ms_io
