#include "imager/data/geometry.h"

#include <array>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <random>

#include "imager/numerics/constants.h"

BOOST_AUTO_TEST_SUITE(geometry)

using namespace misfit::imager;

namespace {

using Vector = std::array<double, 3>;

Vector unit(double ra_rad, double dec_rad) {
  return {std::cos(dec_rad) * std::cos(ra_rad), std::cos(dec_rad) * std::sin(ra_rad), std::sin(dec_rad)};
}

double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

BOOST_AUTO_TEST_CASE(direction_cosines_are_projections_on_east_and_north) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int seen = 0;
  for (int i = 0; i < 1000; ++i) {
    const SkyDirection centre{pi * uniform(random), pi / 2 * uniform(random), {}};
    const SkyDirection direction{pi * uniform(random), pi / 2 * uniform(random), {}};
    const Vector to = unit(direction.ra_rad, direction.dec_rad);
    if (dot(to, unit(centre.ra_rad, centre.dec_rad)) < 1e-12) {
      BOOST_CHECK_THROW(direction_cosines(direction, centre), std::invalid_argument);
      continue;
    }
    ++seen;
    const Vector east{-std::sin(centre.ra_rad), std::cos(centre.ra_rad), 0};
    const Vector north = unit(centre.ra_rad, centre.dec_rad + pi / 2);
    const DirectionCosines is = direction_cosines(direction, centre);
    BOOST_TEST(std::abs(is.l - dot(to, east)) < 1e-14);
    BOOST_TEST(std::abs(is.m - dot(to, north)) < 1e-14);
  }
  BOOST_TEST(seen > 400);
}

BOOST_AUTO_TEST_CASE(the_centre_is_zero_also_at_the_pole_and_a_whole_turn_away) {
  for (const double dec : {-pi / 2, -0.3, 0.0, 1.2, pi / 2}) {
    const DirectionCosines is = direction_cosines({1 + 2 * pi, dec, {}}, {1, dec, {}});
    BOOST_TEST(std::abs(is.l) < 1e-15);
    BOOST_TEST(std::abs(is.m) < 1e-15);
  }
}

BOOST_AUTO_TEST_CASE(what_lies_below_the_horizon_is_refused) {
  BOOST_CHECK_THROW(direction_cosines({0, -1, {}}, {0, 1, {}}), std::invalid_argument);
  BOOST_CHECK_THROW(direction_cosines({pi, 0, {}}, {0, 0, {}}), std::invalid_argument);
}

BOOST_AUTO_TEST_CASE(a_direction_comes_back_from_its_cosines_near_poles_and_the_origin_of_right_ascension_too) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const double dec : {-pi / 2, -pi / 2 + 1e-5, -0.7, 0.0, 1.2, pi / 2 - 1e-9, pi / 2})
    for (const double ra : {0.0, 1e-9, 2.5, 2 * pi - 1e-9, -0.4})
      for (const double radius : {1e-9, 1e-4, 0.1, 0.95})
        for (int i = 0; i < 20; ++i) {
          const double angle = pi * uniform(random);
          const DirectionCosines at{radius * std::cos(angle), radius * std::sin(angle)};
          const SkyDirection direction = sky_direction(at, {ra, dec, "ICRS"});
          BOOST_TEST((direction.ra_rad >= 0 && direction.ra_rad <= 2 * pi && std::abs(direction.dec_rad) <= pi / 2));
          BOOST_TEST(direction.frame == "ICRS");
          const DirectionCosines back = direction_cosines(direction, {ra, dec, "ICRS"});
          // Angles of up to 2π, each rounded a few times by 4e-16.
          BOOST_TEST(std::hypot(back.l - at.l, back.m - at.m) < 1e-14);
        }
  BOOST_CHECK_THROW(sky_direction({0.8, 0.7}, {1, 1, {}}), std::invalid_argument);
}

BOOST_AUTO_TEST_CASE(east_is_towards_lower_columns_and_north_towards_higher_rows) {
  for (const ImageGeometry& g : {ImageGeometry{6, 5, 0.1, {}}, ImageGeometry{7, 4, 0.1, {}}}) {
    BOOST_TEST(g.l(3) == 0);
    BOOST_TEST(g.m(2) == 0);
    BOOST_TEST(g.l(2) == 0.1);
    BOOST_TEST(g.m(3) == 0.1);
  }
}

BOOST_AUTO_TEST_CASE(an_image_crosses_the_horizon_if_any_of_its_pixels_does) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int crossing = 0;
  for (int i = 0; i < 300; ++i) {
    const ImageGeometry g{7, 4, 0.1, {}, {uniform(random), uniform(random)}};
    bool any = false;
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 7; ++column) any = any || std::hypot(g.l(column), g.m(row)) > 1;
    BOOST_TEST(crosses_horizon(g) == any);
    crossing += any ? 1 : 0;
  }
  BOOST_TEST((crossing > 50 && crossing < 250));
}

BOOST_AUTO_TEST_SUITE_END()
