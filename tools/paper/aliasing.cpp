#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <tuple>

#include "imager/coplanar/coplanar_transform.h"
#include "imager/direct/direct_transform.h"
#include "imager/direct/source_sums.h"
#include "imager/numerics/constants.h"
#include "imager/numerics/parallel.h"
#include "kernels/map_error.h"
#include "tools/paper/paper_experiments.h"

namespace misfit::tools {
namespace {

constexpr int shown_width = 7;
constexpr int alias_pixels = 32;
constexpr int alias_fft_size = 2 * alias_pixels;
constexpr double farthest = 3.25;  // sizes of the FFT
constexpr int fields = 3;          // that alias into the image, on either side
/// The steps between sources in pixels of the FFT, so that sources are pixels of the endless plane.
constexpr int step = 2;

/// The levels of unit sources at the positions x, in sizes of the FFT, where their aliases fall into the image: h(x − n) c(x)
/// with n the nearest whole number, times h(0) c(0) of the other axis; NaN where the alias falls beside it.
Eigen::VectorXd levels_of_aliases(const kernels::Kernel& kernel, const Eigen::VectorXd& x) {
  const auto nearest = [](double at) { return std::round(at); };
  const Eigen::VectorXd folded = x - x.unaryExpr(nearest);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(1);
  const double across =
      kernels::optimal_correction(kernel.polynomial, zero)[0] * kernels::image_taper(kernel.polynomial, zero)[0];
  const Eigen::ArrayXd level = across * kernels::optimal_correction(kernel.polynomial, folded).array() *
                               kernels::image_taper(kernel.polynomial, x).array();
  return (folded.array().abs() <= paper_x0).select(level.abs(), std::numeric_limits<double>::quiet_NaN());
}

/// Samples and image of the experiment.
struct SmallField {
  imager::ImageGeometry geometry;
  imager::VisibilityBlock block;
};

/// Visibilities at random all over the grid, so that sidelobes are low and aliases stand out.
SmallField small_field() {
  constexpr double cell_rad = 1e-6;
  constexpr int samples = 4000;
  SmallField field{{alias_pixels, alias_pixels, cell_rad, {}}, {}};
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-0.5 / cell_rad, 0.5 / cell_rad);
  field.block.frequency_hz = {imager::speed_of_light_m_s};  // so that metres are wavelengths
  for (int i = 0; i < samples; ++i) {
    for (int axis = 0; axis < 2; ++axis) field.block.uvw_m.edit().push_back(uniform(random));
    field.block.uvw_m.edit().push_back(0);
  }
  field.block.visibility.resize(samples);
  field.block.weight.assign(samples, 1);
  return field;
}

/// The largest |gridded − direct| over the image with each kernel, for a source of 1 Jy at the position x on the axis of l.
class LargestErrors {
 public:
  LargestErrors(const SmallField& field, const ComparedKernels& pair)
      : field_(field),
        direct_({field.geometry, false, 1}),
        least_misfit_(plane(field, pair.least_misfit)),
        spheroidal_(plane(field, pair.spheroidal)) {}

  std::pair<double, double> operator()(double x) const {
    const imager::Source source{{x * alias_fft_size * field_.geometry.cell_rad, 0}, 1};
    const std::vector<std::complex<double>> visibility = imager::predict_sources({source}, field_.block, 1, false);
    const std::vector<double> exact = image_by(direct_, visibility);
    return {largest(image_by(*least_misfit_, visibility), exact), largest(image_by(*spheroidal_, visibility), exact)};
  }

 private:
  static std::unique_ptr<imager::Transform> plane(const SmallField& field, const kernels::Kernel& kernel) {
    return imager::make_coplanar_transform(
        {field.geometry, alias_fft_size, alias_fft_size, kernel, kernel, kernels::Precision::double_precision, 1});
  }
  std::vector<double> image_by(const imager::Transform& transform, const std::vector<std::complex<double>>& visibility) const {
    const auto sum = transform.adjoint({});
    sum->add(field_.block, visibility);
    return sum->finish().images.front().pixel;
  }
  double largest(const std::vector<double>& gridded, const std::vector<double>& exact) const {
    double difference = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) difference = std::max(difference, std::abs(gridded[i] - exact[i]));
    return difference / static_cast<double>(field_.block.samples());  // Σ w
  }

  const SmallField& field_;
  imager::DirectTransform direct_;
  std::unique_ptr<imager::Transform> least_misfit_;
  std::unique_ptr<imager::Transform> spheroidal_;
};

/// The levels measured with the least-misfit and the spheroidal function.
std::vector<Series> measured_levels(const SmallField& field, const ComparedKernels& pair) {
  Series least{.label = "least-misfit", .x = {}, .y = {}, .points = true, .line = false};
  for (int p = static_cast<int>(paper_x0 * alias_fft_size) + step / 2; p <= farthest * alias_fft_size; p += step)
    least.x.push_back(static_cast<double>(p) / alias_fft_size);
  least.y.resize(least.x.size());
  Series spheroidal = least;
  spheroidal.label = "spheroidal";
  const LargestErrors errors(field, pair);
  imager::parallel_for(least.x.size(), imager::available_threads(),
                       [&](std::size_t i) { std::tie(least.y[i], spheroidal.y[i]) = errors(least.x[i]); });
  return {least, spheroidal};
}

