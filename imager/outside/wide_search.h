#pragma once

#include <array>
#include <cstdint>

#include "imager/outside/outside.h"
#include "imager/outside/sidelobes.h"
#include "imager/outside/unexplained.h"
#include "imager/plan/gridding_plan.h"
#include "imager/transform/imaging.h"

namespace misfit::imager {

/// An image of a wider field about another, as coarse as short baselines make it.
struct WideField {
  ImageGeometry geometry;  ///< four times the image's sides
  double max_abs_w = 0;    ///< of the samples that this cell can represent, in wavelengths
  double reaching = 0;     ///< part of all samples that lie within half of the u and v that it can represent
};

/// Its cell is the image's times a power of two: 4 or, where it then has more than 1024 pixels a side, more; less where fewer
/// than a tenth of the samples lie within half as far in u and v as it can represent, or it has fewer than 64 pixels.
class WideFieldFinder {
 public:
  explicit WideFieldFinder(const ImageGeometry& image) : image_(image) {}

  void add(const SampleCoordinates& samples);
  /// Takes in the samples of all other ranks.
  void add_up(const Ranks& ranks);
  WideField field() const;

 private:
  static constexpr int most_doublings = 12;

  /// Samples by the number of doublings of the image's cell.
  ImageGeometry image_;
  std::uint64_t samples_ = 0;
  std::array<std::uint64_t, most_doublings + 1> inner_{};  ///< with |u|, |v| below 1/(4 cell)
  std::array<double, most_doublings + 1> max_abs_w_{};     ///< of those below 1/(2 cell)
};

/// How the wider field is imaged: to 1e-4, within the memory that `image` allows.
GriddingPlan plan_wide_field(const WideField& field, const GriddingRequest& image);

/// True if any rank has a usable sample for the wider field: all its samples may be flagged.
bool can_be_imaged(const ImageGeometry& field, const VisibilitySource& source);

/// The result of the search in a wider field.
struct WideSearch {
  std::vector<Component> components;
  Sidelobes sidelobes;  ///< of its PSF, by its pixels
  double least_jy = 0;  ///< flux from which on sources are told from noise, and from CLEAN's residuals of bright ones: 1/200
  Unexplained unexplained;  ///< by the components, of the samples that its pixels can represent
  /// The height of sidelobes that sources not found may have, such as sources beyond the field: fainter components may be such
  /// sidelobes. Noise alone does not count, so far as samples share cells of the uv plane.
  double sidelobe_jy = 0;
};

/// Images the wider field of `plan` with weights that fall off towards the edge of its grid, and finds its sources by Högbom's
/// CLEAN with major cycles, down to five times the noise or a five-hundredth of the peak. Ranks after the first get
/// WideSearch::unexplained alone. Stages timed: "statistics", and those of make_dirty_images and clean. Throws what they throw.
WideSearch search_wide_field(const VisibilitySource& source, const GriddingPlan& plan, const Context& context);

}  // namespace misfit::imager
