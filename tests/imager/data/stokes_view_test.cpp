#include "imager/data/stokes_view.h"

#include <boost/test/unit_test.hpp>

#include "tests/imager/comparison.h"
#include "tests/imager/several_stokes.h"

BOOST_AUTO_TEST_SUITE(stokes_view)

using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

StoredVisibilities source() {
  return stored({with_others(random_samples(4, 3, 1e-5, 1), 2, 2), with_others(random_samples(2, 5, 1e-5, 3), 2, 4)});
}

std::vector<std::shared_ptr<const VisibilityBlock>> blocks_of(const VisibilitySource& source) {
  std::vector<std::shared_ptr<const VisibilityBlock>> blocks;
  const auto stream = source.open();
  while (auto block = stream->next()) blocks.push_back(std::move(block));
  return blocks;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_view_hands_out_the_blocks_of_its_stokes_parameter_without_a_copy) {
  const StoredVisibilities from = source();
  const auto blocks = blocks_of(from);
  for (int index = 0; index < 3; ++index) {
    const StokesView view(from, index);
    const auto seen = blocks_of(view);
    BOOST_REQUIRE(seen.size() == blocks.size());
    for (std::size_t i = 0; i < seen.size(); ++i)
      BOOST_TEST(seen[i] == (index == 0 ? blocks[i] : blocks[i]->other_stokes[static_cast<std::size_t>(index) - 1]));
    BOOST_TEST(view.samples() == from.samples());
  }
}

BOOST_AUTO_TEST_CASE(a_stokes_parameter_that_no_block_carries_is_refused) {
  const StoredVisibilities from = source();
  BOOST_CHECK_THROW(StokesView(from, -1), std::invalid_argument);
  const StokesView view(from, 3);
  BOOST_CHECK_EXCEPTION(view.open()->next(), std::invalid_argument, [](const std::exception& error) {
    return std::string(error.what()).find("Stokes parameter 3 of a block that carries 3") != std::string::npos;
  });
}

BOOST_AUTO_TEST_SUITE_END()
