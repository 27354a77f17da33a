#pragma once

#include <boost/test/unit_test.hpp>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/temporary_folder.h"

namespace misfit::testing {

/// An archive of other people's observations, unpacked for the length of a test. They lie outside the project, in the folder
/// that MISFIT_TEST_DATA names or in ../shared/data; where one is absent the test says so and is skipped.
class Unpacked {
 public:
  explicit Unpacked(const std::string& name) {
    const char* const given = std::getenv("MISFIT_TEST_DATA");
    const std::filesystem::path folder =
        given != nullptr ? given : std::filesystem::path(MISFIT_SOURCE_DIR) / ".." / "shared" / "data";
    const std::filesystem::path archive = folder / (name + ".tar.xz");
    present_ = std::filesystem::exists(archive);
    if (!present_) {
      BOOST_TEST_MESSAGE("skipped: there is no " << archive);
      return;
    }
    const std::string command = "tar -xJf '" + archive.string() + "' -C '" + (folder_ / "") + "'";
    BOOST_REQUIRE_EQUAL(std::system(command.c_str()), 0);
  }
  bool present() const { return present_; }
  std::string operator/(const std::string& name) const { return folder_ / name; }

 private:
  TemporaryFolder folder_;
  bool present_ = false;
};

}  // namespace misfit::testing
