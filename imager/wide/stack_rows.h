#pragma once

#include <vector>

#include "imager/numerics/fft.h"
#include "imager/numerics/spares.h"
#include "imager/wide/image_planes.h"
#include "imager/wide/plane_stack.h"

namespace misfit::imager {

/// The FFTs along u between a band of a stack and the columns that an image keeps of it, a few rows at a time, while the nearer
/// caches still hold what was gridded there, or will be degridded.
template <typename Real>
class StackRows {
 public:
  /// Stack and image must outlive it, and have the same numbers of planes and grids.
  StackRows(PlaneStack<Real>& stack, ImagePlanes<Real>& image, int threads);
  ~StackRows();

  /// Σ_p G(p, q) exp(+2πi px/nu) for the used rows q that have not been transformed yet and to which rows of storage from
  /// `filled` on add nothing.
  void to_image(int filled);
  /// The first row of storage that belongs to rows not transformed yet.
  int first_awaited() const;
  /// The adjoint, for a stack of one grid a plane: G(p, q) for the rows q not transformed yet that rows of storage up to
  /// `needed` show, margins filled by periodicity.
  void to_grid(int needed);

 private:
  struct Work;
  template <typename Transform>
  void for_each(const std::vector<int>& rows, const Transform& transform);

  PlaneStack<Real>& stack_;
  ImagePlanes<Real>& image_;
  int threads_;
  Fft<Real> along_u_;
  std::vector<char> done_;  ///< [q]
  Spares<Work> spares_;
};

}  // namespace misfit::imager
