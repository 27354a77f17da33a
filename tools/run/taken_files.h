#pragma once

#include <string>
#include <vector>

#include "imager/files/image_header.h"
#include "imager/plan/plan.h"
#include "imager/plan/taken_images.h"

namespace CLI {
class App;
}

namespace misfit::tools {

struct ImageOptions;

/// Which images are made anew, as typed; the others are taken from files under the same imagename.
struct TypedTaken {
  bool calcpsf = true;
  bool calcres = true;

  bool any() const { return !calcpsf || !calcres; }
};

void declare(CLI::App& command, TypedTaken& options);

/// Throws as check(const ImageOptions&) does.
void check_taken(const ImageOptions& options);

/// The planes taken for a channel.
struct TakenPlanes {
  std::vector<imager::Image> psf;                    ///< [k] of 2 terms − 1; none where they are made
  std::vector<std::vector<imager::Image>> residual;  ///< [term][Stokes]; none where they are made
};

/// The PSF and the residual of a run before, or of whoever put them there, as far as --calcpsf and --calcres ask to take them;
/// the newer one of a CASA image and a FITS file. All messages name the file, and what was expected.
class TakenFiles {
 public:
  /// Finds the files for an image with these planes and Stokes parameters. Throws std::runtime_error where one is not there, or
  /// has other pixels, planes or terms.
  TakenFiles(const ImageOptions& options, const imager::ImageHeader& image);

  /// Decisions for the plan: which files are taken.
  imager::Plan decisions() const;

  /// Throws std::runtime_error where they cannot be read, or have pixels without values above the horizon. Files are closed
  /// when it returns: the run puts others in their places. Several threads may call it.
  TakenPlanes read(int channel) const;
  /// Throws std::runtime_error where a .sumwt that misfit wrote has the plane, and another sum of weights than the samples.
  void require_weights(int channel, const std::vector<imager::SampleSums>& sums) const;
  /// Throws std::runtime_error that names the file, in place of `unlike`.
  [[noreturn]] void refuse(const imager::UnlikeSamples& unlike) const;

 private:
  std::string find(const std::string& kind, int order, const char* option) const;
  std::vector<imager::Image> planes(const std::string& path, int channel, const std::vector<imager::Stokes>& stokes) const;

  const ImageOptions& o_;
  imager::ImageHeader image_;
  std::vector<std::string> psf_;       ///< paths [k]; none where it is made
  std::vector<std::string> residual_;  ///< [term]; none where it is made
  std::string sumwt_;                  ///< empty: there is none
};

}  // namespace misfit::tools
