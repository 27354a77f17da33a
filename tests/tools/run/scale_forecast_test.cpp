#include "tools/run/scale_forecast.h"

#include <cmath>

#include "ms_io/measurement_set.h"
#include "tests/tools/program.h"
#include "tools/base/numbers.h"
#include "tools/run/run_plan.h"

BOOST_AUTO_TEST_SUITE(scale_forecast)

namespace {

using namespace misfit;
using namespace misfit::tools;
using namespace misfit::tools::testing;

/// A planned run of the small set, as if it had so many samples.
struct Planned {
  explicit Planned(int niter, int planes = 1, int pixels = 4096, double samples = 1e11) {
    options.vis = {track()};
    options.imsize = {pixels, pixels};
    options.cell = "0.05arcsec";
    options.gridding.accuracy = 1e-4;
    options.clean.niter = niter;
    options.memory_gib = 64;
    options.scale.visibilities = samples;
    scene.emplace(RunScene{.options = options,
                           .set = set,
                           .ranks = imager::alone(),
                           .geometry = geometry_of(options, set.observation().phase_centre),
                           .reach = set.reach(),
                           .threads = 8,
                           .channels = planes,
                           .workers = std::min(8, planes),
                           .samples = samples / planes,
                           .enlarged = samples / static_cast<double>(set.samples())});
    imager::StageTimes times;
    ProgressLine silent(true);
    plan = plan_run(*scene, times, silent);
  }
  ScaleForecast scale() const { return {*scene, plan, forecast, work_of(*scene, plan)}; }

  ImageOptions options;
  ms_io::MeasurementSet set{track(), {}, "data"};
  TimeForecast forecast{std::filesystem::path()};
  std::optional<RunScene> scene;
  RunPlan plan;
};

constexpr double one_image_bytes = 8 * 4096.0 * 4096;
const auto nearly = boost::test_tools::tolerance(1e-9);

}  // namespace

BOOST_AUTO_TEST_CASE(one_node_takes_what_the_plan_expects) {
  for (const int planes : {1, 16}) {
    const Planned run(0, planes);
    const NodeForecast one = run.scale().at(1);
    const double expected = total_seconds(run.forecast.expected(work_of(*run.scene, run.plan)));
    // Planes are written one at a time.
    if (planes == 1)
      BOOST_TEST(one.image.total() == expected, nearly);
    else
      BOOST_TEST(one.image.total() >= expected * (1 - 1e-9));
    BOOST_TEST(one.image.exchange == 0);
    BOOST_TEST(one.cycle.total() == 0);
  }
}

BOOST_AUTO_TEST_CASE(samples_are_shared_and_images_are_not) {
  const Planned run(1000);
  const ScaleForecast scale = run.scale();
  const NodeForecast one = scale.at(1);
  BOOST_TEST(one.cycle.gridding > 0);
  for (const int nodes : {2, 7, 64}) {
    const NodeForecast some = scale.at(nodes);
    BOOST_TEST_CONTEXT(nodes << " nodes") {
      for (const auto& [is, was] : {std::pair(some.image, one.image), {some.cycle, one.cycle}}) {
        BOOST_TEST(is.gridding >= was.gridding / nodes * (1 - 1e-9));
        BOOST_TEST(is.gridding <= was.gridding / nodes + is.fft);  // grids, which each node has, are less than their FFTs
        BOOST_TEST(is.fft == was.fft, nearly);
        BOOST_TEST(is.first == was.first, nearly);
        BOOST_TEST(is.exchange > 0);
      }
      BOOST_TEST(some.image.read == one.image.read / nodes, nearly);
      BOOST_TEST(some.cycle.read == (some.kept ? 0 : some.image.read), nearly);
      BOOST_TEST(some.read_bytes == one.read_bytes / nodes, nearly);
      BOOST_TEST(some.image_bytes == 2 * one_image_bytes);
      BOOST_TEST(some.cycle_bytes == one_image_bytes);
    }
  }
  const double piece_bytes = 8.0 * (1 << 18), two_s = scale.at(2).image.exchange;
  for (const int nodes : {3, 8, 100})  // images pass in pieces, of which the first has the longest way
    BOOST_TEST(scale.at(nodes).image.exchange == two_s * (1 + (nodes - 2) * piece_bytes / one_image_bytes / 2), nearly);
  BOOST_TEST(!one.kept);
  BOOST_TEST(scale.at(64).kept);
}

BOOST_AUTO_TEST_CASE(a_network_half_as_fast_takes_longer_for_the_same_bytes) {
  Planned run(0);
  const double fast = run.scale().at(2).image.exchange;
  run.options.scale.network_gb_s = 12.5 / 1000;
  const double bytes = 2 * one_image_bytes;
  BOOST_TEST(run.scale().at(2).image.exchange - fast == bytes * (1000 - 1) / 12.5e9, nearly);
}

