#include "kernels/catalogue.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

using namespace misfit::kernels;

BOOST_AUTO_TEST_SUITE(catalogue)

BOOST_AUTO_TEST_CASE(every_family_makes_what_it_offers) {
  for (const KernelFamily& family : kernel_catalogue())
    for (int width = family.min_width; width <= std::min(family.max_width, 9); ++width) {
      const Kernel kernel = family.make(width, 0.4);
      BOOST_TEST(kernel.name == family.name);
      BOOST_TEST(kernel.width() == width);
      BOOST_TEST(kernel.x0 == 0.4);
      BOOST_TEST(std::abs(optimal_correction(kernel.polynomial, Eigen::VectorXd::Zero(1))[0] - 1) < 1e-14);
      BOOST_TEST(!family.description.empty());
    }
}

BOOST_AUTO_TEST_CASE(no_family_is_better_than_least_misfit, *boost::unit_test::label("sweep")) {
  for (const double x0 : {0.02, 0.1, 0.25, 0.4, 0.47})
    for (int width = 1; width <= 8; ++width) {
      const double least = kernel_family("least-misfit").make(width, x0).origin.mean_error;
      for (const KernelFamily& family : kernel_catalogue()) {
        if (family.name == "least-misfit" || width < family.min_width || width > family.max_width) continue;
        const Kernel kernel = family.make(width, x0);
        // The least is known to 1e-6.
        BOOST_TEST(kernel.misfit.mean > (1 - 1e-6) * least, family.name << ", W = " << width << ", x0 = " << x0);
        BOOST_TEST(kernel.origin.mean_error > (1 - 1e-6) * least, family.name << ", W = " << width << ", x0 = " << x0);
      }
    }
}

BOOST_AUTO_TEST_CASE(what_is_stored_is_as_good_as_what_it_stands_for) {
  for (const double x0 : {0.05, 0.25, 0.4})
    for (const KernelFamily& family : kernel_catalogue())
      for (int width = family.min_width; width <= std::min(family.max_width, family.costly ? 9 : 20); width += 3) {
        const Kernel kernel = family.make(width, x0);
        // 1% of E, and what doubles hold: some units of rounding, amplified by the correction.
        const double rounding = 20 * 0x1p-53 * noise_gain(kernel.polynomial, x0);
        BOOST_TEST(std::abs(std::sqrt(kernel.misfit.mean) - std::sqrt(kernel.origin.mean_error)) <
                       0.005 * std::sqrt(kernel.origin.mean_error) + rounding,
                   family.name << ", W = " << width << ", x0 = " << x0);
      }
}

BOOST_AUTO_TEST_CASE(what_a_family_does_not_offer_is_refused) {
  for (const KernelFamily& family : kernel_catalogue()) {
    BOOST_CHECK_THROW(family.make(family.min_width - 1, 0.25), std::invalid_argument);
    BOOST_CHECK_THROW(family.make(family.max_width + 1, 0.25), std::invalid_argument);
    for (const double x0 : {0.0, 0.009, 0.491, 0.5, std::nan("")})
      BOOST_CHECK_THROW(family.make(family.min_width, x0), std::invalid_argument);
  }
}

BOOST_AUTO_TEST_CASE(unknown_kernels_are_refused_with_the_names_there_are) {
  BOOST_CHECK_EXCEPTION(kernel_family("kaiser"), std::invalid_argument, [](const std::invalid_argument& e) {
    const std::string message = e.what();
    bool all = message.rfind("kernel \"kaiser\" is not known; expected one of: least-misfit", 0) == 0;
    for (const KernelFamily& family : kernel_catalogue()) all = all && message.find(family.name) != std::string::npos;
    return all;
  });
}

BOOST_AUTO_TEST_SUITE_END()
