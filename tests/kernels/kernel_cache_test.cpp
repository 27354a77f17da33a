#include "kernels/kernel_cache.h"

#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <thread>

#include "kernels/kernel_table.h"
#include "tests/kernels/kernels.h"
#include "tests/temporary_folder.h"

using namespace misfit::kernels;
using namespace misfit::kernels::testing;
using misfit::testing::TemporaryFolder;
namespace bdata = boost::unit_test::data;
namespace fs = std::filesystem;

namespace {

/// least-misfit, which counts how often it is solved.
struct Counted {
  TemporaryFolder temporary;
  std::string folder = temporary / "not yet/cache";
  int solved = 0;
  KernelFamily plain = kernel_family("least-misfit");
  KernelFamily family;

  Counted() { family = cached(counting(), folder); }
  KernelFamily counting() {
    KernelFamily counting = plain;
    counting.solve = [this](int width, double x0) {
      ++solved;
      return plain.solve(width, x0);
    };
    return counting;
  }
  std::string only_file() const {
    BOOST_REQUIRE(std::distance(fs::directory_iterator(folder), {}) == 1);
    return fs::directory_iterator(folder)->path().string();
  }
};

}  // namespace

BOOST_AUTO_TEST_SUITE(kernel_cache)

BOOST_DATA_TEST_CASE(a_kept_kernel_is_the_solved_one_bit_for_bit,
                     bdata::make({1, 5, 7, 12}) * bdata::make({0.25, 1.0 / 3, 0.4321}), width, x0) {
  Counted c;
  const Kernel missed = c.family.make(width, x0), found = c.family.make(width, x0);
  BOOST_TEST(c.solved == 1);
  BOOST_TEST(same(missed, c.plain.make(width, x0)));
  BOOST_TEST(same(found, missed));
}

BOOST_AUTO_TEST_CASE(kernels_with_other_keys_are_other_kernels) {
  Counted c;
  const double x0 = 0.25, next = std::nextafter(x0, 1);
  c.family.make(4, x0);
  BOOST_TEST(c.family.make(4, next).x0 == next);
  BOOST_TEST(c.family.make(5, x0).width() == 5);
  BOOST_TEST(c.solved == 3);
}

BOOST_AUTO_TEST_CASE(a_damaged_file_is_solved_for_anew_and_replaced) {
  Counted c;
  const Kernel kernel = c.family.make(4, 0.25);
  const std::string path = c.only_file(), good = content(path);
  std::string flipped = good;
  flipped[good.size() - 2880 + 9] ^= 1;
  int solved = 1;
  for (const std::string& bad : {std::string(), good.substr(0, 2880), good.substr(0, 5000), flipped, std::string("text")}) {
    put(path, bad);
    BOOST_TEST(same(c.family.make(4, 0.25), kernel));
    BOOST_TEST(c.solved == ++solved);
    BOOST_TEST(same(c.family.make(4, 0.25), kernel));
    BOOST_TEST(c.solved == solved);
  }
}

BOOST_AUTO_TEST_CASE(a_file_under_another_kernels_name_is_not_believed) {
  Counted c;
  c.family.make(4, 0.25);
  const std::string path = c.only_file();
  for (const auto& [name, width, x0] :
       {std::tuple("least-misfit", 5, 0.25), {"least-misfit", 4, 0.26}, {"spheroidal", 4, 0.25}}) {
    write_kernel_table(kernel_family(name).make(width, x0), {}, path);
    BOOST_TEST(same(c.family.make(4, 0.25), c.plain.make(4, 0.25)));
  }
  BOOST_TEST(c.solved == 4);
}

BOOST_AUTO_TEST_CASE(where_nothing_can_be_kept_the_family_solves) {
  Counted c;
  put(c.temporary / "file", "");
  for (const std::string& folder :
       {std::string(), c.temporary / "file", c.temporary / "file/below", std::string("/proc/none")}) {
    const KernelFamily family = cached(c.counting(), folder);
    BOOST_TEST(same(family.make(3, 0.25), c.plain.make(3, 0.25)));
    BOOST_TEST(same(family.make(3, 0.25), c.plain.make(3, 0.25)));
  }
  BOOST_TEST(c.solved == 8);
}

BOOST_AUTO_TEST_CASE(a_family_that_is_not_costly_keeps_nothing) {
  const TemporaryFolder folder;
  cached(kernel_family("spheroidal"), folder / "cache").make(6, 0.25);
  BOOST_TEST(!fs::exists(folder / "cache"));
}

BOOST_AUTO_TEST_CASE(threads_and_processes_that_share_a_folder_do_no_harm) {
  const TemporaryFolder folder;
  const KernelFamily plain = kernel_family("least-misfit");
  const Kernel expected = plain.make(5, 0.3);
  const auto all_right = [&] {
    std::atomic<bool> right{true};
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i)
      threads.emplace_back([&] {
        for (int round = 0; round < 10; ++round) {
          const KernelFamily family = cached(plain, folder / std::to_string(round));
          right = right && same(family.make(5, 0.3), expected);
        }
      });
    for (std::thread& thread : threads) thread.join();
    return right.load();
  };
  const pid_t child = fork();
  if (child == 0) _exit(all_right() ? 0 : 1);
  BOOST_TEST(all_right());
  int status = 0;
  BOOST_REQUIRE(waitpid(child, &status, 0) == child);
  BOOST_TEST(status == 0);
  for (int round = 0; round < 10; ++round)
    BOOST_TEST(std::distance(fs::directory_iterator(folder / std::to_string(round)), {}) == 1);
}

BOOST_AUTO_TEST_SUITE_END()
