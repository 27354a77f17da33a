#include "tools/run/memory_plan.h"

#include <boost/test/unit_test.hpp>

#include "tools/base/memory.h"

BOOST_AUTO_TEST_SUITE(memory_plan)

using namespace misfit;
using namespace misfit::tools;

namespace {

/// 1.2 GiB to keep, 0.36 GiB in flight, less than 1 GiB for all else.
const imager::MemoryDemand demand{
    .transform = {0.3 * gib, 0.15 * gib, 1e6}, .pixels = 1e7, .rows = 1, .samples = 0.1 * gib, .block_samples = 0.01 * gib};

MemoryPlan plan(double memory_gib) {
  ImageOptions options;
  options.imsize = {4000, 2500};
  options.memory_gib = memory_gib;
  return plan_memory(demand, options, physical_memory_bytes());
}

}  // namespace

BOOST_AUTO_TEST_CASE(visibilities_are_kept_where_they_fit) {
  const MemoryPlan roomy = plan(3);
  BOOST_TEST(roomy.streaming.keep);
  BOOST_TEST(roomy.decision.decision == "kept in memory");
  BOOST_TEST(roomy.peak.total() <= 3 * gib);
  const MemoryPlan tight = plan(1.5);
  BOOST_TEST(!tight.streaming.keep);
  BOOST_TEST(tight.streaming.ahead == 2U);
  BOOST_TEST(tight.decision.decision == "read again in every pass");
  BOOST_TEST(tight.peak.total() <= 1.5 * gib);
}

BOOST_AUTO_TEST_CASE(the_less_memory_the_less_is_read_ahead) {
  std::size_t last = 2;
  for (double memory_gib = 1.5;; memory_gib -= 0.01) {
    try {
      const MemoryPlan made = plan(memory_gib);
      BOOST_TEST(made.peak.total() <= memory_gib * gib);
      BOOST_TEST(made.streaming.ahead <= last);
      last = made.streaming.ahead;
    } catch (const std::invalid_argument&) {
      break;
    }
  }
  BOOST_TEST(last == 0U);
}

BOOST_AUTO_TEST_CASE(what_is_said_to_be_needed_is_enough_and_a_hundredth_less_is_not) {
  std::string message;
  try {
    plan(0.01);
  } catch (const std::invalid_argument& error) {
    message = error.what();
  }
  BOOST_TEST(message.find("--memory 0.01: expected at least ") == 0U);
  BOOST_TEST(message.find("4000 × 2500") != std::string::npos);
  const double needed_gib = std::stod(message.substr(message.find("least ") + 6));
  BOOST_CHECK_NO_THROW(plan(needed_gib));
  BOOST_CHECK_THROW(plan(needed_gib - 0.011), std::invalid_argument);
}

BOOST_AUTO_TEST_CASE(by_default_half_of_the_machine_is_there_for_visibilities) {
  imager::MemoryDemand large = demand;
  ImageOptions options;
  options.imsize = {4000, 2500};
  BOOST_TEST(plan_memory(demand, options, physical_memory_bytes()).streaming.keep ==
             (imager::peak_memory(demand, {}).total() < physical_memory_bytes() / 2));
  large.samples = physical_memory_bytes();  // twelve times what there is
  BOOST_TEST(!plan_memory(large, options, physical_memory_bytes()).streaming.keep);
  large.pixels = physical_memory_bytes();
  BOOST_CHECK_EXCEPTION(
      plan_memory(large, options, physical_memory_bytes()), std::invalid_argument, [](const std::exception& error) {
        return std::string(error.what()).find("--imsize 4000 2500: expected an image that fits this machine's") == 0;
      });
}

BOOST_AUTO_TEST_CASE(a_w_axis_gathers_as_many_samples_as_there_is_room_for) {
  const auto demand_of = [](const imager::GriddingPlan& plan) {
    const auto samples = static_cast<double>(plan.request.samples);
    return imager::MemoryDemand{.transform = imager::memory_of(plan),
                                .pixels = static_cast<double>(plan.request.geometry.pixels()),
                                .rows = samples / 64,
                                .samples = samples,
                                .block_samples = 1e6};
  };
  for (const double memory_gib : {1.0, 2.0, 16.0})
    for (const double samples : {1e5, 1e7, 1e9})
      for (const double max_abs_w : {0.0, 5e4}) {
        imager::GriddingRequest request;
        request.geometry = {2048, 2048, 5e-6, {}};
        request.accuracy = 1e-4;
        request.samples = static_cast<std::uint64_t>(samples);
        request.max_abs_w = max_abs_w;
        limit_memory(memory_gib * gib, request);
        ImageOptions options;
        options.memory_gib = memory_gib;
        const imager::GriddingPlan plan = plan_with_room(request, demand_of, options, physical_memory_bytes());
        const std::size_t at_once = plan.request.samples_at_once;
        BOOST_TEST_CONTEXT(memory_gib << " GiB, " << samples << " samples, w to " << max_abs_w) {
          const double held = imager::peak_memory(demand_of(plan), least_streaming).total();
          BOOST_TEST(held <= memory_gib * gib);
          BOOST_TEST(at_once >= request.samples_at_once);
          if (max_abs_w == 0 || samples <= static_cast<double>(request.samples_at_once)) {
            BOOST_TEST(at_once == request.samples_at_once);
          } else if (samples == 1e9 && memory_gib < 12) {  // where visibilities are not kept
            BOOST_TEST(at_once > 2 * request.samples_at_once);
            BOOST_TEST(held > 0.5 * memory_gib * gib);
          }
        }
      }
}

BOOST_AUTO_TEST_CASE(the_table_names_the_peak_and_every_part) {
  const std::string table = memory_table({"the PSF is made", gib, 2 * gib, 0.5 * gib, 4 * gib, 0.25 * gib, 8 * gib});
  for (const char* part : {"15.8 GiB at most, while the PSF is made", "program: 1 GiB", "visibilities kept: 2 GiB",
                           "blocks in flight: 0.5 GiB", "grids: 4 GiB", "FFT buffers: 0.25 GiB", "images: 8 GiB"})
    BOOST_TEST(table.find(part) != std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()
