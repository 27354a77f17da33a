#include "tools/kernel_choice/kernel_choice.h"

#include <CLI/CLI.hpp>

#include "kernels/kernel_table.h"
#include "tests/kernels/kernels.h"
#include "tests/tools/program.h"
#include "tools/kernel_choice/cache_folder.h"

BOOST_AUTO_TEST_SUITE(kernel_choice)

using namespace misfit::tools;
using misfit::testing::TemporaryFolder;

namespace {

/// The value of a variable of the environment, for the length of a test; nullptr unsets it.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* const before = std::getenv(name)) before_ = before;
    set(value);
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;
  ~Variable() { set(before_ ? before_->c_str() : nullptr); }

 private:
  void set(const char* value) const {
    if (value == nullptr)
      unsetenv(name_);
    else
      setenv(name_, value, 1);
  }
  const char* name_;
  std::optional<std::string> before_;
};

/// The folder in force, for the length of a test.
class CurrentFolder {
 public:
  explicit CurrentFolder(const std::filesystem::path& folder) { std::filesystem::current_path(folder); }
  CurrentFolder(const CurrentFolder&) = delete;
  CurrentFolder& operator=(const CurrentFolder&) = delete;
  ~CurrentFolder() { std::filesystem::current_path(before_); }

 private:
  std::filesystem::path before_ = std::filesystem::current_path();
};

