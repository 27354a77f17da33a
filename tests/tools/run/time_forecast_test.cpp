#include "tools/run/time_forecast.h"

#include <boost/test/unit_test.hpp>
#include <filesystem>

#include "tests/temporary_folder.h"
#include "tools/base/files.h"

BOOST_AUTO_TEST_SUITE(time_forecast)

using namespace misfit;
using namespace misfit::tools;

namespace {

imager::GriddingPlan plan_of(double samples, int pixels) {
  imager::GriddingRequest request;
  request.geometry = {pixels, pixels, 1e-6, {}};
  request.samples = static_cast<std::uint64_t>(samples);
  request.accuracy = 1e-4;
  return imager::plan_gridding(request);
}

RunWork work_of(const imager::GriddingPlan& plan, double major_cycles = 0) {
  RunWork work;
  work.plan = &plan;
  work.rows = 1e4;
  work.samples = static_cast<double>(plan.request.samples);
  work.pixels = static_cast<double>(plan.request.geometry.pixels());
  work.deconvolver = "hogbom";
  work.major_cycles = major_cycles;
  work.components = 1000 * major_cycles;
  return work;
}

/// What a machine takes that is `slower` than the one whose constants are built in.
imager::StageTimes times_of(const RunWork& work, double slower) {
  imager::StageTimes times;
  for (const StageSeconds& s : counted_seconds(work)) times.add(s.stage, slower * s.seconds);
  return times;
}

double expected_of(const TimeForecast& forecast, const RunWork& work, const std::string& stage) {
  for (const StageSeconds& s : forecast.expected(work))
    if (s.stage == stage) return s.seconds;
  return 0;
}

}  // namespace

BOOST_AUTO_TEST_CASE(further_taylor_terms_take_time_in_every_pass) {
  const imager::GriddingPlan plan = plan_of(1e7, 1024);
  const TimeForecast forecast("");
  for (const double cycles : {0.0, 4.0}) {
    RunWork work = work_of(plan, cycles);
    for (const int terms : {2, 3}) {
      const RunWork fewer = work;
      work.terms = terms;
      for (const std::string stage : {"grid", "fft"})
        BOOST_TEST(expected_of(forecast, work, stage) > expected_of(forecast, fewer, stage));
      if (cycles > 0)
        for (const std::string stage : {"degrid", "minor cycles", "restore"})
          BOOST_TEST(expected_of(forecast, work, stage) > expected_of(forecast, fewer, stage));
    }
  }
}

BOOST_AUTO_TEST_CASE(weights_take_time_where_they_follow_from_a_density) {
  const imager::GriddingPlan plan = plan_of(1e7, 1024);
  RunWork work = work_of(plan);
  const TimeForecast forecast("");
  BOOST_TEST(expected_of(forecast, work, "weights") == 0);
  work.density = true;
  const double plain = expected_of(forecast, work, "weights");
  BOOST_TEST(plain > 0);
  work.tapered = true;
  BOOST_TEST(expected_of(forecast, work, "weights") > plain);
}

BOOST_AUTO_TEST_CASE(a_machine_of_another_speed_is_known_after_one_run_and_scenes_of_another_size_too) {
  const misfit::testing::TemporaryFolder folder;
  const imager::GriddingPlan plan = plan_of(1e7, 1024), larger = plan_of(4e7, 2048);
  const RunWork work = work_of(plan, 3), other = work_of(larger, 5);
  BOOST_TEST(!TimeForecast(folder / "cache").knows(work));
  TimeForecast(folder / "cache").learn(work, times_of(work, 2.5));
  const TimeForecast forecast(folder / "cache");
  BOOST_TEST(forecast.knows(work));
  for (const StageSeconds& s : counted_seconds(work)) {
    double counted = 0, counted_other = 0;
    for (const StageSeconds& part : counted_seconds(work)) counted += part.stage == s.stage ? part.seconds : 0;
    for (const StageSeconds& part : counted_seconds(other)) counted_other += part.stage == s.stage ? part.seconds : 0;
    if (2.5 * counted < 5e-3) continue;  // too short to say anything
    BOOST_TEST(expected_of(forecast, work, s.stage) == 2.5 * counted, boost::test_tools::tolerance(1e-9));
    BOOST_TEST(expected_of(forecast, other, s.stage) == 2.5 * counted_other, boost::test_tools::tolerance(1e-9));
  }
}

