#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <map>
#include <memory>
#include <random>

#include "imager/direct/direct_transform.h"
#include "imager/plan/gridding_plan.h"
#include "tests/imager/comparison.h"
#include "tests/imager/random_samples.h"

BOOST_AUTO_TEST_SUITE(wide_accuracy)

namespace bdata = boost::unit_test::data;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

constexpr double degree = pi / 180;

/// A field and the largest |w| of its data, in wavelengths; u and v fill the grid.
struct Scene {
  const char* name;
  ImageGeometry geometry;
  double max_abs_w;
  std::size_t rows;
  std::size_t channels;
};

const Scene scenes[] = {
    {"a narrow field", {96, 96, 1e-5, {}}, 2e4, 300, 4},
    {"4 degrees with 3.6 km at 1.4 GHz", {90, 90, 4 * degree / 90, {}}, 17000, 300, 2},
    {"90 degrees with 150 m at 1.4 GHz", {140, 140, 1.41421356 / 140, {}}, 714, 300, 1},
    {"off the phase centre", {100, 64, 1e-3, {}, {0.2, -0.35}}, 3000, 300, 2},
    {"331 × 517", {331, 517, 2e-4, {}}, 2000, 30, 2},
    {"channels that span 1 : 3", {90, 70, 1e-3, {}}, 3000, 20, 64},
    {"10.5 degrees with 0.8 km at 0.46 GHz", {128, 128, 1.43209e-3, {}}, 1281, 300, 1},
};

VisibilityBlock samples_of(const Scene& s) {
  VisibilityBlock block = random_samples_with_w(s.rows, s.channels, s.geometry.cell_rad, s.max_abs_w, 5);
  if (s.channels == 64)
    for (std::size_t c = 0; c < 64; ++c) block.frequency_hz[c] = block.frequency_hz[63] * (1 + 2.0 / 63 * double(c)) / 3;
  return block;
}

std::vector<double> seen(const Image& image) {
  std::vector<double> pixels;
  for (const double p : image.pixel)
    if (!std::isnan(p)) pixels.push_back(p);
  return pixels;
}

struct Truth {
  VisibilityBlock block;
  std::vector<double> image;
  Image model;
  std::vector<std::complex<double>> visibility;
};

/// Solves each kernel once for all cases.
misfit::kernels::KernelFamily least_misfit() {
  static const misfit::kernels::KernelFamily family = misfit::kernels::kernel_family("least-misfit");
  static std::map<std::pair<int, double>, misfit::kernels::Kernel> solved;
  misfit::kernels::KernelFamily once = family;
  once.solve = [](int width, double x0) {
    const auto found = solved.find({width, x0});
    return found != solved.end() ? found->second : solved.emplace(std::pair(width, x0), family.make(width, x0)).first->second;
  };
  return once;
}

/// Direct sums, made once for each scene.
const Truth& truth_of(std::size_t i) {
  static std::vector<std::unique_ptr<Truth>> made(std::size(scenes));
  if (!made[i]) {
    const Scene& s = scenes[i];
    Truth t{samples_of(s), {}, Image(s.geometry.width, s.geometry.height), {}};
    const DirectTransform direct(s.geometry, 2);
    const auto sum = direct.adjoint({});
    sum->add(t.block);
    t.image = seen(sum->finish().images[0]);
    std::mt19937_64 random(3);
    for (int k = 0; k < 200; ++k) t.model.pixel[random() % t.model.pixel.size()] = 1 + static_cast<double>(k % 7);
    t.visibility = direct.predict(t.model)->at(t.block);
    made[i] = std::make_unique<Truth>(std::move(t));
  }
  return *made[i];
}

void check_promise(std::size_t i, double accuracy) {
  const Scene& s = scenes[i];
  const Truth& truth = truth_of(i);
  GriddingRequest request;
  request.geometry = s.geometry;
  request.accuracy = accuracy;
  request.kernel = least_misfit();
  request.samples = truth.block.samples();
  request.max_abs_w = s.max_abs_w;
  request.threads = 2;
  const GriddingPlan plan = plan_gridding(request);
  const auto transform = make_transform(plan.options);
  const auto sum = transform->adjoint({});
  sum->add(truth.block);
  BOOST_TEST_CONTEXT(s.name) {
    BOOST_TEST(relative_error(seen(sum->finish().images[0]), truth.image) < accuracy);
    BOOST_TEST(relative_error(transform->predict(truth.model)->at(truth.block), truth.visibility) < accuracy);
  }
}

}  // namespace

BOOST_DATA_TEST_CASE(a_plan_keeps_its_promise_over_the_whole_image,
                     bdata::xrange(std::size(scenes)) * bdata::make({1e-2, 1e-6}), i, accuracy) {
  check_promise(i, accuracy);
}

BOOST_TEST_DECORATOR(*boost::unit_test::label("sweep"))
BOOST_DATA_TEST_CASE(and_at_accuracies_between, bdata::xrange(std::size(scenes)) * bdata::make({1e-4, 1e-8}), i, accuracy) {
  check_promise(i, accuracy);
}

BOOST_TEST_DECORATOR(*boost::unit_test::label("sweep"))
BOOST_DATA_TEST_CASE(and_to_ten_digits, bdata::xrange(3), i) {
  check_promise(static_cast<std::size_t>(i), 1e-10);
}

BOOST_DATA_TEST_CASE(and_where_u_v_and_w_magnify_rounding_at_the_corners, bdata::make({1e-10, 1.55e-11}), accuracy) {
  check_promise(std::size(scenes) - 1, accuracy);
}

BOOST_AUTO_TEST_SUITE_END()
