#include <boost/test/unit_test.hpp>

#include "imager/beams/beam.h"
#include "imager/clean/clean.h"
#include "imager/clean/joint_clean.h"
#include "imager/data/noise.h"
#include "imager/plan/gridding_plan.h"
#include "imager/taylor/spectral_index.h"
#include "imager/taylor/taylor_basis.h"
#include "imager/taylor/taylor_imaging.h"
#include "tests/imager/comparison.h"
#include "tests/imager/taylor/wide_band.h"

BOOST_AUTO_TEST_SUITE(wide_band_clean)

using namespace misfit;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

constexpr double arcsec = pi / 180 / 3600;
constexpr double reference_hz = 4e9;
const ImageGeometry geometry{96, 80, 0.08 * arcsec, {}};

struct Place {
  int row, column;
};
constexpr Place steep{40, 48}, flat{16, 76}, faint{62, 20};

/// A steep source, a flat one, and one of few times the noise where there is some.
std::vector<SpectralSource> sky() {
  return {{geometry.at(steep.row, steep.column), power_law(1, -0.7, reference_hz)},
          {geometry.at(flat.row, flat.column), power_law(0.6, 0, reference_hz)},
          {geometry.at(faint.row, faint.column), power_law(0.1, -0.7, reference_hz)}};
}

struct Scene {
  StoredVisibilities source;
  const Transform* transform = nullptr;
  DirtyImages first;
  TaylorImages further;
  std::vector<const Image*> psf;
  TaylorExpansion expansion;
  Beam beam;
  double max_sidelobe = 0;

  ImagedData imaged() const { return {source, *transform, first.normalisation}; }
};

constexpr int hour_angles = 5, channels = 8;

/// Of all scenes: their samples lie at the same places.
const Transform& gridding() {
  static const std::unique_ptr<Transform> made = [] {
    GriddingRequest request;
    request.geometry = geometry;
    request.accuracy = 1e-5;
    request.threads = 2;
    return make_coplanar_transform(plan_gridding(request).options);
  }();
  return *made;
}

Scene make_scene(int terms, double fraction, double noise_jy, unsigned seed) {
  VisibilityBlock block = wide_band_samples(hour_angles, channels, fraction);
  observe(sky(), noise_jy, seed, block);
  Scene s;
  s.expansion = {reference_hz, terms};
  s.source = stored({block});
  s.transform = &gridding();
  s.first = make_dirty_images(s.source, *s.transform, {.with_psf = true}, {});
  s.further = make_taylor_images(s.imaged(), *s.transform, s.expansion, {});
  s.psf.push_back(&s.first.psf);
  for (const Image& image : s.further.psf) s.psf.push_back(&image);
  Image middle(geometry.width, geometry.height);
  middle.at(geometry.centre_row(), geometry.centre_column()) = 1;
  s.beam = fit_beam(s.first.psf, geometry.cell_rad);
  s.max_sidelobe = largest_sidelobe(s.first.psf, convolve_with_beam(middle, s.beam, geometry.cell_rad, 1));
  return s;
}

CleanOptions options_to(double threshold_jy) {
  CleanOptions options;
  options.max_iterations = 20000;
  options.threshold_jy = threshold_jy;
  options.threads = 2;
  return options;
}

CleanState first() {
  return first_state(ComponentModel(geometry.width, geometry.height, {0}));
}

CleanInput input_of(const Scene& of) {
  CleanInput input{.imaged = of.imaged(),
                   .expansion = of.expansion,
                   .dirty = {of.first.dirty[0]},
                   .psf = of.psf,
                   .max_sidelobe = of.max_sidelobe,
                   .accuracy = 1e-5,
                   .beam = {5, 5, 0},
                   .cell_rad = 1};
  for (const Image& dirty : of.further.dirty) input.dirty.push_back(dirty);
  return input;
}

CleanResult cleaned(
    const Scene& of, const CleanOptions& options, const CleanState& begin = first(),
    const CycleProgress& cycle_progress = [](const CleanState&) {}) {
  const JointClean minor(of.psf, {.threads = options.threads});
  return imager::clean(input_of(of), minor, options, begin, cycle_progress, {});
}

