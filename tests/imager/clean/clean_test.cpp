#include "imager/clean/clean.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "imager/beams/beam.h"
#include "imager/clean/bright_loops.h"
#include "imager/clean/joint_clean.h"
#include "imager/data/noise.h"
#include "imager/plan/gridding_plan.h"
#include "tests/imager/comparison.h"
#include "tests/imager/vla_samples.h"

BOOST_AUTO_TEST_SUITE(clean)

using namespace misfit;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

constexpr double arcsec = pi / 180 / 3600;
const ImageGeometry geometry{128, 96, 0.08 * arcsec, {}};

struct Sky {
  int row, column;
  double flux_jy;
};
constexpr Sky sky[] = {{48, 64, 1}, {20, 100, 0.5}, {70, 30, 0.3}, {80, 90, -0.2}};

/// Everything that clean() takes, for sources on pixels seen by 13 snapshots.
struct Scene {
  StoredVisibilities source;
  std::unique_ptr<Transform> transform;
  std::vector<CoarserTransform> coarser;
  DirtyImages images;
  double dirty_accuracy = 0;
  double max_sidelobe = 0;
  bool same_sidelobes = false;
  Beam beam;

  ImagedData imaged() const { return {source, *transform, images.normalisation}; }
};

Scene make_scene(const DirectionCosines& centre) {
  ImageGeometry g = geometry;
  g.centre = centre;
  std::vector<Source> sources;
  for (const Sky& s : sky) sources.push_back({g.at(s.row, s.column), s.flux_jy});
  VisibilityBlock block = vla_samples(13);
  observe(sources, block);
  GriddingRequest request;
  request.geometry = g;
  request.accuracy = 1e-5;
  request.threads = 2;
  Scene s;
  s.source = stored({block});
  s.transform = make_coplanar_transform(plan_gridding(request).options);
  for (const double accuracy : {1e-2, 1e-3, 1e-4}) {
    request.accuracy = accuracy;
    s.coarser.push_back({accuracy, make_coplanar_transform(plan_gridding(request).options)});
  }
  s.images = make_dirty_images(s.source, *s.transform, {.with_psf = true}, {});
  Image middle(g.width, g.height);
  middle.at(g.centre_row(), g.centre_column()) = 1;
  const Beam beam = fit_beam(s.images.psf, g.cell_rad);
  s.max_sidelobe = largest_sidelobe(s.images.psf, convolve_with_beam(middle, beam, g.cell_rad, 1));
  s.beam = beam;
  return s;
}

const Scene& scene() {
  static const Scene made = make_scene({});
  return made;
}

CleanResult cleaned(const Scene& of, const CleanOptions& options, const DirtyImages& images, const CleanState& begin,
                    const CycleProgress& cycle_progress, bool of_start = false) {
  const JointClean minor({&images.psf}, {.threads = options.threads});
  const CleanInput input{.imaged = of.imaged(),
                         .dirty = {images.dirty[0]},
                         .dirty_accuracy = of.dirty_accuracy,
                         .of_start = of_start,
                         .psf = {&images.psf},
                         .max_sidelobe = of.max_sidelobe,
                         .same_sidelobes = of.same_sidelobes,
                         .coarser = of.coarser,
                         .data_jy = images.sums.front().data_jy(),
                         .accuracy = 1e-5,
                         .beam = of.beam,
                         .cell_rad = geometry.cell_rad};
  return imager::clean(input, minor, options, begin, cycle_progress, {});
}

CleanResult cleaned(const Scene& of, const CleanOptions& options, const DirtyImages& images) {
  return cleaned(of, options, images, first_state(ComponentModel(geometry.width, geometry.height, {0})),
                 [](const CleanState&) {});
}

CleanResult cleaned(const CleanOptions& options, const DirtyImages& images = scene().images) {
  return cleaned(scene(), options, images);
}

/// Beginning with dirty images that a coarser transform made.
CleanResult cleaned_from_coarse(std::size_t coarser, const CleanOptions& options) {
  const CoarserTransform& by = scene().coarser[coarser];
  Scene of = make_scene({});
  of.images.dirty = make_dirty_images(of.source, *by.transform, AdjointOptions{}, {}).dirty;
  of.dirty_accuracy = by.accuracy;
  return cleaned(of, options, of.images);
}

