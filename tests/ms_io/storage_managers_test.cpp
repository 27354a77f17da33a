// Tables whose columns are stored by something that casacore would look for as a library.
#include <boost/test/unit_test.hpp>
#include <fstream>
#include <sstream>

#include "ms_io/casa_image.h"
#include "tests/ms_io/small_set.h"

namespace misfit::ms_io {

BOOST_AUTO_TEST_SUITE(storage_managers)

using namespace testing;

namespace {

/// Gives all columns of a table that are stored by `manager` another one, whose name is as long.
void rename_manager(const std::string& table, const std::string& manager, const std::string& other) {
  const std::string path = table + "/table.dat";
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  std::string bytes = text.str();
  std::size_t found = 0;
  for (std::size_t at = 0; (at = bytes.find(manager, at)) != std::string::npos; ++found)
    bytes.replace(at, manager.size(), other);
  BOOST_REQUIRE(found > 0U);
  std::ofstream(path, std::ios::binary) << bytes;
}

std::string refusal_of(const std::string& path) {
  try {
    MeasurementSet(path, {}, "DATA");
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_library_that_a_set_names_by_a_path_is_not_loaded) {
  for (const std::string table : {"", "/ANTENNA", "/SPECTRAL_WINDOW"}) {
    const SmallSet set;
    rename_manager(set.path() + table, "StandardStMan", "x/aLibraryFar");
    const std::string refusal = refusal_of(set.path());
    BOOST_TEST(
        refusal.find(set.path() + table + " has columns stored by 'x/aLibraryFar', expected the name") != std::string::npos,
        refusal);
  }
}

BOOST_AUTO_TEST_CASE(nor_one_that_a_set_names_to_which_another_refers) {
  const SmallSet set;
  const TemporaryFolder folder;
  const std::string reference = folder / "reference.ms";
  {
    const casacore::MeasurementSet whole(set.path());
    casacore::Table(whole(casacore::Vector<casacore::rownr_t>(std::vector<casacore::rownr_t>{0, 1})))
        .rename(reference, casacore::Table::New);
  }
  BOOST_TEST(refusal_of(reference) == "");
  rename_manager(set.path(), "StandardStMan", "x/aLibraryFar");
  BOOST_TEST(refusal_of(reference).find(set.path() + " has columns stored by") != std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
