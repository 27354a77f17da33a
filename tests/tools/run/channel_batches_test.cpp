#include "tools/run/channel_batches.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>

BOOST_AUTO_TEST_SUITE(channel_batches)

namespace {

using namespace misfit;

}  // namespace

BOOST_AUTO_TEST_CASE(batches_hold_every_plane_once_no_more_than_there_is_room_for_and_a_round_for_every_worker) {
  for (const int planes : {1, 2, 7, 64, 1000})
    for (const int workers : {1, 2, 3, 16})
      for (const int held : {1, 2, 5, 22, 1000}) {
        if (workers > planes || held < workers) continue;
        tools::ChannelBatches batches;
        batches.channels = std::min(held, planes);
        batches.workers.count = workers;
        BOOST_TEST((tools::batches_of(planes, batches).size() == 1) == (held >= planes));
        int next = 0;
        for (const imager::PlaneRange& range : tools::batches_of(planes, batches)) {
          BOOST_TEST_CONTEXT(planes << " planes, " << workers << " workers, " << held << " held, from " << range.first) {
            BOOST_TEST(range.first == next);
            BOOST_TEST(range.count > 0);
            BOOST_TEST(range.count <= held);
            const bool last = range.first + range.count == planes;
            BOOST_TEST((last || range.count % workers == 0));
          }
          next += range.count;
        }
        BOOST_TEST(next == planes);
      }
}

BOOST_AUTO_TEST_SUITE_END()
