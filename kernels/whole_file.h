#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

namespace misfit::kernels {

/// The bytes of the regular file at `path`, at most `limit`. Throws std::runtime_error that names the path.
std::vector<char> read_whole_file(const std::filesystem::path& path, std::size_t limit);

/// The path where a file called `path` is to be written: links are followed. Throws std::runtime_error where a device, a folder
/// or anything else that is no regular file lies there, since a new file would replace it.
std::filesystem::path writable_target(const std::filesystem::path& path);

/// A name beside `path` that no other process on any machine uses, for a file that is renamed to `path` when it is complete.
std::filesystem::path temporary_beside(const std::filesystem::path& path);

/// True if a name is one that temporary_beside() gives.
bool is_temporary(const std::filesystem::path& path);

/// Writes `size` bytes; the file appears under its name only when complete, and whoever writes the same name at the same time
/// does no harm. Throws std::runtime_error that names the path, and leaves nothing behind then.
void write_whole_file(const std::filesystem::path& path, const char* bytes, std::size_t size);

}  // namespace misfit::kernels
