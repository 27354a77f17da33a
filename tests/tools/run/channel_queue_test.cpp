#include "tools/run/channel_queue.h"

#include <atomic>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <mutex>
#include <stdexcept>

#include "tests/imager/thread_ranks.h"
#include "tools/run/channel_messages.h"

BOOST_AUTO_TEST_SUITE(channel_queue)

namespace bdata = boost::unit_test::data;
using namespace misfit;
using namespace misfit::tools;
using imager::testing::ThreadRanks;

namespace {

/// A channel whose members are all different, as far as messages have them.
MadeChannel channel(int number) {
  MadeChannel made;
  made.report.channel = number;
  made.report.frequency_hz = 1e9 + number;
  made.report.stokes[0].theory = imager::TheoreticalError{1e-3, 2e-3, 3e-3};
  made.report.stokes[0].clean =
      imager::CleanReport{.iterations = number, .stop_reason = "so", .cycles = {{}, {.ended = "why"}}, .kept = 1};
  made.report.stokes[0].brightest = {1, 2, 3.5};
  made.report.beams.emplace();
  made.report.beams->restoring = imager::Beam{3, 2, 1};
  made.report.beams->how = "fitted";
  made.report.beams->warnings = {"a", "b"};
  made.report.sums.used = 7;
  made.components = 12;
  made.warnings = {"c"};
  made.doubts = {"d", "e"};
  made.times.add("grid", 0.25);
  return made;
}

void check_channel(const MadeChannel& is) {
  const MadeChannel should = channel(is.report.channel);
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

imager::Image image(int number) {
  imager::Image image(3, 2);
  image.pixel = {1.0 * number, 0.1, -1e300, std::nan(""), 0, 5};
  return image;
}

const std::vector<imager::PlaneRange> batches{{0, 3}, {3, 3}, {6, 3}, {9, 1}};

/// Checks all that comes to it: channels in their order, with all that make_channels() gave them.
class Sink : public ChannelSink {
 public:
  void write(const std::string& kind, const imager::PlaneIndex& at, const imager::Image& pixels,
             const std::optional<imager::Beam>& beam) override {
    const std::lock_guard lock(mutex_);
    const imager::Image should = image(at.channel);
    BOOST_TEST(std::memcmp(pixels.pixel.data(), should.pixel.data(), 6 * sizeof(double)) == 0);
    BOOST_TEST((kind == "residual" && at.stokes == 1 && pixels.width == 3 && pixels.height == 2));
    BOOST_TEST(beam->major_rad == at.channel);
    ++written;
  }
  void take(MadeChannel&& made) override {
    const std::lock_guard lock(mutex_);
    BOOST_TEST(made.report.channel == taken++);
    check_channel(made);
  }

  int written = 0;
  int taken = 0;

 private:
  std::mutex mutex_;  ///< Boost.Test is for one thread
};

/// As a run does.
void make_channels(ChannelQueue& queue) {
  while (const auto batch = queue.next())
    for (int number = batch->first; number < batch->first + batch->count; ++number) {
      if (const auto file = queue.writer("residual")) file->write({number, 1}, image(number), imager::Beam{1.0 * number, 2, 3});
      queue.done(channel(number));
    }
  queue.finish();
}

/// How many rank 0 takes of so many ranks.
int taken_of(int size) {
  Sink sink;
  ThreadRanks(size).run([&](const imager::Ranks& ranks) { make_channels(*make_channel_queue(ranks, batches, sink)); });
  return sink.taken;
}

/// Takes all without a look.
class Deaf : public ChannelSink {
 public:
  void write(const std::string&, const imager::PlaneIndex&, const imager::Image&, const std::optional<imager::Beam>&) override {
  }
  void take(MadeChannel&& made) override { taken.push_back(made.report.channel); }

  std::vector<int> taken;
};

/// How many of three ranks stop where this one's channel was stopped.
int stopped_by(int rank) {
  Deaf sink;
  const std::vector<imager::PlaneRange> many(100000, {0, 1});
  std::atomic<int> stopped = 0;
  ThreadRanks(3).run([&](const imager::Ranks& ranks) {
    const auto queue = make_channel_queue(ranks, many, sink);
    if (ranks.rank() == rank) {
      MadeChannel last = channel(0);
      last.report.stokes[0].clean->stop = imager::CleanStop::user;
      queue->done(std::move(last));
    }
    while (!queue->stopped() && queue->next()) continue;
    queue->finish();
    if (queue->stopped()) ++stopped;
  });
  return stopped;
}

}  // namespace

BOOST_DATA_TEST_CASE(each_channel_comes_once_in_its_turn_with_all_that_it_has, bdata::make({1, 2, 3, 8}), size) {
  BOOST_TEST(taken_of(size) == 10);
}

BOOST_AUTO_TEST_CASE(images_of_others_are_written_at_rank_0) {
  Sink sink;
  ThreadRanks(3).run([&](const imager::Ranks& ranks) {
    const auto queue = make_channel_queue(ranks, batches, sink);
    if (!ranks.first()) return make_channels(*queue);
    BOOST_TEST(queue->writer("residual") == nullptr);
    queue->finish();
  });
  BOOST_TEST(sink.written == 10);
  BOOST_TEST(sink.taken == 10);
}

BOOST_AUTO_TEST_CASE(channels_that_wait_for_others_which_do_not_come_are_handed_on_at_the_end) {
  Deaf sink;
  const auto queue = make_channel_queue(imager::alone(), batches, sink);
  for (const int number : {2, 0, 5}) queue->done(channel(number));
  BOOST_TEST(sink.taken == std::vector{0});
  queue->finish();
  BOOST_TEST(sink.taken == (std::vector{0, 2, 5}));
}

BOOST_AUTO_TEST_CASE(who_is_told_to_stop_gets_no_more) {
  Sink sink;
  std::atomic<int> without_batch = 0, stopped = 0;  // Boost.Test is for one thread
  ThreadRanks(3).run([&](const imager::Ranks& ranks) {
    const auto queue = make_channel_queue(ranks, batches, sink);
    if (ranks.first()) {
      queue->stop();
      return queue->finish();
    }
    if (!queue->next().has_value()) ++without_batch;
    if (queue->stopped()) ++stopped;
    queue->finish();
  });
  BOOST_TEST(without_batch == 2);
  BOOST_TEST(stopped == 2);
}

BOOST_DATA_TEST_CASE(a_channel_that_the_user_stopped_stops_all, bdata::make({0, 1}), by) {
  BOOST_TEST(stopped_by(by) == 3);
}

BOOST_AUTO_TEST_CASE(a_rank_that_is_told_to_stop_while_it_makes_nothing_stops_all) {
  Deaf sink;
  std::atomic<int> stopped = 0;
  ThreadRanks(3).run([&](const imager::Ranks& ranks) {
    const auto queue = make_channel_queue(ranks, batches, sink);
    if (ranks.rank() == 2) queue->stop();
    queue->finish();
    if (ranks.first() && queue->stopped()) ++stopped;
  });
  BOOST_TEST(stopped == 1);
}

BOOST_AUTO_TEST_CASE(what_fails_with_what_others_send_fails_at_rank_0) {
  class Full : public Sink {
   public:
    void take(MadeChannel&&) override { throw std::runtime_error("full"); }
  } sink;
  bool told = false;
  ThreadRanks(2).run([&](const imager::Ranks& ranks) {
    if (!ranks.first())
      return ranks.send(0, bytes_of(ChannelMessage{.kind = ChannelMessage::Kind::channel, .channel = channel(0)}));
    const auto queue = make_channel_queue(ranks, batches, sink);
    BOOST_CHECK_EXCEPTION(queue->finish(), std::runtime_error, [](const auto& e) { return std::string(e.what()) == "full"; });
    told = queue->given_up();
  });
  BOOST_TEST(told);
}

/// Rank 0 does not wait for channels that others still make when it fails itself.
BOOST_AUTO_TEST_CASE(who_leaves_does_not_wait_for_others) {
  Sink sink;
  ThreadRanks(2).run([&](const imager::Ranks& ranks) {
    if (ranks.first()) make_channel_queue(ranks, batches, sink)->next();
  });
}

BOOST_AUTO_TEST_SUITE_END()
