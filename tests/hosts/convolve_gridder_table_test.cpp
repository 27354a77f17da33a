#include "tools/hosts/convolve_gridder_table.h"

#include <casacore/casa/Arrays/ArrayLogical.h>

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "kernels/lookup_table.h"
#include "kernels/map_error.h"
#include "tests/hosts/gridded_sky.h"
#include "tests/hosts/least_misfit_file.h"
#include "tools/hosts/casacore_table.h"

BOOST_AUTO_TEST_SUITE(convolve_gridder_table)

using namespace misfit;
using namespace misfit::testing;
using casacore::IPosition;
using casacore::Vector;
using hosts::ConvolveGridderTable;
namespace bdata = boost::unit_test::data;

namespace {

constexpr int visibilities = 2000;

/// Relative errors of both directions.
struct Errors {
  double degridding;
  double gridding;
};

Errors errors(GriddedSky& sky, CasacoreBase& gridder) {
  const Eigen::VectorXcd noise = sky.noise();
  return {relative_error(sky.degridded(gridder), sky.visibilities()),
          relative_error(sky.gridded(gridder, noise), sky.dirty(noise))};
}

ConvolveGridderTable gridder_for(const LeastMisfitFile& file, const GriddedSky& sky, int per_cell) {
  return ConvolveGridderTable(file.path, sky.shape(), sky.scale(), sky.offset(), per_cell);
}

}  // namespace

BOOST_DATA_TEST_CASE(the_table_errs_as_theory_says_in_both_directions,
                     bdata::xrange(1, 8) * bdata::make({100, 128, 100000}) * bdata::make({0, 1}), width, per_cell, little) {
  const Size size = little != 0 ? padded_little : padded_twice;
  const LeastMisfitFile file(width, size.x0());
  GriddedSky sky = GriddedSky::random_phases(size.pixels, size.fft, visibilities);
  ConvolveGridderTable gridder = gridder_for(file, sky, per_cell);
  const kernels::TapFunction taps = hosts::casacore_taps(hosts::casacore_table(file.kernel.polynomial, per_cell), per_cell);
  const double expected = std::sqrt(sky.expected(kernels::map_error(taps, sky.x(), {per_cell, {}})));
  const Errors found = errors(sky, gridder);
  BOOST_TEST_MESSAGE("of these pixels " << expected << ", degridding " << found.degridding << ", gridding " << found.gridding);
  // 10% for 2000 visibilities, as in casacore_gridder_test. Rounding: single precision, 2^-25, of sums that corrections and
  // taps of these widths magnify by noise_gain².
  const double tolerance = 0.1 * expected + 5 * 0x1p-25 * std::pow(kernels::noise_gain(file.kernel.polynomial, size.x0()), 2);
  BOOST_TEST(std::abs(found.degridding - expected) < tolerance);
  BOOST_TEST(std::abs(found.gridding - expected) < tolerance);
}

BOOST_DATA_TEST_CASE(seven_cells_err_by_the_misfit_of_normalised_taps_and_by_the_table,
                     bdata::make({100, 10000, 100000}) * bdata::make({0, 1}), per_cell, little) {
  const Size size = little != 0 ? padded_little : padded_twice;
  const LeastMisfitFile file(7, size.x0());
  GriddedSky sky = GriddedSky::random_phases(size.pixels, size.fft, visibilities);
  ConvolveGridderTable gridder = gridder_for(file, sky, per_cell);
  const kernels::TapFunction normalised = [&](double t) -> Eigen::VectorXd {
    const Eigen::VectorXd taps = file.kernel.polynomial(t);
    return taps / taps.sum();
  };
  const double function = kernels::judge(normalised, size.x0()).mean;
  const double table = kernels::table_misfit({per_cell, kernels::Interpolation::nearest}, size.x0());
  const double expected = std::sqrt(2 * (function + table));
  const Errors found = errors(sky, gridder);
  BOOST_TEST_MESSAGE("√(2(E + e²)) " << expected << ", degridding " << found.degridding << ", gridding " << found.gridding);
  // 10% for the sample; and the pixels, -60 to 59, have one of two edges, where ℓ is largest, as a whole pixel: up to 7%.
  BOOST_TEST(std::abs(found.degridding / expected - 1) < 0.17);
  BOOST_TEST(std::abs(found.gridding / expected - 1) < 0.17);
}

