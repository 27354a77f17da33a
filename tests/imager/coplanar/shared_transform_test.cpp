#include "imager/coplanar/shared_transform.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "imager/numerics/constants.h"
#include "kernels/catalogue.h"
#include "tests/imager/comparison.h"
#include "tests/imager/random_samples.h"

BOOST_AUTO_TEST_SUITE(shared_transform)

using namespace misfit;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

constexpr double cell_rad = 1e-5, max_w = 40, steps_a_wavelength = 5;

CoplanarOptions options(Precision precision, int width = 7) {
  CoplanarOptions o;
  o.geometry = {60, 48, cell_rad, {}, {0.003, -0.001}};
  o.nu = 96;
  o.nv = 80;
  o.kernel_u = kernels::kernel_family("least-misfit").make(width, 0.35);
  o.kernel_v = o.kernel_u;
  o.precision = precision;
  o.threads = 2;
  return o;
}

/// Smooth shares: real parts even in w, imaginary parts odd.
std::complex<double> share(std::size_t image, std::size_t channel, double w) {
  const auto k = static_cast<double>(image), c = static_cast<double>(channel);
  return {std::cos(0.003 * k * w) * (1 - 0.1 * c), std::sin((0.01 + 0.003 * k) * w) * (0.3 + 0.1 * c)};
}

ShareTable table(std::size_t images, std::size_t channel) {
  std::vector<double> values;
  const int points = static_cast<int>(max_w * steps_a_wavelength) + 1 + ShareTable::points;
  for (int p = 0; p < points; ++p) {
    const double w = (p - ShareTable::before) / steps_a_wavelength;
    for (std::size_t k = 0; k < images; ++k) values.push_back(share(k, channel, w).real());
    for (std::size_t k = 0; k < images; ++k) values.push_back(share(k, channel, w).imag());
  }
  return {images, values};
}

/// Samples whose shares and phases are known one by one.
struct Shared {
  VisibilityBlock block = random_samples_with_w(150, 3, cell_rad, max_w, 7);
  std::vector<ShareTable> tables;
  std::vector<std::complex<double>> phase;

  explicit Shared(std::size_t images) {
    for (std::size_t c = 0; c < block.channels(); ++c) tables.push_back(table(images, c));
    for (std::size_t i = 0; i < block.samples(); ++i) phase.push_back(std::polar(1.0, 0.7 * static_cast<double>(i)));
    block.weight[5] = 0;
  }

  SampleShares shares(std::size_t first, std::size_t images) const {
    SampleShares all{{}, first, images, steps_a_wavelength, phase.data()};
    for (const ShareTable& of_channel : tables) all.of_channel.push_back(&of_channel);
    return all;
  }
  std::complex<double> share_of(std::size_t sample, std::size_t image) const {
    const std::size_t row = sample / block.channels(), channel = sample % block.channels();
    const double w = block.uvw_m[3 * row + 2] * block.frequency_hz[channel] / speed_of_light_m_s;
    return phase[sample] * share(image, channel, w);
  }
};

/// Images whose shares begin with that of image `first` of the tables, and a kernel's width.
struct Asked {
  std::size_t images;
  std::size_t first;
  int width;
};

}  // namespace

/// Each image is that of a transform of its own, whose samples are multiplied by their shares, and a prediction is the sum of
/// those of its images with shares; to rounding, in either precision, for any kernel's width.
BOOST_AUTO_TEST_CASE(images_and_predictions_are_those_of_transforms_one_by_one) {
  for (const Precision precision : {Precision::double_precision, Precision::single_precision})
    for (const Asked& asked : {Asked{1, 0, 7}, {3, 2, 4}, {17, 0, 12}, {32, 0, 7}}) {
      const std::size_t images = asked.images, first = asked.first;
      const double rounding = precision == Precision::double_precision ? 1e-12 : 3e-6;
      const CoplanarOptions o = options(precision, asked.width);
      const auto together = make_shared_transform(o);
      const auto alone = make_coplanar_transform(o);
      const Shared samples(first + images);
      const SampleShares shares = samples.shares(first, images);
      const std::size_t sets = images > 16 ? 1 : 2, count = samples.block.samples();
      std::vector<std::vector<std::complex<double>>> values(sets);
      for (std::size_t s = 0; s < sets; ++s)
        for (std::size_t i = 0; i < count; ++i)
          values[s].push_back(std::complex<double>(samples.block.visibility[i]) * std::polar(1.0 + double(s), double(s)));
      const auto sum = together->adjoint(sets, images);
      sum->add(samples.block, values, shares);
      std::size_t told = 0;
      std::vector<Image> model;
      std::vector<std::complex<double>> expected(count);
      sum->finish([&](std::size_t set, std::size_t k, const Image& is) {
        BOOST_TEST(told++ == set * images + k);
        std::vector<std::complex<double>> of_one(count);
        for (std::size_t i = 0; i < count; ++i) of_one[i] = std::conj(samples.share_of(i, first + k)) * values[set][i];
        const auto one = alone->adjoint({.beyond_grid = true});
        one->add(samples.block, of_one);
        BOOST_TEST(relative_error(is.pixel, one->finish().images.front().pixel) < rounding);
        if (set > 0) return;
        model.push_back(random_image(is.width, is.height, static_cast<unsigned>(k)));
        const auto seen = alone->predict(model.back())->at_usable(samples.block);
        for (std::size_t i = 0; i < count; ++i) expected[i] += samples.share_of(i, first + k) * seen[i];
      });
      BOOST_TEST(told == sets * images);
      BOOST_TEST(relative_error(together->predict(model)->at_usable(samples.block, shares), expected) < rounding);
    }
}

BOOST_AUTO_TEST_CASE(images_and_predictions_are_adjoint_to_rounding) {
  constexpr std::size_t images = 5;
  const auto transform = make_shared_transform(options(Precision::double_precision));
  const Shared samples(images);
  std::vector<Image> model;
  for (std::size_t k = 0; k < images; ++k) model.push_back(random_image(60, 48, static_cast<unsigned>(k)));
  const auto seen = transform->predict(model)->at_usable(samples.block, samples.shares(0, images));
  double in_samples = 0, in_images = 0, size = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const double product =
        double{samples.block.weight[i]} * (std::conj(std::complex<double>(samples.block.visibility[i])) * seen[i]).real();
    in_samples += product;
    size += std::abs(product);
  }
  const auto sum = transform->adjoint(1, images);
  sum->add(samples.block, {samples.block, 1}, samples.shares(0, images));
  sum->finish([&](std::size_t, std::size_t k, const Image& image) {
    for (std::size_t i = 0; i < image.pixel.size(); ++i) in_images += image.pixel[i] * model[k].pixel[i];
  });
  BOOST_TEST(std::abs(in_images - in_samples) < 1e-13 * size);
}

BOOST_AUTO_TEST_CASE(samples_beyond_the_tables_and_too_many_images_are_refused) {
  const auto transform = make_shared_transform(options(Precision::double_precision));
  Shared samples(2);
  samples.block.uvw_m.edit()[2] = 3 * max_w * speed_of_light_m_s / samples.block.frequency_hz.front();
  const auto sum = transform->adjoint(1, 2);
  BOOST_CHECK_THROW(sum->add(samples.block, {samples.block, 1}, samples.shares(0, 2)), std::invalid_argument);
  BOOST_CHECK_THROW(transform->adjoint(3, 11), std::invalid_argument);
  BOOST_CHECK_THROW(transform->predict({}), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
