#include "imager/beams/common_beam.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <random>

BOOST_AUTO_TEST_SUITE(common_beam)

using namespace misfit::imager;

namespace {

double area(const Beam& beam) {
  return beam.major_rad * beam.minor_rad;
}

/// By how much the farthest point of `inner` reaches beyond `outer`, (x/r)² − 1: with x = L y, |y| ≤ 1, the larger eigenvalue
/// of Lᵀ diag(1/major², 1/minor²) L.
double beyond(const Beam& inner, const Beam& outer) {
  const double turn = inner.position_angle_rad - outer.position_angle_rad, c = std::cos(turn), s = std::sin(turn);
  const double a = 1 / (outer.major_rad * outer.major_rad), b = 1 / (outer.minor_rad * outer.minor_rad);
  const double major = inner.major_rad * inner.major_rad * (a * c * c + b * s * s);
  const double minor = inner.minor_rad * inner.minor_rad * (a * s * s + b * c * c);
  const double mixed = inner.major_rad * inner.minor_rad * c * s * (b - a);
  return 0.5 * (major + minor) + std::hypot(0.5 * (major - minor), mixed) - 1;
}

std::vector<Beam> random_beams(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> axis(1, 3), angle(-M_PI / 2, M_PI / 2);
  std::vector<Beam> beams;
  while (beams.size() < count) {
    const double a = axis(random), b = axis(random);
    beams.push_back({1e-6 * std::max(a, b), 1e-6 * std::min(a, b), angle(random)});
  }
  return beams;
}

}  // namespace

BOOST_AUTO_TEST_CASE(one_beam_is_its_own) {
  const Beam beam{5e-6, 2e-6, 0.7};
  for (const std::vector<Beam>& beams : {std::vector<Beam>{beam}, {beam, beam, beam}, {beam, {1e-6, 1e-6, 0}}}) {
    const Beam common = misfit::imager::common_beam(beams);
    BOOST_TEST(std::abs(common.major_rad / beam.major_rad - 1) < 1e-3);
    BOOST_TEST(std::abs(common.minor_rad / beam.minor_rad - 1) < 1e-3);
    BOOST_TEST(std::abs(common.position_angle_rad - beam.position_angle_rad) < 1e-3);
  }
}

BOOST_AUTO_TEST_CASE(ellipses_across_each_other_have_a_circle) {
  for (const double turn : {0.0, 0.3, -1.2}) {
    const Beam common = misfit::imager::common_beam({{4e-6, 1e-6, turn}, {4e-6, 1e-6, turn + M_PI / 2}});
    BOOST_TEST(std::abs(common.major_rad / 4e-6 - 1) < 1e-3);
    BOOST_TEST(std::abs(common.minor_rad / 4e-6 - 1) < 1e-3);
  }
}

BOOST_AUTO_TEST_CASE(all_beams_lie_within) {
  for (const std::size_t count : {2U, 5U, 40U})
    for (unsigned seed = 1; seed <= 10; ++seed) {
      const std::vector<Beam> beams = random_beams(count, seed);
      const Beam common = misfit::imager::common_beam(beams);
      for (const Beam& beam : beams) BOOST_TEST(beyond(beam, common) < 1e-9);
    }
}

BOOST_AUTO_TEST_CASE(no_other_ellipse_around_all_is_smaller_by_more_than_a_thousandth) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const std::vector<Beam> beams = random_beams(3, seed);
    const double common = area(misfit::imager::common_beam(beams));
    // The smallest of each shape on a grid, which misses the best of all by little.
    double least = 1;
    for (double ratio = 0.3; ratio <= 1; ratio += 0.02)
      for (double angle = -M_PI / 2; angle < M_PI / 2; angle += 0.05) {
        const Beam shape{1e-6, ratio * 1e-6, angle};
        double square = 0;
        for (const Beam& beam : beams) square = std::max(square, beyond(beam, shape) + 1);
        least = std::min(least, area(shape) * square);
      }
    BOOST_TEST(common <= 1.001 * least);
  }
}

BOOST_AUTO_TEST_CASE(what_is_no_beam_is_refused) {
  BOOST_CHECK_THROW(misfit::imager::common_beam({}), std::invalid_argument);
  BOOST_CHECK_THROW(misfit::imager::common_beam({{1e-6, 0, 0}}), std::invalid_argument);
  BOOST_CHECK_THROW(misfit::imager::common_beam({{1e-6, 2e-6, 0}}), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