BOOST_AUTO_TEST_CASE(a_fine_table_beats_the_stock_gridder_by_a_thousand) {
  const LeastMisfitFile file(7, padded_twice.x0());
  for (GriddedSky sky : {GriddedSky::random_phases(64, 128, visibilities), GriddedSky::points(64, 128, visibilities)}) {
    casacore::ConvolveGridder<double, casacore::Complex> stock(sky.shape(), sky.scale(), sky.offset(), "SF");
    ConvolveGridderTable gridder = gridder_for(file, sky, 100000);
    const Errors before = errors(sky, stock), after = errors(sky, gridder);
    BOOST_TEST_MESSAGE("stock " << before.degridding << ' ' << before.gridding << ", table " << after.degridding << ' '
                                << after.gridding);
    // √2 e of 100 entries a cell is 3.7e-3; of 100000, 3.7e-6, to which √(2E) = 1.7e-7 adds nothing.
    for (const double error : {before.degridding, before.gridding}) BOOST_TEST((error > 1e-3 && error < 1e-2));
    for (const double error : {after.degridding, after.gridding}) BOOST_TEST(error < 6e-6);
  }
}

BOOST_AUTO_TEST_CASE(casacore_holds_the_table_as_it_should) {
  const LeastMisfitFile file(6, 0.25, kernels::TableSampling{64, 0});
  ConvolveGridderTable gridder(file.path, IPosition(2, 40, 40), Vector<double>(2, 1.0), Vector<double>(2, 0.0));
  const Eigen::VectorXd table = hosts::casacore_table(file.kernel.polynomial, 64);
  BOOST_TEST(gridder.cSampling() == 64);
  BOOST_TEST(casacore::allEQ(gridder.cSupport(), 3));
  BOOST_TEST(gridder.cFunction().size() == 4U * 64U);
  for (std::size_t i = 0; i < gridder.cFunction().size(); ++i)
    BOOST_TEST(gridder.cFunction()[i] == table[static_cast<Eigen::Index>(i)]);
}

BOOST_DATA_TEST_CASE(corrections_are_one_over_the_optimal_one_of_the_taps, bdata::make({4, 7}), width) {
  const LeastMisfitFile file(width, 0.25, kernels::TableSampling{100, 0});
  constexpr int size = 600;  // more than are corrected at once
  ConvolveGridderTable gridder(file.path, IPosition(2, size, 41), Vector<double>(2, 1.0), Vector<double>(2, 0.0));
  const kernels::TapFunction taps = hosts::casacore_taps(hosts::casacore_table(file.kernel.polynomial, 100), 100);
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(size, -300, 299) / size;
  const Eigen::VectorXd h = kernels::optimal_correction(taps, x, 100);
  const double h_y = kernels::optimal_correction(taps, Eigen::VectorXd::Constant(1, 5 / 41.0), 100)[0];
  for (int l = 0; l < size; ++l)  // three roundings
    BOOST_TEST(std::abs(std::complex<double>(gridder.correct(IPosition(2, l, 25))) * (h[l] * h_y) - 1.0) < 3 * 0x1p-24);
}

BOOST_AUTO_TEST_CASE(what_is_no_kernel_for_it_is_refused_by_name) {
  const auto refused = [](const std::string& path, const std::string& because) {
    BOOST_CHECK_EXCEPTION(ConvolveGridderTable(path, IPosition(2, 40, 40), Vector<double>(2, 1.0), Vector<double>(2, 0.0)),
                          std::runtime_error, [&](const std::runtime_error& error) {
                            const std::string what = error.what();
                            return what.find(path) != std::string::npos && what.find(because) != std::string::npos;
                          });
  };
  const LeastMisfitFile unsampled(7, 0.25), wide(8, 0.25, kernels::TableSampling{});
  refused(unsampled.path, "CONVFUNC");
  refused(wide.path, "W = 8");
  const LeastMisfitFile cubic(7, 0.25, kernels::TableSampling{128, 3});
  refused(cubic.path, "the nearest entry");
  refused(wide.folder / "missing.fits", "does not exist");
  const std::string damaged = wide.folder / "damaged.fits";
  std::filesystem::copy_file(wide.path, damaged);
  std::fstream(damaged, std::ios::in | std::ios::out | std::ios::binary).seekp(-2000, std::ios::end).put('x');
  refused(damaged, "checksum");
}

BOOST_AUTO_TEST_CASE(only_grids_of_two_axes_are_taken) {
  const LeastMisfitFile file(6, 0.25, kernels::TableSampling{64, 0});
  const Vector<double> one(1, 1.0), two(2, 1.0);
  BOOST_CHECK_THROW(ConvolveGridderTable(file.path, IPosition(1, 40), one, one), std::invalid_argument);
  BOOST_CHECK_THROW(ConvolveGridderTable(file.path, IPosition(2, 40, 40), one, two), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
