#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "imager/clean/components.h"
#include "imager/clean/found_flux.h"
#include "imager/data/image.h"

namespace misfit::imager {

/// Sidelobes that a minor cycle's PSF lacks or has wrongly, in Jy/beam for each Jy of components.
struct DoubtfulSidelobes {
  double of_many = 0;  ///< × √Σ f², f being the |flux| found in each square of bright_tile_side pixels
  double of_one = 0;   ///< × f
};

struct MinorCycleOptions {
  double gain = 0.1;  ///< part of a peak that a component takes
  int max_iterations = 0;
  double threshold_jy = 0;  ///< in Jy/beam; ends when no pixel that may be cleaned exceeds it in magnitude
  /// It goes no deeper than this many times the robust noise of the residual that it begins with; or, without a mask, than this
  /// many times, at least five times, the noise that is left as sources are removed: fainter pixels may be that noise.
  double nsigma = 0;
  double noise_jy = 0;  ///< of the residual that it begins with
  /// It ends when no pixel exceeds what doubtful sidelobes of all its components may leave; but it goes down to `sure_jy` in
  /// any case.
  DoubtfulSidelobes doubtful{};
  double sure_jy = 0;           ///< in Jy/beam; 0 = down to the threshold, whatever the doubt
  const Image* mask = nullptr;  ///< where components may lie, see mask.h; null = everywhere
  /// True if it looks in the end at pixels that were faint, if sidelobes of all components, by nine standard deviations, may
  /// have raised them above the threshold; no pixel then exceeds it by more than half a percent. Where the noise sets the depth
  /// it looks in any case. Otherwise pixels that were faint until sidelobes were removed may exceed the threshold; a residual
  /// made anew shows them, too.
  bool to_the_last = true;
  std::function<bool()> stop_requested;  ///< asked now and then; may be empty
};

enum class MinorCycleEnd {
  threshold,   ///< no pixel exceeds it
  iterations,  ///< as many components as allowed
  diverging,   ///< the peak exceeds minor_cycle_divergence times that of the start
  stopped,     ///< as requested
  no_place,    ///< all pixels left lie where none of its scales may be put
};

/// A peak that has grown by this factor shows that components do harm: sources beyond the PSF's reach, or a wrong PSF.
constexpr double minor_cycle_divergence = 3;

struct MinorCycleReport {
  std::vector<Component> components;  ///< in the order in which they were found; places repeat
  double peak_jy = 0;                 ///< magnitude of the brightest pixel left that may be cleaned
  double depth_jy = 0;  ///< that it was to reach: the threshold, or above it what noise or doubts allow; or that it reached
                        ///< before it was to end
  double noise_jy = 0;  ///< of the residual, as far as it was followed
  MinorCycleEnd end = MinorCycleEnd::threshold;

  int iterations() const { return static_cast<int>(components.size()); }
};

/// A way to find components in an image whose PSF is known: CLEAN without visibilities. Made once for a PSF, whose size is that
/// of the images, and whose peak, 1, is the middle pixel (row height/2, column width/2). Places beyond the PSF, and NaN, count
/// as 0. Pixels of a residual that are NaN are never cleaned. The number of threads does not change components.
class MinorCycle {
 public:
  MinorCycle(const MinorCycle&) = delete;
  MinorCycle& operator=(const MinorCycle&) = delete;
  virtual ~MinorCycle() = default;

  /// The scales of its components, see ComponentModel.
  virtual const std::vector<double>& scale_pixels() const = 0;
  /// The number of residuals that it looks at together: the Taylor terms of an image.
  int terms() const { return terms_; }
  /// Components whose images, convolved with the PSF and taken off the residuals [term] (Jy/beam), leave less. Throws
  /// std::invalid_argument unless there is a residual for each term, and all images have the size of the PSF.
  MinorCycleReport clean(const std::vector<const Image*>& residual, const MinorCycleOptions& options) const;
  /// Finds components in the residual of one term.
  MinorCycleReport clean(const Image& residual, const MinorCycleOptions& options) const { return clean({&residual}, options); }

 protected:
  explicit MinorCycle(const Image& psf, int terms = 1) : width_(psf.width), height_(psf.height), terms_(terms) {}
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  /// clean() of images of the right size.
  virtual MinorCycleReport find(const std::vector<const Image*>& residual, const MinorCycleOptions& options) const = 0;

  int width_;
  int height_;
  int terms_;
};

/// Says when a minor cycle ends, in one way for all minor cycles.
class MinorCycleWatch {
 public:
  /// Watches a minor cycle in an image of this width and height, whose brightest pixel is first_peak_jy to begin with.
  MinorCycleWatch(const MinorCycleOptions& options, int width, int height, double first_peak_jy)
      : options_(options), found_(width, height), first_peak_jy_(first_peak_jy), noise_jy_(options.noise_jy) {}

  void add(const Component& found) { found_.add(found.row, found.column, 0, std::abs(found.flux_jy)); }
  /// Learns the noise of the residual left.
  void see_noise(double noise_jy) {
    constexpr double hardly_less = 0.98;
    noise_falls_ = noise_jy < hardly_less * noise_jy_;
    noise_jy_ = std::min(noise_jy_, noise_jy);
  }
  /// The depth to reach, given the components so far.
  double depth_jy() const {
    const DoubtfulSidelobes& doubtful = options_.doubtful;
    const double left_jy = std::max(doubtful.of_many * std::sqrt(found_.square(0)), doubtful.of_one * found_.largest(0));
    return std::max(least_depth_jy(), std::min(options_.sure_jy, left_jy));
  }
  /// The depth that neither threshold nor noise let it pass.
  double least_depth_jy() const { return std::max(options_.threshold_jy, noise_depth_jy()); }
  /// True while the noise, and not the threshold, sets the least depth, so that less noise lets it go deeper.
  bool follows_noise() const { return options_.mask == nullptr && noise_depth_jy() > options_.threshold_jy; }
  /// True where it has reached the depth that the noise sets, and there may be less noise by now.
  bool may_go_deeper() const { return noise_falls_ && follows_noise() && depth_jy() == noise_depth_jy(); }
  double noise_jy() const { return noise_jy_; }
  /// True where pixels that were faint are to be looked at in the end.
  bool is_to_the_last() const {
    const double depth = depth_jy();
    return depth == options_.threshold_jy ? options_.to_the_last : depth == noise_depth_jy();
  }
  /// True if no further component is to be taken now that the brightest pixel has this magnitude; `report` then says why.
  bool ends(double peak_jy, MinorCycleReport& report) const;
  /// True if there are as many components as allowed, or the user wishes to end; `report` then says which of the two.
  bool is_at_limit(MinorCycleReport& report) const;

 private:
  double noise_depth_jy() const {
    constexpr double surely_sources = 5;  // deviations
    return std::min(options_.nsigma * options_.noise_jy, std::max(options_.nsigma, surely_sources) * noise_jy_);
  }

  const MinorCycleOptions& options_;
  FoundFlux found_;
  double first_peak_jy_;
  double noise_jy_;
  bool noise_falls_ = true;  ///< as far as it is known
};

}  // namespace misfit::imager
