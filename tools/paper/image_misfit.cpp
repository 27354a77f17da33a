#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "imager/coplanar/coplanar_transform.h"
#include "imager/numerics/parallel.h"
#include "kernels/map_error.h"
#include "tools/base/numbers.h"
#include "tools/paper/paper_experiments.h"

namespace misfit::tools {
namespace {

constexpr std::array<int, 7> widths{2, 4, 6, 7, 8, 10, 12};

/// A kernel's misfit, measured and expected.
struct Compared {
  int width = 0;
  MisfitProfile measured;
  MisfitProfile expected;

  double largest_deviation() const {
    double largest = 0;
    for (std::size_t k = 0; k < measured.rms.size(); ++k)
      largest = std::max(largest, std::abs(measured.rms[k] / expected.rms[k] - 1));
    return largest;
  }
};

/// The image by gridding and FFT with one kernel on both axes, not divided by Σ w.
imager::Image gridded_image(const CardScene& scene, const kernels::Kernel& kernel) {
  const int size = fft_size_for(scene, paper_x0);
  const auto transform = imager::make_coplanar_transform(
      {scene.geometry, size, size, kernel, kernel, kernels::Precision::double_precision, imager::available_threads()});
  const auto sum = transform->adjoint({});
  sum->add(scene.block, scene.visibility);
  return sum->finish().images.front();
}

Compared compare(const CardScene& scene, const kernels::Kernel& kernel) {
  const int size = fft_size_for(scene, paper_x0);
  const imager::Image image = gridded_image(scene, kernel);
  const Eigen::VectorXd map_error = kernels::map_error(kernel.polynomial, pixel_offsets(scene.geometry.width, size));
  const AxisErrors errors{map_error, map_error};  // 1 − hc = ℓ with the optimal h
  return {kernel.width(), measured_misfit(image, scene, size), expected_misfit(errors, scene, size)};
}

Figure misfit_figure(const std::string& name, const std::string& title, const std::vector<Compared>& all) {
  Figure figure{
      .name = name,
      .title = title,
      .caption =
          "RMS of gridded − direct image in strips of pixels at |x| and |y|, relative to the RMS that the image would "
          "have with random phases. Broken: √(ℓ(x) + E), since the two axes add their map errors.",
      .x = {.label = "x, offset from the phase centre / size of the FFT", .from = 0, .to = paper_x0},
      .y = {.label = "RMS misfit", .logarithmic = true, .from = 1e-14, .to = 1},
      .series = {}};
  Series law{.label = "theory", .x = {}, .y = {}, .law = true};
  for (const Compared& one : all) {
    figure.series.push_back(
        {.label = width_label(one.width), .x = one.measured.x, .y = one.measured.rms, .points = true, .line = false});
    law.x.insert(law.x.end(), one.expected.x.begin(), one.expected.x.end());
    law.y.insert(law.y.end(), one.expected.rms.begin(), one.expected.rms.end());
    law.x.push_back(law.x.back());
    law.y.push_back(std::numeric_limits<double>::quiet_NaN());
  }
  figure.series.push_back(law);
  return figure;
}

DataTable whole_images(const std::vector<Compared>& least, const std::vector<Compared>& spheroidal) {
  DataTable table{.name = "paper-misfit-rms",
                  .title = "RMS misfit of the whole image",
                  .caption = "Theory is √(2E). The ratio is what least-misfit functions gain, as measured.",
                  .columns = {"W", "least-misfit", "theory", "spheroidal", "theory", "spheroidal / least-misfit"},
                  .rows = {}};
  for (std::size_t k = 0; k < least.size(); ++k)
    table.rows.push_back({static_cast<double>(least[k].width), least[k].measured.whole, least[k].expected.whole,
                          spheroidal[k].measured.whole, spheroidal[k].expected.whole,
                          spheroidal[k].measured.whole / least[k].measured.whole});
  return table;
}

double largest_deviation(const std::vector<Compared>& all) {
  double largest = 0;
  for (const Compared& one : all) largest = std::max(largest, one.largest_deviation());
  return largest;
}

Statement reduction(const std::vector<Compared>& least, const std::vector<Compared>& spheroidal) {
  std::map<int, double> ratio_by_width;
  for (std::size_t k = 0; k < least.size(); ++k)
    ratio_by_width[least[k].width] = spheroidal[k].measured.whole / least[k].measured.whole;
  return hundredfold("§4.1", "RMS misfit of the image: spheroidal over least-misfit, same W, x₀ = 0.25", ratio_by_width);
}

/// RMS of the direct image over the RMS for random phases.
double coherence(const CardScene& scene) {
  const std::vector<double>& pixel = scene.direct.pixel;
  const double square = std::inner_product(pixel.begin(), pixel.end(), pixel.begin(), 0.0);
  return std::sqrt(square / static_cast<double>(pixel.size())) / scene.random_rms;
}

}  // namespace

PaperExperiment image_misfit_experiment(const CardScene& scene, SolvedKernels& solved) {
  std::vector<Compared> least;
  std::vector<Compared> spheroidal;
  for (const int width : widths) {
    const ComparedKernels pair = compared_kernels(solved, width, paper_x0);
    least.push_back(compare(scene, pair.least_misfit));
    spheroidal.push_back(compare(scene, pair.spheroidal));
  }
  const double deviation = std::max(largest_deviation(least), largest_deviation(spheroidal));
  constexpr double sampling_error = 0.2;
  const std::string pixels = std::to_string(scene.geometry.width);
  PaperExperiment result;
  result.section = {
      .heading = "The paper's experiments: image misfit",
      .paragraphs =
          {"The 34 sources of the paper's test card, as `misfit simulate` has them, seen by the VLA in configuration A "
           "at 4 GHz in snapshots over six hours: " +
               grouped(static_cast<long long>(scene.block.samples())) + " visibilities without w and noise, " + pixels +
               "² pixels of 0.05″ out of an FFT of " + std::to_string(fft_size_for(scene, paper_x0)) +
               "², x₀ = 0.25, in doubles.",
           "Each visibility errs by its own position in a cell, so that errors add up at random, whatever the phases "
           "are. They are shown relative to what the RMS of the image would be with random phases; it is " +
               significant(coherence(scene), 3) + " times that."},
      .figures = {misfit_figure("paper-misfit-least", "Image misfit of least-misfit functions", least),
                  misfit_figure("paper-misfit-spheroidal", "Image misfit of spheroidal functions", spheroidal)},
      .tables = {whole_images(least, spheroidal)}};
  result.statements = {
      {"§2", "The misfit of an image follows from ℓ(x)", "√ℓ(x), its equations",
       "measured within " + significant(100 * deviation, 2) + " % of √(ℓ(x) + E) in every strip and for every W and function",
       verdict(deviation < sampling_error, "by more than a random sample of positions explains")},
      reduction(least, spheroidal)};
  return result;
}

}  // namespace misfit::tools
