#include "tools/run/gridding_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "imager/plan/gridding_plan.h"
#include "kernels/kernel_table.h"
#include "tools/base/option_checks.h"

namespace misfit::tools {
namespace {

void check_tables(const TypedGridding& o) {
  const std::optional<kernels::TableOptions> lookup = lookup_of(o);
  constexpr int most = kernels::kernel_table_max_per_cell;
  if (lookup && !(o.sampling >= 1 && o.sampling <= most))
    refuse_option("sampling", std::to_string(o.sampling),
                  "1 to " + std::to_string(most) + " entries a cell beside --evaluation " + o.evaluation);
  if (!lookup && o.sampling != 0)
    refuse_option("sampling", std::to_string(o.sampling), "--evaluation nearest, linear, quadratic or cubic beside it");
}

}  // namespace

void declare_gridder(CLI::App& command, TypedGridding& o) {
  command
      .add_option("--gridder", o.gridder,
                  "w planes: auto (where w matters), standard (none), wide (always); or mosaic: pointings become one image, "
                  "each with its "
                  "beam, which auto makes of fields that point apart with one --phasecenter")
      ->transform(also_named({{"gridft", "standard"},
                              {"widefield", "wide"},
                              {"wproject", "wide"},
                              {"mosaicft", "mosaic"},
                              {"ftmosaic", "mosaic"}}))
      ->check(CLI::IsMember({"auto", "standard", "wide", "mosaic"}));
}

void declare(CLI::App& command, TypedGridding& o) {
  list_kernels(*command.add_option("--kernel", o.kernel.name,
                                   "Gridding function: a name such as least-misfit or spheroidal, or a kernel-table file"));
  declare_kernel_folder(command, o.kernel.folder);
  command.add_option("--accuracy", o.accuracy,
                     "Largest error of the whole image relative to the direct transform, RMS over RMS");
  command.add_option("--psf-accuracy", o.psf_accuracy, "The same of the PSF; 0 = the larger of --accuracy and 1e-4");
  command.add_option("--kernel-width", o.kernel_width, "Cells a visibility touches per axis; chosen when 0");
  command.add_option("--padding", o.padding, "FFT size over image size; chosen when 0");
  command
      .add_option("--evaluation", o.evaluation,
                  "Kernel values from: polynomial, as short as the kernel's error allows; full polynomial; or a table, read "
                  "by interpolation (with --sampling)")
      ->check(CLI::IsMember({"polynomial", "full", "nearest", "linear", "quadratic", "cubic"}));
  command.add_option("--sampling", o.sampling, "Entries a cell of a table of kernel values");
  command.add_option("--precision", o.precision, "Of kernel values, grid and FFT: auto, single, double")
      ->check(CLI::IsMember({"auto", "single", "double"}));
}

void check(const TypedGridding& o) {
  check_tables(o);
  const bool accuracy_is_free = kernel_is_given(o);
  if (!(o.accuracy > 0 && o.accuracy < 1) && !(o.accuracy == 0 && accuracy_is_free))
    refuse_option("accuracy", typed(o.accuracy), "a number above 0 and below 1");
  if (!(o.psf_accuracy >= 0 && o.psf_accuracy < 1))
    refuse_option("psf-accuracy", typed(o.psf_accuracy), "a number above 0 and below 1, or 0 (chosen)");
  if (o.psf_accuracy != 0 && o.accuracy == 0)
    refuse_option("psf-accuracy", typed(o.psf_accuracy), "--accuracy beside it, since the kernel given decides otherwise");
  imager::check_request(gridding_request(o, 1));
}

bool kernel_is_given(const TypedGridding& o) {
  return is_kernel_file(o.kernel) || (o.kernel_width != 0 && o.padding != 0);
}

std::optional<kernels::TableOptions> lookup_of(const TypedGridding& o) {
  const auto& names = kernels::interpolation_names;
  const auto found = std::find(names.begin(), names.end(), o.evaluation);
  if (found == names.end()) return {};
  return kernels::TableOptions{o.sampling, static_cast<kernels::Interpolation>(found - names.begin())};
}

imager::GriddingRequest gridding_request(const TypedGridding& o, int threads) {
  imager::GriddingRequest request;
  request.accuracy = o.accuracy;
  constexpr double enough = 1e-4;  // to steer minor cycles
  request.psf_accuracy = o.psf_accuracy != 0 ? o.psf_accuracy : std::max(o.accuracy, enough);
  request.kernel = choose_kernel(o.kernel);
  request.kernel_width = o.kernel_width;
  request.padding = o.padding;
  request.gridder = o.gridder == "standard" ? imager::Gridder::standard
                    : o.gridder == "wide"   ? imager::Gridder::wide
                                            : imager::Gridder::automatic;
  request.lookup = lookup_of(o);
  request.shortest_polynomials = o.evaluation != "full";
  if (o.precision != "auto")
    request.precision = o.precision == "single" ? imager::Precision::single_precision : imager::Precision::double_precision;
  request.threads = threads;
  return request;
}

}  // namespace misfit::tools
