#pragma once

// It leaves macros behind: grdsf, cgrd2d and more.
#include <casacore/scimath/Mathematics/ConvolveGridder.h>

#include <Eigen/Core>
#include <filesystem>
#include <optional>

namespace misfit::hosts {

/// casacore's own ConvolveGridder with another table in it: a gridding function of width W ≤ 7, looked up and normalised as
/// casacore does, and the optimal correction of the taps that result. How densely C is sampled limits the accuracy: the error
/// of nearest entries, √2 e in two dimensions with e of kernels::table_misfit, falls only as 1/per_cell. As in casacore only
/// grids of two axes work, and degrid() does not know of setOffset().
class ConvolveGridderTable : public casacore::ConvolveGridder<casacore::Double, casacore::Complex> {
 public:
  /// The kernel of a file by `misfit kernel --emit casacore`, with the number of entries a cell that the file has, or any
  /// kernel file with another number. The FFT has to be at least 1/(2 x0) times as large as the image: the gridder cannot know.
  /// std::runtime_error that names the path when this is no such file, its checksum does not match, its table is not for the
  /// nearest entry and no number is given, or W > 7; std::invalid_argument unless shape, scale and offset have two axes.
  ConvolveGridderTable(const std::filesystem::path& kernel_table, const casacore::IPosition& shape,
                       const casacore::Vector<casacore::Double>& scale, const casacore::Vector<casacore::Double>& offset,
                       std::optional<int> per_cell = {});

 protected:
  casacore::Complex correctionFactor1D(casacore::Int loc, casacore::Int len) override;

 private:
  Eigen::VectorXd table_;
  Eigen::VectorXd divisor_;  ///< 1/h along an axis of the length last asked for
};

}  // namespace misfit::hosts
