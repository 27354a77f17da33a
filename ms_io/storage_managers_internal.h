#pragma once

#include <string>

namespace misfit::ms_io {

/// Throws std::runtime_error that names the table at `path`, or one that it refers to or that lies in its keywords, where its
/// columns are stored by a manager whose name is a path: casacore would load a library from there, and run it; or in tiles that
/// check_tiled_header() refuses. Tables that cannot be read are for casacore to refuse.
void check_storage_managers(const std::string& path);

}  // namespace misfit::ms_io