BOOST_AUTO_TEST_CASE(the_run_of_the_nearest_size_counts) {
  const imager::GriddingPlan small = plan_of(1e5, 512), large = plan_of(1e8, 2048), larger = plan_of(8e8, 2048);
  TimeForecast forecast{std::filesystem::path()};
  const RunWork between = work_of(larger);
  forecast.learn(work_of(large), times_of(work_of(large), 4));
  forecast.learn(work_of(small), times_of(work_of(small), 0.3));
  for (const std::string stage : {"read", "grid"}) {
    double counted = 0;
    for (const StageSeconds& part : counted_seconds(between)) counted += part.stage == stage ? part.seconds : 0;
    BOOST_TEST(expected_of(forecast, between, stage) == 4 * counted, boost::test_tools::tolerance(1e-9));
  }
}

BOOST_AUTO_TEST_CASE(a_search_outside_is_expected_and_its_speed_learned_apart) {
  const imager::GriddingPlan plan = plan_of(1e7, 1024), wider = plan_of(1e7, 1000);
  RunWork work = work_of(plan);
  const double without = total_seconds(counted_seconds(work));
  work.wider = &wider;
  TimeForecast forecast{std::filesystem::path()};
  const double counted = expected_of(forecast, work, "sources outside");
  BOOST_TEST(counted > 0);
  BOOST_TEST(total_seconds(counted_seconds(work)) == without + counted, boost::test_tools::tolerance(1e-12));
  imager::StageTimes times;
  times.add("sources outside", 7 * counted);
  forecast.learn(work, times);
  BOOST_TEST(expected_of(forecast, work, "sources outside") == 7 * counted, boost::test_tools::tolerance(1e-12));
  work.wider = nullptr;
  BOOST_TEST(total_seconds(forecast.expected(work)) == without);
}

BOOST_AUTO_TEST_CASE(one_slow_run_among_many_is_forgotten) {
  const imager::GriddingPlan plan = plan_of(1e7, 1024);
  const RunWork work = work_of(plan);
  TimeForecast forecast{std::filesystem::path()};
  forecast.learn(work, times_of(work, 20));
  for (int run = 0; run < 30; ++run) forecast.learn(work, times_of(work, 1.5));
  BOOST_TEST(total_seconds(forecast.expected(work)) < 1.7 * total_seconds(counted_seconds(work)));
}

BOOST_AUTO_TEST_CASE(files_that_are_damaged_or_of_another_machine_are_not_used) {
  const misfit::testing::TemporaryFolder folder;
  const imager::GriddingPlan plan = plan_of(1e7, 1024);
  const RunWork work = work_of(plan);
  TimeForecast(folder / "cache").learn(work, times_of(work, 3));
  const std::string file = (folder / "cache") + "/times.json";
  const std::string kept = read_file(file);
  const auto expects_as_built_in = [&](const std::string& content) {
    write_file(file, content);
    BOOST_TEST(total_seconds(TimeForecast(folder / "cache").expected(work)) == total_seconds(counted_seconds(work)));
  };
  expects_as_built_in(kept.substr(0, kept.size() / 2));
  expects_as_built_in("[]");
  expects_as_built_in("{\"machine\": 3, \"kinds\": 4}");
  std::string other = kept;
  other.replace(other.find("\"machine\": \"") + 12, 3, "???");
  expects_as_built_in(other);
  const std::string wrong =
      R"({"machine": )" + kept.substr(kept.find("\"machine\": ") + 11,
                                      kept.find('\n', kept.find("\"machine\": ")) - kept.find("\"machine\": ") - 11);
  expects_as_built_in(wrong + R"(, "kinds": 4})");
  expects_as_built_in(wrong + R"(, "kinds": {"reading": 5, "planning": {"log": "x", "runs": 1}}})");
}

BOOST_AUTO_TEST_SUITE_END()
