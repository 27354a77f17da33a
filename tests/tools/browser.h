#pragma once

#include <boost/test/unit_test.hpp>
#include <string>
#include <vector>

namespace misfit::tools::testing {

/// Whether Chromium is installed, for preconditions of tests.
boost::test_tools::assertion_result browser_is_installed(boost::unit_test::test_unit_id test);

/// What is wrong with a page as Chromium shows it, without a network, at the widths of a phone and of a screen: each fault
/// begins with the width, such as "360 px: ". Faults are scripts, what a console says, whatever a page asks for that it does
/// not hold, pictures without a size, text that tells of a missing number (NaN, inf, undefined, null), and what is wider than
/// the page or cut off at a box that hides it.
std::vector<std::string> faults_in_browser(const std::string& html);

}  // namespace misfit::tools::testing
