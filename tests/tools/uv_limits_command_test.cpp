// Limits in the uv plane, by the program itself.
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "imager/files/fits_image_reader.h"
#include "imager/numerics/constants.h"
#include "ms_io/measurement_set.h"
#include "tests/imager/comparison.h"
#include "tests/tools/program.h"

BOOST_AUTO_TEST_SUITE(uv_limits_command)

namespace {

using namespace misfit;
using namespace misfit::tools::testing;

constexpr int size = 32, channels = 3;
constexpr double cell_rad = 0.05 * M_PI / 180 / 3600;

/// A snapshot of the test card, with noise, whose channels are so far apart that the same limits leave other baselines in each.
struct Observation {
  TemporaryFolder folder;
  std::string vis = folder / "wide.ms";

  Observation() {
    succeed({"simulate", "--output", vis, "--channels", std::to_string(channels), "--channel-width", "1GHz", "--noise", "1Jy"});
  }
  Arguments image(const Arguments& more) const {
    return Arguments{"image",  "--vis",     vis, "--imagename", folder / "a", "--imsize", std::to_string(size),
                     "--cell", "0.05arcsec"} +
           more;
  }
};

struct Limits {
  double min_lambda = 0, max_lambda = std::numeric_limits<double>::infinity();
};

/// The sum over all samples within the limits, of one channel or of all, by the definition of a dirty image.
imager::Image direct_sum(const std::string& vis, const Limits& limits, int only_channel = -1) {
  imager::Image image(size, size);
  double weights = 0;
  const ms_io::MeasurementSet set(vis, {}, "DATA");
  const auto stream = set.open();
  while (const auto block = stream->next())
    for (std::size_t i = 0; i < block->samples(); ++i) {
      const std::size_t row = i / block->channels(), channel = i % block->channels();
      const double per_m = block->frequency_hz[channel] / imager::speed_of_light_m_s;
      const double u = block->uvw_m[3 * row] * per_m, v = block->uvw_m[3 * row + 1] * per_m, r = std::sqrt(u * u + v * v);
      if (only_channel >= 0 && static_cast<std::size_t>(only_channel) != channel) continue;
      if (r < limits.min_lambda || r > limits.max_lambda) continue;
      const std::complex<double> visibility(block->visibility[i]);
      weights += double{block->weight[i]};
      for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
          const double turns = cell_rad * (u * (size / 2 - x) + v * (y - size / 2));
          image.at(y, x) += double{block->weight[i]} * (visibility * std::polar(1., -2 * M_PI * turns)).real();
        }
    }
  BOOST_REQUIRE(weights > 0);
  for (double& pixel : image.pixel) pixel /= weights;
  return image;
}

// The accuracy asked by default is 1e-6, and files hold single precision.
constexpr double bound = 1.1e-6;

}  // namespace

BOOST_AUTO_TEST_CASE(an_image_is_the_direct_sum_of_the_samples_within_the_limits) {
  const Observation data;
  const imager::Image all = direct_sum(data.vis, {});
  for (const auto& [words, limits] : {std::pair{Arguments{"--maxuv-l", "200klambda"}, Limits{0, 200e3}},
                                      {Arguments{"--minuv-l", "50000"}, Limits{50e3}},
                                      {Arguments{"--minuv-l", "50klambda", "--maxuv-l", "0.2Mlambda"}, Limits{50e3, 200e3}}}) {
    succeed(data.image(words));
    const imager::Image expected = direct_sum(data.vis, limits);
    BOOST_TEST(imager::testing::relative_error(pixels_of(data.folder / "a", "residual").pixel, expected.pixel) < bound);
    BOOST_TEST(imager::testing::relative_error(expected.pixel, all.pixel) > 0.1);
  }
}

BOOST_AUTO_TEST_CASE(planes_of_a_cube_have_the_limits_at_their_own_frequencies) {
  const Observation data;
  succeed(data.image({"--specmode", "cube", "--outframe", "TOPO", "--minuv-l", "50klambda", "--maxuv-l", "200klambda"}));
  const auto cube = imager::open_fits_image(data.folder / "a.residual.fits");
  for (int plane = 0; plane < channels; ++plane) {
    const imager::Image expected = direct_sum(data.vis, {50e3, 200e3}, plane);
    BOOST_TEST(imager::testing::relative_error(cube->read({plane, 0}).pixel, expected.pixel) < bound);
  }
}

BOOST_AUTO_TEST_CASE(limits_without_samples_end_in_one_line) {
  const Observation data;
  for (const Arguments& more : {Arguments{}, {"--weighting", "uniform"}, {"--specmode", "cube"}, {"--niter", "10"}}) {
    const Outcome outcome = run(data.image(Arguments{"--maxuv-l", "1", "--quiet"} + more));
    BOOST_TEST_CONTEXT(outcome.err) {
      BOOST_TEST(outcome.code == 1);
      BOOST_TEST(outcome.err.starts_with("misfit: --maxuv-l 1: no sample"));
      BOOST_TEST(outcome.err.find("keeps a weight that counts; expected limits") != std::string::npos);
      BOOST_TEST(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
    }
    BOOST_TEST(!std::filesystem::exists(data.folder / "a.residual.fits"));
  }
  const Outcome report = run({"report", "scene", "--vis", data.vis, "--imsize", "32", "--cell", "0.05arcsec", "--maxuv-l", "1",
                              "--output", data.folder / "scene"});
  BOOST_TEST(report.code == 1);
  BOOST_TEST(report.err.find("--maxuv-l 1: no sample keeps a weight that counts") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_run_with_edges_and_a_rank_filter_is_repeated_from_its_own_options) {
  const Observation data;
  succeed(data.image({"--weighting", "uniform", "--weighting-rank-filter", "1.5", "--weighting-rank-filter-size", "8",
                      "--maxuv-l", "300klambda", "--taper-tukey", "100klambda", "--taper-inner-tukey", "20klambda"}));
  const std::string text = report_of(data.folder / "a").dump();
  BOOST_TEST(text.find("rank filter 1.5, from 0lambda with a Tukey edge of 20klambda, up to 300klambda") != std::string::npos);
  succeed({"image", "--config", data.folder / "a.last.ini", "--imagename", data.folder / "again"});
  BOOST_CHECK(pixels_of(data.folder / "a", "residual").pixel == pixels_of(data.folder / "again", "residual").pixel);
  succeed(data.image({"--weighting", "uniform", "--maxuv-l", "300klambda"}));
  BOOST_CHECK(pixels_of(data.folder / "a", "residual").pixel != pixels_of(data.folder / "again", "residual").pixel);
}

BOOST_AUTO_TEST_SUITE_END()
