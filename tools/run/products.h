#pragma once

#include <functional>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "imager/files/image_writer.h"
#include "imager/taylor/taylor_beam.h"
#include "tools/run/channel_batches.h"
#include "tools/run/channel_run.h"
#include "tools/run/name_lock.h"
#include "tools/run/primary_beam_stage.h"
#include "tools/run/product_kinds.h"
#include "tools/run/run_pictures.h"

namespace misfit::tools {

/// Keeps the name of the images from other runs, and removes files that a killed run left half written. Throws
/// std::runtime_error that names the path where the folder of the images cannot be written, an image's name holds something
/// that no image may replace, or another run is making the images.
std::unique_ptr<NameLock> claim_product_paths(const ImageOptions& options);

/// Header cards for the errors and the noise that are known; of errors the largest of all channels and Stokes parameters.
std::vector<imager::HeaderCard> error_cards(const RunReport& report);

/// The images of a run, and the list of what CLEAN found. Each channel is written as soon as it is made, in any order; several
/// threads wait for each other. With --restoringbeam common, restored images follow once all channels are there. Stages timed:
/// "restore", "statistics", "primary beam", "write images", which counts in what a channel waits for others.
class Products {
 public:
  /// Begins a file for the images of a kind.
  using Open = std::function<std::unique_ptr<imager::ImageWriter>(const ProductKind& kind, const imager::ImageHeader& header)>;

  /// Begins the files. Options and `primary_beam`, null where none is wanted, are kept by reference. Throws std::runtime_error
  /// that names the file which cannot be written.
  Products(const ImageOptions& options, const imager::ImageHeader& header, const PrimaryBeamStage* primary_beam,
           const ChannelWorkers& workers, const Open& open);

  /// Writes the images of a channel. Adds statistics of its pixels to its report, and doubts about its primary beam to its
  /// doubts. Draws `pictures` of it, unless they are null. May be called for several channels at the same time.
  void write(ChannelRun& run, RunPictures* pictures);
  /// A plane that another rank made.
  void write(const std::string& kind, const imager::PlaneIndex& at, const imager::Image& image,
             const std::optional<imager::Beam>& beam);
  /// To be called after the last channel, with cards for the headers. Puts the common beam, if there is one, into the reports.
  /// Returns the names of files that an earlier run left and this one removed.
  std::vector<std::string> finish(std::vector<ChannelReport>& channels, const std::vector<imager::HeaderCard>& cards,
                                  imager::StageTimes& times);

 private:
  struct File {
    ProductKind kind;
    std::unique_ptr<imager::ImageWriter> writer;
    std::vector<imager::HeaderCard> cards;  ///< of its own
  };
  struct OfBeam;
  struct Written;

  void put(const std::string& kind, const imager::PlaneIndex& at, const imager::Image& image,
           const std::optional<imager::Beam>& beam);
  void put_terms(const std::string& kind, const imager::PlaneIndex& at, const std::vector<const imager::Image*>& terms,
                 const std::optional<imager::Beam>& beam, const std::string& end = "");
  void put_spectra(const imager::SpectralImages& spectra, const std::string& end, const imager::PlaneIndex& at,
                   const std::optional<imager::Beam>& beam);
  OfBeam primary_beam_of(ChannelRun& run) const;
  /// Begins work on files, which goes on meanwhile where there is more than one thread.
  std::future<void> beside(const std::function<void()>& work) const;
  /// Ends that work, and rethrows what it threw.
  static void wait_for(std::future<void>& work, ChannelRun& run);
  void write_stokes(std::size_t stokes, const OfBeam& primary_beam, ChannelRun& run, RunPictures* pictures);
  void put_images(std::size_t stokes, const OfBeam& primary_beam, const RestoredTerms& restored, ChannelRun& run);
  void write_corrected(const imager::PlaneIndex& at, const OfBeam& primary_beam,
                       const std::vector<const imager::Image*>& apparent, const imager::SpectralImages* spectra,
                       const std::optional<imager::Beam>& beam);
  imager::Image mask_of_ones() const;
  void put_weights(const imager::PlaneIndex& at, ChannelRun& run);
  void write_components(const std::vector<imager::CleanResult>& cleaned, const imager::Image* divided_by) const;
  imager::Image restore(const imager::Image& model, const imager::Image& residual, const imager::Beam& beam) const;
  void restore_in_common(std::vector<ChannelReport>& channels);
  void restore_channel(ChannelReport& channel, const imager::Beam& common, const Written& written);
  void finish_files(Completed which);

  const ImageOptions& o_;
  imager::ImageHeader header_;
  const PrimaryBeamStage* primary_beam_;
  ChannelWorkers workers_;
  std::map<std::string, File> files_;  ///< by the name of their kind
  std::vector<std::string> paths_;     ///< of the files
  bool in_common_;                     ///< whether all channels are restored with one beam, known only once they are there
};

}  // namespace misfit::tools
