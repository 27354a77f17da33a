#include "tools/pictures.h"

#include <filesystem>
#include <fstream>
#include <future>

#include "tools/gnuplot.h"
#include "tools/picture_script.h"

namespace misfit::tools {
namespace {

namespace fs = std::filesystem;

/// Whether a PNG file is there to its last chunk, IEND; gnuplot says nothing when the disk is full.
bool is_complete(const fs::path& path) {
  const std::string end("IEND\xae\x42\x60\x82", 8);
  std::ifstream file(path, std::ios::binary);
  file.seekg(-static_cast<std::streamoff>(end.size()), std::ios::end);
  std::string last(end.size(), '\0');
  file.read(last.data(), static_cast<std::streamsize>(last.size()));
  return file && last == end;
}

}  // namespace

/// A picture being drawn.
struct PictureDrawing::Sheet {
  std::string path;
  std::unique_ptr<WorkFolder> work;
  std::future<std::string> failure;

  explicit Sheet(const Picture& picture)
      : path(picture.path), failure(std::async(std::launch::async, [this, picture] { return draw(picture); })) {}

  std::string draw(const Picture& picture) {
    work = std::make_unique<WorkFolder>(fs::absolute(picture.path).parent_path());
    write_picture_script(picture, work->path());
    return run_gnuplot(*work);
  }
  fs::path drawn() const { return work->path() / "png"; }
};

PictureDrawing::PictureDrawing(const std::vector<Picture>& pictures) {
  for (const Picture& picture : pictures) sheets_.push_back(std::make_unique<Sheet>(picture));
}

PictureDrawing::~PictureDrawing() = default;

std::string PictureDrawing::finish() {
  for (const auto& sheet : sheets_) {
    const std::string failure = sheet->failure.get();
    if (!failure.empty()) return "Pictures are left out because " + failure + ".";
  }
  for (const auto& sheet : sheets_)
    if (!is_complete(sheet->drawn())) return "Pictures are left out because gnuplot could not finish them; is the disk full?";
  for (const auto& sheet : sheets_) fs::rename(sheet->drawn(), sheet->path);
  return "";
}

std::string draw_pictures(const std::vector<Picture>& pictures) {
  return PictureDrawing(pictures).finish();
}

}  // namespace misfit::tools
