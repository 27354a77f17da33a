#include <casacore/measures/Measures/MCDirection.h>
#include <casacore/measures/Measures/MCEpoch.h>
#include <casacore/measures/Measures/MCPosition.h>
#include <casacore/measures/Measures/MeasConvert.h>

#include <filesystem>

#include "ms_io/body_internal.h"
#include "ms_io/planets_internal.h"

namespace misfit::ms_io {
namespace {

using casacore::MDirection;

/// The vector from the middle of the Earth to the observer, in metres along the axes of J2000. Aberration turns a direction and
/// its opposite alike, so that half their difference is free of it to 1e-8.
casacore::MVPosition observer_m(const casacore::MeasFrame& frame) {
  const casacore::MVPosition here =
      casacore::MPosition::Convert(*dynamic_cast<const casacore::MPosition*>(frame.position()), casacore::MPosition::ITRF)()
          .getValue();
  const double radius_m = here.getLength().getValue("m");
  if (radius_m == 0) return here;
  MDirection::Convert to_sky(MDirection::Ref(MDirection::ITRF, frame), MDirection::Ref(MDirection::J2000, frame));
  const casacore::MVDirection up(here), down(-here);
  casacore::MVDirection axis = to_sky(up).getValue();
  axis -= to_sky(down).getValue();
  axis.adjust();
  casacore::MVPosition there(axis);
  there *= radius_m;
  return there;
}

bool is_beside_field(const std::string& path) {
  const std::filesystem::path table = std::filesystem::absolute(path).lexically_normal();
  const std::filesystem::path named = table.has_filename() ? table : table.parent_path();
  return named.parent_path().filename() == "FIELD" && named.filename().string().rfind("EPHEM", 0) == 0;
}

/// The target of an ephemeris' table.
class TabledBody : public Body {
 public:
  explicit TabledBody(const std::string& path)
      : ephemeris_(path), as_phased_to_(is_beside_field(path) || !ephemeris_.geocentric()) {}

  double recession_m_s(const casacore::MEpoch& when) const override { return ephemeris_.recession_m_s(utc_mjd(when)); }
  casacore::MFrequency::Types velocity_frame() const override { return ms_io::velocity_frame(ephemeris_); }

 protected:
  Place place(const casacore::MEpoch& when) const override {
    const double mjd = utc_mjd(when);
    return {ephemeris_.at(mjd), as_phased_to_ ? 0 : ephemeris_.distance_m(mjd)};
  }

 private:
  Ephemeris ephemeris_;
  bool as_phased_to_;  ///< whether it lists directions that the telescope sees
};

/// A body of the tables of JPL.
class Planet : public Body {
 public:
  explicit Planet(MDirection::Types which) : which_(which) {}

  /// The change of the distance that light crosses, over some minutes about the time.
  double recession_m_s(const casacore::MEpoch& when) const override {
    constexpr double step_s = 100, day_s = 86400;
    const double tdb = tdb_mjd(when);
    const double later_m = planet_place(which_, tdb + step_s / day_s).distance_m;
    return (later_m - planet_place(which_, tdb - step_s / day_s).distance_m) / (2 * step_s);
  }

 protected:
  Place place(const casacore::MEpoch& when) const override {
    const PlanetPlace there = planet_place(which_, tdb_mjd(when));
    return {there.direction, there.distance_m};
  }

 private:
  static double tdb_mjd(const casacore::MEpoch& when) {
    return casacore::MEpoch::Convert(when, casacore::MEpoch::TDB)().get("d").getValue();
  }

  MDirection::Types which_;
};

}  // namespace

casacore::MFrequency::Types velocity_frame(const Ephemeris& ephemeris) {
  return ephemeris.geocentric() ? casacore::MFrequency::GEO : casacore::MFrequency::TOPO;
}

MDirection Body::seen_from(const casacore::MeasFrame& frame, const casacore::MEpoch& when) const {
  const Place there = place(when);
  const auto own = MDirection::castType(there.direction.getRef().getType());
  const MDirection direction = own == MDirection::J2000 || own == MDirection::ICRS
                                   ? there.direction
                                   : MDirection::Convert(there.direction, MDirection::Ref(MDirection::J2000, frame))();
  if (there.distance_m == 0) return direction;
  casacore::MVPosition from_here(direction.getValue());
  from_here *= there.distance_m;
  from_here -= observer_m(frame);
  casacore::MVDirection seen(from_here);
  seen.adjust();
  return {seen, direction.getRef()};
}

bool is_body_name(const std::string& name) {
  return planet_named(name).has_value();
}

std::shared_ptr<const Body> make_body(const std::string& name) {
  if (const auto planet = planet_named(name)) return std::make_shared<Planet>(*planet);
  return std::make_shared<TabledBody>(name);
}

}  // namespace misfit::ms_io
