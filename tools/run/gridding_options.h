#pragma once

#include <optional>

#include "imager/plan/gridding_choice.h"
#include "kernels/lookup_table.h"
#include "tools/kernel_choice/kernel_choice.h"

namespace CLI {
class App;
}

namespace misfit::tools {

/// How samples are gridded, as typed.
struct TypedGridding {
  std::string gridder = "auto";  ///< declared by declare_gridder()
  KernelSource kernel;
  double accuracy = 1e-6;
  double psf_accuracy = 0;  ///< 0 = the larger of accuracy and 1e-4
  int kernel_width = 0;     ///< 0 = chosen
  double padding = 0;       ///< 0 = chosen
  std::string evaluation = "polynomial";
  int sampling = 0;  ///< entries a cell of a table; 0 = none
  std::string precision = "auto";
};

void declare_gridder(CLI::App& command, TypedGridding& options);
/// Declares the other options.
void declare(CLI::App& command, TypedGridding& options);

/// Checks what needs neither the data nor the kernel's solution. Throws as check(const ImageOptions&) does.
void check(const TypedGridding& options);

/// True if the options leave nothing of the kernel to choose: a file, or width and padding. Then no accuracy need be asked.
bool kernel_is_given(const TypedGridding& options);

/// The tables that --evaluation names, if it does.
std::optional<kernels::TableOptions> lookup_of(const TypedGridding& options);

imager::GriddingRequest gridding_request(const TypedGridding& options, int threads);

}  // namespace misfit::tools