Series expected_levels(const std::string& label, const kernels::Kernel& kernel) {
  constexpr int points = 1537;  // 512 a field: the measured positions are among them
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(points, paper_x0, farthest);
  Series series = curve(label, x, levels_of_aliases(kernel, x));
  series.law = true;
  return series;
}

Figure levels_figure(const ComparedKernels& pair) {
  const SmallField field = small_field();
  std::vector<Series> series = measured_levels(field, pair);
  series.push_back(expected_levels("alias, least-misfit", pair.least_misfit));
  series.push_back(expected_levels("alias, spheroidal", pair.spheroidal));
  return {
      .name = "paper-aliases",
      .title = "What a source outside the field leaves in the image, W = 7, x₀ = 0.25",
      .caption =
          "Marks: the largest difference between the gridded and the direct image of a source of 1 Jy at x, from 4000 "
          "visibilities at random places; the source's own sidelobes are in both. Broken: the alias h(x − n) c(x), where it "
          "falls into the image. Elsewhere it is cut off with the margins of the FFT, and its sidelobes are left.",
      .x = {.label = "position x of the source / size of the FFT", .from = 0, .to = farthest},
      .y = {.label = "largest error / Jy", .logarithmic = true, .from = 1e-9, .to = 1e-3},
      .series = std::move(series)};
}

/// The levels over the positions whose aliases fall into the image, both sides of it alike.
struct AliasLevels {
  double rms = 0;  ///< of the sum of all aliases at a pixel
  double max = 0;
};

AliasLevels alias_levels(const kernels::Kernel& kernel) {
  constexpr int places = 257;  // exact in binary, the edges included
  const Eigen::VectorXd folded = Eigen::VectorXd::LinSpaced(places, -paper_x0, paper_x0);
  AliasLevels levels;
  for (int n = 1; n <= fields; ++n) {
    const Eigen::VectorXd level = levels_of_aliases(kernel, (folded.array() + n).matrix());
    const double ends = (level[0] * level[0] + level[places - 1] * level[places - 1]) / 2;  // count half in a mean over x
    levels.rms += 2 * (level.squaredNorm() - ends) / (places - 1);
    levels.max = std::max(levels.max, level.maxCoeff());
  }
  levels.rms = std::sqrt(levels.rms);
  return levels;
}

}  // namespace

PaperExperiment aliasing_experiment(SolvedKernels& solved) {
  DataTable table{.name = "paper-alias-levels",
                  .title = "Alias levels by width, x₀ = 0.25",
                  .caption =
                      "RMS over the image of what sources of 1 Jy everywhere in the three next fields on either side would "
                      "leave, and the largest alias of one source.",
                  .columns = {"W", "least-misfit, RMS", "largest", "spheroidal, RMS", "largest", "ratio of RMS", "of largest"},
                  .rows = {}};
  std::map<int, double> ratio_by_width;
  constexpr double stated = 1e-7;
  int enough = 0, spheroidal_enough = 0;  // widths whose aliases lie below
  for (int width = 4; width <= 14; ++width) {
    const ComparedKernels pair = compared_kernels(solved, width, paper_x0);
    const AliasLevels least = alias_levels(pair.least_misfit);
    const AliasLevels spheroidal = alias_levels(pair.spheroidal);
    const double ratio = spheroidal.rms / least.rms;
    table.rows.push_back(
        {static_cast<double>(width), least.rms, least.max, spheroidal.rms, spheroidal.max, ratio, spheroidal.max / least.max});
    ratio_by_width[width] = ratio;
    if (enough == 0 && least.max <= stated) enough = width;
    if (spheroidal_enough == 0 && spheroidal.max <= stated) spheroidal_enough = width;
  }
  PaperExperiment result;
  result.section = {.heading = "The paper's experiments: aliases",
                    .paragraphs = {"Gridding repeats the sky at every whole x, tapered: a source at x comes back at x − n, "
                                   "times the taper c(x) and the correction h(x − n)."},
                    .figures = {levels_figure(compared_kernels(solved, shown_width, paper_x0))},
                    .tables = {table}};
  result.statements = {
      {"§4.2", "Width whose aliases are below 10⁻⁷ of a source outside", "W = 7, spheroidal W = 10",
       "W = " + std::to_string(enough) + ", spheroidal W = " + std::to_string(spheroidal_enough) +
           ", at every place of the image",
       verdict(enough == 7 && spheroidal_enough == 10, "aliases that fall on the image's edge need more")},
      hundredfold("§4.2", "Suppression of aliases: spheroidal over least-misfit, same W, x₀ = 0.25", ratio_by_width)};
  return result;
}

}  // namespace misfit::tools