/// As products are: models at the beam's resolution and the principal solution of what is left.
struct Restored {
  std::vector<Image> image, residual;
};

Restored restored(const Scene& of, const CleanResult& result) {
  std::vector<const Image*> left{&result.residual}, models{&result.model};
  for (const Image& image : result.further_residuals) left.push_back(&image);
  for (const Image& image : result.further_models) models.push_back(&image);
  Restored made;
  made.residual = principal_solution(basis_of(of.psf), left, 2);
  for (std::size_t t = 0; t < models.size(); ++t) {
    made.image.push_back(convolve_with_beam(*models[t], of.beam, geometry.cell_rad, 2));
    for (std::size_t i = 0; i < made.image[t].pixel.size(); ++i) made.image[t].pixel[i] += made.residual[t].pixel[i];
  }
  return made;
}

SpectralImages spectra(const Scene& of, const CleanResult& result) {
  const Restored made = restored(of, result);
  return spectral_images(made.image, made.residual, 2);
}

double at(const Image& image, Place place) {
  return image.at(place.row, place.column);
}

}  // namespace

/// With two terms the straight line through (1+x)^−0.7 over 20 % of bandwidth has a slope over height of −0.7018: the third
/// coefficient −0.5355 adds 0.6 × 0.1² of itself, the second 0.595 × 0.1²/3 to the height. Noise of 1e-3 of the brightest
/// source would leave 5e-3 of α, and so much more of the others; here is none.
BOOST_AUTO_TEST_CASE(spectral_indices_are_recovered) {
  for (const int terms : {2, 3}) {
    const Scene scene = make_scene(terms, 0.2, 0, 1);
    const CleanResult result = cleaned(scene, options_to(1e-3));
    BOOST_TEST((result.report.stop == CleanStop::threshold));
    const SpectralImages made = spectra(scene, result);
    BOOST_TEST(std::abs(at(made.alpha, steep) + 0.7) < 0.01);
    BOOST_TEST(std::abs(at(made.alpha, flat)) < 0.01);
  }
}

/// Coefficients of the polynomial that fits a power law best over the channels, which all count alike.
TaylorValues fit(const TaylorExpansion& expansion, double fraction, double alpha) {
  const VisibilityBlock block = wide_band_samples(1, channels, fraction);
  std::vector<double> peaks(static_cast<std::size_t>(2 * expansion.terms - 1));
  TaylorValues residual{};
  for (const double frequency : block.frequency_hz) {
    const double x = expansion.x(frequency), flux = power_law(1, alpha, reference_hz)(frequency);
    for (std::size_t k = 0; k < peaks.size(); ++k) peaks[k] += std::pow(x, double(k)) / channels;
    for (std::size_t t = 0; t < static_cast<std::size_t>(expansion.terms); ++t)
      residual[t] += std::pow(x, double(t)) * flux / channels;
  }
  const TaylorBasis basis(peaks);
  return basis.coefficients(basis.coordinates(residual));
}

/// Over two thirds of the frequency the curve that a line or a parabola does not follow turns −0.7 into −0.72 or −0.75: CLEAN
/// gives that, to 1 % of it for the tails of the residual.
BOOST_AUTO_TEST_CASE(over_a_very_wide_band_spectra_are_those_of_the_polynomials_that_fit_them_best) {
  constexpr double fraction = 0.66;
  for (const int terms : {2, 3}) {
    const Scene scene = make_scene(terms, fraction, 0, 1);
    const SpectralImages made = spectra(scene, cleaned(scene, options_to(1e-3)));
    const TaylorValues best = fit(scene.expansion, fraction, -0.7);
    const double alpha = best[1] / best[0];
    BOOST_TEST(std::abs(at(made.alpha, steep) - alpha) < 0.01);
    if (terms == 3) BOOST_TEST(std::abs(at(made.beta, steep) - (best[2] / best[0] - alpha * (alpha - 1) / 2)) < 0.02);
  }
}