/// What choose_kernel says of a kernel that cannot be meant.
std::string refusal(const KernelSource& kernel) {
  try {
    choose_kernel(kernel);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

std::string declared_folder(const char* environment, std::vector<std::string> typed) {
  const Variable variable("MISFIT_KERNEL_FOLDER", environment);
  CLI::App command;
  std::string folder;
  declare_kernel_folder(command, folder);
  command.parse(typed);
  return folder;
}

std::string cache_folder_for(const char* given, const char* xdg, const char* home) {
  const Variable a("MISFIT_CACHE", given), b("XDG_CACHE_HOME", xdg), c("HOME", home);
  return default_cache_folder().string();
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_cache_is_where_the_user_says_or_where_caches_are) {
  BOOST_TEST(cache_folder_for("/a", "/b", "/c") == "/a");
  BOOST_TEST(cache_folder_for("", "/b", "/c") == "/b/misfit");
  BOOST_TEST(cache_folder_for(nullptr, "relative", "/c") == "/c/.cache/misfit");
  BOOST_TEST(cache_folder_for(nullptr, nullptr, "/c") == "/c/.cache/misfit");
  BOOST_TEST(cache_folder_for(nullptr, nullptr, "/").empty());
  BOOST_TEST(cache_folder_for(nullptr, nullptr, nullptr).empty());
}

BOOST_AUTO_TEST_CASE(names_are_of_the_catalogue_and_paths_are_files) {
  const TemporaryFolder folder;
  BOOST_TEST(!is_kernel_file({"least-misfit", ""}));
  BOOST_TEST(!is_kernel_file({"nosuch", ""}));
  BOOST_TEST(is_kernel_file({"k.fits", ""}));
  BOOST_TEST(is_kernel_file({"./k", ""}));
  std::ofstream(folder / "k") << "";
  BOOST_TEST(is_kernel_file({folder / "k", ""}));
}

BOOST_AUTO_TEST_CASE(a_solved_kernel_is_kept_in_the_cache) {
  const TemporaryFolder folder;
  const Variable cache("MISFIT_CACHE", (folder / "cache").c_str());
  choose_kernel({}).make(3, 0.3);
  BOOST_TEST(std::distance(std::filesystem::directory_iterator(folder / "cache"), {}) == 1);
}

BOOST_AUTO_TEST_CASE(a_file_is_a_family_of_its_one_kernel) {
  using namespace misfit::kernels;
  const TemporaryFolder folder;
  const std::string path = folder / "k.fits";
  const Kernel kernel = kernel_family("spheroidal").make(6, 0.3);
  write_kernel_table(kernel, {}, path);
  const KernelFamily family = choose_kernel({path, ""});
  BOOST_TEST(family.name == path);
  BOOST_TEST(misfit::kernels::testing::same(family.make(6, 0.3), kernel));
  const Kernel narrower = family.make(6, 0.2);
  BOOST_TEST(narrower.misfit.mean == judge(kernel.polynomial, 0.2).mean);
  BOOST_TEST(narrower.name == "spheroidal");
  BOOST_CHECK_THROW(family.make(7, 0.3), std::invalid_argument);
  BOOST_CHECK_THROW(family.make(6, 0.31), std::invalid_argument);
}

BOOST_AUTO_TEST_CASE(a_library_is_found_in_the_folder_that_the_user_names_and_nowhere_else) {
  const CurrentFolder here(MISFIT_PLUGINS);
  const Variable path("LD_LIBRARY_PATH", MISFIT_PLUGINS);
  for (const char* folder : {MISFIT_PLUGINS, "."}) {
    BOOST_TEST(choose_kernel({"gauss", folder}).make(6, 0.25).name == "gauss");
    BOOST_TEST(!is_kernel_file({"gauss", folder}));
    BOOST_TEST(file_of({"gauss", folder}) == std::filesystem::path(folder) / "libmisfit_kernel_gauss.so");
  }
  BOOST_TEST(ends_with(refusal({"gauss", ""}), "a kernel-table file, or with --kernel-folder a library"));
  BOOST_TEST(file_of({"gauss", ""}).empty());
  BOOST_TEST(file_of({"gaussian", MISFIT_PLUGINS}).empty());
  BOOST_TEST(choose_kernel({"gaussian", MISFIT_PLUGINS}).name == "gaussian");
}

BOOST_AUTO_TEST_CASE(the_folder_is_the_one_typed_or_that_of_the_environment) {
  BOOST_TEST(declared_folder(nullptr, {}) == "");
  BOOST_TEST(declared_folder("/a", {}) == "/a");
  BOOST_TEST(declared_folder("/a", {"/b", "--kernel-folder"}) == "/b");  // the parser takes them from the end
}

BOOST_AUTO_TEST_CASE(a_kernel_of_a_library_is_not_kept_in_the_cache) {
  const TemporaryFolder folder;
  const Variable cache("MISFIT_CACHE", (folder / "cache").c_str());
  choose_kernel({"gauss", MISFIT_PLUGINS}).make(3, 0.3);
  BOOST_TEST(!std::filesystem::exists(folder / "cache"));
}

BOOST_AUTO_TEST_CASE(a_kernel_that_is_not_known_is_refused_with_the_libraries_there_are) {
  const TemporaryFolder folder;
  const std::string wanted = folder / "libmisfit_kernel_han.so";
  BOOST_TEST(ends_with(refusal({"han", folder / ""}), "or a library: " + wanted + " does not exist, nor any other kernel's"));
  for (const char* name : {"libmisfit_kernel_hann.so", "libmisfit_kernel_a.so"}) std::ofstream(folder / name) << "";
  BOOST_TEST(ends_with(refusal({"han", folder / ""}), wanted + " does not exist; that folder has a, hann"));
  BOOST_TEST(
      ends_with(refusal({"han", folder / "none"}), "none/libmisfit_kernel_han.so does not exist: there is no such folder"));
}

BOOST_AUTO_TEST_CASE(no_library_takes_the_place_of_a_kernel_of_the_catalogue_or_of_a_file) {
  const TemporaryFolder folder;
  const CurrentFolder here(folder / "");
  std::filesystem::create_directory("libraries");
  for (const std::string name : {"gaussian", "spheroidal-exact-0.5", "k", "some"})
    std::ofstream("libraries/libmisfit_kernel_" + name + ".so") << "";
  std::ofstream("k") << "";
  std::filesystem::create_directory("some");
  for (const std::string name : {"gaussian", "spheroidal-exact-0.5", "k"})
    BOOST_TEST(refusal({name, "libraries"}).find("means both") != std::string::npos, name);
  BOOST_TEST(refusal({"k", "libraries"}).find("expected ./k for the file") != std::string::npos);
  BOOST_TEST(is_kernel_file({"./k", "libraries"}));
  BOOST_CHECK_THROW(choose_kernel({"some", "libraries"}), std::runtime_error);  // a folder is no kernel: the library is meant
}

BOOST_AUTO_TEST_SUITE_END()
