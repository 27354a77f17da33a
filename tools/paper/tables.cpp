#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "imager/numerics/constants.h"
#include "imager/numerics/parallel.h"
#include "kernels/evaluation.h"
#include "tools/base/numbers.h"
#include "tools/paper/paper_experiments.h"
#include "tools/paper/plain_gridder.h"

namespace misfit::tools {
namespace {

using kernels::Interpolation;
using kernels::TableOptions;

constexpr int tables_width = 7;

constexpr std::array<const char*, 4> degree_names{"nearest", "linear", "quadratic", "cubic"};
constexpr std::array<int, 10> sizes{10, 30, 100, 300, 1000, 3000, 10000, 100000, 1000000, 10000000};

/// Measured and expected misfit of one table.
struct ComparedTables {
  TableOptions table;
  MisfitProfile measured;
  MisfitProfile expected;
};

/// Images with tables of one kernel, always with the correction of the function itself.
class TableImages {
 public:
  TableImages(const CardScene& scene, const kernels::Kernel& kernel)
      : scene_(scene),
        kernel_(kernel),
        size_(fft_size_for(scene, paper_x0)),
        x_(pixel_offsets(scene.geometry.width, size_)),
        correction_(kernels::optimal_correction(kernel.polynomial, x_)),
        map_error_(kernels::map_error(kernel.polynomial, x_)) {}

  ComparedTables operator()(const TableOptions& options) const {
    const kernels::Evaluation table =
        kernels::evaluate_by_table(kernel_.polynomial, options, kernels::Precision::double_precision);
    const imager::Image image = plain_image({scene_.geometry, size_, table.taps, correction_}, scene_.block, scene_.visibility);
    return {options, measured_misfit(image, scene_, size_), expected(options)};
  }

 private:
  /// The misfit expected of interpolation. The mean square of δ = binomial(p, d+1) (2πx/Ms)^(d+1) adds to ℓ
  /// (kernels::table_misfit is its mean over |x| ≤ x0). The mean of δ is not 0 for odd d, where the curve between two entries
  /// always bends to one side.
  MisfitProfile expected(const TableOptions& options) const {
    constexpr std::array<double, 4> mean_binomial{0, 1.0 / 12, 0, 19.0 / 720};
    const int degree = static_cast<int>(options.interpolation);
    const Eigen::VectorXd power =
        (x_.array() * (2 * imager::pi / options.samples_per_cell)).pow(static_cast<double>(degree + 1));
    const double factor = kernels::interpolation_error_factor(options.interpolation);
    return expected_misfit(
        {map_error_ + factor * factor * power.cwiseAbs2(), mean_binomial[static_cast<std::size_t>(degree)] * power}, scene_,
        size_);
  }