/// Options that stop at 1% of the brightest source.
CleanOptions deep() {
  CleanOptions options;
  options.max_iterations = 10000;
  options.threshold_jy = 0.01;
  options.threads = 2;
  return options;
}

double peak_magnitude(const Image& image) {
  return std::abs(find_peak(image).value);
}

double total(const Image& image) {
  return std::accumulate(image.pixel.begin(), image.pixel.end(), 0.0);
}

/// The residual's own definition: the dirty image of data − model.
void check_consistent(const CleanResult& result) {
  const Image residual = make_residual_image(scene().imaged(), result.model, {});
  BOOST_TEST((residual.pixel == result.residual.pixel));
  BOOST_TEST(result.report.final_state().peak_residual_jy == peak_magnitude(result.residual));
  BOOST_TEST(result.report.final_state().model_flux_jy == total(result.model));
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_peak_residual_falls_to_the_threshold_and_the_flux_is_recovered) {
  const CleanResult result = cleaned(deep());
  BOOST_TEST((result.report.stop == CleanStop::threshold));
  BOOST_TEST(peak_magnitude(result.residual) <= (1 + threshold_tolerance) * 0.01);
  check_consistent(result);
  for (const Sky& s : sky) {
    double flux = 0;
    for (int r = s.row - 1; r <= s.row + 1; ++r)
      for (int c = s.column - 1; c <= s.column + 1; ++c) flux += result.model.at(r, c);
    // The residual at the source is what its components lack; sidelobes of the others' residuals add a little.
    BOOST_TEST(std::abs(flux - s.flux_jy) < 2 * 0.01);
  }
}

/// A residual made anew is no brighter than its minor cycle's depth and six times what random sidelobes of its components are,
/// however they lie: that is what lets minor cycles go on.
BOOST_AUTO_TEST_CASE(components_err_by_less_than_their_sidelobes) {
  CleanOptions options = deep();
  options.threshold_jy = 1e-4;
  std::vector<CleanState> states;
  cleaned(scene(), options, scene().images, first_state(ComponentModel(geometry.width, geometry.height, {0})),
          [&](const CleanState& state) { states.push_back(state); });
  const double psf_rms = root_mean_square(scene().images.psf);
  for (std::size_t i = 1; i < states.size(); ++i) {
    const MajorCycle& is = states[i].cycles.back();
    const Image before = states[i - 1].model.image(1), after = states[i].model.image(1);
    double square = 0;
    for (std::size_t p = 0; p < after.pixel.size(); ++p) square += std::pow(after.pixel[p] - before.pixel[p], 2);
    BOOST_TEST(is.peak_residual_jy <= 1.01 * is.cycle_threshold_jy + 6 * psf_rms * std::sqrt(square));
  }
}

/// The states of a run to 1e-4 Jy, which takes the largest sidelobe for that.
std::vector<CleanState> states_with(double max_sidelobe,
                                    const CleanState& begin = first_state(ComponentModel(geometry.width, geometry.height, {0})),
                                    bool same_sidelobes = false) {
  Scene of = make_scene({});
  of.max_sidelobe = max_sidelobe;
  of.same_sidelobes = same_sidelobes;
  CleanOptions options = deep();
  options.threshold_jy = 1e-4;
  std::vector<CleanState> states;
  cleaned(of, options, of.images, begin, [&](const CleanState& state) { states.push_back(state); });
  return states;
}

