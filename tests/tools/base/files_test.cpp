#include "tools/base/files.h"

#include <sys/stat.h>

#include <boost/test/unit_test.hpp>

#include "tests/tools/program.h"

BOOST_AUTO_TEST_SUITE(files)

using namespace misfit::tools;
using misfit::tools::testing::files_below;
using misfit::tools::testing::TemporaryFolder;

BOOST_AUTO_TEST_CASE(bytes_written_are_read_back_and_replace_what_was_there) {
  const TemporaryFolder folder;
  const std::string path = folder / "a 'file'", bytes("zero \0 and \n\xff", 12);
  write_file(path, "longer than what follows");
  write_file(path, bytes);
  BOOST_TEST(read_file(path) == bytes);
  write_file(path, "");
  BOOST_TEST(read_file(path) == "");
  BOOST_TEST(files_below(folder / "").size() == 1U);
}

BOOST_AUTO_TEST_CASE(a_file_that_cannot_be_written_is_named_and_leaves_nothing) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "taken");
  std::filesystem::create_directory(folder / "taken/child");
  const auto before = files_below(folder / "");
  for (const std::string& path : {folder / "none/a", folder / "taken"}) {
    BOOST_CHECK_EXCEPTION(write_file(path, "text"), std::runtime_error, [&](const std::exception& error) {
      return std::string(error.what()).find("cannot write " + path) == 0;
    });
  }
  BOOST_TEST((files_below(folder / "") == before));
}

BOOST_AUTO_TEST_CASE(links_are_followed_and_devices_are_not_replaced) {
  const TemporaryFolder folder;
  write_file(folder / "file", "old");
  std::filesystem::create_symlink("file", folder / "link");
  write_file(folder / "link", "new");
  BOOST_TEST(std::filesystem::is_symlink(folder / "link"));
  BOOST_TEST(read_file(folder / "file") == "new");
  const std::string pipe = folder / "pipe";
  BOOST_REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  BOOST_CHECK_THROW(write_file(pipe, "text"), std::runtime_error);
  BOOST_TEST(std::filesystem::is_fifo(pipe));
}

BOOST_AUTO_TEST_CASE(a_file_that_cannot_be_read_is_named) {
  const TemporaryFolder folder;
  const auto says = [](const std::string& expected) {
    return [expected](const std::exception& error) { return error.what() == expected; };
  };
  const std::string none = folder / "none", itself = folder / "";
  BOOST_CHECK_EXCEPTION(read_file(none), std::runtime_error, says("cannot read " + none + ": No such file or directory"));
  BOOST_CHECK_EXCEPTION(read_file(itself), std::runtime_error,
                        says("cannot read " + itself + ": it is a folder; expected a file"));
}

BOOST_AUTO_TEST_CASE(the_folder_of_an_output_must_exist_and_be_no_table) {
  const TemporaryFolder folder;
  BOOST_CHECK_NO_THROW(check_writable_folder(folder / "a"));
  BOOST_CHECK_NO_THROW(check_writable_folder("a"));
  BOOST_CHECK_THROW(check_writable_folder(folder / "none/a"), std::runtime_error);
  write_file(folder / "table.dat", "");
  BOOST_CHECK_THROW(check_writable_folder(folder / "a"), std::runtime_error);
}

BOOST_AUTO_TEST_SUITE_END()
