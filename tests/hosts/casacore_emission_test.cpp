// What `misfit kernel --emit casacore` writes and says, in casacore itself.
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "kernels/catalogue.h"
#include "tests/hosts/gridded_sky.h"
#include "tests/temporary_folder.h"
#include "tools/emit/emission_plan.h"
#include "tools/hosts/convolve_gridder_table.h"

BOOST_AUTO_TEST_SUITE(casacore_emission)

using namespace misfit;
using namespace misfit::testing;
namespace bdata = boost::unit_test::data;

namespace {

constexpr int pixels = 300, visibilities = 1000;

tools::Emission emission_for(int width, int per_cell, double padding) {
  tools::EmitOptions options;
  options.host = "casacore";
  options.width = width;
  options.per_cell = per_cell;
  options.host_padding = padding;
  return tools::plan_emission(options, kernels::kernel_family("least-misfit"));
}

/// A thousand visibilities are known to 5 %, and 300 pixels, one of whose edges counts in full, stand for a continuum to 3 %.
void check_agrees(double measured, double said) {
  BOOST_TEST_MESSAGE("said " << said << ", measured " << measured);
  BOOST_TEST(std::abs(measured / said - 1) < 0.1);
}

}  // namespace

BOOST_DATA_TEST_CASE(casacore_errs_by_what_is_said,
                     bdata::make({4, 6, 7}) * bdata::make({100, 10000}) * bdata::make({1.2, 2.0}), width, per_cell, padding) {
  const TemporaryFolder folder;
  const std::string file = folder / "k.fits";
  const tools::Emission emission = emission_for(width, per_cell, padding);
  emission.host->write(emission, file);
  const GriddedSky sky = GriddedSky::random_phases(pixels, static_cast<int>(std::lround(pixels * padding)), visibilities);
  hosts::ConvolveGridderTable gridder(file, sky.shape(), sky.scale(), sky.offset());
  check_agrees(relative_error(sky.degridded(gridder), sky.visibilities()), emission.realised.rms);
}

BOOST_DATA_TEST_CASE(casacore_without_us_errs_by_what_is_said, bdata::make({1.2, 2.0}), padding) {
  const GriddedSky sky = GriddedSky::random_phases(pixels, static_cast<int>(std::lround(pixels * padding)), visibilities);
  casacore::ConvolveGridder<double, casacore::Complex> stock(sky.shape(), sky.scale(), sky.offset(), "SF");
  check_agrees(relative_error(sky.degridded(stock), sky.visibilities()), emission_for(7, 100, padding).stock->rms);
}

BOOST_AUTO_TEST_SUITE_END()
