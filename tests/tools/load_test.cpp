#include "tools/load.h"

#include "tests/tools/program.h"
#include "tests/tools/set_changes.h"

using namespace misfit;
using namespace misfit::tools::testing;

BOOST_AUTO_TEST_SUITE(load)

BOOST_AUTO_TEST_CASE(what_is_kept_in_memory_is_what_the_set_holds) {
  const ms_io::MeasurementSet set(snapshot(), {}, "DATA");
  imager::StageTimes times;
  std::uint64_t told = 0;
  const tools::LoadedVisibilities loaded = tools::load_visibilities(
      set, [&](std::uint64_t done, std::uint64_t) { told = done; }, times);
  BOOST_TEST(loaded.counts.used == 351U);
  BOOST_TEST(told == 351U);
  BOOST_TEST(loaded.w_spread.weighted_w_square == 0);
  const auto stream = set.open(), stored = loaded.source->open();
  while (const auto block = stream->next()) {
    const auto kept = stored->next();
    BOOST_REQUIRE(kept != nullptr);
    BOOST_TEST((kept->visibility == block->visibility));
    BOOST_TEST((kept->weight == block->weight));
    BOOST_TEST((kept->uvw_m == block->uvw_m));
  }
  BOOST_TEST((stored->next() == nullptr));
}

BOOST_AUTO_TEST_CASE(a_set_without_usable_samples_is_an_error_that_counts_the_reasons) {
  const TemporaryFolder folder;
  const std::string path = folder / "flagged.ms";
  std::filesystem::copy(snapshot(), path, std::filesystem::copy_options::recursive);
  flag_all(path);
  make_autocorrelation(path, 0);
  const ms_io::MeasurementSet set(path, {}, "DATA");
  imager::StageTimes times;
  BOOST_CHECK_EXCEPTION(
      tools::load_visibilities(
          set, [](std::uint64_t, std::uint64_t) {}, times),
      std::runtime_error, [](const std::exception& error) {
        return std::string(error.what()) ==
               "no visibility is left of 351: 1 auto-correlations, 350 flagged, 0 not finite, 0 of zero weight";
      });
}

BOOST_AUTO_TEST_SUITE_END()
