#include "tools/kernel_choice/kernel_choice.h"

#include "kernels/kernel_table.h"
#include "tests/kernels/kernels.h"
#include "tests/tools/program.h"

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

std::string cache_folder_for(const char* given, const char* xdg, const char* home) {
  const Variable a("MISFIT_CACHE", given), b("XDG_CACHE_HOME", xdg), c("HOME", home);
  return default_cache_folder().string();
}

}  // namespace

BOOST_AUTO_TEST_SUITE(kernel_choice)

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
  BOOST_TEST(!is_kernel_file("least-misfit"));
  BOOST_TEST(!is_kernel_file("nosuch"));
  BOOST_TEST(is_kernel_file("k.fits"));
  BOOST_TEST(is_kernel_file("./k"));
  std::ofstream(folder / "k") << "";
  BOOST_TEST(is_kernel_file(folder / "k"));
}

BOOST_AUTO_TEST_CASE(a_solved_kernel_is_kept_in_the_cache) {
  const TemporaryFolder folder;
  const Variable cache("MISFIT_CACHE", (folder / "cache").c_str());
  choose_kernel("least-misfit").make(3, 0.3);
  BOOST_TEST(std::distance(std::filesystem::directory_iterator(folder / "cache"), {}) == 1);
}

BOOST_AUTO_TEST_CASE(a_file_is_a_family_of_its_one_kernel) {
  using namespace misfit::kernels;
  const TemporaryFolder folder;
  const std::string path = folder / "k.fits";
  const Kernel kernel = kernel_family("spheroidal").make(6, 0.3);
  write_kernel_table(kernel, {}, path);
  const KernelFamily family = choose_kernel(path);
  BOOST_TEST(family.name == path);
  BOOST_TEST(misfit::kernels::testing::same(family.make(6, 0.3), kernel));
  const Kernel narrower = family.make(6, 0.2);
  BOOST_TEST(narrower.misfit.mean == judge(kernel.polynomial, 0.2).mean);
  BOOST_TEST(narrower.name == "spheroidal");
  BOOST_CHECK_THROW(family.make(7, 0.3), std::invalid_argument);
  BOOST_CHECK_THROW(family.make(6, 0.31), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
