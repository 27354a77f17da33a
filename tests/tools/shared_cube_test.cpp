#include "tools/run/shared_cube.h"

#include <atomic>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <map>
#include <mutex>
#include <stdexcept>

#include "tests/imager/thread_ranks.h"

BOOST_AUTO_TEST_SUITE(shared_cube)

namespace bdata = boost::unit_test::data;
using namespace misfit;
using namespace misfit::tools;
using imager::testing::ThreadRanks;

namespace {

/// A plane whose members are all different, as far as messages have them.
CubePlane plane(int channel) {
  CubePlane plane;
  plane.report.channel = channel;
  plane.report.frequency_hz = 1e9 + channel;
  plane.report.stokes[0].theory = imager::TheoreticalError{1e-3, 2e-3, 3e-3};
  plane.report.stokes[0].clean =
      imager::CleanReport{.iterations = channel, .stop_reason = "so", .cycles = {{}, {.ended = "why"}}, .kept = 1};
  plane.report.stokes[0].brightest = {1, 2, 3.5};
  plane.report.beams.emplace();
  plane.report.beams->restoring = imager::Beam{3, 2, 1};
  plane.report.beams->how = "fitted";
  plane.report.beams->warnings = {"a", "b"};
  plane.report.sums.used = 7;
  plane.components = 12;
  plane.warnings = {"c"};
  plane.doubts = {"d", "e"};
  plane.times.add("grid", 0.25);
  return plane;
}

void check_plane(const CubePlane& is) {
  const CubePlane should = plane(is.report.channel);
  BOOST_TEST(is.report.frequency_hz == should.report.frequency_hz);
  const StokesReport &stokes = is.report.stokes.at(0), &expected = should.report.stokes.at(0);
  BOOST_TEST(stokes.theory->bound_max == 3e-3);
  BOOST_TEST(!stokes.measured.has_value());
  BOOST_TEST(stokes.clean->iterations == expected.clean->iterations);
  BOOST_TEST(stokes.clean->final_state().ended == "why");
  BOOST_TEST(stokes.brightest.value == 3.5);
  BOOST_TEST(is.report.beams->restoring->minor_rad == 2);
  BOOST_TEST(!is.report.beams->quadrant.has_value());
  BOOST_TEST(is.report.beams->warnings == should.report.beams->warnings);
  BOOST_TEST(is.report.sums.used == 7U);
  BOOST_TEST(is.components == 12);
  BOOST_TEST(is.warnings == should.warnings);
  BOOST_TEST(is.doubts == should.doubts);
  BOOST_TEST(is.times.of("grid") == 0.25);
}

imager::Image image(int channel) {
  imager::Image image(3, 2);
  image.pixel = {1.0 * channel, 0.1, -1e300, std::nan(""), 0, 5};
  return image;
}

const std::vector<imager::PlaneRange> batches{{0, 3}, {3, 3}, {6, 3}, {9, 1}};

void make_as_others_do(const imager::Ranks& ranks) {
  PlaneLink link(ranks);
  link.open();
  const auto file = link.open();
  while (const auto batch = link.next())
    for (int channel = batch->first; channel < batch->first + batch->count; ++channel) {
      file->write({channel, 1}, image(channel), imager::Beam{1.0 * channel, 2, 3});
      link.put(plane(channel));
    }
  link.end();
}

}  // namespace

BOOST_DATA_TEST_CASE(each_plane_comes_once_with_all_that_it_has, bdata::make({1, 2, 3, 8}), size) {
  std::mutex mutex;
  std::map<int, int> written, taken;
  ThreadRanks(size).run([&](const imager::Ranks& ranks) {
    if (!ranks.first()) return make_as_others_do(ranks);
    PlaneDealer dealer(
        ranks, batches,
        {[&](int file, const imager::PlaneIndex& at, const imager::Image& pixels, const std::optional<imager::Beam>& beam) {
           const std::lock_guard lock(mutex);
           ++written[at.channel];
           const imager::Image should = image(at.channel);
           BOOST_TEST(std::memcmp(pixels.pixel.data(), should.pixel.data(), 6 * sizeof(double)) == 0);
           BOOST_TEST((file == 1 && at.stokes == 1 && pixels.width == 3 && pixels.height == 2));
           BOOST_TEST(beam->major_rad == at.channel);
         },
         [&](CubePlane&& one) {
           const std::lock_guard lock(mutex);
           ++taken[one.report.channel];
           check_plane(one);
         },
         [] {}, [] { return false; }, [] {}});
    while (const auto batch = dealer.next())
      for (int channel = batch->first; channel < batch->first + batch->count; ++channel) {
        const std::lock_guard lock(mutex);
        ++written[channel];
        ++taken[channel];
      }
    dealer.finish();
  });
  BOOST_TEST(taken.size() == 10U);
  for (const auto& [channel, times] : taken) BOOST_TEST((times == 1 && written[channel] == 1));
}

BOOST_AUTO_TEST_CASE(who_is_told_to_stop_gets_no_more) {
  std::atomic<int> without_batch = 0, stopped = 0;  // Boost.Test is for one thread
  ThreadRanks(3).run([&](const imager::Ranks& ranks) {
    if (ranks.first()) {
      PlaneDealer dealer(ranks, batches, {[](auto&&...) {}, [](CubePlane&&) {}, [] {}, [] { return true; }, [] {}});
      return dealer.finish();
    }
    PlaneLink link(ranks);
    if (!link.next().has_value()) ++without_batch;
    if (link.stopped()) ++stopped;
    link.end();
  });
  BOOST_TEST(without_batch == 2);
  BOOST_TEST(stopped == 2);
}

BOOST_AUTO_TEST_CASE(whoever_is_told_to_stop_stops_all) {
  bool stopped = false;
  ThreadRanks(3).run([&](const imager::Ranks& ranks) {
    if (ranks.first()) {
      PlaneDealer dealer(ranks, batches,
                         {[](auto&&...) {}, [](CubePlane&&) {}, [&] { stopped = true; }, [&] { return stopped; }, [] {}});
      return dealer.finish();
    }
    PlaneLink link(ranks);
    if (ranks.rank() == 1) link.stop();
    while (link.next())  // as long as the other has not said so
      continue;
    link.end();
  });
  BOOST_TEST(stopped);
}

BOOST_AUTO_TEST_CASE(what_fails_with_what_others_send_fails_at_rank_0) {
  bool told = false;
  ThreadRanks(2).run([&](const imager::Ranks& ranks) {
    if (!ranks.first()) return ranks.send(0, bytes_of(PlaneMessage{PlaneMessage::Kind::plane, 0, {}, {}, {}, plane(0)}));
    PlaneDealer dealer(ranks, batches,
                       {[](auto&&...) {}, [](CubePlane&&) { throw std::runtime_error("full"); }, [] {}, [] { return false; },
                        [&] { told = true; }});
    BOOST_CHECK_EXCEPTION(dealer.finish(), std::runtime_error, [](const auto& e) { return std::string(e.what()) == "full"; });
  });
  BOOST_TEST(told);
}

/// Rank 0 does not wait for planes that others still make when it fails itself.
BOOST_AUTO_TEST_CASE(who_leaves_does_not_wait_for_others) {
  ThreadRanks(2).run([&](const imager::Ranks& ranks) {
    if (ranks.first()) PlaneDealer(ranks, batches, {[](auto&&...) {}, [](CubePlane&&) {}, [] {}, [] { return false; }, [] {}});
  });
}

BOOST_AUTO_TEST_SUITE_END()
