#include "imager/plan/accurate_imaging.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "imager/direct/verify.h"
#include "imager/pointing/mosaic_response.h"

namespace misfit::imager {
namespace {

/// RMS of the dirty image of data with random phases: √(½ Σ w²|V|²) / Σ w.
double random_image_rms(const SampleSums& sums) {
  return std::sqrt(0.5 * sums.weight2_square) / sums.weight;
}

/// Replaces `image` by `taken`, at rank 0. Returns its statistics, at every rank.
ImageStatistics replace(Image& image, Image& taken, const Ranks& ranks) {
  image = std::move(taken);
  ImageStatistics statistics = ranks.first() ? statistics_of(image) : ImageStatistics();
  share_values(ranks, statistics);
  return statistics;
}

/// Replaces the compared pixels by the images that are taken.
void take(const TakenImages& taken, const ComparedPixels& pixels, const Ranks& ranks, AccurateImages& made) {
  FormerImages former;
  former.dirty.resize(made.images.dirty.size());
  if (ranks.first()) former = taken.read();
  const GriddingRequest& request = made.plan.request;
  if (taken.psf) {
    if (ranks.first())
      pixels.require(former.psf, made.images.psf, root_mean_square(former.psf), request.psf_accuracy, {.psf = true});
    made.images.psf_statistics = replace(made.images.psf, former.psf, ranks);
  }
  for (std::size_t s = 0; taken.dirty && s < made.images.dirty.size(); ++s) {
    Image& image = former.dirty.at(s);
    if (ranks.first() && !taken.of_model)
      pixels.require(image, made.images.dirty[s], root_mean_square(image), request.accuracy, {.stokes = s});
    made.images.dirty_statistics[s] = replace(made.images.dirty[s], image, ranks);
  }
}

AccurateImages make_images(const VisibilitySource& source, GriddingPlan plan, const Context& context,
                           std::shared_ptr<const PlannedTransform> transform = nullptr, const TakenImages& taken = {},
                           bool begin_clean = false) {
  AccurateImages made;
  made.plan = std::move(plan);
  made.transform = std::move(transform);
  if (!made.transform) {
    const StageTimer timer(context.times, stage::plan);
    made.transform = std::make_shared<PlannedTransform>(made.plan);
  }
  std::optional<ComparedPixels> pixels;
  if (taken.any()) pixels.emplace(made.plan, made.transform->images());
  if (begin_clean && !pixels && made.plan.psf && may_be_coarser(made.plan) &&
      made.plan.psf->request.accuracy > made.plan.request.accuracy)
    made.dirty_accuracy = made.plan.psf->request.accuracy;
  const Transform& psf = taken.psf ? pixels->transform() : made.transform->psf();
  const Transform& images = made.dirty_accuracy != 0 ? psf : taken.dirty ? pixels->transform() : made.transform->images();
  const int stokes = made.plan.request.stokes;
  const bool with_psf = made.plan.request.psf || taken.psf;
  made.images = with_psf && &psf != &images ? make_dirty_images(source, images, OwnPsf{psf, stokes}, context)
                                            : make_dirty_images(source, images, AdjointOptions{stokes, with_psf}, context);
  if (pixels) take(taken, *pixels, source.ranks(), made);
  return made;
}

/// The largest error of the images relative to their RMS, at a few to many pixels, so that the direct sums take less than a
/// second.
double largest_checked_error(const VisibilitySource& source, const AccurateImages& made, const Context& context) {
  const StageTimer timer(context.times, stage::check_pixels);
  const DirtyImages& images = made.images;
  const WideTransformOptions& o = made.plan.options;
  const ImageGeometry& geometry = made.plan.request.geometry;
  const double affordable = 4e7 / static_cast<double>(images.sums.front().used);
  const int count = static_cast<int>(std::clamp(affordable, 4.0, 64.0));
  const DirectPixels at{geometry, random_pixels(geometry, count), made.plan.direct || made.plan.windows || o.has_w_axis(),
                        o.threads, response_of(made.plan)};
  std::vector<std::vector<double>> sum(images.dirty.size(), std::vector<double>(at.pixel.size()));
  const auto stream = source.open();
  while (const auto block = stream->next()) add_direct_pixels(*block, at, sum);
  for (std::vector<double>& of_image : sum) source.ranks().sum_at_first(of_image.data(), of_image.size());
  double largest = 0;
  for (std::size_t i = 0; source.ranks().first() && i < sum.size(); ++i) {
    const PixelError error = pixel_error(images.dirty[i], at.pixel, sum[i], images.normalisation);
    largest = std::max(largest, relative_pixel_error(error, images.dirty[i]).rms);
  }
  share_values(source.ranks(), largest);
  return largest;
}

/// How much weaker an image is than its data would let expect.
struct Weakness {
  double random = 1;    ///< than random data of this size give
  double coherent = 1;  ///< than data of one source give
};

/// The largest weakness of all images; an image of zeros has no relative error.
Weakness weakness_of(const DirtyImages& images) {
  const double psf_rms = images.psf_statistics.root_mean_square();
  Weakness largest;
  for (std::size_t i = 0; i < images.dirty.size(); ++i) {
    const double image_rms = images.dirty_statistics[i].root_mean_square();
    if (image_rms == 0) continue;
    const SampleSums& sums = images.sums[i];
    largest.random =
        std::max(largest.random, random_image_rms(sums) * images.normalisation.noise_factor(sums.weight) / image_rms);
    largest.coherent = std::max(largest.coherent, psf_rms * std::sqrt(sums.weight_square / sums.weight) / image_rms);
  }
  return largest;
}

/// Tells from dirty images made together with the PSF whether those of the plan would keep their promise.
bool would_keep_promise(const AccurateImages& made) {
  constexpr double known = 0.02;  // an image's RMS
  const Weakness weak = weakness_of(made.images);
  const double weakest = std::max(weak.random, weak.coherent);
  return made.plan.psf->expected_error * weakest <= known && made.plan.expected_error * weakest <= made.plan.request.accuracy;
}

/// Makes dirty images, in place of those made together with the PSF, as exactly as the plan says.
void make_dirty_exact(const VisibilitySource& source, const Context& context, AccurateImages& made) {
  made.images.dirty.clear();  // there may be no room for both
  DirtyImages exact =
      make_dirty_images(source, made.transform->images(), AdjointOptions{made.plan.request.stokes, false}, context);
  exact.psf = std::move(made.images.psf);
  exact.psf_statistics = made.images.psf_statistics;
  made.images = std::move(exact);
  made.dirty_accuracy = 0;
}

}  // namespace

std::shared_ptr<const SampleResponse> response_of(const GriddingPlan& plan) {
  return plan.request.mosaic ? std::make_shared<const MosaicResponse>(plan.request.mosaic->beams) : nullptr;
}

TheoreticalError theoretical_error(const GriddingPlan& plan, const SampleSums& sums, double image_rms, const NeglectedPhase& w,
                                   const Normalisation* by) {
  const double phase_rms =
      plan.leaves_w_out() ? std::min(w.rms_rad, std::sqrt(2.0)) : 0;  // unit phasors at random are √2 apart
  const double phase_max = plan.leaves_w_out() ? std::min(w.max_rad, 2.0) : 0;
  const auto over_image = [image_rms](double x) { return x == 0 ? 0 : x / image_rms; };
  // The pointings p of a mosaic add Σ B_p Σ w|V| to a pixel at most, which over √W is no more than √(Σ w|V|²).
  const bool mosaic = by != nullptr && by->mosaic() != nullptr;
  const double flux = over_image(mosaic ? std::sqrt(sums.weight_square / by->weight()) : sums.weight_abs / sums.weight);
  TheoreticalError error;
  error.expected_rms = std::hypot(plan.expected_error, phase_rms) *
                       std::max(1.0, over_image(random_image_rms(sums) * (mosaic ? by->noise_factor(sums.weight) : 1)));
  error.bound_rms = ((1 + plan.bound_rms) * (1 + phase_max) - 1) * flux;
  error.bound_max = ((1 + plan.bound_max) * (1 + phase_max) - 1) * flux;
  return error;
}

AccurateImages make_accurate_images(const VisibilitySource& source, GriddingPlan plan, const Context& context,
                                    std::shared_ptr<const PlannedTransform> transform, const TakenImages& taken,
                                    bool begin_clean) {
  const GriddingRequest request = plan.request;
  AccurateImages made = make_images(source, std::move(plan), context, std::move(transform), taken, begin_clean);
  if (made.dirty_accuracy != 0) {
    if (would_keep_promise(made)) return made;
    make_dirty_exact(source, context, made);
  }
  // The images' largest gridding error over the accuracy, once by theory and once by direct sums at pixels, which may miss half
  // of it.
  const auto excess = [&] {
    const Weakness weak = weakness_of(made.images);
    const double expected = made.plan.expected_error * weak.random / request.accuracy;
    if (expected > 1 || made.plan.expected_error * weak.coherent <= request.accuracy) return expected;
    return std::max(expected, 2 * largest_checked_error(source, made, context) / request.accuracy);
  };
  if (request.accuracy == 0 || taken.dirty) return made;
  const double first = excess();
  if (first <= 1) return made;
  GriddingRequest stricter = request;
  stricter.accuracy = request.accuracy / first;
  stricter.best_effort = true;
  Image psf;
  const ImageStatistics psf_statistics = made.images.psf_statistics;
  const bool psf_stays = made.plan.psf || taken.psf;  // it is exact enough
  if (psf_stays) {
    psf = std::move(made.images.psf);
    stricter.psf = false;
  }
  made.transform.reset();  // all comes again, and there may be no room for both
  made.images = {};
  {
    const StageTimer timer(context.times, stage::plan);
    plan = plan_gridding(stricter);
  }
  made = make_images(source, std::move(plan), context);
  if (psf_stays) {
    made.images.psf = std::move(psf);
    made.images.psf_statistics = psf_statistics;
  }
  char because[160];
  std::snprintf(because, sizeof because, "the image is weak against its data: its error came to %.3g times the accuracy",
                first);
  made.plan.decisions.push_back({"second pass", made.plan.direct ? "by direct sums" : "with a more exact kernel", because});
  const double second = excess();
  made.judged_error = second * request.accuracy;
  made.promise_kept = second <= 1;
  return made;
}

}  // namespace misfit::imager
