#include "imager/beams/polynomial_pattern.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "imager/numerics/constants.h"

BOOST_AUTO_TEST_SUITE(polynomial_pattern)

using namespace misfit::imager;

namespace {

/// Power at x arcmin · GHz.
double power(const Pattern& pattern, double x, double hz) {
  return std::pow(pattern->voltage(std::sin(x * 1e9 / hz * pi / 180 / 60), hz), 2);
}

const Pattern vla = misfit::imager::polynomial_pattern(vla_beams()), gmrt = misfit::imager::polynomial_pattern(gmrt_beams()),
              atca = misfit::imager::polynomial_pattern(atca_beams());

}  // namespace

/// Values worked out from the printed coefficients by hand, at 20 arcmin · GHz: 1 + 400 a + 160 000 b + 6.4e7 c + 2.56e10 d.
BOOST_AUTO_TEST_CASE(power_is_the_published_polynomial) {
  // 1488 MHz: −1.455e-3, 7.92e-7, −1.63e-10
  BOOST_TEST(std::abs(power(vla, 20, 1488e6) - 0.534288) < 1e-9);
  // 470 MHz: −1.010e-3, 4.85e-7, −1.07e-10, 0.86e-14
  BOOST_TEST(std::abs(power(vla, 20, 470e6) - 0.66697216) < 1e-9);
  // 43948 MHz: −1.452e-3, 7.68e-7, −1.47e-10
  BOOST_TEST(std::abs(power(vla, 20, 43948e6) - 0.532672) < 1e-9);
  // Band 5: −2.614e-3, 27.594e-7, −13.268e-10, 2.395e-13; at 15: 225, 50 625, 11 390 625, 2.562890625e9
  BOOST_TEST(std::abs(power(gmrt, 15, 1.25e9) - 0.53704536) < 1e-7);
  // 4.8 GHz, the reciprocal of: 1.08e-3, 1.31e-6, −1.17e-9, 1.07e-12
  BOOST_TEST(std::abs(power(atca, 20, 4.8e9) - 1 / 1.594112) < 1e-9);
}

BOOST_AUTO_TEST_CASE(between_fits_the_nearest_counts_or_voltages_are_interpolated) {
  for (const double x : {5.0, 15.0, 25.0}) {
    BOOST_TEST(power(vla, x, 1519e6) == power(vla, x, 1488e6), boost::test_tools::tolerance(1e-12));
    BOOST_TEST(power(vla, x, 1521e6) == power(vla, x, 1552e6), boost::test_tools::tolerance(1e-12));
    // A quarter of the way from 1332 to 1588 MHz.
    const double a = std::sqrt(power(atca, x, 1332e6)), b = std::sqrt(power(atca, x, 1588e6));
    BOOST_TEST(power(atca, x, 1396e6) == std::pow(0.75 * a + 0.25 * b, 2), boost::test_tools::tolerance(1e-12));
    // Beyond all fits of a band, and beyond all bands.
    BOOST_TEST(power(atca, x, 3.2e9) == power(atca, x, 2868e6), boost::test_tools::tolerance(1e-12));
    BOOST_TEST(power(vla, x, 74e6) == power(vla, x, 232e6), boost::test_tools::tolerance(1e-9));
    BOOST_TEST(power(gmrt, x, 520e6) == power(gmrt, x, 375e6), boost::test_tools::tolerance(1e-12));
  }
}

BOOST_AUTO_TEST_CASE(every_fit_falls_from_the_axis_to_the_end_of_its_main_lobe) {
  for (const FittedBeams* beams : {&vla_beams(), &gmrt_beams(), &atca_beams()}) {
    const Pattern pattern = misfit::imager::polynomial_pattern(*beams);
    for (const FittedBand& band : beams->bands)
      for (const BeamFit& fit : band.fits) {
        const double hz = fit.frequency_hz, end = arcmin_ghz(pattern->main_lobe_sine(hz), hz);
        BOOST_TEST_CONTEXT(beams->telescope << " at " << hz / 1e6 << " MHz ends at " << end) {
          BOOST_TEST(hz >= band.low_hz);
          BOOST_TEST(hz <= band.high_hz);
          BOOST_TEST(pattern->doubt(hz) == "");
          BOOST_TEST(power(pattern, 0, hz) == 1.0);
          double before = 1;
          for (double x = 0.5; x < end; x += 0.5) {
            const double now = power(pattern, x, hz);
            BOOST_TEST(now < before);
            before = now;
          }
          BOOST_TEST(before < 0.14);  // where fits to the P band turn up
          BOOST_TEST(power(pattern, end + 0.1, hz) == 0.0);
        }
      }
    for (std::size_t b = 1; b < beams->bands.size(); ++b) BOOST_TEST(beams->bands[b - 1].high_hz <= beams->bands[b].low_hz);
    for (const FittedBand& band : beams->bands)
      for (std::size_t f = 1; f < band.fits.size(); ++f) BOOST_TEST(band.fits[f - 1].frequency_hz < band.fits[f].frequency_hz);
  }
  BOOST_TEST(gmrt->doubt(520e6).find("GMRT was not fitted at 520 MHz") != std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()
