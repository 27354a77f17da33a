#include "tools/drawing/pictures.h"

#include <filesystem>
#include <functional>
#include <future>
#include <stdexcept>
#include <system_error>

#include "imager/numerics/parallel.h"
#include "tools/base/files.h"
#include "tools/drawing/gnuplot.h"
#include "tools/drawing/picture_script.h"
#include "tools/drawing/uv_picture.h"

namespace misfit::tools {
namespace {

namespace fs = std::filesystem;

/// True if a PNG file ends with its last chunk, IEND; gnuplot says nothing when the disk is full.
bool is_complete(const std::string& png) {
  return png.ends_with(std::string("IEND\xae\x42\x60\x82", 8));
}

fs::path temporary_folder() {
  std::error_code absent;
  fs::path folder = fs::temp_directory_path(absent);
  if (absent) throw std::runtime_error("there is no folder for temporary files; expected one in TMPDIR");
  return folder;
}

}  // namespace

/// A picture being drawn.
struct PictureDrawing::Sheet {
  std::string path;
  std::unique_ptr<WorkFolder> work;
  std::string png;  ///< the file's bytes
  std::future<std::string> failure;

  /// `write_script` writes what gnuplot needs into a folder.
  Sheet(const std::string& to, const std::function<void(const fs::path& folder)>& write_script) : path(to) {
    try {
      work = std::make_unique<WorkFolder>(temporary_folder());
      write_script(work->path());
      failure = std::async(std::launch::async, [this] { return draw(); });
    } catch (const std::exception& error) {  // a picture less is no reason to lose a run
      std::promise<std::string> reason;
      reason.set_value(error.what());
      failure = reason.get_future();
    }
  }
  ~Sheet() {
    if (failure.valid()) failure.wait();
  }

  /// Leaves nothing on the disk while the run goes on, which may be killed.
  std::string draw() {
    std::string reason = run_gnuplot(*work);
    const fs::path drawn = work->path() / "png";
    if (reason.empty() && fs::exists(drawn)) png = read_file(drawn);
    work.reset();
    return reason;
  }
};

PictureDrawing::PictureDrawing() = default;
PictureDrawing::~PictureDrawing() = default;

void PictureDrawing::add(const std::vector<Picture>& pictures) {
  const std::size_t before = sheets_.size();
  sheets_.resize(before + pictures.size());
  imager::parallel_for(pictures.size(), static_cast<int>(pictures.size()), [&](std::size_t i) {
    const auto write_script = [&](const fs::path& folder) { write_picture_script(pictures[i], folder); };
    sheets_[before + i] = std::make_unique<Sheet>(pictures[i].path, write_script);
  });
}

void PictureDrawing::add(const imager::UvCoverage& coverage, const std::string& path) {
  const auto write_script = [&](const fs::path& folder) { write_uv_script(coverage, folder); };
  sheets_.push_back(std::make_unique<Sheet>(path, write_script));
}

std::string PictureDrawing::finish() {
  for (const auto& sheet : sheets_) {
    const std::string failure = sheet->failure.get();
    if (!failure.empty()) return "Pictures are left out: " + failure + ".";
  }
  for (const auto& sheet : sheets_)
    if (!is_complete(sheet->png))
      return "Pictures are left out: gnuplot could not finish them; expected room on the disk of temporary files.";
  for (const auto& sheet : sheets_) write_file(sheet->path, sheet->png);
  return "";
}

std::string draw_pictures(const std::vector<Picture>& pictures) {
  PictureDrawing drawing;
  drawing.add(pictures);
  return drawing.finish();
}

}  // namespace misfit::tools
