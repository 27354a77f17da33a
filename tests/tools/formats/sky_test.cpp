#include "tools/formats/sky.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>

BOOST_AUTO_TEST_SUITE(sky)

using namespace misfit;

BOOST_AUTO_TEST_CASE(the_test_card_has_34_sources_within_390_cells) {
  const double cell_rad = 1e-7;
  const auto card = tools::test_card(cell_rad);
  BOOST_TEST(card.size() == 34u);
  double total_jy = 0, farthest = 0;
  for (const imager::Source& source : card) {
    total_jy += source.flux_jy;
    farthest = std::max({farthest, std::abs(source.position.l), std::abs(source.position.m)});
    BOOST_TEST(source.fwhm_rad == 0);
  }
  BOOST_TEST(total_jy == 52);  // 10 of 2 Jy, 20 of 1 Jy, 4 of 3 Jy
  BOOST_TEST(std::abs(farthest / cell_rad - 390) < 1e-9);
  // The third source tells east from west and north from south.
  BOOST_TEST(std::abs(card[2].position.l / cell_rad + 120) < 1e-9);
  BOOST_TEST(std::abs(card[2].position.m / cell_rad - 180) < 1e-9);
}

BOOST_AUTO_TEST_SUITE_END()
