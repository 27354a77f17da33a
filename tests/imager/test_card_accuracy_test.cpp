#include <Eigen/Core>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include "imager/data/noise.h"
#include "imager/plan/gridding_plan.h"
#include "imager/transform/imaging.h"
#include "tests/imager/comparison.h"
#include "tests/imager/vla_samples.h"

BOOST_AUTO_TEST_SUITE(test_card_accuracy)

namespace bdata = boost::unit_test::data;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

const ImageGeometry geometry{1024, 1024, 0.05 * pi / 180 / 3600, {}};

struct CardSource {
  int x, y;  ///< cells to the east and to the north
  double flux_jy;
};
/// The corners, edges and off-axis sources of the paper's test card.
constexpr CardSource card[] = {{390, 390, 3},  {390, -390, 3}, {-390, -390, 3}, {-390, 390, 3}, {345, 0, 2},
                               {-345, 0, 2},   {0, -345, 2},   {0, 345, 2},     {-120, 180, 2}, {300, 90, 2},
                               {150, -150, 2}, {-90, 300, 2},  {270, -270, 1},  {0, 0, 2}};

std::vector<Source> sources() {
  std::vector<Source> list;
  for (const CardSource& s : card) list.push_back({{s.x * geometry.cell_rad, s.y * geometry.cell_rad}, s.flux_jy});
  return list;
}

/// The snapshot, its direct image and PSF over Σ w: with w = 0, exp(−2πi(ul+vm)) is a product of a row and a column.
struct Scene {
  VisibilityBlock block;
  Image dirty{geometry.width, geometry.height};
  Image psf{geometry.width, geometry.height};
};

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

const Scene& scene() {
  static const Scene made = [] {
    Scene s;
    s.block = vla_samples(1);
    observe(sources(), s.block);
    const auto samples = static_cast<Eigen::Index>(s.block.samples());
    const double per_m = 2 * pi * s.block.frequency_hz[0] / speed_of_light_m_s;
    const auto phases = [&](const Eigen::VectorXd& position, std::size_t axis) {
      const auto uvw_m = Eigen::Map<const Matrix>(s.block.uvw_m.data(), samples, 3);
      return Eigen::ArrayXXd(per_m * position * uvw_m.col(static_cast<Eigen::Index>(axis)).transpose());
    };
    Eigen::VectorXd l(geometry.width), m(geometry.height);
    for (int c = 0; c < geometry.width; ++c) l[c] = geometry.l(c);
    for (int r = 0; r < geometry.height; ++r) m[r] = geometry.m(r);
    const Eigen::ArrayXXd ul = phases(l, 0), vm = phases(m, 1);
    const auto image_of = [&](const Eigen::ArrayXd& real, const Eigen::ArrayXd& imaginary, Image& image) {
      // Re[V e^(−i vm) e^(−i ul)]
      const Eigen::ArrayXXd a = vm.cos().rowwise() * real.transpose() + vm.sin().rowwise() * imaginary.transpose();
      const Eigen::ArrayXXd b = vm.cos().rowwise() * imaginary.transpose() - vm.sin().rowwise() * real.transpose();
      Eigen::Map<Matrix>(image.pixel.data(), image.height, image.width) =
          (a.matrix() * ul.cos().matrix().transpose() + b.matrix() * ul.sin().matrix().transpose()) / double(samples);
    };
    Eigen::ArrayXd real(samples), imaginary(samples);
    for (Eigen::Index i = 0; i < samples; ++i) {
      real[i] = double{s.block.visibility[static_cast<std::size_t>(i)].real()};
      imaginary[i] = double{s.block.visibility[static_cast<std::size_t>(i)].imag()};
    }
    image_of(real, imaginary, s.dirty);
    image_of(Eigen::ArrayXd::Ones(samples), Eigen::ArrayXd::Zero(samples), s.psf);
    return s;
  }();
  return made;
}

std::unique_ptr<Transform> planned(double accuracy) {
  GriddingRequest request;
  request.geometry = geometry;
  request.accuracy = accuracy;
  request.samples = scene().block.samples();
  request.threads = 2;
  return make_coplanar_transform(plan_gridding(request).options);
}

const auto accuracies = bdata::make({1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7});

}  // namespace

BOOST_DATA_TEST_CASE(the_whole_image_and_psf_keep_the_accuracy_borders_included, accuracies, accuracy) {
  const DirtyImages is = make_dirty_images(stored({scene().block}), *planned(accuracy), {.with_psf = true}, {});
  BOOST_TEST(relative_error(is.dirty[0].pixel, scene().dirty.pixel) <= accuracy);
  BOOST_TEST(relative_error(is.psf.pixel, scene().psf.pixel) <= accuracy);
  BOOST_TEST(std::abs(is.psf.at(512, 512) - 1) <= std::max(accuracy, 1e-5));
}

BOOST_DATA_TEST_CASE(predicted_visibilities_keep_the_accuracy, accuracies, accuracy) {
  Image model(geometry.width, geometry.height);
  for (const CardSource& s : card) model.at(512 + s.y, 512 - s.x) = s.flux_jy;
  const auto is = planned(accuracy)->predict(model)->at(scene().block);
  BOOST_TEST(relative_error(is, predict_sources(sources(), scene().block, 2)) <= accuracy);
}

BOOST_AUTO_TEST_CASE(sources_lie_where_the_card_has_them) {
  const Image dirty = make_dirty_images(stored({scene().block}), *planned(1e-6), AdjointOptions{}, {}).dirty[0];
  for (const CardSource& s : card) {
    // The beam is 9 cells wide, and the others' sidelobes can move a peak by a third of it.
    Image around(13, 13);
    for (int r = 0; r < 13; ++r)
      for (int c = 0; c < 13; ++c) around.at(r, c) = dirty.at(512 + s.y + r - 6, 512 - s.x + c - 6);
    const Peak peak = find_peak(around);
    BOOST_TEST_CONTEXT("source at " << s.x << ", " << s.y) {
      BOOST_TEST(std::abs(peak.row - 6) <= 3);
      BOOST_TEST(std::abs(peak.column - 6) <= 3);
      BOOST_TEST(peak.value > 0.5 * s.flux_jy);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
