#include "imager/outside/unexplained.h"

#include <boost/test/unit_test.hpp>

#include "imager/data/noise.h"
#include "imager/direct/direct_transform.h"
#include "imager/direct/source_sums.h"
#include "tests/imager/comparison.h"
#include "tests/imager/random_samples.h"

BOOST_AUTO_TEST_SUITE(unexplained)

using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

const ImageGeometry field{64, 48, 1e-5, {}};
constexpr std::size_t rows = 4000;

/// Noise of 1 Jy/√weight in each part, and a source of `flux_jy` beside the field. Every second row lies close to the one
/// before where there are `pairs`, else anywhere.
VisibilityBlock observed(double flux_jy, bool pairs) {
  VisibilityBlock block = random_samples(rows, 1, field.cell_rad, 7);
  for (std::size_t row = 1; pairs && row < rows; row += 2)
    for (std::size_t i = 0; i < 2; ++i) block.uvw_m.edit()[3 * row + i] = (1 + 1e-6) * block.uvw_m[3 * (row - 1) + i];
  const auto exact = predict_sources({{{0.8 * field.width * field.cell_rad, 0}, flux_jy}}, block, 2);
  for (std::size_t i = 0; i < rows; ++i)
    block.visibility[i] = block.visibility[i] / std::sqrt(block.weight[i]) + std::complex<float>(exact[i]);
  return block;
}

struct Seen {
  Unexplained unexplained;
  double image_rms_jy = 0;  ///< of the exact image
  double weight = 0;
};

Seen seen(const VisibilityBlock& block) {
  const StoredVisibilities source = stored({block});
  const DirectTransform transform(field, 2);
  const DirtyImages images = make_dirty_images(source, transform, AdjointOptions{}, {});
  return {unexplained_by(Image(field.width, field.height), source, transform, field, {}), root_mean_square(images.dirty[0]),
          images.sums[0].weight};
}

}  // namespace

BOOST_AUTO_TEST_CASE(noise_alone_is_no_source_and_is_that_of_the_image) {
  const Seen of = seen(observed(0, true));
  BOOST_TEST(of.unexplained.sources_least_jy == 0);
  // Three deviations of a mean over 2000 pairs: the square is 3/√2000 of the noise's at most, and their sum twice that.
  BOOST_TEST(of.unexplained.sources_most_jy < std::sqrt(2 * 3 / std::sqrt(2000.0)) * of.unexplained.rms_jy);
  // An RMS over 3072 pixels, and one over 4000 samples, are each right to 2%.
  BOOST_TEST(of.unexplained.image_noise_jy(of.weight) == of.image_rms_jy, boost::test_tools::tolerance(0.06));
}

BOOST_AUTO_TEST_CASE(a_source_beside_the_field_is_told_from_noise_where_samples_share_cells) {
  const Seen of = seen(observed(2, true));
  BOOST_TEST(of.unexplained.sources_least_jy > 0);
  BOOST_TEST(of.unexplained.sources_least_jy < 2);
  BOOST_TEST(of.unexplained.sources_most_jy > 2);
  BOOST_TEST(of.unexplained.sources_most_jy < of.unexplained.rms_jy);
  // By three deviations the source may be less, and the noise the more.
  const double noise = seen(observed(0, true)).image_rms_jy;
  BOOST_TEST(of.unexplained.image_noise_jy(of.weight) > 0.95 * noise);
  BOOST_TEST(of.unexplained.image_noise_jy(of.weight) < 1.3 * noise);
}

/// As of channels smoothed by ¼ ½ ¼, which ALMA and the VLA deliver.
BOOST_AUTO_TEST_CASE(noise_that_neighbouring_channels_share_is_no_source_and_is_that_of_the_image) {
  constexpr std::size_t channels = 8;
  VisibilityBlock block = random_samples(rows, channels, field.cell_rad, 9);
  for (std::size_t c = 0; c < channels; ++c)
    block.frequency_hz[c] = block.frequency_hz.front() * (1 + 1e-5 * static_cast<double>(c));
  for (std::size_t row = 1; row < rows; row += 2)
    for (std::size_t i = 0; i < 2; ++i) block.uvw_m.edit()[3 * row + i] = block.uvw_m[3 * (row - 1) + i];
  std::fill(block.weight.begin(), block.weight.end(), 1.f);
  const std::vector<std::complex<float>> noise = block.visibility;
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t c = 1; c + 1 < channels; ++c) {
      const std::complex<float>* at = &noise[row * channels + c];
      block.visibility[row * channels + c] = 0.25F * at[-1] + 0.5F * at[0] + 0.25F * at[1];
    }
  const Seen of = seen(block);
  BOOST_TEST(of.unexplained.sources_least_jy == 0);
  BOOST_TEST(of.unexplained.image_noise_jy(of.weight) > 0.94 * of.image_rms_jy);
  BOOST_TEST(of.unexplained.image_noise_jy(of.weight) < 1.06 * of.image_rms_jy);
}

/// Where all short baselines see an extended source, and long ones none, noise is not nought.
BOOST_AUTO_TEST_CASE(sources_in_crowded_cells_alone_leave_the_noise_as_it_is) {
  VisibilityBlock block = observed(0, true);
  const double noise = seen(block).image_rms_jy;
  for (std::size_t row = 0; row < rows; ++row)
    if (std::abs(block.uvw_m[3 * row]) + std::abs(block.uvw_m[3 * row + 1]) <
        0.02 * speed_of_light_m_s / block.frequency_hz[0] / field.cell_rad)
      block.visibility[row] += 100;
  const Seen of = seen(block);
  BOOST_TEST(of.unexplained.image_noise_jy(of.weight) > 0.95 * noise);
  BOOST_TEST(of.unexplained.image_noise_jy(of.weight) < 1.2 * noise);
}

BOOST_AUTO_TEST_CASE(without_pairs_all_may_be_a_source_and_all_may_be_noise) {
  VisibilityBlock block = observed(2, false);
  for (std::size_t row = 0; row < rows; ++row) {  // each in a cell of its own, of those 1/(4 · 64 · cell) wide
    const double turns_to_m = misfit::imager::speed_of_light_m_s / block.frequency_hz.front() / field.cell_rad;
    block.uvw_m.edit()[3 * row] = (static_cast<double>(row % 200) - 99.5) / (4 * field.width) * turns_to_m;
    block.uvw_m.edit()[3 * row + 1] = (static_cast<double>(row / 200) + 0.5) / (4 * field.height) * turns_to_m;
  }
  const Unexplained all = seen(block).unexplained;
  BOOST_TEST(all.sources_least_jy == 0);
  BOOST_TEST(all.sources_most_jy == all.rms_jy);
}

BOOST_AUTO_TEST_CASE(what_the_model_explains_is_not_left) {
  VisibilityBlock block = random_samples(rows, 1, field.cell_rad, 8);
  Image model(field.width, field.height);
  model.at(11, 30) = 3;
  const DirectTransform transform(field, 2);
  const auto exact = transform.predict(model)->at(block);
  block.visibility.assign(exact.begin(), exact.end());
  const StoredVisibilities source = stored({block});
  // Visibilities are held in single precision.
  BOOST_TEST(unexplained_by(model, source, transform, field, {}).rms_jy < 1e-6);
  BOOST_TEST(unexplained_by(Image(field.width, field.height), source, transform, field, {}).rms_jy == 3,
             boost::test_tools::tolerance(1e-6));
}

BOOST_AUTO_TEST_SUITE_END()
