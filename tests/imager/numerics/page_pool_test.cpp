#include "imager/numerics/page_pool.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <thread>
#include <vector>

BOOST_AUTO_TEST_SUITE(page_pool)

using misfit::imager::PagePool;

namespace {

struct Block {
  std::uint64_t* words;
  std::size_t count;
  std::uint64_t mark;

  void write() {
    for (std::size_t i = 0; i < count; ++i) words[i] = mark + i;
  }
  bool is_whole() const {
    for (std::size_t i = 0; i < count; ++i)
      if (words[i] != mark + i) return false;
    return true;
  }
};

/// Takes and gives back blocks of any size, many at a time. Returns whether each kept what was written into it.
bool blocks_stay_whole(unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Block> blocks;
  bool whole = true;
  for (int step = 0; step < 300; ++step) {
    if (blocks.size() > 5 || (!blocks.empty() && random() % 2 == 0)) {
      std::swap(blocks[random() % blocks.size()], blocks.back());
      whole = whole && blocks.back().is_whole() && PagePool::give(blocks.back().words);
      blocks.pop_back();
    } else {
      const std::size_t count = 1 + random() % (4 * PagePool::page_bytes / sizeof(std::uint64_t));
      const std::size_t bytes = count * sizeof(std::uint64_t);
      void* const block = random() % 2 == 0 ? PagePool::take(bytes) : PagePool::take_to_fill(bytes);
      blocks.push_back({static_cast<std::uint64_t*>(block), count, random()});
      blocks.back().write();
    }
  }
  for (const Block& block : blocks) whole = whole && block.is_whole() && PagePool::give(block.words);
  return whole;
}

}  // namespace

BOOST_AUTO_TEST_CASE(blocks_begin_with_a_page_and_keep_what_is_written_also_beside_other_threads) {
  void* const block = PagePool::take(1);
  BOOST_TEST_REQUIRE(block != nullptr);
  BOOST_TEST(reinterpret_cast<std::uintptr_t>(block) % PagePool::page_bytes == 0U);
  BOOST_TEST(PagePool::give(block));
  bool beside = false;
  PagePool::fill_by(3);
  std::thread other([&beside] { beside = blocks_stay_whole(1); });
  BOOST_TEST(blocks_stay_whole(2));
  other.join();
  BOOST_TEST(beside);
  PagePool::release();
  BOOST_TEST(blocks_stay_whole(3));
}

/// Pages of the system are clear, and those that come again are not.
BOOST_AUTO_TEST_CASE(pages_come_again_in_blocks_of_any_size) {
  PagePool::release();
  constexpr std::size_t page_words = PagePool::page_bytes / sizeof(std::uint64_t);
  std::vector<void*> blocks;
  const auto take = [&blocks](std::size_t pages) { blocks.push_back(PagePool::take(pages * PagePool::page_bytes)); };
  const auto word = [&blocks](std::size_t block, std::size_t page) -> std::uint64_t& {
    return static_cast<std::uint64_t*>(blocks[block])[page * page_words];
  };
  const auto give_all = [&blocks] {
    for (void* const block : blocks) BOOST_TEST(PagePool::give(block));
    blocks.clear();
  };
  take(2), take(3), take(1);
  for (const auto& [block, pages] : {std::pair(0, 2), {1, 3}, {2, 1}})
    for (int page = 0; page < pages; ++page) word(block, page) = 1;
  give_all();
  take(6);
  for (int page = 0; page < 6; ++page) BOOST_TEST(word(0, page) == 1U);
  give_all();
  take(4), take(2), take(1);
  for (int page = 0; page < 4; ++page) BOOST_TEST(word(0, page) == 1U);
  for (int page = 0; page < 2; ++page) BOOST_TEST(word(1, page) == 1U);
  BOOST_TEST(word(2, 0) == 0U);
  give_all();
}

/// Where the system lends pages on demand.
BOOST_AUTO_TEST_CASE(blocks_to_fill_have_all_their_pages_and_those_are_clear) {
  PagePool::release();
  PagePool::fill_by(3);
  constexpr std::size_t bytes = 7 * PagePool::page_bytes;
  void* const block = PagePool::take_to_fill(bytes);
  std::vector<unsigned char> resident(bytes / static_cast<std::size_t>(sysconf(_SC_PAGESIZE)));
  BOOST_TEST(mincore(block, bytes, resident.data()) == 0);
#ifdef MADV_POPULATE_WRITE
  if (madvise(nullptr, 0, MADV_POPULATE_WRITE) == 0)
    BOOST_TEST(std::all_of(resident.begin(), resident.end(), [](unsigned char page) { return (page & 1) != 0; }));
#endif
  const auto* const words = static_cast<const std::uint64_t*>(block);
  BOOST_TEST(std::all_of(words, words + bytes / sizeof *words, [](std::uint64_t word) { return word == 0; }));
  BOOST_TEST(PagePool::give(block));
}

BOOST_AUTO_TEST_CASE(what_is_not_of_the_pool_stays_as_it_is) {
  int here = 0;
  BOOST_TEST(!PagePool::give(&here));
  BOOST_TEST(!PagePool::give(nullptr));
  void* const aligned = std::aligned_alloc(PagePool::page_bytes, PagePool::page_bytes);
  BOOST_TEST(!PagePool::give(aligned));
  std::free(aligned);
}

BOOST_AUTO_TEST_CASE(more_than_there_can_be_is_refused) {
  BOOST_TEST(PagePool::take(~std::size_t{0}) == nullptr);
  BOOST_TEST(PagePool::take(std::size_t{1} << 50) == nullptr);
}

BOOST_AUTO_TEST_SUITE_END()
