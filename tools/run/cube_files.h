#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "imager/files/image_writer.h"
#include "tools/run/image_options.h"

namespace misfit::tools {

/// The images of a cube on their way into files: <imagename>.psf, .residual, and with CLEAN .model, .image and, where there are
/// masks, .mask; .pb and .image.pbcor where they are wanted. Each plane is written as soon as it is done, in any order; planes
/// of several threads wait for each other.
class CubeFiles {
 public:
  /// Begins one of the files, which is called <imagename>.<kind>.
  using Open = std::function<std::unique_ptr<imager::ImageWriter>(const std::string& name, const imager::ImageHeader& header)>;

  /// Throws std::runtime_error that names the file which cannot be written.
  CubeFiles(const ImageOptions& options, const imager::ImageHeader& header, bool masks, const Open& open);

  /// What a plane of one Stokes parameter has; null where there is none.
  struct Plane {
    const imager::Image* residual = nullptr;
    const imager::Image* model = nullptr;
    const imager::Image* restored = nullptr;
    const imager::Image* mask = nullptr;
    const imager::Image* primary_beam = nullptr;  ///< by which the brightness is divided for --pbcor
  };

  /// The PSF of a channel, and the beam fitted to it.
  void write_psf(int channel, const imager::Image& psf, const std::optional<imager::Beam>& beam);
  void write(const imager::PlaneIndex& at, const Plane& plane, const std::optional<imager::Beam>& beam);
  /// The restored image alone, where it comes later, and what --pbcor makes of it.
  void write_restored(const imager::PlaneIndex& at, const Plane& plane, const std::optional<imager::Beam>& beam);
  /// A plane that another rank made, of the file that it opened as this one, counted from 0.
  void write_sent(int file, const imager::PlaneIndex& at, const imager::Image& image, const std::optional<imager::Beam>& beam);
  /// Numbers for the headers of all of them, which are known once planes are made.
  void add_cards(const std::vector<imager::HeaderCard>& cards);
  /// Those that finish() makes.
  const std::vector<std::string>& paths() const { return paths_; }
  /// All files get their names; but for those of restored images where these follow, since they wait for a beam of all.
  void finish(bool restored_follow);
  void finish_restored();

 private:
  using Writer = std::unique_ptr<imager::ImageWriter>;
  static void put(const Writer& writer, const imager::PlaneIndex& at, const imager::Image* image,
                  const std::optional<imager::Beam>& beam);
  std::vector<std::string> paths_;
  std::vector<imager::ImageWriter*> files_;                                     ///< in the order in which they were opened
  Writer psf_, residual_, model_, restored_, mask_, primary_beam_, corrected_;  ///< null where there is no such image
};

}  // namespace misfit::tools
