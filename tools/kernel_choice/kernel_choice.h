#pragma once

#include <filesystem>
#include <string>

#include "kernels/catalogue.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace misfit::tools {

/// The values of --kernel and --kernel-folder.
struct KernelSource {
  std::string name = "least-misfit";  ///< of the catalogue, of a library in `folder`, or a kernel-table file
  std::string folder;                 ///< the only place where libmisfit_kernel_<name>.so is looked for; empty = nowhere
};

/// Lets --help list the kernels of the catalogue as values of `option`, which also takes files and names of libraries.
void list_kernels(CLI::Option& option);

/// Declares --kernel-folder, whose default is $MISFIT_KERNEL_FOLDER.
void declare_kernel_folder(CLI::App& command, std::string& folder);

/// True if the name is a kernel-table file: none of the catalogue, but something with a slash, with the ending .fits, or that
/// exists and is not a library's name too.
bool is_kernel_file(const KernelSource& kernel);

/// The table or library that the kernel comes from; an empty path for one of the catalogue, or none.
std::filesystem::path file_of(const KernelSource& kernel);

/// The family that is meant: of the catalogue, with the user's cache; of a library, see plugin_family.h; or the only kernel of
/// a file. Throws std::invalid_argument that lists the names for a kernel that is not known, or says what else bears its name:
/// no library takes the place of a kernel of the catalogue or of a file. Throws std::runtime_error that names the file when it
/// cannot be used or, a table, has changed since it was written.
kernels::KernelFamily choose_kernel(const KernelSource& kernel);

}  // namespace misfit::tools
