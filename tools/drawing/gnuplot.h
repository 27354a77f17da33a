#pragma once

#include <filesystem>
#include <string>

namespace misfit::tools {

/// A folder for gnuplot's script, data and results; removed with all it holds.
class WorkFolder {
 public:
  /// Makes it in `parent`. Throws std::runtime_error that names `parent`.
  explicit WorkFolder(const std::filesystem::path& parent);
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  ~WorkFolder();

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// `text` as a gnuplot string.
std::string gnuplot_quoted(const std::string& text);

/// Runs gnuplot, found on PATH, on the file "script" in `folder`, which is also where it writes. Returns an empty string, or
/// why that failed: "gnuplot is not installed", or "gnuplot failed: " and the first line it said.
std::string run_gnuplot(const WorkFolder& folder);

}  // namespace misfit::tools
