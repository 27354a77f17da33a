#pragma once

#include <string>

namespace misfit::tools {

/// Throws std::runtime_error that names the folder when no file can or should be made beside `path`:
/// casacore deletes a table with all that lies in it.
void check_writable_folder(const std::string& path);

/// Writes `content`; the file appears under its name only when complete. Throws std::runtime_error that names the path.
void write_file(const std::string& path, const std::string& content);

/// The file's bytes. Throws std::runtime_error that names the path.
std::string read_file(const std::string& path);

}  // namespace misfit::tools