BOOST_AUTO_TEST_CASE(more_nodes_than_the_limit_help_little) {
  for (const int niter : {0, 1000})
    for (const double samples : {1e6, 1e9, 1e12}) {
      const Planned run(niter, 1, 1024, samples);
      const ScaleForecast scale = run.scale();
      const int limit = scale.limit();
      const auto seconds = [&](int nodes) { return scale.at(nodes).shown(niter > 0).total(); };
      BOOST_TEST(seconds(limit) < 1.25 * seconds(2 * limit));
      if (limit > 1) BOOST_TEST(seconds(limit / 2) >= 1.25 * seconds(limit));
    }
  BOOST_TEST(Planned(0, 1, 1024, 1e12).scale().limit() > Planned(0, 1, 1024, 1e9).scale().limit());
}

BOOST_AUTO_TEST_CASE(planes_are_made_by_as_many_nodes_as_there_are_planes) {
  const Planned run(0, 16);
  const ScaleForecast scale = run.scale();
  BOOST_TEST(scale.at(16).image.gridding < scale.at(4).image.gridding);
  BOOST_TEST(scale.at(32).image.gridding == scale.at(16).image.gridding, nearly);
  BOOST_TEST(scale.at(32).image.first == scale.at(1).image.first, nearly);
  BOOST_TEST(scale.limit() <= 16);
}

BOOST_AUTO_TEST_CASE(facets_are_taken_where_they_gain) {
  const Planned run(1000, 1, 16384, 1e9);
  const ScaleForecast scale = run.scale();
  BOOST_TEST(scale.best_facets(1).sharing.facets == 1);
  const NodeForecast rows = scale.at(1024), facets = scale.best_facets(1024);
  BOOST_TEST_REQUIRE(facets.sharing.facets > 1);
  BOOST_TEST(facets.cycle.total() < rows.cycle.total());
  BOOST_TEST(facets.cycle.fft < rows.cycle.fft);
  BOOST_TEST(facets.cycle.exchange < rows.cycle.exchange);
  BOOST_TEST(facets.cycle.first == rows.cycle.first, nearly);
}

BOOST_AUTO_TEST_CASE(the_program_prints_a_line_for_each_number_of_nodes_and_why_more_do_not_help) {
  const Arguments image{"image",      "--vis",     track(),   "--imagename", "none",           "--imsize", "4096",    "--cell",
                        "0.05arcsec", "--dry-run", "--nodes", "100",         "--visibilities", "1e12",     "--niter", "1000"};
  const Outcome outcome = run(image);
  BOOST_TEST(outcome.code == 0);
  BOOST_TEST(outcome.out.find("for " + grouped(1000000000000) + " samples on nodes of ") != std::string::npos, outcome.out);
  for (const char* nodes : {"\n        1 ", "\n       64 ", "\n      100 "})
    BOOST_TEST(outcome.out.find(nodes) != std::string::npos, nodes);
  BOOST_TEST(outcome.out.find("\n      128 ") == std::string::npos);
  BOOST_TEST(outcome.out.find("do not help: twice as many are ") != std::string::npos);
  BOOST_TEST(outcome.out.find("where a tree would take ") != std::string::npos);
  BOOST_TEST(outcome.out.find("nodes: facets shared among 100") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(nodes_are_refused_where_nothing_is_told_of_them) {
  const Arguments image = small_image(track(), "none");
  const Arguments dry = image + Arguments{"--dry-run"};
  for (const auto& [arguments, said] :
       {std::pair(image + Arguments{"--nodes", "4"}, "--nodes 4: expected --dry-run beside it"),
        {dry + Arguments{"--nodes", "-1"}, "--nodes -1: expected 0 (none) to 1048576 machines"},
        {dry + Arguments{"--visibilities", "1e9"}, "--visibilities 1e+09: expected --nodes"},
        {dry + Arguments{"--nodes", "4", "--visibilities", "-1"}, "--visibilities -1: expected 0"},
        {dry + Arguments{"--nodes", "4", "--network", "1e-9"}, "--network 1e-09: expected 0.001 to 1e6"},
        {dry + Arguments{"--nodes", "4", "--visibilities", "0.5"}, "--visibilities 0.5: expected 0"},
        {dry + Arguments{"--network", "4"}, "--network 4: expected --nodes"}}) {
    const Outcome outcome = run(arguments);
    BOOST_TEST(outcome.code == 2);
    BOOST_TEST(outcome.err.find(said) != std::string::npos, outcome.err);
  }
}

BOOST_AUTO_TEST_SUITE_END()
