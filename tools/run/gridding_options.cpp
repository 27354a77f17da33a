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
                  "auto corrects for w if it matters; standard never does, wide always does; mosaic joins pointings to one "
                  "image by their beams. auto also makes a mosaic of fields that point apart if there is a --phasecenter")
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
  command.add_option(
      "--accuracy", o.accuracy,
      "Largest error that the image may have: RMS of its difference from the direct transform, over the RMS of the image");
  command.add_option(
      "--psf-accuracy", o.psf_accuracy,
      "Largest error that the PSF may have, defined as for --accuracy; 0 means the larger of --accuracy and 1e-4");
  command.add_option("--kernel-width", o.kernel_width,
                     "Grid cells that a visibility touches per axis; 0 means that they are chosen");
  command.add_option("--padding", o.padding, "FFT size over image size; 0 means that it is chosen");
  command
      .add_option("--evaluation", o.evaluation,
                  "Compute kernel values by a polynomial as short as the kernel's error allows (polynomial) or by the full "
                  "polynomial (full); or look them up in a table (nearest, linear, quadratic, cubic; with --sampling)")
      ->check(CLI::IsMember({"polynomial", "full", "nearest", "linear", "quadratic", "cubic"}));
  command.add_option("--sampling", o.sampling,
                     "Entries per cell of the table that --evaluation nearest, linear, quadratic or cubic looks up");
  command.add_option("--precision", o.precision, "Precision of kernel values, grid and FFT")
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
