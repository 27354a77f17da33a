#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "kernels/kernel_table.h"
#include "kernels/lookup_table.h"
#include "kernels/map_error.h"
#include "tools/base/files.h"
#include "tools/base/json_text.h"
#include "tools/base/numbers.h"
#include "tools/base/option_checks.h"
#include "tools/command.h"
#include "tools/emit/emission_plan.h"
#include "tools/kernel_choice/cache_folder.h"
#include "tools/kernel_choice/kernel_advice.h"
#include "tools/kernel_choice/kernel_choice.h"
#include "tools/kernel_choice/machine_costs.h"

namespace misfit::tools {
namespace {

struct KernelOptions {
  KernelSource kernel;
  int width = 0;
  double x0 = 0;
  double padding = 0;
  kernels::TableSampling sampling;
  int degree = -1;
  std::string output;
  std::string inspect;
  bool json = false;
  bool quiet = false;
  EmitOptions emit;
  KernelJob job;  ///< for which width and padding are chosen when it has an accuracy
};

void refuse(bool wrong, const std::string& option, const std::string& value, const std::string& expected) {
  if (wrong) throw std::invalid_argument("--" + option + " " + value + ": expected " + expected);
}

void refuse_outside(int value, int least, int most, const std::string& option) {
  refuse(value < least || value > most, option, std::to_string(value), std::to_string(least) + " to " + std::to_string(most));
}

/// Checks the values that are given, for every way to make a kernel; missing ones are looked for afterwards.
void check_values(const KernelOptions& o) {
  refuse(o.padding != 0 && !(o.padding > 1 && o.padding <= 500), "padding", significant(o.padding, 6),
         "more than 1, at most 500");
  refuse_outside(o.sampling.per_cell, 1, kernels::kernel_table_max_per_cell, "sampling");
  refuse_outside(o.sampling.interpolation, 0, 3, "interpolation");
  if (o.degree != -1) refuse_outside(o.degree, 0, kernels::highest_degree, "degree");
  for (const int size : o.job.imsize) refuse_outside(size, 1, 65536, "imsize");
  refuse(o.job.accuracy != 0 && !(o.job.accuracy > 0 && o.job.accuracy < 1), "accuracy", significant(o.job.accuracy, 6),
         "a number above 0 and below 1");
  refuse(o.emit.target_error != 0 && !(o.emit.target_error > 0 && o.emit.target_error < 1), "target-error",
         significant(o.emit.target_error, 6), "a number above 0 and below 1");
  refuse(o.emit.host_padding != 0 && !(o.emit.host_padding > 1 && o.emit.host_padding <= 500), "host-padding",
         significant(o.emit.host_padding, 6), "more than 1, at most 500");
  const kernels::KernelFamily family = choose_kernel(o.kernel);
  if (o.width != 0) family.require_width(o.width);
  if (o.x0 != 0) family.require_x0(o.x0);
}

void refuse_two_paddings(const KernelOptions& o) {
  refuse(o.x0 != 0 && o.padding != 0, "x0", significant(o.x0, 6) + " beside --padding " + significant(o.padding, 6),
         "either --x0 or --padding");
}

void check_given(const KernelOptions& o) {
  if (o.width == 0)
    throw std::invalid_argument("no width is given: expected --width, the number of cells a visibility touches per axis");
  if (o.x0 == 0 && o.padding == 0) throw std::invalid_argument("no padding is given: expected either --x0 or --padding");
  refuse_two_paddings(o);
}

/// The part of E that looking the table up adds.
double table_error(const kernels::KernelTable& table) {
  const auto degree = static_cast<kernels::Interpolation>(table.sampling->interpolation);
  return kernels::table_misfit({table.sampling->per_cell, degree}, table.kernel.x0);
}

/// Prints `item` in twelve columns; blanks at its end make up for letters of several bytes.
void print_line(const char* item, const std::string& value) {
  std::printf("  %-12s %s\n", item, value.c_str());
}

void print(const kernels::KernelTable& table, const std::string& path) {
  const kernels::Kernel& k = table.kernel;
  std::printf("%s: %s, width %d, x0 %s, for a padding of %s or more\n", path.c_str(), k.name.c_str(), k.width(),
              significant(k.x0, 6).c_str(), significant(0.5 / k.x0, 6).c_str());
  print_line("E",
             significant(k.misfit.mean, 6) + ", an RMS error of " + significant(std::sqrt(k.misfit.mean), 4) + " per axis");
  print_line("largest ℓ   ", significant(k.misfit.max, 6));
  print_line("worst place", "mean " + significant(k.misfit.worst_mean, 6) + ", largest " + significant(k.misfit.worst, 6));
  print_line("as solved", "E " + significant(k.origin.mean_error, 6) + ", largest ℓ " + significant(k.origin.max_error, 6));
  if (std::isfinite(k.origin.max_error_bound))
    print_line("bound", "no function's largest ℓ is below " + significant(k.origin.max_error_bound, 6));
  if (std::isfinite(k.origin.condition)) print_line("condition", significant(k.origin.condition, 4));
  print_line("arithmetic", k.origin.precision + ", " + std::to_string(k.origin.iterations) + " iterations");
  print_line("polynomials", std::to_string(k.width()) + " of degree " + std::to_string(k.polynomial.degree()));
  if (table.sampling)
    print_line("lookup table", std::to_string(table.sampling->per_cell) + " rows a cell, to be interpolated to degree " +
                                   std::to_string(table.sampling->interpolation) + "; reading it adds " +
                                   significant(table_error(table), 2) + " to E");
  if (!table.version.empty()) print_line("written by", "misfit " + table.version);
}

/// True if the polynomials differ from the function by more than rounding, and by more than a part of the error.
bool is_rough(const kernels::Kernel& kernel) {
  constexpr double rounding = 1e-12, part_of_error = 5e-3;
  const double part = kernels::part_in_last_terms(kernel.polynomial);
  const double error = part * kernels::noise_gain(kernel.polynomial, kernel.x0);
  return part > rounding && error > part_of_error * std::sqrt(kernel.misfit.mean);
}

/// Prints how far the polynomials miss the function, and why.
void print_shortfall(const kernels::Kernel& kernel, bool is_cut) {
  const double excess = kernel.misfit.mean / kernel.origin.mean_error;
  if (!is_cut && is_rough(kernel)) {
    std::printf(
        "  The function bends or jumps inside a cell: the polynomials miss %s of it or more, and the errors above are theirs.\n"
        "  Expected a function that does so only where cells meet, which here is at %s\n",
        significant(kernels::part_in_last_terms(kernel.polynomial), 2).c_str(),
        kernel.width() % 2 == 0 ? "u = 0, 1, 2 …" : "u = 0.5, 1.5, 2.5 …");
  } else if (excess > 1.01) {
    std::printf(
        "  E is %s times that of the function as solved: %s\n", significant(excess, 3).c_str(),
        is_cut ? "polynomials of this degree hold no more" : "doubles hold no more, since each rounds by 1.1e-16 of itself");
  }
}

/// A number as JSON, which has none for unknown values.
nlohmann::json number(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

nlohmann::json json_of(const kernels::KernelTable& table) {
  const kernels::Kernel& k = table.kernel;
  nlohmann::json json = {{"kernel", k.name},
                         {"width", k.width()},
                         {"x0", k.x0},
                         {"padding", 0.5 / k.x0},
                         {"sampling", nullptr},
                         {"interpolation", nullptr},
                         {"degree", k.polynomial.degree()},
                         {"E", k.misfit.mean},
                         {"max_ell", k.misfit.max},
                         {"worst_mean", k.misfit.worst_mean},
                         {"worst", k.misfit.worst},
                         {"E_optimum", k.origin.mean_error},
                         {"max_ell_optimum", k.origin.max_error},
                         {"max_ell_bound", number(k.origin.max_error_bound)},
                         {"condition", number(k.origin.condition)},
                         {"iterations", k.origin.iterations},
                         {"precision", k.origin.precision},
                         {"version", table.version},
                         {"checksum_ok", table.checksum_ok}};
  if (table.sampling) {
    json["sampling"] = table.sampling->per_cell;
    json["interpolation"] = table.sampling->interpolation;
  }
  return json;
}

void inspect(const KernelOptions& o) {
  const kernels::KernelTable table = kernels::read_kernel_table(o.inspect);
  if (o.json)
    std::printf("%s\n", json_text(json_of(table), 2).c_str());
  else
    print(table, o.inspect);
  if (!table.checksum_ok)
    throw std::runtime_error(o.inspect +
                             " does not match its checksum: it was changed or cut short after it was written; "
                             "expected the file as misfit kernel wrote it");
}

void make(const KernelOptions& o) {
  check_given(o);
  const kernels::KernelFamily family = choose_kernel(o.kernel);
  check_writable_folder(o.output);
  const kernels::Kernel made = family.make(o.width, o.x0 != 0 ? o.x0 : 0.5 / o.padding);
  const kernels::Kernel kernel = o.degree == -1 ? made : kernels::truncated(made, o.degree);
  kernels::write_kernel_table(kernel, o.sampling, o.output);
  if (o.quiet) return;
  print({kernel, o.sampling, "", kernels::solver_version, true}, o.output);
  print_shortfall(kernel, kernel.polynomial.degree() < made.polynomial.degree());
}

nlohmann::json json_of(const RealisedError& error) {
  return {{"rms", error.rms}, {"largest", error.largest}};
}

nlohmann::json json_of(const Emission& e) {
  const HostKernel& k = e.table;
  nlohmann::json json = {{"host", e.host->name},
                         {"kernel", k.kernel.name},
                         {"width", k.kernel.width()},
                         {"x0", k.kernel.x0},
                         {"padding", k.padding},
                         {"sampling", nullptr},
                         {"interpolation", nullptr},
                         {"degree", k.kernel.polynomial.degree()},
                         {"error", json_of(e.realised)},
                         {"rounding", e.rounding},
                         {"error_of_function", json_of(e.function)},
                         {"error_with_own_correction", nullptr},
                         {"error_of_host_without_this", nullptr}};
  if (k.per_cell > 0) {
    json["sampling"] = k.per_cell;
    json["interpolation"] = k.interpolation;
  }
  if (e.own) json["error_with_own_correction"] = json_of(*e.own);
  if (e.stock) json["error_of_host_without_this"] = json_of(*e.stock);
  return json;
}

void check_emission(const KernelOptions& o) {
  const bool targeted = o.emit.target_error != 0;
  if (o.output.empty()) throw std::invalid_argument("--emit " + o.emit.host + ": expected --output, the file to write");
  if (targeted && (o.width != 0 || o.degree != -1 || o.emit.per_cell != 0))
    throw std::invalid_argument(
        "--target-error chooses width, sampling and degree; expected it without --width, --sampling and --degree");
  if (targeted && o.emit.force)
    throw std::invalid_argument("--force: expected it without --target-error, which makes a kernel for the host's padding");
  if (!o.job.imsize.empty() && !find_host(o.emit.host).depends_on_pixels)
    throw std::invalid_argument("--imsize: the kernel of --emit " + o.emit.host +
                                " does not depend on the image; expected --imsize beside --emit wsclean or --accuracy");
}

/// Writes the kernel as a host wants it.
void emit(KernelOptions& o) {
  check_emission(o);
  refuse_two_paddings(o);
  const kernels::KernelFamily family = choose_kernel(o.kernel);
  o.emit.width = o.width;
  o.emit.degree = o.degree;
  o.emit.x0 = o.padding != 0 ? 0.5 / o.padding : o.x0;
  if (o.emit.x0 == 0 && is_kernel_file(o.kernel)) o.emit.x0 = family.max_x0;
  if (!o.job.imsize.empty()) o.emit.image_size = *std::min_element(o.job.imsize.begin(), o.job.imsize.end());
  check_writable_folder(o.output);
  std::error_code none;
  if (is_kernel_file(o.kernel) && std::filesystem::equivalent(file_of(o.kernel), o.output, none))
    throw std::invalid_argument("--output " + o.output + " is the kernel that is to be emitted; expected another file");
  const Emission emission = plan_emission(o.emit, family);
  emission.host->write(emission, o.output);
  if (o.json) std::printf("%s\n", json_text(json_of(emission), 2).c_str());
  if (o.json || o.quiet) return;
  const char* before = "";
  std::printf("%s: ", o.output.c_str());
  for (const std::string& line : statement(emission)) {
    std::printf("%s%s\n", before, line.c_str());
    before = "  ";
  }
}

/// Fills in width, x0 and degree.
void choose(KernelOptions& o) {
  if (o.width != 0 || o.x0 != 0 || o.padding != 0 || o.degree != -1)
    throw std::invalid_argument(
        "--accuracy chooses width, padding and degree; expected it without --width, --x0, --padding and --degree");
  o.job.kernel = o.kernel;
  const imager::GriddingChoice choice = choose_for(o.job);
  if (!o.quiet) std::printf("%s", text_of(choice, machine_costs(default_cache_folder())).c_str());
  o.width = choice.best.work.width;
  o.x0 = std::max(choice.best.u.kernel.x0, choice.best.v.kernel.x0);  // one function serves both axes
  o.degree = std::max(choice.best.u.kernel.polynomial.degree(), choice.best.v.kernel.polynomial.degree());
}

}  // namespace

void add_kernel_command(CLI::App& program) {
  CLI::App* command = program.add_subcommand("kernel", "Make a kernel-table file, or show what is in one");
  const auto o = std::make_shared<KernelOptions>();
  list_kernels(*command->add_option("--kernel", o->kernel.name,
                                    "Gridding function: a name, or a kernel-table file, which is tabulated anew"));
  declare_kernel_folder(*command, o->kernel.folder);
  command->add_option("--width", o->width, "Grid cells that a visibility touches per axis")
      ->check(not_zero("the number of cells a visibility touches per axis"));
  command->add_option("--x0", o->x0, "Half the part of the FFT image that is kept, 1 / (2 padding); or give --padding")
      ->check(not_zero("more than 0, below 0.5"));
  command->add_option("--padding", o->padding, "FFT size over image size, 1 / (2 x0)")
      ->check(not_zero("more than 1, at most 500"));
  CLI::Option* accuracy =
      command->add_option("--accuracy", o->job.accuracy, "Choose the width and padding that reach this error at the least cost")
          ->check(not_zero("a number above 0 and below 1"));
  command
      ->add_option("--imsize", o->job.imsize, "Width, or width and height, of the image in pixels; with --accuracy or --emit")
      ->expected(1, 2);
  command->add_option("--samples", o->job.samples, "Number of visibilities, with which --accuracy weighs the cost of gridding")
      ->needs(accuracy);
  command
      ->add_option("--w-turns", o->job.w_turns, "Range of w in wavelengths times the image's range of n - 1; 0 means no w axis")
      ->needs(accuracy);
  command->add_option("--sampling", o->sampling.per_cell, "Rows of the lookup table per cell");
  command->add_option("--interpolation", o->sampling.interpolation,
                      "Degree of the interpolation with which a host will read the table, 0 to 3");
  command->add_option("--degree", o->degree, "Cut the polynomials to this degree; -1 keeps all the kernel's terms");
  CLI::Option* host =
      command->add_option("--emit", o->emit.host, "Write --output in this host's format")->check(values_are(host_names()));
  command->add_option("--host-padding", o->emit.host_padding, "Padding with which the host will be run, if not its default")
      ->check(not_zero("more than 1, at most 500"))
      ->needs(host);
  command
      ->add_option("--target-error", o->emit.target_error,
                   "Choose the width, sampling and degree with which the host reaches this error (RMS)")
      ->check(not_zero("a number above 0 and below 1"))
      ->needs(host);
  host->excludes(accuracy);
  command->add_flag("--force", o->emit.force, "Emit the kernel even if it was made for another padding than the host's")
      ->needs(host);
  CLI::Option* output =
      command->add_option("--output", o->output, "File to write: a FITS kernel table, or the format of --emit")
          ->type_name(file_type)
          ->check(not_empty());
  command->add_flag("--quiet", o->quiet, "Print nothing but errors");
  CLI::Option* inspected = command->add_option("--inspect", o->inspect, "Kernel-table file to show")->type_name(file_type);
  inspected->excludes(output)->excludes(accuracy)->excludes(host);
  for (const char* making :
       {"--kernel", "--kernel-folder", "--width", "--x0", "--padding", "--sampling", "--interpolation", "--degree", "--quiet"})
    inspected->excludes(command->get_option(making));
  command->add_flag("--json", o->json, "Print the output of --inspect or --emit as JSON");
  const CLI::Option* sampling = command->get_option("--sampling");
  const CLI::Option* interpolation = command->get_option("--interpolation");
  command->callback([o, sampling, interpolation] {
    const bool choosing = o->job.accuracy != 0;
    if (!o->inspect.empty()) return inspect(*o);
    check_values(*o);
    if (!o->emit.host.empty()) {
      if (sampling->count() > 0) o->emit.per_cell = o->sampling.per_cell;
      if (interpolation->count() > 0) o->emit.interpolation = o->sampling.interpolation;
      return emit(*o);
    }
    if (o->json) throw std::invalid_argument("--json: expected --inspect or --emit beside it");
    if (!choosing && !o->job.imsize.empty()) throw std::invalid_argument("--imsize: expected --accuracy or --emit beside it");
    if (choosing) choose(*o);
    if (o->output.empty() && !choosing)
      throw std::invalid_argument("no output is given: expected one of --output, --inspect and --accuracy");
    if (!o->output.empty()) make(*o);
  });
}

}  // namespace misfit::tools
