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

/// What is made anew, as typed; else images are taken that lie under the same imagename.
struct TypedTaken {
  bool calcpsf = true;
  bool calcres = true;

  bool any() const { return !calcpsf || !calcres; }
};

void declare(CLI::App& command, TypedTaken& options);

/// Throws as check(const ImageOptions&) does.
void check_taken(const ImageOptions& options);

/// What was taken of a channel.
struct TakenPlanes {
  std::vector<imager::Image> psf;                    ///< [k] of 2 terms − 1; none where they are made
  std::vector<std::vector<imager::Image>> residual;  ///< [term][Stokes]; none where they are made
};

/// The PSF and the residual that a run before left, or whoever put them there, of which a run takes what --calcpsf and
/// --calcres say. Of CASA images and FITS files the newer ones. All messages name the file, and what was expected.
class TakenFiles {
 public:
  /// Finds the files for an image with these planes and Stokes parameters. Throws std::runtime_error where one is not there, or
  /// has other pixels, planes or terms.
  TakenFiles(const ImageOptions& options, const imager::ImageHeader& image);

  /// Which are taken, for the plan.
  imager::Plan decisions() const;

  /// Throws std::runtime_error where they cannot be read, or have pixels without values above the horizon. Files are open no
  /// longer than this takes: the run puts others in their places. For several threads.
  TakenPlanes read(int channel) const;
  /// Throws std::runtime_error unless .sumwt, where it was written here and has the plane, says what the samples weigh.
  void require_weights(int channel, const std::vector<imager::SampleSums>& sums) const;
  /// Throws std::runtime_error in place of this.
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
