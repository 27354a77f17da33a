#include "imager/clean/wide_band_clean.h"

#include <stdexcept>
#include <string>
#include <utility>

#include "imager/clean/finite_images.h"
#include "imager/clean/major_cycles.h"
#include "imager/clean/shared_model.h"
#include "imager/taylor/taylor_imaging.h"

namespace misfit::imager {
namespace {

/// All Taylor terms of an image.
class SeveralTerms : public CleanProblem {
 public:
  SeveralTerms(const CleanInput& input, const WideBand& band, const MultiTerm& minor, const Progress& progress,
               StageTimes& times)
      : input_(input), band_(band), minor_(minor), progress_(progress), times_(times), sharer_(input.samples.source.ranks()) {
    const int terms = band.expansion.terms;
    if (minor.terms() != terms || band.further_dirty.size() + 1 != static_cast<std::size_t>(terms))
      throw std::invalid_argument(std::to_string(terms) + " Taylor terms, dirty images of " +
                                  std::to_string(band.further_dirty.size() + 1) + " and a minor cycle of " +
                                  std::to_string(minor.terms()) + "; expected as many of each");
    for (const Image* psf : band.psf) require_finite_psf(*psf);
  }

  const std::vector<double>& scale_pixels() const override { return minor_.scale_pixels(); }
  /// Those of no model are the dirty images.
  Residuals residuals(const ComponentModel& model, int threads) override {
    Residuals made;
    if (model.components().empty()) {
      made.push_back(without_owner(input_.dirty));
      for (const Image& dirty : band_.further_dirty) made.push_back(without_owner(dirty));
    } else {
      sharer_.share(model);
      for (Image& image : make_taylor_residuals(input_.samples, input_.transform, model_images(model, threads), band_.expansion,
                                                progress_, times_))
        made.push_back(std::make_shared<const Image>(std::move(image)));
    }
    const StageTimer timer(times_, "statistics");
    for (const auto& residual : made) require_finite_residual(*residual, input_.dirty);
    return made;
  }
  void end() const override { sharer_.end(); }
  MinorCycleReport find(const Residuals& residuals, const MinorCycleOptions& options) const override {
    std::vector<const Image*> images;
    for (const auto& residual : residuals) images.push_back(residual.get());
    return minor_.clean(images, options);
  }

 private:
  static std::shared_ptr<const Image> without_owner(const Image& image) { return {std::shared_ptr<void>(), &image}; }
  std::vector<Image> model_images(const ComponentModel& model, int threads) const {
    const StageTimer timer(times_, "minor cycles");
    std::vector<Image> images;
    for (int t = 0; t < band_.expansion.terms; ++t) images.push_back(model.image(threads, t));
    return images;
  }

  const CleanInput& input_;
  const WideBand& band_;
  const MultiTerm& minor_;
  const Progress& progress_;
  StageTimes& times_;
  ModelSharer sharer_;
};

}  // namespace

CleanResult clean(const CleanInput& input, const WideBand& band, const MultiTerm& minor, const CleanOptions& options,
                  CleanState state, const Progress& progress, const CycleProgress& cycle_progress, StageTimes& times) {
  SeveralTerms problem(input, band, minor, progress, times);
  return run_major_cycles(problem, input, options, std::move(state), cycle_progress, times);
}

}  // namespace misfit::imager
