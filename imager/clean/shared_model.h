#pragma once

#include "imager/clean/components.h"
#include "imager/taylor/taylor_expansion.h"
#include "imager/transform/imaging.h"

namespace misfit::imager {

/// How rank 0, which alone has the images and runs CLEAN on them, has the others make residuals with it: it tells them of each
/// model before it makes that model's residuals, and of the end. What it says, others wait for in follow_clean().
class ModelSharer {
 public:
  /// Kept by reference.
  explicit ModelSharer(const Ranks& ranks) : ranks_(ranks) {}
  void share(const ComponentModel& model) const;
  /// Others stop following.
  void end() const;

 private:
  const Ranks& ranks_;
};

/// On ranks after the first: makes the parts of residuals that this rank's samples give, of every model that rank 0 tells of,
/// until it tells of the end.
void follow_clean(const ImagedData& imaged, const TaylorExpansion& expansion, const Context& context);

}  // namespace misfit::imager
