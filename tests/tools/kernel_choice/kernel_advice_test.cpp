#include "tools/kernel_choice/kernel_advice.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

#include "tests/temporary_folder.h"
#include "tools/kernel_choice/machine_costs.h"

BOOST_AUTO_TEST_SUITE(kernel_advice)

using namespace misfit;
using namespace misfit::tools;

namespace {

KernelJob job(double accuracy, double w_turns = 0) {
  return {{}, accuracy, {1024, 700}, 1e7, w_turns};
}

/// Costs that tell how many times they were measured, in place of what takes seconds.
class CountedCosts {
 public:
  imager::CostModel operator()() {
    imager::CostModel model;
    model.sample_ns = ++times_;
    return model;
  }
  int times() const { return times_; }

 private:
  int times_ = 0;
};

}  // namespace

BOOST_AUTO_TEST_CASE(the_choice_keeps_the_accuracy_and_costs_least_among_its_neighbours) {
  for (const double accuracy : {1e-2, 1e-4, 1e-6, 1e-8}) {
    const imager::GriddingChoice choice = choose_for(job(accuracy));
    BOOST_TEST(choice.best.worst_error <= accuracy);
    BOOST_TEST(!choice.rejected.empty());
    for (const imager::RejectedCandidate& r : choice.rejected) {
      if (r.reason == imager::Rejection::costs_more)
        BOOST_TEST(r.candidate.cost_s >= choice.best.cost_s * 0.95);  // which was costed before its degree was known
      else
        BOOST_TEST(r.candidate.worst_error > accuracy);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_w_axis_gets_a_width_and_padding_of_its_own_within_one_accuracy) {
  const imager::GriddingChoice choice = choose_for(job(1e-5, 30));
  BOOST_TEST(choice.best.worst_error <= 1e-5);
  BOOST_TEST(choice.best.work.planes >= 30 * choice.best.padding_w);
  BOOST_TEST(choice.best.w.kernel.width() == choice.best.work.width_w);
  BOOST_TEST(choice.best.expected_error >= std::sqrt(choice.best.w.misfit.mean));
}

BOOST_AUTO_TEST_CASE(more_samples_never_take_a_wider_kernel) {
  int width = 100;
  for (const double samples : {1e3, 1e5, 1e7, 1e9}) {
    KernelJob more = job(1e-6);
    more.samples = samples;
    const int chosen = choose_for(more).best.work.width;
    BOOST_TEST(chosen <= width);
    width = chosen;
  }
}

BOOST_AUTO_TEST_CASE(the_text_names_cost_operations_and_neighbours) {
  const std::string text = text_of(choose_for(job(1e-6)), {});
  for (const char* part : {"chosen: width", "operations", "rejected", "times the cost", "precision"})
    BOOST_TEST(text.find(part) != std::string::npos);
}

BOOST_AUTO_TEST_CASE(costs_are_measured_once_and_kept) {
  const misfit::testing::TemporaryFolder folder;
  CountedCosts costs;
  for (int i = 0; i < 2; ++i) BOOST_TEST(machine_costs(folder / "", std::ref(costs)).sample_ns == 1);
  BOOST_TEST(costs.times() == 1);
}

BOOST_AUTO_TEST_CASE(measured_costs_are_times, *boost::unit_test::label("sweep")) {
  const imager::CostModel measured = machine_costs("");
  for (const double cost : {measured.sample_ns, measured.cell_ns, measured.tap_ns, measured.fft_ns, measured.double_cost})
    BOOST_TEST((cost > 0 && std::isfinite(cost)));
}

BOOST_AUTO_TEST_CASE(damaged_files_of_costs_are_not_trusted) {
  const misfit::testing::TemporaryFolder folder;
  const std::filesystem::path file = folder / "costs.json";
  CountedCosts costs;
  int times = 0;
  for (const char* damage : {"", "{\"machine\": 3}", "[1, 2"}) {
    std::ofstream(file) << damage;
    BOOST_TEST(machine_costs(folder / "", std::ref(costs)).sample_ns == ++times);
    std::ifstream in(file);
    std::string first;
    std::getline(in, first);
    BOOST_TEST(first == "{");
  }
  BOOST_TEST(machine_costs("/proc/none", std::ref(costs)).sample_ns == ++times);
}

BOOST_AUTO_TEST_CASE(jobs_that_cannot_be_meant_are_refused) {
  const auto refused = [](auto change) {
    KernelJob j = job(1e-6);
    change(j);
    BOOST_CHECK_THROW(choose_for(j), std::invalid_argument);
  };
  refused([](KernelJob& j) { j.accuracy = 1; });
  refused([](KernelJob& j) { j.accuracy = 1e-17; });
  refused([](KernelJob& j) { j.imsize = {}; });
  refused([](KernelJob& j) { j.imsize = {0}; });
  refused([](KernelJob& j) { j.samples = 0; });
  refused([](KernelJob& j) { j.w_turns = -1; });
  refused([](KernelJob& j) { j.kernel.name = "nosuch"; });
}

BOOST_AUTO_TEST_SUITE_END()
