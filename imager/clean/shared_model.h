#pragma once

#include <vector>

#include "imager/clean/components.h"
#include "imager/taylor/taylor_expansion.h"
#include "imager/transform/imaging.h"

namespace misfit::imager {

/// By this rank 0, which alone has the images and runs CLEAN, has the other ranks make residuals with it: it tells them of each
/// model before it makes that model's residuals, and of the end. The others wait in follow_clean().
class ModelSharer {
 public:
  /// `ranks` is kept by reference.
  explicit ModelSharer(const Ranks& ranks) : ranks_(ranks) {}
  /// `coarser`: which of the coarser transforms is to be taken; −1 = none of them.
  void share(const ComponentModel& model, int coarser) const;
  /// Other ranks stop following.
  void end() const;

 private:
  const Ranks& ranks_;
};

/// On ranks after the first: makes this rank's part of the residuals of every model that rank 0 tells of, until it tells of the
/// end.
void follow_clean(const ImagedData& imaged, const std::vector<CoarserTransform>& coarser, const TaylorExpansion& expansion,
                  const Context& context);

/// Returns the same samples with one of the coarser transforms; −1 = with their own.
ImagedData by_coarser(const ImagedData& imaged, const std::vector<CoarserTransform>& coarser, int which);

}  // namespace misfit::imager
