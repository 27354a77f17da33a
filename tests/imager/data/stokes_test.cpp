#include "imager/data/stokes.h"

#include <boost/test/unit_test.hpp>
#include <stdexcept>

namespace misfit::imager {

BOOST_AUTO_TEST_SUITE(stokes)

BOOST_AUTO_TEST_CASE(every_name_is_parsed_alone_and_in_lists) {
  for (int code = 1; code <= 12; ++code) {
    const auto stokes = static_cast<Stokes>(code);
    BOOST_TEST((parse_stokes(stokes_name(stokes)) == std::vector{stokes}));
    BOOST_TEST((stokes_of_fits_code(fits_stokes_code(stokes)) == stokes));
  }
  BOOST_TEST((parse_stokes("IQUV") == std::vector{Stokes::I, Stokes::Q, Stokes::U, Stokes::V}));
  BOOST_TEST((parse_stokes("XX, YY") == std::vector{Stokes::XX, Stokes::YY}));
  BOOST_TEST((parse_stokes("RRLL") == std::vector{Stokes::RR, Stokes::LL}));
  BOOST_TEST((parse_stokes("IV") == std::vector{Stokes::I, Stokes::V}));
  BOOST_TEST(stokes_names(parse_stokes("QUV")) == "QUV");
  BOOST_TEST(stokes_names(parse_stokes("QI")) == "QI");  // evenly, down the axis
  BOOST_TEST(stokes_names(parse_stokes("IVUQ")) == "IQUV");
}

BOOST_AUTO_TEST_CASE(codes_are_those_of_casacore_and_fits) {
  // casacore's Stokes::StokesTypes; Greisen & Calabretta 2002, table 29.
  BOOST_TEST(static_cast<int>(Stokes::RR) == 5);
  BOOST_TEST(static_cast<int>(Stokes::XX) == 9);
  BOOST_TEST(static_cast<int>(Stokes::YY) == 12);
  const std::vector<Stokes> by_fits_code = {Stokes::RR, Stokes::LL, Stokes::RL, Stokes::LR,
                                            Stokes::XX, Stokes::YY, Stokes::XY, Stokes::YX};
  for (std::size_t i = 0; i < by_fits_code.size(); ++i)
    BOOST_TEST(fits_stokes_code(by_fits_code[i]) == -1 - static_cast<int>(i));
  BOOST_TEST(fits_stokes_code(Stokes::V) == 4);
}

BOOST_AUTO_TEST_CASE(lists_that_no_fits_axis_holds_are_refused) {
  for (const char* text : {"", ",", "A", "i", "X", "IQI", "XXXX", "IQV", "IXXYY", "RRRLLRLL"})
    BOOST_CHECK_THROW(parse_stokes(text), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::imager