/// Beside sidelobes of 4 the PSF's far ones are faint.
BOOST_AUTO_TEST_CASE(minor_cycles_go_deeper_than_sidelobes_while_components_are_trusted) {
  constexpr double sure = 0.8;  // maxpsffraction
  const Image& psf = scene().images.psf;
  const double peak = states_with(4)[0].cycles.back().peak_residual_jy;
  for (const bool same_sidelobes : {false, true}) {
    const std::vector<CleanState> trusted =
        states_with(4, first_state(ComponentModel(geometry.width, geometry.height, {0})), same_sidelobes);
    const double depth = trusted[1].cycles.back().cycle_threshold_jy;
    std::map<std::pair<int, int>, double> flux;
    for (const Component& c : trusted[1].model.components())
      flux[{c.row / bright_tile_side, c.column / bright_tile_side}] += std::abs(c.flux_jy);
    double square = 0, most = 0;
    for (const auto& [where, jy] : flux) square += jy * jy, most = std::max(most, jy);
    // Where w is left out those beyond half the image are doubtful alone.
    const FarSidelobes far = far_sidelobes(psf, same_sidelobes ? 0.375 : 0.25);
    const double rms = same_sidelobes ? far.root_mean_square : root_mean_square(psf);
    const double doubted = std::max(6 * rms * std::sqrt(square), far.largest * most);
    BOOST_TEST(depth < 0.9 * sure * peak);
    BOOST_TEST(depth == std::max(doubted, 0.05 * peak), boost::test_tools::tolerance(1e-9));
  }

  // Far sidelobes that are no fainter than a quarter of the largest.
  for (const double sidelobe : {scene().max_sidelobe, 0.8}) {
    const std::vector<CleanState> states = states_with(sidelobe);
    BOOST_TEST(states[1].cycles.back().cycle_threshold_jy == sidelobe * peak, boost::test_tools::tolerance(1e-12));
  }

  // A cycle that left more than it should have.
  CleanState misled = states_with(4)[1];
  misled.cycles.back().cycle_threshold_jy = misled.cycles.back().peak_residual_jy / 1.6;
  const std::vector<CleanState> states = states_with(4, misled);
  BOOST_TEST(states[1].cycles.back().cycle_threshold_jy == sure * misled.cycles.back().peak_residual_jy,
             boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_CASE(far_sidelobes_are_those_from_a_part_of_the_image_on) {
  Image psf(40, 20);
  psf.at(10, 20) = 1, psf.at(10, 29) = -0.9, psf.at(14, 20) = 0.8;
  BOOST_TEST(far_sidelobes(psf, 0.25).largest == 0);
  BOOST_TEST(far_sidelobes(psf, 0.2).largest == 0.9);
  for (const auto& [row, column] : {std::pair(10, 30), std::pair(10, 10), std::pair(15, 20), std::pair(5, 20)}) {
    psf.at(row, column) = -0.3;
    BOOST_TEST(far_sidelobes(psf, 0.25).largest == 0.3);
    // Rows −5 … 4 and columns −10 … 9 about the middle are near, but for the first of each.
    BOOST_TEST(far_sidelobes(psf, 0.25).root_mean_square == 0.3 / std::sqrt(40 * 20 - 19 * 9),
               boost::test_tools::tolerance(1e-12));
    psf.at(row, column) = std::numeric_limits<double>::quiet_NaN();
    BOOST_TEST(far_sidelobes(psf, 0.25).largest == 0);
    psf.at(row, column) = 0;
  }
}

/// What a cut minor cycle had not come to is no depth of it.
BOOST_AUTO_TEST_CASE(a_minor_cycle_that_is_cut_short_says_how_far_it_came) {
  CleanOptions options = deep();
  options.cycle_iterations = 3;
  options.max_iterations = 9;
  for (const MajorCycle& cycle : cleaned(options).report.cycles)
    if (cycle.iterations > 0) BOOST_TEST(cycle.cycle_threshold_jy > 0.5 * cycle.peak_residual_jy);
}

/// Residuals on the way are as exact as the next depth takes, and that at the end as exact as any.
BOOST_AUTO_TEST_CASE(residuals_that_steer_are_made_by_coarser_transforms) {
  CleanOptions options = deep();
  options.threshold_jy = 1e-4;
  std::vector<CleanState> states;
  const CleanResult result =
      cleaned(scene(), options, scene().images, first_state(ComponentModel(geometry.width, geometry.height, {0})),
              [&](const CleanState& state) { states.push_back(state); });
  BOOST_TEST((result.report.stop == CleanStop::threshold));
  check_consistent(result);
  BOOST_TEST(result.report.final_state().accuracy == 0);
  const std::vector<MajorCycle>& cycles = result.report.cycles;
  BOOST_REQUIRE(cycles.size() > 3);
  BOOST_TEST(cycles[1].accuracy >= 1e-3);
  for (std::size_t i = 2; i + 1 < cycles.size(); ++i) BOOST_TEST(cycles[i].accuracy <= cycles[i - 1].accuracy);
  // What they err by is a small part of the depth to which minor cycles went from them.
  for (std::size_t i = 1; i + 1 < states.size(); ++i) {
    const Image residual = make_residual_image(scene().imaged(), states[i].model.image(1), {});
    BOOST_TEST(std::abs(peak_magnitude(residual) - states[i].cycles.back().peak_residual_jy) <
               0.1 * states[i + 1].cycles.back().cycle_threshold_jy);
  }
}

/// The images of a transform with a point that is not there, as an alias from outside would be.
class Haunted : public Transform {
 public:
  explicit Haunted(const Transform& transform) : transform_(transform) {}
  std::unique_ptr<AdjointSum> adjoint(const AdjointOptions& options) const override {
    return std::make_unique<Sum>(transform_.adjoint(options), options);
  }
  std::unique_ptr<Prediction> predict(Image model) const override { return transform_.predict(std::move(model)); }
  std::vector<std::complex<double>> psf_source(const SampleCoordinates& at) const override { return transform_.psf_source(at); }

 private:
  class Sum : public AdjointSum {
   public:
    Sum(std::unique_ptr<AdjointSum> sum, const AdjointOptions& options) : AdjointSum(options), sum_(std::move(sum)) {}
    AdjointResult finish() override {
      AdjointResult result = sum_->finish();
      const Image& psf = scene().images.psf;
      Image& image = result.images.front();
      for (int r = 0; r < image.height; ++r)
        for (int c = 0; c < image.width; ++c) {
          const int row = r - 60 + psf.height / 2, column = c - 40 + psf.width / 2;
          if (row >= 0 && row < psf.height && column >= 0 && column < psf.width)
            image.at(r, c) += 0.05 * result.sums.front().weight * psf.at(row, column);
        }
      return result;
    }

   private:
    void add_sets(const VisibilityBlock& block, const VisibilitySets& sets) override { sum_->add(block, sets); }
    std::unique_ptr<AdjointSum> sum_;
  };
  const Transform& transform_;
};

BOOST_AUTO_TEST_CASE(it_begins_with_a_dirty_image_as_exact_as_needed_and_ends_exactly) {
  CleanOptions options = deep();
  const CleanResult begun = cleaned_from_coarse(2, options);
  BOOST_TEST(begun.report.cycles.front().accuracy == scene().coarser[2].accuracy);
  BOOST_TEST(begun.report.final_state().accuracy == 0);
  check_consistent(begun);

  // A minor cycle to a thousandth needs more than a hundredth of the image's RMS.
  options.min_psf_fraction = options.max_psf_fraction = 0.001;
  BOOST_TEST(cleaned_from_coarse(0, options).report.cycles.front().accuracy == 0);

  options.threshold_jy = 10;
  const CleanResult nothing = cleaned_from_coarse(2, options);
  BOOST_TEST(nothing.report.iterations == 0);
  BOOST_TEST((nothing.residual.pixel == scene().images.dirty.front().pixel));
}

BOOST_AUTO_TEST_CASE(transforms_that_mislead_it_are_not_asked_again) {
  Scene misled = make_scene({});
  for (CoarserTransform& coarser : misled.coarser)
    coarser.transform =
        std::make_shared<Haunted>(*scene().coarser[static_cast<std::size_t>(&coarser - misled.coarser.data())].transform);
  const CleanResult result = cleaned(misled, deep(), misled.images);
  BOOST_TEST((result.report.stop == CleanStop::threshold));
  check_consistent(result);
  double ghost = 0;
  for (int r = 58; r <= 62; ++r)
    for (int c = 38; c <= 42; ++c) ghost += result.model.at(r, c);
  BOOST_TEST(std::abs(ghost) < 2 * 0.01);
}

BOOST_AUTO_TEST_CASE(a_residual_within_a_hundredth_of_the_threshold_has_reached_it) {
  CleanOptions options = deep();
  const double peak = peak_magnitude(scene().images.dirty[0]);
  options.threshold_jy = peak / (1 + 0.9 * threshold_tolerance);
  const CleanReport reached = cleaned(options).report;
  BOOST_TEST((reached.stop == CleanStop::threshold));
  BOOST_TEST(reached.iterations == 0);
  options.threshold_jy = peak / (1 + 1.1 * threshold_tolerance);
  BOOST_TEST(cleaned(options).report.iterations > 0);
}

BOOST_AUTO_TEST_CASE(an_image_off_the_phase_centre_is_cleaned_like_one_on_it) {
  const Scene off = make_scene({0.02, -0.013});
  const CleanResult here = cleaned(deep()), there = cleaned(off, deep(), off.images);
  BOOST_TEST((there.report.stop == CleanStop::threshold));
  // The same sky on the same pixels; images differ by the accuracy, 1e-5 of their RMS, and rounding of float visibilities.
  BOOST_TEST(relative_error(off.images.dirty[0].pixel, scene().images.dirty[0].pixel) < 1e-4);
  BOOST_TEST(std::abs(there.report.final_state().model_flux_jy - here.report.final_state().model_flux_jy) < 2 * 0.01);
}

BOOST_AUTO_TEST_CASE(the_result_does_not_depend_on_the_number_of_threads) {
  CleanOptions options = deep();
  const CleanResult two = cleaned(options);
  options.threads = 1;
  BOOST_TEST((cleaned(options).model.pixel == two.model.pixel));
}

BOOST_AUTO_TEST_CASE(no_iterations_leave_the_dirty_image) {
  CleanOptions options = deep();
  options.max_iterations = 0;
  const CleanResult result = cleaned(options);
  BOOST_TEST((result.report.stop == CleanStop::iteration_limit));
  BOOST_TEST((result.residual.pixel == scene().images.dirty[0].pixel));
  BOOST_TEST(norm(result.model.pixel) == 0);
  BOOST_TEST(result.report.cycles.size() == 1U);
}

BOOST_AUTO_TEST_CASE(the_iteration_limit_is_not_passed) {
  CleanOptions options = deep();
  options.max_iterations = 37;
  const CleanResult result = cleaned(options);
  BOOST_TEST((result.report.stop == CleanStop::iteration_limit));
  BOOST_TEST(result.report.iterations == 37);
  check_consistent(result);
}

BOOST_AUTO_TEST_CASE(no_minor_cycle_finds_more_components_than_it_may) {
  CleanOptions options = deep();
  options.max_iterations = 50;
  options.cycle_iterations = 7;
  const CleanResult result = cleaned(options);
  const std::vector<MajorCycle>& cycles = result.report.cycles;
  BOOST_TEST(result.report.iterations == 50);
  BOOST_TEST(cycles.size() >= 9U);  // 50 components in sevens, and the state before the first
  for (std::size_t i = 1; i < cycles.size(); ++i) BOOST_TEST(cycles[i].iterations - cycles[i - 1].iterations <= 7);
}

BOOST_AUTO_TEST_CASE(the_limit_of_major_cycles_is_not_passed) {
  CleanOptions options = deep();
  for (const int limit : {0, 1, 2}) {
    options.max_major_cycles = limit;
    const CleanResult result = cleaned(options);
    BOOST_TEST((result.report.stop == CleanStop::major_cycle_limit));
    BOOST_TEST(static_cast<int>(result.report.cycles.size()) == limit + 1);
  }
}

BOOST_AUTO_TEST_CASE(nsigma_stops_at_that_many_times_the_noise) {
  CleanOptions options = deep();
  options.threshold_jy = 0;
  options.nsigma = 20;
  const CleanResult result = cleaned(options);
  BOOST_TEST((result.report.stop == CleanStop::nsigma));
  BOOST_TEST(result.report.final_state().peak_residual_jy <= 20 * result.report.final_state().rms_jy);
}

BOOST_AUTO_TEST_CASE(the_user_stops_it_with_a_valid_result) {
  CleanOptions options = deep();
  int asked = 0;
  options.stop_requested = [&] { return ++asked > 3; };
  const CleanResult result = cleaned(options);
  BOOST_TEST((result.report.stop == CleanStop::user));
  check_consistent(result);
}

BOOST_AUTO_TEST_CASE(components_lie_within_the_mask_and_sources_outside_stay) {
  Image mask(geometry.width, geometry.height);
  for (int r = 40; r < 56; ++r)
    for (int c = 56; c < 72; ++c) mask.at(r, c) = 1;  // around the brightest source
  CleanOptions options = deep();
  options.mask = &mask;
  const CleanResult result = cleaned(options);
  BOOST_TEST((result.report.stop == CleanStop::threshold));
  double within = 0;
  for (int r = 0; r < mask.height; ++r)
    for (int c = 0; c < mask.width; ++c)
      if (mask.at(r, c) == 0)
        BOOST_REQUIRE(result.model.at(r, c) == 0);
      else
        within = std::max(within, std::abs(result.residual.at(r, c)));
  BOOST_TEST(result.report.final_state().peak_residual_jy == within);
  BOOST_TEST(within <= (1 + threshold_tolerance) * options.threshold_jy);
  BOOST_TEST(std::abs(result.residual.at(sky[1].row, sky[1].column)) > 0.3);  // of 0.5 Jy, and sidelobes
  BOOST_TEST(result.report.final_state().peak_anywhere_jy == peak_magnitude(result.residual));
  BOOST_TEST(result.report.final_state().mask_pixels == 256U);
  BOOST_TEST(result.report.final_state().rms_jy == robust_noise(result.residual));
}

BOOST_AUTO_TEST_CASE(a_mask_that_allows_every_pixel_changes_nothing_but_for_nsigma) {
  Image mask(geometry.width, geometry.height);
  std::fill(mask.pixel.begin(), mask.pixel.end(), 1.0);
  CleanOptions options = deep();
  options.mask = &mask;
  BOOST_TEST((cleaned(options).model.pixel == cleaned(deep()).model.pixel));
}

BOOST_AUTO_TEST_CASE(a_mask_that_allows_no_pixel_ends_it_at_once) {
  const Image mask(geometry.width, geometry.height);
  CleanOptions options = deep();
  options.mask = &mask;
  const CleanResult result = cleaned(options);
  BOOST_TEST((result.report.stop == CleanStop::empty_mask));
  BOOST_TEST(result.report.iterations == 0);
  BOOST_TEST((result.residual.pixel == scene().images.dirty[0].pixel));
}

BOOST_AUTO_TEST_CASE(where_the_mask_is_empty_the_peak_is_that_of_the_whole_image_and_it_says_so) {
  const Image mask(geometry.width, geometry.height);
  CleanOptions given = deep(), made = deep();
  given.mask = &mask;
  made.automask = AutoMaskOptions{.noise_threshold = 1e9};
  for (const CleanOptions& options : {given, made}) {
    const CleanResult result = cleaned(options);
    BOOST_TEST((result.report.stop == CleanStop::empty_mask));
    BOOST_TEST(result.report.final_state().peak_residual_jy == peak_magnitude(scene().images.dirty[0]));
    BOOST_TEST(result.report.stop_reason.find("of the whole image") != std::string::npos);
  }
}

BOOST_AUTO_TEST_CASE(a_residual_that_is_not_finite_is_an_error) {
  for (const double value : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    DirtyImages images = scene().images;
    std::fill(images.dirty[0].pixel.begin(), images.dirty[0].pixel.end(), value);
    BOOST_CHECK_THROW(cleaned(deep(), images), std::runtime_error);
  }
}

BOOST_AUTO_TEST_CASE(a_minor_cycle_that_finds_nothing_ends_it) {
  CleanOptions options = deep();
  options.min_psf_fraction = options.max_psf_fraction = 1.01;  // above the peak itself
  const CleanResult result = cleaned(options);
  BOOST_TEST((result.report.stop == CleanStop::no_change));
  BOOST_TEST(result.report.iterations == 0);
}

bool was_taken_back(const MajorCycle& cycle) {
  return cycle.ended.find("taken back") != std::string::npos;
}

BOOST_AUTO_TEST_CASE(a_residual_that_grows_is_taken_back_and_shallower_cycles_go_on) {
  DirtyImages wrong = scene().images;
  std::fill(wrong.psf.pixel.begin(), wrong.psf.pixel.end(), 0.0);  // every pixel of a beam would be a source of its own
  wrong.psf.at(geometry.centre_row(), geometry.centre_column()) = 1;
  CleanOptions options = deep();
  options.max_iterations = 1000000;
  options.max_psf_fraction = 0.05;
  const CleanResult result = cleaned(options, wrong);
  BOOST_TEST((result.report.stop == CleanStop::threshold));
  BOOST_TEST(std::count_if(result.report.cycles.begin(), result.report.cycles.end(), was_taken_back) > 0);
  check_consistent(result);
}

BOOST_AUTO_TEST_CASE(a_residual_that_keeps_growing_ends_it_with_the_best_model) {
  DirtyImages wrong = scene().images;
  for (double& pixel : wrong.psf.pixel) pixel /= 100;  // each component would be a hundred times too bright
  CleanOptions options = deep();
  options.max_psf_fraction = 0.05;
  const CleanResult result = cleaned(options, wrong);
  BOOST_TEST((result.report.stop == CleanStop::diverging));
  const auto& cycles = result.report.cycles;
  BOOST_TEST(cycles.back().peak_residual_jy > 3 * result.report.final_state().peak_residual_jy);
  for (const MajorCycle& cycle : cycles) BOOST_TEST(cycle.peak_residual_jy >= result.report.final_state().peak_residual_jy);
  BOOST_TEST(std::count_if(cycles.begin(), cycles.end(), was_taken_back) == 4);  // three times less deep, and the last
  BOOST_TEST(result.report.iterations == result.report.final_state().iterations);
  check_consistent(result);
}

BOOST_AUTO_TEST_CASE(a_psf_that_is_not_finite_is_an_error) {
  for (const double value : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    DirtyImages images = scene().images;
    images.psf.at(geometry.centre_row(), geometry.centre_column()) = value;
    BOOST_CHECK_THROW(cleaned(deep(), images), std::runtime_error);
  }
}

BOOST_AUTO_TEST_CASE(where_the_transforms_err_clean_ends_without_change) {
  CleanOptions options = deep();
  options.threshold_jy = 0;
  options.max_iterations = 1000000;
  const CleanResult result = cleaned(options);
  BOOST_TEST((result.report.stop == CleanStop::no_change));
  BOOST_TEST(result.report.final_state().peak_residual_jy < 1e-4);  // of sources of 1 Jy, to 1e-5
}

/// Faint sources enter the mask once the sidelobes of the bright are gone: its peak grows, and no cycle is to be taken back.
BOOST_AUTO_TEST_CASE(a_mask_that_grows_is_no_divergence) {
  CleanOptions options = deep();
  options.automask.emplace();
  options.automask->sidelobe_threshold = 1.5;
  const CleanResult result = cleaned(options);
  BOOST_TEST((result.report.stop == CleanStop::threshold));
  BOOST_TEST(std::count_if(result.report.cycles.begin(), result.report.cycles.end(), was_taken_back) == 0);
}

/// Every state that a run passes through leads to its end, bit for bit.
BOOST_AUTO_TEST_CASE(a_run_goes_on_from_any_of_its_states) {
  std::vector<CleanState> states;
  const CleanState first = first_state(ComponentModel(geometry.width, geometry.height, {0}));
  CleanOptions options = deep();
  options.cycle_iterations = 60;
  options.automask.emplace();
  const CleanResult whole =
      cleaned(scene(), options, scene().images, first, [&](const CleanState& state) { states.push_back(state); });
  BOOST_TEST(states.size() > 3U);
  for (const CleanState& state : states) {
    const CleanResult rest = cleaned(scene(), options, scene().images, state, [](const CleanState&) {});
    BOOST_TEST((rest.model.pixel == whole.model.pixel));
    BOOST_TEST((rest.residual.pixel == whole.residual.pixel));
    BOOST_TEST((rest.mask.pixel == whole.mask.pixel));
    BOOST_TEST(rest.report.cycles.size() == whole.report.cycles.size());
    BOOST_TEST(rest.report.stop_reason == whole.report.stop_reason);
  }
}

/// The residual of its model is where CLEAN begins, and no other is made of it.
BOOST_AUTO_TEST_CASE(a_run_goes_on_from_a_residual_that_was_made_before) {
  CleanOptions options = deep();
  options.max_major_cycles = 4;
  const CleanResult whole = cleaned(options);
  options.max_major_cycles = 2;
  CleanResult half = cleaned(options);
  const auto rest = [&](Image residual) {
    DirtyImages images = scene().images;
    images.dirty[0] = std::move(residual);
    ComponentModel model(geometry.width, geometry.height, {0});
    model.add(components_of({&half.model}));
    return cleaned(
        scene(), options, images, first_state(model), [](const CleanState&) {}, true);
  };
  // The whole run went on from a residual by a coarser transform, of 1e-4 at most, which errs by as much of what cycles find.
  const CleanResult same = rest(half.residual);
  BOOST_TEST(relative_error(same.model.pixel, whole.model.pixel) < 1e-5);
  BOOST_TEST(relative_error(same.residual.pixel, whole.residual.pixel) < 1e-3);
  BOOST_TEST(same.report.cycles.front().peak_residual_jy == half.report.final_state().peak_residual_jy);
  // A residual that is too bright is mended by the next major cycle.
  options.max_major_cycles = -1;
  for (double& pixel : half.residual.pixel) pixel *= 1.5;
  const CleanResult mended = rest(half.residual);
  BOOST_TEST(mended.report.cycles.front().peak_residual_jy == peak_magnitude(half.residual));
  BOOST_TEST(mended.report.final_state().peak_residual_jy <= (1 + threshold_tolerance) * options.threshold_jy);
}

BOOST_AUTO_TEST_CASE(a_mask_of_its_own_making_holds_the_sources_and_the_components) {
  CleanOptions options = deep();
  options.automask.emplace();
  const CleanResult result = cleaned(options);
  BOOST_REQUIRE(result.mask.pixel.size() == result.model.pixel.size());
  for (const Sky& s : sky)
    if (s.flux_jy > 0) BOOST_TEST(result.mask.at(s.row, s.column) == 1);
  for (std::size_t i = 0; i < result.mask.pixel.size(); ++i)
    BOOST_REQUIRE((result.mask.pixel[i] == 1 || result.model.pixel[i] == 0));
  BOOST_TEST(total(result.mask) < 0.5 * static_cast<double>(result.mask.pixel.size()));
}

BOOST_AUTO_TEST_CASE(masks_of_its_own_making_have_the_noise_of_where_it_is_wanted) {
  const Image& dirty = scene().images.dirty[0];
  Image corner(geometry.width, geometry.height);
  for (int r = 0; r < 30; ++r) std::fill_n(corner.row(r), 40, 1.0);
  CleanOptions options = deep();
  options.automask = AutoMaskOptions{.sidelobe_threshold = 0, .fast_noise = false};
  options.max_major_cycles = 0;
  const auto noise = [&] { return cleaned(options).report.cycles.front().masked.threshold_jy / 5; };
  const auto expected = [&](const Image* within) { return mask_noise(dirty, Image(dirty.width, dirty.height), within, 1); };
  BOOST_TEST(std::abs(expected(&corner) / expected(nullptr) - 1) > 0.05);
  BOOST_TEST(noise() == expected(nullptr), boost::test_tools::tolerance(1e-15));
  options.noise_within = &corner;
  BOOST_TEST(noise() == expected(&corner), boost::test_tools::tolerance(1e-15));
}

/// Once minor cycles go as deep as threshold, or nsigma, lets them.
BOOST_AUTO_TEST_CASE(a_mask_that_hardly_grows_at_the_end_is_final) {
  for (const double nsigma : {0.0, 4.0})
    for (const double percent : {-1.0, 100.0}) {
      CleanOptions options = deep();
      options.automask = AutoMaskOptions{.sidelobe_threshold = 0.01, .min_percent_change = percent};
      options.nsigma = nsigma;
      if (nsigma > 0) options.threshold_jy = 0;
      options.max_major_cycles = 8;
      std::vector<bool> final;
      cleaned(scene(), options, scene().images, first_state(ComponentModel(geometry.width, geometry.height, {0})),
              [&](const CleanState& state) { final.push_back(state.mask.final); });
      BOOST_TEST(!final.front());
      BOOST_TEST(final.back() == (percent > 0));
    }
}

BOOST_AUTO_TEST_CASE(the_largest_sidelobe_is_what_the_beam_does_not_explain) {
  Image psf(5, 5), beam(5, 5);
  psf.at(2, 2) = beam.at(2, 2) = 1;
  psf.at(2, 3) = 0.5, beam.at(2, 3) = 0.6;
  psf.at(0, 4) = -0.3;
  psf.at(0, 0) = psf.at(4, 4) = std::numeric_limits<double>::quiet_NaN();
  BOOST_TEST(largest_sidelobe(psf, beam) == 0.3);
}

BOOST_AUTO_TEST_SUITE_END()
