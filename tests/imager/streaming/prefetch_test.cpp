#include "imager/streaming/prefetch.h"

#include <atomic>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <chrono>
#include <functional>
#include <set>
#include <stdexcept>
#include <thread>

BOOST_AUTO_TEST_SUITE(prefetch)

namespace bdata = boost::unit_test::data;
using namespace misfit::imager;

namespace {

/// Blocks of 1, 2, 3 … rows, as many as asked for.
class Counting : public BlockStream {
 public:
  explicit Counting(std::size_t blocks, std::function<void(std::size_t)> before = {})
      : blocks_(blocks), before_(std::move(before)) {}
  std::shared_ptr<const VisibilityBlock> next() override {
    if (before_) before_(given_);
    if (given_ == blocks_) return nullptr;
    const auto block = std::make_shared<VisibilityBlock>();
    block->uvw_m.edit().resize(3 * ++given_);
    return block;
  }

 private:
  std::size_t blocks_;
  std::function<void(std::size_t)> before_;
  std::size_t given_ = 0;
};

}  // namespace

BOOST_DATA_TEST_CASE(blocks_come_in_their_order_and_end, bdata::make({0, 1, 2, 7, 100}), ahead) {
  for (const std::size_t blocks : {0, 1, 5, 40}) {
    const auto stream = prefetched(std::make_unique<Counting>(blocks), static_cast<std::size_t>(ahead));
    for (std::size_t i = 1; i <= blocks; ++i) {
      const auto block = stream->next();
      BOOST_REQUIRE(block != nullptr);
      BOOST_REQUIRE_EQUAL(block->rows(), i);
    }
    BOOST_TEST(!stream->next());
    BOOST_TEST(!stream->next());
  }
}

BOOST_DATA_TEST_CASE(what_the_stream_throws_comes_after_the_blocks_before_it, bdata::make({0, 1, 3}), ahead) {
  const auto fail_at_third = [](std::size_t given) {
    if (given == 2) throw std::runtime_error("a broken disk");
  };
  const auto stream = prefetched(std::make_unique<Counting>(9, fail_at_third), static_cast<std::size_t>(ahead));
  BOOST_TEST(stream->next()->rows() == 1U);
  BOOST_TEST(stream->next()->rows() == 2U);
  BOOST_CHECK_EXCEPTION(stream->next(), std::runtime_error,
                        [](const std::exception& error) { return error.what() == std::string("a broken disk"); });
}

BOOST_AUTO_TEST_CASE(a_stream_may_be_dropped_at_any_time) {
  for (const int taken : {0, 1, 2, 5})
    for (const bool waiting : {false, true}) {
      const auto stream = prefetched(std::make_unique<Counting>(5), 2);
      for (int i = 0; i < taken; ++i) stream->next();
      if (waiting) std::this_thread::sleep_for(std::chrono::milliseconds(2));  // until the reader waits for room, mostly
    }
}

BOOST_AUTO_TEST_CASE(no_more_is_read_ahead_than_asked_and_all_of_it_in_one_other_thread) {
  constexpr std::size_t ahead = 3;
  std::atomic<std::size_t> taken = 0;
  std::atomic<bool> too_far = false;
  std::set<std::thread::id> threads;
  const auto watch = [&](std::size_t given) {
    // Called to read block `given`, counted from 0, while `ahead` − 1 others may wait.
    if (given >= taken + ahead) too_far = true;
    threads.insert(std::this_thread::get_id());
  };
  {
    const auto stream = prefetched(std::make_unique<Counting>(20, watch), ahead);
    for (++taken; stream->next(); ++taken) std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  BOOST_TEST(!too_far);
  BOOST_TEST(threads.size() == 1U);
  BOOST_TEST(threads.count(std::this_thread::get_id()) == 0U);
}

BOOST_AUTO_TEST_SUITE_END()
