#pragma once

#include <casacore/scimath/Mathematics/Gridder.h>

#include <Eigen/Core>
#include <filesystem>

#include "kernels/kernel.h"
#include "kernels/polynomial_taps.h"

namespace misfit::hosts {

/// The cells that one visibility touches, and how much of it each takes.
struct CasacoreFootprint;

/// A casacore gridder with a gridding function of any width W from 1 to 20, its taps by polynomials at the visibility's own
/// position instead of from a table, and the optimal correction. Its calls are ConvolveGridder's, on grids of one to three
/// axes:
///   grid(x, p, V):    x[n] += V Π_a C(n_a − pos_a)      degrid(x, p, V):  V = Σ_n x[n] Π_a C(n_a − pos_a)
/// with pos = scale·p + offset − the setOffset() of a tile, the same in both, which makes one the adjoint of the other. Taps
/// are not divided by their sum. A visibility whose W cells do not all lie on the grid that is handed in is left alone: False.
/// Arrays need not be contiguous; of axes beyond the gridder's the first plane is meant.
///
/// correct() and correctX1D() are what the image is divided by, 1/h at x = (loc − len/2)/len with integer division. Beyond the
/// kernel's x0 there is no image to correct; |1/h| is kept within [1e-15, 1e15] there, so that all remains finite.
///
/// The values of a grid of Complex are rounded to 2^-24, which the correction magnifies by noise_gain() on each axis: 8 cells
/// are about as many as single precision repays. Padded by 2 the rounding leaves 5e-8 to 1e-7 then; padded by 1.2, 1e-5, and
/// more for wider kernels.
///
/// cFunction() and cSampling() are lacking on purpose: gridding with a table of C makes other taps, which need another
/// correction. convolve_gridder_table.h has both for widths to 7.
class CasacoreGridder : public casacore::Gridder<casacore::Double, casacore::Complex> {
 public:
  /// The kernel of a file that `misfit kernel --output` has written. std::runtime_error that names the path when this is no
  /// such file or its checksum does not match; std::invalid_argument unless shape, scale and offset have the same one to three
  /// axes.
  CasacoreGridder(const std::filesystem::path& kernel_table, const casacore::IPosition& shape,
                  const casacore::Vector<casacore::Double>& scale, const casacore::Vector<casacore::Double>& offset);

  casacore::Bool grid(casacore::Array<casacore::Complex>& gridded, const casacore::Vector<casacore::Double>& position,
                      const casacore::Complex& value) override;
  casacore::Bool degrid(const casacore::Array<casacore::Complex>& gridded, const casacore::Vector<casacore::Double>& position,
                        casacore::Complex& value) override;

  /// Cells to either side of the nearest one that a visibility may touch, on each axis: ⌊W/2⌋.
  casacore::Vector<casacore::Int> cSupport() const;
  const kernels::Kernel& kernel() const { return kernel_; }

 protected:
  casacore::Complex correctionFactor1D(casacore::Int loc, casacore::Int len) override;

 private:
  /// Where the visibility falls; false when not all of it falls on the grid.
  bool place(const casacore::ArrayBase& gridded, const casacore::Vector<casacore::Double>& position,
             CasacoreFootprint& footprint) const;

  kernels::Kernel kernel_;
  kernels::PlainPolynomial<double> polynomial_;
  void (*add_)(const CasacoreFootprint&, casacore::Complex value, casacore::Complex* grid);
  casacore::Complex (*sum_)(const CasacoreFootprint&, const casacore::Complex* grid);
  Eigen::VectorXd divisor_;  ///< 1/h along an axis of the length last asked for
};

}  // namespace misfit::hosts
