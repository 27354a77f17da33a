#include "kernels/catalogue.h"

#include <boost/test/unit_test.hpp>

using namespace misfit::kernels;

BOOST_AUTO_TEST_SUITE(catalogue)

BOOST_AUTO_TEST_CASE(every_family_makes_what_it_offers) {
  for (const KernelFamily& family : kernel_catalogue())
    for (int width = family.min_width; width <= std::min(family.max_width, 9); ++width) {
      const Kernel kernel = family.make(width, 0.4);
      BOOST_TEST(kernel.name == family.name);
      BOOST_TEST(kernel.width() == width);
      BOOST_TEST(kernel.x0 == 0.4);
      BOOST_TEST(!family.description.empty());
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