/// α less what the fit of two terms makes of it, over its error, of two sources in 12 realisations of noise: the root mean
/// square of 24 normal numbers is 1 to 1/√48 = 14 %; three times that is allowed.
BOOST_AUTO_TEST_CASE(with_noise_the_error_of_the_index_is_its_scatter, *boost::unit_test::label("sweep")) {
  constexpr int realisations = 12;
  constexpr double fraction = 0.2, image_noise_jy = 2e-3;
  // A pixel is the mean of the real parts of so many samples, turned to it.
  const double noise_jy = image_noise_jy * std::sqrt(351.0 * hour_angles * channels);
  double square = 0;
  for (unsigned seed = 0; seed < realisations; ++seed) {
    const Scene scene = make_scene(2, fraction, noise_jy, seed);
    const SpectralImages made = spectra(scene, cleaned(scene, options_to(4 * image_noise_jy)));
    for (const auto& [place, alpha] : {std::pair{steep, -0.7}, std::pair{flat, 0.0}}) {
      const TaylorValues best = fit(scene.expansion, fraction, alpha);
      square += std::pow((at(made.alpha, place) - best[1] / best[0]) / at(made.alpha_error, place), 2);
    }
  }
  BOOST_TEST(std::abs(std::sqrt(square / (2 * realisations)) - 1) < 3 * 0.144);
}

/// The residuals' own definition.
BOOST_AUTO_TEST_CASE(residuals_are_those_of_the_models) {
  const Scene scene = make_scene(3, 0.3, 0.01, 3);
  const CleanResult result = cleaned(scene, options_to(0.02));
  std::vector<Image> models{result.model};
  models.insert(models.end(), result.further_models.begin(), result.further_models.end());
  const std::vector<Image> left = make_taylor_residuals(scene.imaged(), models, scene.expansion, {});
  BOOST_TEST((left[0].pixel == result.residual.pixel));
  for (std::size_t t = 1; t < left.size(); ++t) BOOST_TEST((left[t].pixel == result.further_residuals[t - 1].pixel));
  BOOST_TEST(result.report.final_state().peak_residual_jy == largest_magnitude(result.residual));
}

BOOST_AUTO_TEST_CASE(no_iterations_leave_the_dirty_images) {
  const Scene scene = make_scene(2, 0.2, 0, 1);
  CleanOptions options = options_to(0);
  options.max_iterations = 0;
  const CleanResult result = cleaned(scene, options);
  BOOST_TEST((result.report.stop == CleanStop::iteration_limit));
  BOOST_TEST((result.residual.pixel == scene.first.dirty[0].pixel));
  BOOST_TEST((result.further_residuals[0].pixel == scene.further.dirty[0].pixel));
}

/// Every state that a run passes through leads to its end, bit for bit, with an automatic mask as well.
BOOST_AUTO_TEST_CASE(a_run_goes_on_from_any_of_its_states) {
  const Scene scene = make_scene(2, 0.2, 0.01, 1);
  CleanOptions options = options_to(0.01);
  options.cycle_iterations = 60;
  options.automask.emplace();
  std::vector<CleanState> states;
  const CleanResult whole = cleaned(scene, options, first(), [&](const CleanState& state) { states.push_back(state); });
  BOOST_TEST(states.size() > 2U);
  for (const CleanState& state : states) {
    const CleanResult rest = cleaned(scene, options, state);
    BOOST_TEST((rest.model.pixel == whole.model.pixel));
    BOOST_TEST((rest.further_models[0].pixel == whole.further_models[0].pixel));
    BOOST_TEST((rest.further_residuals[0].pixel == whole.further_residuals[0].pixel));
  }
}

BOOST_AUTO_TEST_CASE(a_minor_cycle_of_other_terms_is_refused) {
  const Scene two = make_scene(2, 0.2, 0, 1), three = make_scene(3, 0.2, 0, 1);
  const JointClean minor(three.psf, {.threads = 1});
  BOOST_CHECK_THROW(imager::clean(input_of(two), minor, options_to(0.1), first(), [](const CleanState&) {}, {}),
                    std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
