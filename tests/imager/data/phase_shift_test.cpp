#include "imager/data/phase_shift.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>

#include "imager/direct/direct_transform.h"
#include "tests/imager/random_samples.h"

BOOST_AUTO_TEST_SUITE(phase_shift)

using namespace misfit::imager;
using namespace misfit::imager::testing;
using Complex = std::complex<double>;

namespace {

constexpr double degree = pi / 180, arcsec = degree / 3600;
constexpr double cell_rad = 1e-3;

struct Centres {
  SkyDirection from, to;
};

/// From an arcsecond to 20 degrees, over right ascension 0, and over and at the poles.
const std::vector<Centres> all_centres = {
    {{1.25, -0.5}, {1.25 + arcsec, -0.5 + 2 * arcsec}},
    {{1.25, -0.5}, {1.25 - 0.1 * degree, -0.5 + 0.03 * degree}},
    {{0.05, 0.3}, {2 * pi - 0.05, 0.2}},
    {{3, 0.8}, {3, 0.8 + 20 * degree}},
    {{1.25, -0.5}, {1.25 + 20 * degree, -0.5}},
    {{2, pi / 2 - arcsec}, {2 + 2.5, pi / 2 - 30 * arcsec}},
    {{5, pi / 2 - 0.05 * degree}, {1, pi / 2 - 10 * degree}},
    {{0, -pi / 2}, {4, -pi / 2 + 0.2}},
    {{0.3, pi / 2 - 0.1}, {0.3 + pi, pi / 2 - 0.1}},
};

VisibilityBlock samples() {
  return random_samples_with_w(60, 3, cell_rad, 400, 7);
}

PhaseShift shift_of(const Centres& centres) {
  return {uvw_axes(centres.from), uvw_axes(centres.to)};
}

/// Σ w Re[V exp(−2πi(ul + vm + w(n−1)))].
double direct_sum(const VisibilityBlock& block, const PhasePosition& at) {
  double sum = 0;
  for (std::size_t i = 0; i < block.samples(); ++i) {
    const double turns = turns_per_hz(&block.uvw_m[3 * (i / block.channels())], at) * block.frequency_hz[i % block.channels()];
    sum += double{block.weight[i]} * (Complex(block.visibility[i]) * std::polar(1.0, -2 * pi * turns)).real();
  }
  return sum;
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_image_about_the_new_centre_is_the_direct_sum_of_the_old_at_the_same_directions) {
  for (const Centres& centres : all_centres) {
    const VisibilityBlock old = samples();
    VisibilityBlock shifted = old;
    shift_of(centres).apply(shifted);
    const ImageGeometry geometry{9, 7, 20 * cell_rad, centres.to};
    double all = 0;
    for (std::size_t i = 0; i < old.samples(); ++i) all += double{old.weight[i]} * std::abs(old.visibility[i]);
    for (int row = 0; row < geometry.height; ++row)
      for (int column = 0; column < geometry.width; ++column) {
        const SkyDirection direction = sky_direction(geometry.at(row, column), centres.to);
        const PhasePosition seen = phase_position(direction_cosines(direction, centres.from));
        // Each shifted visibility is rounded to single precision, by 2⁻²⁴ of itself in each part.
        BOOST_TEST(std::abs(direct_sum(shifted, phase_position(geometry.at(row, column))) - direct_sum(old, seen)) <
                   1e-7 * all);
      }
  }
}

BOOST_AUTO_TEST_CASE(a_source_at_the_new_centre_has_its_flux_as_visibility) {
  for (const Centres& centres : all_centres) {
    VisibilityBlock block = samples();
    const DirectionCosines at = direction_cosines(centres.to, centres.from);
    const auto visibilities = predict_sources({Source{at, 2.5}}, block, 1);
    std::copy(visibilities.begin(), visibilities.end(), block.visibility.begin());
    shift_of(centres).apply(block);
    for (const auto& visibility : block.visibility) BOOST_TEST(std::abs(visibility - 2.5F) < 2.5 * 3e-7);  // three roundings
  }
}

BOOST_AUTO_TEST_CASE(what_is_predicted_about_the_new_centre_comes_back_as_that_of_the_old) {
  const DirectionCosines offset{0.04, -0.03};
  for (const Centres& centres : all_centres) {
    const VisibilityBlock block = samples();
    const PhaseShift shift = shift_of(centres);
    SampleCoordinates moved = block;
    shift.rotate(moved.uvw_m.edit());
    auto visibilities = predict_sources({Source{offset, 1.5}}, moved, 1);
    shift.undo(block, visibilities);
    const DirectionCosines seen = direction_cosines(sky_direction(offset, centres.to), centres.from);
    const auto expected = predict_sources({Source{seen, 1.5}}, block, 1);
    // Phases of some 10³ rad, from angles and rotations that are right to 1e-16 of 1, are right to some 1e-12.
    for (std::size_t i = 0; i < expected.size(); ++i) BOOST_TEST(std::abs(visibilities[i] - expected[i]) < 1e-11);
  }
}

BOOST_AUTO_TEST_CASE(there_and_back_is_where_it_was) {
  for (const Centres& centres : all_centres) {
    const VisibilityBlock old = samples();
    VisibilityBlock block = old;
    shift_of(centres).apply(block);
    shift_of({centres.to, centres.from}).apply(block);
    for (std::size_t i = 0; i < old.uvw_m.size(); ++i)
      BOOST_TEST(std::abs(block.uvw_m[i] - old.uvw_m[i]) < 1e-14 * 1e3);  // of metres up to some hundred
    for (std::size_t i = 0; i < old.samples(); ++i)
      BOOST_TEST(std::abs(block.visibility[i] - old.visibility[i]) < 2e-7F * std::abs(old.visibility[i]));  // two roundings
  }
}

BOOST_AUTO_TEST_CASE(to_where_it_is_changes_no_bit) {
  const SkyDirection here{1.25, -0.5};
  const PhaseShift shift = shift_of({here, here});
  BOOST_TEST(shift.none());
  VisibilityBlock block = samples();
  shift.apply(block);
  BOOST_CHECK(block.visibility == samples().visibility);
  BOOST_CHECK(block.uvw_m == samples().uvw_m);
}

BOOST_AUTO_TEST_CASE(rows_with_shifts_of_their_own_are_each_shifted_as_if_alone) {
  const VisibilityBlock old = samples();
  std::vector<PhaseShift> shifts{PhaseShift()};
  for (const Centres& centres : all_centres) shifts.push_back(shift_of(centres));
  RowShifts rows;
  for (std::size_t row = 0; row < old.rows(); ++row) rows.append(shifts[row / 2 % shifts.size()], 1);
  VisibilityBlock block = old;
  rows.apply(block);
  std::vector<double> rotated(old.uvw_m.begin(), old.uvw_m.end());
  rows.rotate(rotated);
  BOOST_CHECK(block.uvw_m == rotated);
  std::vector<Complex> back(block.visibility.begin(), block.visibility.end());
  rows.undo(old, back);
  for (std::size_t row = 0; row < old.rows(); ++row) {
    VisibilityBlock alone = old;
    shifts[row / 2 % shifts.size()].apply(alone);
    for (std::size_t axis = 0; axis < 3; ++axis) BOOST_TEST(block.uvw_m[3 * row + axis] == alone.uvw_m[3 * row + axis]);
    for (std::size_t i = row * old.channels(); i < (row + 1) * old.channels(); ++i) {
      BOOST_CHECK(block.visibility[i] == alone.visibility[i]);
      // Of two roundings to single precision, the first remains.
      BOOST_TEST(std::abs(back[i] - Complex(old.visibility[i])) < 1e-7 * std::abs(old.visibility[i]));
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
