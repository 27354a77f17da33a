#include "imager/beams/row_beams.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "imager/beams/airy_pattern.h"
#include "imager/beams/image_pattern.h"
#include "imager/numerics/constants.h"

BOOST_AUTO_TEST_SUITE(row_beams)

using namespace misfit::imager;

namespace {

constexpr double hz = 1.4e9, arcmin = pi / 180 / 60;

/// A pattern that tells by its values where it was looked at.
class Telltale : public VoltagePattern {
 public:
  explicit Telltale(bool round) : round_(round) {}
  double voltage(double sine, double frequency_hz) const override { return 1 - sine * frequency_hz / hz; }
  bool is_round() const override { return round_; }
  double voltage_at(double sine, double angle_rad, double frequency_hz) const override {
    return voltage(sine, frequency_hz) * (1 + 0.1 * std::cos(2 * angle_rad));
  }
  double main_lobe_sine(double) const override { return 1; }
  double detail_sine(double) const override { return 0.1; }

 private:
  bool round_;
};

/// The angle between directions and the position angle of one about the other, by spherical trigonometry.
struct OnSphere {
  double apart_rad;
  double angle_rad;
};

OnSphere on_sphere(const SkyDirection& of, const SkyDirection& about) {
  const double east = of.ra_rad - about.ra_rad;
  const double x = std::cos(of.dec_rad) * std::sin(east);
  const double y =
      std::sin(of.dec_rad) * std::cos(about.dec_rad) - std::cos(of.dec_rad) * std::sin(about.dec_rad) * std::cos(east);
  const double z =
      std::sin(of.dec_rad) * std::sin(about.dec_rad) + std::cos(of.dec_rad) * std::cos(about.dec_rad) * std::cos(east);
  return {std::atan2(std::hypot(x, y), z), std::atan2(x, y)};
}

SampleCoordinates rows_with(const std::vector<RowSight>& sights) {
  return {std::vector<double>(3 * sights.size()), {hz}, sights};
}

}  // namespace

BOOST_AUTO_TEST_CASE(directions_lie_about_an_axis_as_on_the_sphere) {
  for (const double dec : {-1.5, -0.4, 0.0, 0.9, 1.57}) {
    const SkyDirection centre{2, dec};
    for (const DirectionCosines axis : {DirectionCosines{}, {0.02, -0.01}, {-0.5, 0.3}}) {
      const AxisFrame frame(axis, dec);
      for (const DirectionCosines at : {DirectionCosines{0.001, 0}, {-0.03, 0.02}, {0.4, 0.5}, {-0.2, -0.7}}) {
        const OnSphere expected = on_sphere(sky_direction(at, centre), sky_direction(axis, centre));
        if (expected.apart_rad >= pi / 2) {
          BOOST_TEST(frame.sine(at) == 2);
          continue;
        }
        BOOST_TEST(std::abs(frame.sine(at) - std::sin(expected.apart_rad)) < 1e-14);
        BOOST_TEST(std::abs(std::remainder(frame.angle_rad(at) - expected.angle_rad, 2 * pi)) < 1e-11);
      }
      BOOST_TEST(std::isnan(frame.sine({0.9, 0.9})));
    }
  }
  // About the pole itself, north is where the image has it.
  BOOST_TEST(AxisFrame({}, pi / 2).angle_rad({0.1, 0}) == pi / 2);
  const AxisFrame pole({0, std::cos(1.2)}, 1.2);
  BOOST_TEST(std::abs(pole.angle_rad({0.001, std::cos(1.2)}) - pi / 2) < 1e-3);
  BOOST_TEST(std::abs(pole.angle_rad({0, std::cos(1.2) + 0.001})) < 1e-9);
}

BOOST_AUTO_TEST_CASE(a_pair_sees_the_product_of_its_voltages_turned_as_the_zenith_is) {
  const auto round = std::make_shared<Telltale>(true), other = std::make_shared<Telltale>(false);
  const Pattern airy = airy_pattern({25, 0});
  const DirectionCosines axis{0.01, 0.02}, at{0.03, -0.02};
  const AxisFrame frame(axis, 0.7);
  const double sine = frame.sine(at), angle = frame.angle_rad(at);
  const PairBeam alike{airy, airy, frame, 1}, mixed{airy, round, frame, 1}, turned{other, airy, frame, 0.4};
  BOOST_TEST(alike.is_round());
  BOOST_TEST(!turned.is_round());
  BOOST_TEST(alike.power(at, hz) == std::pow(airy->voltage(sine, hz), 2));
  BOOST_TEST(mixed.power(at, 2 * hz) == airy->voltage(sine, 2 * hz) * (1 - 2 * sine));
  BOOST_TEST(turned.power(at, hz) == other->voltage_at(sine, angle - 0.4, hz) * airy->voltage(sine, hz));
  BOOST_TEST(alike.power(axis, hz) == 1);
  BOOST_TEST(alike.power({0.9, 0.9}, hz) == 0);                                             // beyond the horizon
  BOOST_TEST((PairBeam{airy, airy, AxisFrame({0.9, 0}, 0), 0}.power({-0.9, 0}, hz) == 0));  // behind the dishes
  const std::vector<Source> seen = seen_by(alike, {{axis, 2}, {at, 3, arcmin}}, hz);
  BOOST_TEST(seen[0].flux_jy == 2);
  BOOST_TEST(seen[1].flux_jy == 3 * alike.power(at, hz));
  BOOST_TEST(seen[1].fwhm_rad == arcmin);
}

BOOST_AUTO_TEST_CASE(rows_that_see_alike_are_one_group) {
  const Pattern large = airy_pattern({12, 0.75}), small = airy_pattern({7, 0.75}), turns = std::make_shared<Telltale>(false);
  const RowBeams beams({large, large, small, turns}, {AxisFrame({}, 0), AxisFrame({0.1, 0}, 0)});
  const auto rows_of_groups = [&](const std::vector<RowSight>& sights, double turn_rad = 0) {
    std::vector<std::vector<std::size_t>> rows;
    for (const RowBeams::Group& group : beams.groups(rows_with(sights), turn_rad)) rows.push_back(group.rows);
    return rows;
  };
  using Rows = std::vector<std::vector<std::size_t>>;
  // Dishes of one pattern are alike whichever they are and wherever the zenith is, but not where they point elsewhere.
  BOOST_TEST((rows_of_groups({{0, 1, 0, 0.1F}, {0, 2, 0, 0.1F}, {1, 0, 0, 0.7F}, {0, 1, 1, 0.1F}, {1, 2, 0, 0}}) ==
              Rows{{0, 2}, {1, 4}, {3}}));
  const std::vector<RowSight> turned{{3, 0, 0, 0.1F}, {3, 0, 0, 0.104F}, {3, 0, 0, 0.2F}, {3, 0, 0, 0.1F}};
  BOOST_TEST((rows_of_groups(turned) == Rows{{0, 3}, {1}, {2}}));
  BOOST_TEST((rows_of_groups(turned, 0.02) == Rows{{0, 1, 3}, {2}}));
  BOOST_CHECK_THROW(rows_of_groups({{0, 4, 0, 0}}), std::runtime_error);
  BOOST_CHECK_THROW(rows_of_groups({{-1, 0, 0, 0}}), std::runtime_error);
  BOOST_CHECK_THROW(rows_of_groups({{0, 1, 2, 0}}), std::out_of_range);
  BOOST_CHECK_THROW(beams.groups({std::vector<double>(3), {hz}}), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
