#include "imager/taylor/taylor_imaging.h"

#include <boost/test/unit_test.hpp>
#include <numeric>

#include "imager/plan/gridding_plan.h"
#include "tests/imager/comparison.h"
#include "tests/imager/random_samples.h"

BOOST_AUTO_TEST_SUITE(taylor_imaging)

using namespace misfit;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

constexpr double reference_hz = 1.12e9;
constexpr double cell_rad = 1e-4;
constexpr double accuracy = 1e-5;

ImageGeometry geometry(const DirectionCosines& centre = {}) {
  ImageGeometry g{20, 14, cell_rad, {}};
  g.centre = centre;
  return g;
}

/// Σ w x^k Re[V exp(−2πi(ul+vm))] / Σ w as it is written, with V of the block or of a source at `source`. w is 0.
Image by_definition(const VisibilityBlock& block, const ImageGeometry& g, int power, const DirectionCosines* source) {
  Image image(g.width, g.height);
  double weight = 0;
  for (std::size_t i = 0; i < block.samples(); ++i) {
    const double frequency = block.frequency_hz[i % block.channels()];
    const double* const uvw = &block.uvw_m[3 * (i / block.channels())];
    const double u = uvw[0] * frequency / speed_of_light_m_s, v = uvw[1] * frequency / speed_of_light_m_s;
    const std::complex<double> visibility = source == nullptr ? std::complex<double>(block.visibility[i])
                                                              : std::polar(1.0, 2 * pi * (u * source->l + v * source->m));
    const double w = double{block.weight[i]};
    weight += w;
    for (int r = 0; r < g.height; ++r)
      for (int c = 0; c < g.width; ++c) {
        const DirectionCosines at = g.at(r, c);
        image.at(r, c) += w * std::pow(frequency / reference_hz - 1, power) *
                          (visibility * std::polar(1.0, -2 * pi * (u * at.l + v * at.m))).real();
      }
  }
  for (double& pixel : image.pixel) pixel /= weight;
  return image;
}

double weight_of(const VisibilityBlock& block) {
  return std::accumulate(block.weight.begin(), block.weight.end(), 0.0);
}

std::unique_ptr<Transform> gridding(const ImageGeometry& g) {
  GriddingRequest request;
  request.geometry = g;
  request.accuracy = accuracy;
  return make_coplanar_transform(plan_gridding(request).options);
}

/// Gridding errs by the accuracy relative to what random data of this size give; images here are that. Twice it for a sample of
/// the few that there are.
constexpr double bound = 2 * accuracy;

}  // namespace

BOOST_AUTO_TEST_CASE(dirty_images_and_psfs_are_direct_sums_with_taylor_weights) {
  const VisibilityBlock block = random_samples(80, 6, cell_rad, 5);
  for (const DirectionCosines& centre : {DirectionCosines{}, DirectionCosines{0.01, -0.02}})
    for (const int terms : {2, 3}) {
      const ImageGeometry g = geometry(centre);
      const auto transform = gridding(g);
      const StoredVisibilities twice = stored({block, block});
      const TaylorImages made =
          make_taylor_images({twice, *transform, Normalisation(2 * weight_of(block))}, *transform, {reference_hz, terms}, {});
      BOOST_REQUIRE(made.dirty.size() + 1 == static_cast<std::size_t>(terms));
      BOOST_REQUIRE(made.psf.size() + 2 == static_cast<std::size_t>(2 * terms));
      for (std::size_t t = 0; t < made.dirty.size(); ++t)
        BOOST_TEST(relative_error(made.dirty[t].pixel, by_definition(block, g, int(t) + 1, nullptr).pixel) < bound);
      for (std::size_t k = 0; k < made.psf.size(); ++k)
        BOOST_TEST(relative_error(made.psf[k].pixel, by_definition(block, g, int(k) + 1, &centre).pixel) < bound);
    }
}

/// Of data − model: for a model of zeros the dirty images themselves, for one that explains the data nothing.
BOOST_AUTO_TEST_CASE(residuals_are_the_taylor_weighted_images_of_data_less_all_terms) {
  constexpr int terms = 3;
  const TaylorExpansion expansion{reference_hz, terms};
  const ImageGeometry g = geometry();
  const auto transform = gridding(g);
  VisibilityBlock block = random_samples(80, 6, cell_rad, 5);
  std::vector<Image> models;
  for (unsigned t = 0; t < terms; ++t) models.push_back(random_image(g.width, g.height, t));
  const StoredVisibilities source = stored({block});
  const std::vector<Image> left =
      make_taylor_residuals({source, *transform, Normalisation(weight_of(block))}, models, expansion, {});
  // The same by definition, of visibilities less those of every pixel of every term.
  VisibilityBlock less = block;
  for (std::size_t i = 0; i < block.samples(); ++i) {
    const double frequency = block.frequency_hz[i % block.channels()];
    const double* const uvw = &block.uvw_m[3 * (i / block.channels())];
    const double per_m = frequency / speed_of_light_m_s;
    std::complex<double> sum = std::complex<double>(block.visibility[i]);
    for (int r = 0; r < g.height; ++r)
      for (int c = 0; c < g.width; ++c) {
        const DirectionCosines at = g.at(r, c);
        double flux = 0;
        for (int t = 0; t < terms; ++t)
          flux += std::pow(frequency / reference_hz - 1, t) * models[static_cast<std::size_t>(t)].at(r, c);
        sum -= flux * std::polar(1.0, 2 * pi * per_m * (uvw[0] * at.l + uvw[1] * at.m));
      }
    less.visibility[i] = std::complex<float>(sum);
  }
  for (int t = 0; t < terms; ++t)
    BOOST_TEST(relative_error(left[static_cast<std::size_t>(t)].pixel, by_definition(less, g, t, nullptr).pixel) < 2 * bound);
}

BOOST_AUTO_TEST_SUITE_END()
