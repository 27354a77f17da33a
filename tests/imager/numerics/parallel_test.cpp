#include "imager/numerics/parallel.h"

#include <atomic>
#include <boost/test/unit_test.hpp>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

BOOST_AUTO_TEST_SUITE(parallel)

using namespace misfit::imager;

BOOST_AUTO_TEST_CASE(every_index_runs_once_for_any_number_of_threads) {
  for (const int threads : {-1, 0, 1, 2, 7, 100})
    for (const std::size_t count : {0U, 1U, 5U, 1000U}) {
      const auto runs = std::make_unique<std::atomic<int>[]>(count);
      parallel_for(count, threads, [&](std::size_t i) { ++runs[i]; });
      BOOST_TEST_CONTEXT("threads " << threads << " count " << count)
      for (std::size_t i = 0; i < count; ++i) BOOST_TEST(runs[i] == 1);
    }
}

BOOST_AUTO_TEST_CASE(an_exception_reaches_the_caller_and_ends_the_work) {
  for (const int threads : {1, 4}) {
    std::atomic<int> after{0};
    const auto body = [&](std::size_t i) {
      if (i == 10) throw std::runtime_error("ten");
      if (i > 100000) ++after;
    };
    BOOST_CHECK_EXCEPTION(parallel_for(10000000, threads, body), std::runtime_error,
                          [](const std::exception& error) { return std::string(error.what()) == "ten"; });
    // Others may go on for as long as the exception takes to be thrown, not to the end.
    BOOST_TEST(after < 9000000);
  }
}

BOOST_AUTO_TEST_CASE(one_of_many_exceptions_is_rethrown) {
  const auto fail = [](std::size_t i) { throw std::out_of_range(std::to_string(i)); };
  BOOST_CHECK_THROW(parallel_for(100, 4, fail), std::out_of_range);
}

BOOST_AUTO_TEST_CASE(a_check_of_the_caller_s_thread_ends_the_work) {
  const auto pause = [](std::size_t) { std::this_thread::sleep_for(std::chrono::milliseconds(1)); };
  for (const int threads : {1, 4}) {
    std::atomic<int> runs{0};
    const StopCheck stop([] { throw std::runtime_error("stop"); });
    const auto body = [&](std::size_t i) {
      pause(i);
      ++runs;
    };
    BOOST_CHECK_THROW(parallel_for(100000, threads, body), std::runtime_error);
    BOOST_TEST(runs < 50000);
  }
  parallel_for(50, 1, pause);  // without one there is nothing to stop it
}

BOOST_AUTO_TEST_CASE(there_is_always_a_thread_to_run_in) {
  BOOST_TEST(available_threads() >= 1);
}

BOOST_AUTO_TEST_CASE(what_is_done_side_by_side_is_taken_in_order) {
  for (const int threads : {1, 3, 8}) {
    std::vector<std::size_t> made(200), taken;
    parallel_in_order(
        made.size(), threads,
        [&](std::size_t i) {
          for (std::size_t k = 0; k < 1000 * (i % 7); ++k) made[i] += k;
          made[i] = i * i;
        },
        [&](std::size_t i) { taken.push_back(made[i]); });
    BOOST_TEST(taken.size() == made.size());
    for (std::size_t i = 0; i < taken.size(); ++i) BOOST_TEST(taken[i] == i * i);
  }
  const auto fail = [](std::size_t i) {
    if (i == 5) throw std::out_of_range("five");
  };
  std::size_t taken = 0;
  BOOST_CHECK_THROW(parallel_in_order(100, 4, fail, [&](std::size_t) { ++taken; }), std::out_of_range);
  BOOST_TEST(taken <= 5U);
}

BOOST_AUTO_TEST_SUITE_END()
