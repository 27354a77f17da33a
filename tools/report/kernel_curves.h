#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <utility>

#include "kernels/least_misfit.h"
#include "kernels/map_error.h"
#include "tools/report/figure.h"

namespace misfit::tools {

/// The x0 of most kernels in the paper (Ye, Gull, Tan & Nikolic 2020) and in reports: that of a padding of 2.
inline constexpr double paper_x0 = 0.25;

/// Least-misfit functions, each solved when it is first asked for.
class SolvedKernels {
 public:
  const kernels::LeastMisfit& operator()(int width, double x0);

 private:
  std::map<std::pair<int, double>, kernels::LeastMisfit> solved_;
};

/// Parts of figures that show gridding functions.

/// y over x, both of one length.
Series curve(const std::string& label, const Eigen::VectorXd& x, const Eigen::VectorXd& y);

/// ℓ(x), 0 ≤ x ≤ ½.
Series map_error_curve(const std::string& label, const kernels::TapFunction& taps, const kernels::JudgeOptions& options = {});

/// C(u), 0 ≤ u ≤ W/2, broken where cells meet so that its jumps are not bridged.
Series function_curve(const std::string& label, const kernels::TapFunction& taps);

/// The optimal h(x), 0 ≤ x ≤ x0.
Series correction_curve(const std::string& label, const kernels::TapFunction& taps, double x0);

/// Places x from 0 to `to`, closer than a printed line is wide.
Eigen::VectorXd places(double to);

/// A figure of ℓ(x), 0 ≤ x ≤ ½, that has no curves yet; ℓ is shown between `from` and `to`.
Figure map_error_figure(const std::string& name, const std::string& title, double from, double to);

/// "x₀ = 0.25".
std::string x0_label(double x0);
/// "W = 7".
std::string width_label(int width);

}  // namespace misfit::tools
