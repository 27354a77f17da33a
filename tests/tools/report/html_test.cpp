#include "tools/report/html.h"

#include <boost/test/unit_test.hpp>

BOOST_AUTO_TEST_SUITE(html)

using misfit::tools::base64;
using misfit::tools::html_escaped;
using misfit::tools::html_power;

BOOST_AUTO_TEST_CASE(characters_with_a_meaning_are_escaped) {
  BOOST_TEST(html_escaped("<a & 'b' \"c\">") == "&lt;a &amp; &#39;b&#39; &quot;c&quot;&gt;");
  BOOST_TEST(html_escaped("a\tb\n\x1b[0m\x7f ü") == "a\tb\n?[0m? ü");
}

// RFC 4648, section 10.
BOOST_AUTO_TEST_CASE(base64_gives_the_test_vectors_of_its_definition) {
  BOOST_TEST(base64("") == "");
  BOOST_TEST(base64("f") == "Zg==");
  BOOST_TEST(base64("fo") == "Zm8=");
  BOOST_TEST(base64("foo") == "Zm9v");
  BOOST_TEST(base64("foob") == "Zm9vYg==");
  BOOST_TEST(base64("\xff\xfe\xfd") == "//79");
}

BOOST_AUTO_TEST_CASE(powers_of_ten_are_raised) {
  BOOST_TEST(html_power(3.24e-7) == "3.2 × 10<sup>−7</sup>");
  BOOST_TEST(html_power(1e-6) == "10<sup>−6</sup>");
  BOOST_TEST(html_power(9.99e-7) == "10<sup>−6</sup>");
  BOOST_TEST(html_power(-2e12) == "−2 × 10<sup>12</sup>");
  BOOST_TEST(html_power(0.25) == "0.25");
  BOOST_TEST(html_power(0) == "0");
}

BOOST_AUTO_TEST_SUITE_END()
