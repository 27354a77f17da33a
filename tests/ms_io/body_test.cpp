// Planets and ephemerides as telescopes see them.
#include <casacore/measures/Measures/MCDirection.h>
#include <casacore/measures/Measures/MCEpoch.h>
#include <casacore/measures/Measures/MCPosition.h>
#include <casacore/measures/Measures/MeasConvert.h>
#include <casacore/measures/Measures/MeasJPL.h>
#include <casacore/tables/Tables/ScaColDesc.h>
#include <casacore/tables/Tables/ScalarColumn.h>
#include <casacore/tables/Tables/SetupNewTab.h>
#include <casacore/tables/Tables/TableRecord.h>

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <set>

#include "ms_io/body_internal.h"
#include "ms_io/phase_centre.h"
#include "ms_io/phase_centre_internal.h"
#include "ms_io/planets_internal.h"
#include "ms_io/spectral_frame.h"
#include "ms_io/table_access_internal.h"
#include "tests/ms_io/moving_set.h"

namespace misfit::ms_io {

BOOST_AUTO_TEST_SUITE(body)

using namespace testing;
using namespace moving_testing;
using casacore::MDirection;

namespace {

constexpr double au_m = 149597870700.0, light_m_s = 299792458;

casacore::MPosition vla() {
  return {casacore::MVPosition(-1601185.4, -5041977.5, 3554875.9), casacore::MPosition::ITRF};
}

casacore::MEpoch utc(double time_s) {
  return {casacore::MVEpoch(casacore::Quantity(time_s, "s")), casacore::MEpoch::UTC};
}

/// An ephemeris of three days about a time of slow_observation().
struct TableOf {
  double ra_deg = 71, dec_deg = -28, ra_rate = 3, dec_rate = 1;  ///< degrees a day
  double rho_au = 0.1, rho_rate = 0.01;                          ///< AU a day
  bool topocentric = false;
};

constexpr double middle_s = 4.9e9 + 1200;

void write_table(const std::string& path, const TableOf& of) {
  constexpr int rows = 145;
  casacore::TableDesc description;
  for (const char* const column : {"MJD", "RA", "DEC", "Rho", "RadVel"})
    description.addColumn(casacore::ScalarColumnDesc<double>(column));
  casacore::SetupNewTable made(path, description, casacore::Table::New);
  casacore::Table table(made, rows);
  for (int r = 0; r < rows; ++r) {
    const auto row = static_cast<casacore::rownr_t>(r);
    const double days = (r - rows / 2) / 48.0;
    const std::array<double, 5> values{middle_s / day_s + days, of.ra_deg + of.ra_rate * days, of.dec_deg + of.dec_rate * days,
                                       of.rho_au + of.rho_rate * days, of.rho_rate};
    constexpr std::array<const char*, 5> names{"MJD", "RA", "DEC", "Rho", "RadVel"};
    for (std::size_t i = 0; i < names.size(); ++i) casacore::ScalarColumn<double>(table, names[i]).put(row, values[i]);
  }
  table.rwKeywordSet().define("posrefsys", casacore::String("ICRF/ICRS"));
  table.rwKeywordSet().define("GeoDist", of.topocentric ? 2.12 : 0.0);
}

std::vector<double> ratios(const MeasurementSet& set) {
  std::vector<double> all;
  const auto stream = set.open();
  while (const auto block = stream->next()) all.insert(all.end(), block->frame_ratio.begin(), block->frame_ratio.end());
  return all;
}

Selection following(const std::string& what, const std::string& set) {
  return phased_to({}, what, {set});
}

}  // namespace

// casacore's own way is from DE200, with parallax above the telescope, which the step back to J2000 does not undo. DE200 was
// fitted to what was seen up to 1980, and the outer planets have left it since (Standish 1990, A&A 233, 252): by so much in
// 2014.
BOOST_AUTO_TEST_CASE(planets_are_where_casacore_has_them_above_the_telescope) {
  silence_casacore();
  find_planet_tables();
  for (const auto& [name, departed_arcsec] : {std::pair{"MERCURY", 0.2},
                                              {"Venus", 0.2},
                                              {"mars", 0.2},
                                              {"JUPITER", 0.2},
                                              {"SATURN", 0.5},
                                              {"URANUS", 0.8},
                                              {"NEPTUNE", 1.4},
                                              {"PLUTO", 8},
                                              {"SUN", 0.2}})
    for (const double time_s : {4.9e9, 4.9e9 + 40000, 4.9e9 + 1.2e7}) {
      const casacore::MEpoch when = utc(time_s);
      const casacore::MeasFrame frame(when, vla());
      const MDirection::Ref here(MDirection::TOPO, frame), j2000(MDirection::J2000, frame);
      const MDirection above = MDirection::Convert(MDirection(*planet_named(name)), here)();
      const MDirection expected = MDirection::Convert(above, j2000)();
      const MDirection found = MDirection::Convert(make_body(name)->seen_from(frame, when), j2000)();
      const double apart_arcsec = found.getValue().separation(expected.getValue()) / arcsec;
      BOOST_TEST(apart_arcsec < departed_arcsec, name << " " << apart_arcsec);
    }
}

// Origin: astropy 5.2.1, get_body("moon") by its own series (ERFA's moon98, good to some kilometres), from the middle of the
// Earth. casacore has the Moon farther away by 1/82.3, though in the right direction.
BOOST_AUTO_TEST_CASE(the_moon_is_as_far_away_as_it_is) {
  silence_casacore();
  for (const auto& [time_s, distance_km] :
       {std::pair{4.9e9, 366440.05}, {4.9e9 + 40000, 364783.26}, {4.9e9 + 1.2e7, 358475.93}}) {
    const double tdb = casacore::MEpoch::Convert(utc(time_s), casacore::MEpoch::TDB)().get("d").getValue();
    const PlanetPlace moon = planet_place(MDirection::MOON, tdb);
    BOOST_TEST(std::abs(moon.distance_m / 1e3 - distance_km) < 10, moon.distance_m);
    // casacore's direction from the middle of the Earth is right but for where the Moon goes, and DE200 has it, by half an
    // arcsec.
    const casacore::MeasFrame frame(utc(time_s), vla());
    const MDirection::Ref j2000(MDirection::J2000, frame);
    const MDirection there = MDirection::Convert(MDirection(MDirection::MOON), j2000)();
    BOOST_TEST(MDirection::Convert(moon.direction, j2000)().getValue().separation(there.getValue()) < 0.6 * arcsec);
  }
}

BOOST_AUTO_TEST_CASE(planets_recede_as_the_tables_have_their_velocities) {
  silence_casacore();
  find_planet_tables();
  for (const auto& [name, code] : {
           std::pair{"VENUS", casacore::MeasJPL::VENUS},
           {"JUPITER", casacore::MeasJPL::JUPITER},
       })
    for (const double time_s : {4.9e9, 4.9e9 + 40000, 4.9e9 + 1.2e7}) {
      const double tdb = casacore::MEpoch::Convert(utc(time_s), casacore::MEpoch::TDB)().get("d").getValue();
      const double away_s = planet_place(*planet_named(name), tdb).distance_m / light_m_s;
      casacore::Vector<double> planet(6), earth(6);
      casacore::MeasJPL::get(planet, casacore::MeasJPL::DE405, code, casacore::MVEpoch(tdb - away_s / day_s));
      casacore::MeasJPL::get(earth, casacore::MeasJPL::DE405, casacore::MeasJPL::EARTH, casacore::MVEpoch(tdb));
      double along = 0, of_planet = 0, length = 0;
      for (std::size_t i = 0; i < 3; ++i) length = std::hypot(length, planet(i) - earth(i));
      for (std::size_t i = 0; i < 3; ++i) {
        const double unit = (planet(i) - earth(i)) / length;
        along += unit * (planet(i + 3) - earth(i + 3)) * au_m / day_s;
        of_planet += unit * planet(i + 3) * au_m / day_s;
      }
      const auto body = make_body(name);
      // The third order of the change over 200 s, and centimetres of rounding over these.
      BOOST_TEST(std::abs(body->recession_m_s(utc(time_s)) - along / (1 + of_planet / light_m_s)) < 0.01, name);
      BOOST_TEST((body->velocity_frame() == casacore::MFrequency::GEO));
    }
}

// Origin: astropy 5.2.1, EarthLocation.get_gcrs_posvel of the VLA.
BOOST_AUTO_TEST_CASE(what_is_near_is_seen_from_the_telescope) {
  const TemporaryFolder folder;
  const std::string path = folder / "near.tab";
  const double time_s = 4.9e9;
  const std::array<double, 3> observer_m{4410744.523939434, 2928046.566305027, 3548851.998910051};
  TableOf of;
  of.rho_au = 0.003;  // 1.2 times as far as the Moon
  of.rho_rate = 0;
  write_table(path, of);
  const casacore::MEpoch when = utc(time_s);
  const casacore::MeasFrame frame(when, vla());
  const Ephemeris read(path);
  const casacore::MVDirection geocentric = read.at(time_s / day_s).getValue();
  casacore::MVPosition expected(geocentric);
  for (std::size_t i = 0; i < 3; ++i)
    expected(static_cast<casacore::uInt>(i)) = geocentric.getValue()(i) * of.rho_au * au_m - observer_m[i];
  casacore::MVDirection from_there(expected);
  from_there.adjust();
  const casacore::MVDirection found = make_body(path)->seen_from(frame, when).getValue();
  BOOST_TEST(found.separation(geocentric) > 600 * arcsec);
  // Without tables of the IERS the Earth's rotation is 0.16 s off, 60 m there: 0.03 arcsec; casacore's precession and nutation
  // are those of 1976, some 0.05 arcsec off, of a parallax of 1e-2.
  BOOST_TEST(found.separation(from_there) < 0.05 * arcsec, found.separation(from_there) / arcsec);
  std::filesystem::remove_all(path);
  of.topocentric = true;
  write_table(path, of);
  BOOST_TEST(make_body(path)->seen_from(frame, when).getValue().separation(geocentric) < 1e-12);
}

BOOST_AUTO_TEST_CASE(fields_that_stand_still_are_shifted_to_what_is_followed) {
  const SmallSet set(slow_observation());
  const std::string table = set.path() + ".tab";
  write_table(table, {});
  const std::shared_ptr<const Body> comet = make_body(table);
  set.modify([&](casacore::MeasurementSet& open) {
    const casacore::ScalarColumn<double> time(open, "TIME");
    for (casacore::rownr_t row = 0; row < rows; ++row) {
      const casacore::MeasFrame frame(utc(time(row)), vla());
      const MDirection there =
          MDirection::Convert(comet->seen_from(frame, utc(time(row))), MDirection::Ref(MDirection::J2000, frame))();
      const casacore::Vector<double> at = there.getAngle().getValue();
      put_point(open, row, {at(0), at(1)}, small_observation().fields.front().phase_centre);
    }
  });
  const MeasurementSet opened(set.path(), following(table, set.path()), "DATA");
  // The antennas of the set stand 100 m and more from the VLA's place: 1e-9 rad of a comet at 0.1 AU.
  BOOST_TEST(largest_error_jy(opened, {{0, 0}, flux_jy}) < 10 * roundings_jy);
  BOOST_TEST(opened.observation().moving_at == "2014-02-24T23:26:40.000");
  BOOST_TEST(says(opened, table + " moves by "));
  BOOST_TEST((opened.followed_at("2014-02-25T23:26:40").has_value() && !opened.followed_at("2014-03-25T23:26:40").has_value()));
  std::filesystem::remove_all(table);
}

BOOST_AUTO_TEST_CASE(what_cannot_be_followed_is_refused_by_name) {
  const SmallSet set(slow_observation());
  const TemporaryFolder folder;
  write_table(folder / "short.tab", {});
  {
    casacore::Table table(folder / "short.tab", casacore::Table::Update);
    for (casacore::rownr_t row = 0; row < table.nrow(); ++row) {
      casacore::ScalarColumn<double> mjd(table, "MJD");
      mjd.put(row, mjd(row) - 30);
    }
  }
  const std::string error = error_of([&] { MeasurementSet(set.path(), following(folder / "short.tab", set.path()), "DATA"); });
  BOOST_TEST(contains(error, "its ephemeris " + (folder / "short.tab") + " goes from MJD"), error);
  write_table(folder / "without.tab", {});
  casacore::Table(folder / "without.tab", casacore::Table::Update).removeColumn("Rho");
  const std::string without =
      error_of([&] { MeasurementSet(set.path(), following(folder / "without.tab", set.path()), "DATA"); });
  BOOST_TEST(contains(without, "has no column Rho, expected one"), without);
  const std::string no_ephemeris = error_of([&] { following(set.path() + "/ANTENNA", set.path()); });
  BOOST_TEST(contains(no_ephemeris, "has no column MJD, expected MJD, RA and DEC"), no_ephemeris);
  const std::string nothing = error_of([&] { following("NIBIRU", set.path()); });
  BOOST_TEST(contains(nothing, "--phasecenter 'NIBIRU' is neither a direction, a planet nor the table of an ephemeris"),
             nothing);
}

BOOST_AUTO_TEST_CASE(frequencies_come_to_rest_by_the_velocity_of_what_is_followed) {
  const SmallSet set(slow_observation());
  const std::string table = set.path() + ".tab";
  for (const bool topocentric : {false, true}) {
    TableOf of;
    of.topocentric = topocentric;
    write_table(table, of);
    Selection at_rest = following(table, set.path()), other = at_rest;
    at_rest.spectral_frame = "SOURCE";
    other.spectral_frame = topocentric ? "TOPOCENT" : "GEOCENTR";
    const std::vector<double> found = ratios(MeasurementSet(set.path(), at_rest, "DATA"));
    std::vector<double> before = ratios(MeasurementSet(set.path(), other, "DATA"));
    const double of_light = of.rho_rate * au_m / day_s / light_m_s;
    BOOST_TEST_REQUIRE(found.size() == rows);
    for (std::size_t row = 0; row < rows; ++row)
      BOOST_TEST(std::abs(found[row] / (before[row] * std::sqrt((1 + of_light) / (1 - of_light))) - 1) < 1e-13);  // 0.03 mm/s
    const MeasurementSet opened(set.path(), at_rest, "DATA");
    BOOST_TEST(opened.spectral_windows()[0].frequency_hz[0] == 1e9 * found[0]);
    std::filesystem::remove_all(table);
  }
  Selection nothing;
  nothing.spectral_frame = "SOURCE";
  const std::string error = error_of([&] { ratios(MeasurementSet(set.path(), nothing, "DATA")); });
  BOOST_TEST(contains(error, "it has no ephemeris; expected one, or --phasecenter with the name of a planet"), error);
}

BOOST_AUTO_TEST_CASE(frequencies_come_to_rest_by_the_ephemeris_of_the_field_whatever_the_image_is_about) {
  const MovingSet set(Path::ephemeris);
  {
    casacore::Table table(set.path() + "/FIELD/EPHEM0_Object.tab", casacore::Table::Update);
    casacore::ScalarColumn<double>(table, "RadVel").fillColumn(0.02);
  }
  const double of_light = 0.02 * au_m / day_s / light_m_s, factor = std::sqrt((1 + of_light) / (1 - of_light));
  for (Selection at_rest : {Selection(), with(Moving::about_targets), to_direction(about, Path::ephemeris)}) {
    Selection geocentric = at_rest;
    at_rest.spectral_frame = "SOURCE";
    geocentric.spectral_frame = "GEOCENTR";
    const std::vector<double> found = ratios(MeasurementSet(set.path(), at_rest, "DATA"));
    const std::vector<double> before = ratios(MeasurementSet(set.path(), geocentric, "DATA"));
    BOOST_TEST_REQUIRE(found.size() == rows);
    for (std::size_t row = 0; row < rows; ++row)
      BOOST_TEST(std::abs(found[row] / (before[row] * factor) - 1) < 1e-13);  // 0.03 mm/s
  }
}

// Each has its own velocity, in integrations by turns; the first three, which are flagged, are before both ephemerides.
BOOST_AUTO_TEST_CASE(frequencies_of_fields_come_to_rest_each_by_its_own_ephemeris) {
  const MovingSet set(Path::ephemeris);
  add_still_field(set.path(), about);
  const MovingField other(set.path(), 1, Path::ephemeris, about);
  for (const int field : {0, 1}) {
    casacore::Table table(set.path() + "/FIELD/EPHEM" + std::to_string(field) + "_Object.tab", casacore::Table::Update);
    casacore::ScalarColumn<double>(table, "RadVel").fillColumn(0.01 * (field + 1));
    const casacore::Vector<double> mjd = casacore::ScalarColumn<double>(table, "MJD").getColumn();
    std::vector<casacore::rownr_t> before;
    for (casacore::rownr_t row = 0; row < table.nrow(); ++row)
      if (mjd(row) * day_s < middle_s - 1) before.push_back(row);
    table.removeRow(casacore::Vector<casacore::rownr_t>(before));
  }
  std::vector<int> field_of_row;
  set.modify([&](casacore::MeasurementSet& open) {
    for (casacore::rownr_t row = 0; row < 3 * baselines; ++row) casacore::ScalarColumn<bool>(open, "FLAG_ROW").put(row, true);
    field_of_row = casacore::ScalarColumn<int>(open, "FIELD_ID").getColumn().tovector();
  });
  BOOST_TEST_REQUIRE(std::count(field_of_row.begin(), field_of_row.end(), 1) > 0);
  Selection at_rest = with(Moving::about_targets), geocentric = at_rest;
  at_rest.spectral_frame = "SOURCE";
  geocentric.spectral_frame = "GEOCENTR";
  const MeasurementSet rest(set.path(), at_rest, "DATA"), geo(set.path(), geocentric, "DATA");
  const auto one = rest.open(), two = geo.open();
  std::set<double> factors;
  while (const auto block = one->next()) {
    const auto same = two->next();
    for (std::size_t row = 0; row < block->rows(); ++row)
      if (block->weight[row * block->channels()] != 0) factors.insert(block->frame_ratio[row] / same->frame_ratio[row]);
  }
  for (const double factor : factors) {
    const auto expected = [](double au_per_day) {
      const double of_light = au_per_day * au_m / day_s / light_m_s;
      return std::sqrt((1 + of_light) / (1 - of_light));
    };
    BOOST_TEST((std::abs(factor / expected(0.01) - 1) < 1e-13 || std::abs(factor / expected(0.02) - 1) < 1e-13), factor);
  }
  BOOST_TEST(*factors.rbegin() - *factors.begin() > 1e-6);
}

BOOST_AUTO_TEST_CASE(an_ephemeris_beside_field_is_taken_as_telescopes_phased_to_it) {
  const MovingSet set(Path::ephemeris);
  const MeasurementSet tracked(set.path(), with(Moving::about_targets), "DATA");
  const MeasurementSet named(set.path(), following(set.path() + "/FIELD/EPHEM0_Object.tab", set.path()), "DATA");
  BOOST_TEST(separation_rad(tracked.observation().phase_centre, named.observation().phase_centre) < 1e-12);
}

BOOST_AUTO_TEST_CASE(the_way_of_light_is_found_at_all_times) {
  silence_casacore();
  for (int day = 0; day < 20000; ++day) {
    const double mjd = 45000 + 0.7 * day;
    const PlanetPlace one = planet_place(MDirection::MARS, mjd), next = planet_place(MDirection::MARS, mjd + 1e-3);
    // Mars and the Earth approach each other by 19 km/s at most.
    BOOST_TEST_REQUIRE(std::abs(next.distance_m - one.distance_m) < 20e3 * 1e-3 * day_s);
  }
}

BOOST_AUTO_TEST_CASE(a_planet_goes_before_a_field_of_its_name) {
  const SmallSet set(slow_observation());
  set.modify([](casacore::MeasurementSet& open) { casacore::MSFieldColumns(open.field()).name().put(0, "Jupiter"); });
  const Selection planet = following("Jupiter", set.path());
  BOOST_TEST((planet.body == "JUPITER" && planet.moving == Moving::about_targets));
  const MeasurementSet opened(set.path(), planet, "DATA");
  BOOST_TEST(says(opened, "--phasecenter 'Jupiter' is taken for the body of the solar system, not for the field of that name"));
  BOOST_TEST(says(opened, "JUPITER moves by "));
  BOOST_TEST(following("0", set.path()).body.empty());
  set.add_field(1.5, -0.25);  // another of that name, elsewhere
  set.modify([](casacore::MeasurementSet& open) { casacore::MSFieldColumns(open.field()).name().put(1, "Jupiter"); });
  BOOST_TEST(following("JUPITER", set.path()).body == "JUPITER");
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