  const CardScene& scene_;
  const kernels::Kernel& kernel_;
  int size_;
  Eigen::VectorXd x_;
  Eigen::VectorXd correction_;
  Eigen::VectorXd map_error_;
};

/// [degree][size]; sizes end where finer tables are as good as the function.
using AllTables = std::array<std::vector<ComparedTables>, 4>;

AllTables all_tables(const CardScene& scene, const kernels::Kernel& kernel) {
  const TableImages images(scene, kernel);
  struct Job {
    std::size_t degree;
    TableOptions options;
    ComparedTables result;
  };
  std::vector<Job> jobs;
  for (std::size_t degree = 0; degree < degree_names.size(); ++degree) {
    for (const int samples : sizes) {
      const TableOptions options{samples, static_cast<Interpolation>(degree)};
      jobs.push_back({degree, options, {}});
      if (kernels::table_misfit(options, paper_x0) < 0.01 * kernel.misfit.mean) break;
    }
  }
  imager::parallel_for(jobs.size(), imager::available_threads(),
                       [&](std::size_t i) { jobs[i].result = images(jobs[i].options); });
  AllTables all;
  for (const Job& job : jobs) all[job.degree].push_back(job.result);
  return all;
}

Figure by_x_figure(const std::string& name, const std::string& title, const std::vector<std::string>& labels,
                   const std::vector<const ComparedTables*>& shown) {
  Figure figure{.name = name,
                .title = title,
                .caption =
                    "As measured in the image of the test card. Broken: theory, for which interpolation of degree d adds "
                    "κ² (2πx/Ms)²ᵈ⁺² to ℓ(x). Linear and cubic interpolation err to one side, so that a part of their error "
                    "is the image itself, scaled.",
                .x = {.label = "x, offset from the phase centre / size of the FFT", .from = 0, .to = paper_x0},
                .y = {.label = "RMS misfit", .logarithmic = true},
                .series = {}};
  Series law{.label = "theory", .x = {}, .y = {}, .law = true};
  for (std::size_t k = 0; k < shown.size(); ++k) {
    const auto& [table, measured, expected] = *shown[k];
    figure.series.push_back({.label = labels[k], .x = measured.x, .y = measured.rms, .points = true, .line = false});
    law.x.insert(law.x.end(), expected.x.begin(), expected.x.end());
    law.y.insert(law.y.end(), expected.rms.begin(), expected.rms.end());
    law.x.push_back(law.x.back());
    law.y.push_back(std::numeric_limits<double>::quiet_NaN());
  }
  figure.series.push_back(law);
  return figure;
}

const ComparedTables* find(const std::vector<ComparedTables>& tables, int samples) {
  const auto found = std::find_if(tables.begin(), tables.end(),
                                  [=](const ComparedTables& one) { return one.table.samples_per_cell == samples; });
  return found == tables.end() ? nullptr : &*found;
}

Figure nearest_figure(const AllTables& all) {
  std::vector<std::string> labels;
  std::vector<const ComparedTables*> shown;
  for (const int samples : {100, 1000, 10000, 100000, 1000000, 10000000}) {
    labels.push_back("Ms = " + power_of_ten(samples, 2));
    shown.push_back(find(all[0], samples));
  }
  return by_x_figure("paper-tables-nearest", "Image misfit with the nearest entry, W = 7", labels, shown);
}

Figure degrees_figure(const AllTables& all) {
  std::vector<std::string> labels;
  std::vector<const ComparedTables*> shown;
  for (std::size_t degree = 0; degree < all.size(); ++degree) {
    labels.emplace_back(degree_names[degree]);
    shown.push_back(find(all[degree], 30));
  }
  return by_x_figure("paper-tables-degrees", "Image misfit by degree of interpolation, W = 7, Ms = 30", labels, shown);
}

DataTable by_size_table(const AllTables& all) {
  DataTable table{
      .name = "paper-tables",
      .title = "Image misfit by size of the table, W = 7, x₀ = 0.25",
      .caption =
          "RMS over the whole image, relative to the RMS that it would have with random phases. Empty where a smaller "
          "table is already as good as the function. Theory is √(2(E + e²)), where e² is what the table adds, "
          "whatever the function; linear and cubic tables also scale the image, which is not random.",
      .columns = {"Ms", "nearest", "theory", "linear", "theory", "quadratic", "theory", "cubic", "theory"},
      .rows = {}};
  for (const int samples : sizes) {
    table.rows.push_back({static_cast<double>(samples)});
    for (const std::vector<ComparedTables>& tables : all) {
      const ComparedTables* one = find(tables, samples);
      table.rows.back().emplace_back(one == nullptr ? std::nan("") : one->measured.whole);
      table.rows.back().emplace_back(one == nullptr ? std::nan("") : one->expected.whole);
    }
  }
  return table;
}

/// The largest deviation of the whole image's misfit from the law where Ms is large enough for it.
double largest_deviation(const AllTables& all) {
  double largest = 0;
  for (const std::vector<ComparedTables>& tables : all)
    for (const ComparedTables& one : tables)
      if (one.table.samples_per_cell >= 30) largest = std::max(largest, std::abs(one.measured.whole / one.expected.whole - 1));
  return largest;
}

}  // namespace

PaperExperiment table_experiment(const CardScene& scene, SolvedKernels& solved) {
  const kernels::Kernel kernel = store("least-misfit", solved(tables_width, paper_x0));
  const AllTables all = all_tables(scene, kernel);
  constexpr double sampling_error = 0.2;
  const double deviation = largest_deviation(all);
  PaperExperiment result;
  result.section = {
      .heading = "The paper's experiments: lookup tables",
      .paragraphs = {"The same image with the least-misfit function of W = 7 looked up in tables of Ms entries a cell: the "
                     "nearest entry, as in the paper, or polynomials through two to four entries."},
      .figures = {nearest_figure(all), degrees_figure(all)},
      .tables = {by_size_table(all)}};
  result.statements = {
      {"App. F", "What a table adds to the error", "grows as x^(d+1) and falls as Ms^−(d+1) with the degree d of interpolation",
       "measured within " + significant(100 * deviation, 2) + " % of κ (2πx/Ms)^(d+1) for Ms from 30 to 10⁷ and every degree",
       verdict(deviation < sampling_error, "it does not follow this law")}};
  return result;
}

}  // namespace misfit::tools
