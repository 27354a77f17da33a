#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "imager/files/image_header.h"
#include "imager/files/image_reader.h"
#include "imager/plan/plan.h"
#include "imager/plan/taken_images.h"

namespace CLI {
class App;
}

namespace misfit::tools {

struct ImageOptions;

/// What is made anew, as typed; else images are taken that lie under the same imagename.
struct TypedTaken {
  bool calcpsf = true;
  bool calcres = true;

  bool any() const { return !calcpsf || !calcres; }
};

void declare(CLI::App& command, TypedTaken& options);

/// Throws as check(const ImageOptions&) does.
void check_taken(const ImageOptions& options);

/// The PSF and the residual that a run before left, or whoever put them there, of which a run takes what --calcpsf and
/// --calcres say. Of CASA images and FITS files the newer ones. All messages name the file, and what was expected.
class TakenFiles {
 public:
  /// Opens the files for an image with these planes and Stokes parameters. Throws std::runtime_error where one is not there, or
  /// has other pixels, planes or terms.
  TakenFiles(const ImageOptions& options, const imager::ImageHeader& image);

  /// Which are taken, for the plan.
  imager::Plan decisions() const;

  /// Those of a channel; of the first of several Taylor terms. At ranks that make no images they are empty. Throws
  /// std::runtime_error where they cannot be read, or have pixels without values above the horizon. For several threads.
  imager::TakenImages read(int channel, bool images_here) const;
  /// The further terms' [term − 1]; none where they are not taken.
  std::optional<std::vector<imager::Image>> further_dirty() const;
  std::optional<std::vector<imager::Image>> further_psf() const;

  /// Throws std::runtime_error in place of this.
  [[noreturn]] void refuse(const imager::UnlikeSamples& unlike) const;
  /// Throws std::runtime_error unless .sumwt, where it is there, says what the samples weigh.
  void require_weights(int channel, const std::vector<imager::SampleSums>& sums) const;

 private:
  struct File {
    std::string path;
    std::unique_ptr<imager::ImageReader> reader;
  };

  File open(const std::string& kind, int order, const char* option) const;
  imager::Image read(const File& file, int channel, std::size_t stokes) const;
  imager::Image read_whole(const File& file, int channel, std::size_t stokes) const;
  std::optional<std::vector<imager::Image>> further(const std::vector<File>& files) const;

  const ImageOptions& o_;
  imager::ImageHeader image_;
  std::vector<File> psf_;       ///< [k]; none where it is made
  std::vector<File> residual_;  ///< [term]; none where it is made
  std::optional<File> sumwt_;
};

}  // namespace misfit::tools
