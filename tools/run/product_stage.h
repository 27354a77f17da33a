#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "imager/clean/clean.h"
#include "imager/numerics/stage_times.h"
#include "imager/taylor/taylor_beam.h"
#include "imager/transform/imaging.h"
#include "tools/run/image_options.h"
#include "tools/run/image_products.h"
#include "tools/run/name_lock.h"
#include "tools/run/taylor_stage.h"
#include "tools/run_page/report_page.h"

namespace misfit::tools {

/// What goes into every image of a run.
struct ProductScene {
  const imager::ImageGeometry& geometry;
  std::vector<imager::Stokes> stokes;
  imager::Observation observation;
  std::vector<std::string> history;
  std::vector<imager::HeaderCard> cards;
  std::optional<imager::Beam> restoring_beam;
  int threads = 1;
};

/// Keeps the name of the images from other runs, and removes what one that was killed left half written. Throws
/// std::runtime_error that names it where the folder of the images cannot be written, something lies under the name of one that
/// none may take the place of, or another run is making them.
std::unique_ptr<NameLock> claim_product_paths(const ImageOptions& options);

/// The images, pictures and lists that `misfit image` leaves. Stages timed: "draw pictures", "restore", "write images".
class ProductStage {
 public:
  ProductStage(const ImageOptions& options, ProductScene scene, imager::StageTimes& times);

  /// Images are those of Taylor terms from now on. Kept by reference.
  void set_taylor(TaylorStage& taylor) { taylor_ = &taylor; }

  /// Begins to draw what is there before CLEAN, while the caller does other things; an automatic mask is not known yet, and
  /// the dirty image then drawn with the others. Images are looked at until it returns.
  /// `mask_of` gives a Stokes parameter's mask, or null.
  void draw_dirty(const imager::UvCoverage& coverage, const imager::DirtyImages& images,
                  const std::function<const imager::Image*(std::size_t)>& mask_of);

  /// To be written with the images [term], which --pbcor divides by it; of several terms `of_terms` does, which is kept.
  void set_primary_beam(std::vector<imager::Image> beam, const imager::TaylorBeam* of_terms) {
    primary_beam_ = std::move(beam);
    taylor_beam_ = of_terms;
  }
  /// Writes the images of a run without CLEAN. Returns the names of files that an earlier run left and this one removed.
  std::vector<std::string> write(imager::DirtyImages images);
  /// Those of CLEAN [Stokes], restored, and the list of components. Takes the images out of `cleaned`, but for models that
  /// --savemodel still needs.
  std::vector<std::string> write(imager::Image psf, std::vector<imager::CleanResult>& cleaned);

  /// Adds the pictures to `drawn`, or returns in a sentence why there are none.
  std::string finish_pictures(std::vector<PagePicture>& drawn);

 private:
  /// The picture of one Stokes parameter, whose name and title say which where there are several.
  ProductPicture picture_of(std::size_t stokes, ProductPicture picture) const;
  void draw(std::vector<imager::CleanResult>& cleaned, const std::vector<imager::Image>& restored_images);
  /// The primary beam, if there is one.
  void add_primary_beam();
  /// Images [Stokes] divided by it.
  void add_corrected(const std::vector<imager::Image>& images);
  /// The same of Taylor terms [term], and of their spectral indices, or null.
  void add_corrected_terms(const std::vector<const imager::Image*>& apparent, const imager::SpectralImages* spectra);
  /// Images for files whose headers tell whether the beam is divided out of the spectra that they have.
  void add_spectra(imager::SpectralImages& spectra, const std::string& end, bool corrected);
  void write_components(const std::vector<imager::CleanResult>& cleaned) const;
  imager::Image restored(const imager::CleanResult& cleaned);
  /// Images [Stokes] of a Taylor term, or of all where there are not several: the name `kind`, then the term, then `end`, and
  /// the header tell which.
  void add(const std::string& kind, const std::string& unit, std::vector<imager::Image> images, int term = 0,
           const std::string& end = "");
  void add_further(const std::string& kind, std::vector<imager::Image>& images);
  void add_taylor(imager::CleanResult& cleaned);
  std::vector<imager::Source> sources(const imager::ComponentModel& model) const;
  void remove_other_stokes(std::vector<std::string>& removed) const;

  const ImageOptions& o_;
  ProductScene scene_;
  imager::StageTimes& times_;
  ImageProducts products_;
  std::vector<imager::Image> primary_beam_;          ///< [term]; empty where none is wanted
  const imager::TaylorBeam* taylor_beam_ = nullptr;  ///< null where none is wanted, or there is one term
  TaylorStage* taylor_ = nullptr;                    ///< null where there is one term
  RestoredTerms restored_;                           ///< of several
  std::vector<Sketch> dirty_;  ///< what is left of the dirty images when CLEAN is over, where masks were not known before
};

}  // namespace misfit::tools
