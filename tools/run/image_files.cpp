#include "tools/run/image_files.h"

#include "imager/fits_image_writer.h"
#include "ms_io/casa_image.h"

namespace misfit::tools {
namespace {

class SeveralWriters : public imager::ImageWriter {
 public:
  void add(std::unique_ptr<imager::ImageWriter> writer) { writers_.push_back(std::move(writer)); }

  void write(const imager::PlaneIndex& at, const imager::Image& image, const std::optional<imager::Beam>& beam) override {
    for (const auto& writer : writers_) writer->write(at, image, beam);
  }
  void finish() override {
    for (const auto& writer : writers_) writer->finish();
  }

 private:
  std::vector<std::unique_ptr<imager::ImageWriter>> writers_;
};

}  // namespace

const std::vector<std::string>& image_formats() {
  static const std::vector<std::string> names{"fits", "casa", "both"};
  return names;
}

std::unique_ptr<imager::ImageWriter> open_image_files(const std::string& name, const imager::ImageHeader& header,
                                                      imager::PixelFormat format, const std::string& outformat) {
  auto files = std::make_unique<SeveralWriters>();
  if (outformat != "casa") files->add(imager::create_fits_image(header, name + ".fits", format));
  if (outformat != "fits") files->add(ms_io::create_casa_image(header, name, format));
  return files;
}

}  // namespace misfit::tools
