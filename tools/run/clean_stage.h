#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "imager/beams/beam.h"
#include "imager/clean/clean.h"
#include "imager/clean/deconvolver.h"
#include "imager/files/image_header.h"
#include "tools/formats/clean_state_file.h"
#include "tools/formats/mask_file.h"
#include "tools/run/image_options.h"
#include "tools/run/start_model.h"

namespace misfit::tools {

/// The input of CLEAN from the stages before it, for one Stokes parameter.
struct CleanScene {
  imager::ImagedData imaged;
  imager::TaylorExpansion expansion;
  std::vector<imager::Image> dirty;                 ///< [term]
  double dirty_accuracy = 0;                        ///< see CleanInput
  bool of_start = false;                            ///< see CleanInput
  std::vector<const imager::Image*> psf;            ///< [k], see CleanInput
  bool same_sidelobes = false;                      ///< see CleanInput
  imager::Beam main_lobe;                           ///< of the PSF
  std::vector<imager::CoarserTransform> coarser{};  ///< see CleanInput
  double data_jy = 0;                               ///< see CleanInput
  double expected_error = 0;                        ///< of the dirty image
};

/// CLEAN as `misfit image` runs it, one Stokes parameter after the other, with the files that go into it: mask, start model,
/// and the states that it leaves after every major cycle and may begin with.
class CleanStage {
 public:
  /// Opens the mask and the start model of an image with these planes and Stokes parameters. Throws std::runtime_error that
  /// names the file and what was expected.
  CleanStage(const ImageOptions& options, imager::ImageHeader image);

  /// From here on all functions are about this channel of the image. Reads its mask and start model. To be called before the
  /// functions below.
  void begin_channel(int channel);
  /// Keeps masks of this channel to where its primary beam is --pbmask or more, and the pixels of the masks' noise to where it
  /// is both --pbmask and --pblimit or more.
  void keep_within(const imager::Image& primary_beam);

  const std::vector<std::unique_ptr<MaskFile>>& mask_files() const { return mask_files_; }
  /// Null where CLEAN may go everywhere; CLEAN may make a mask of its own within this one.
  const imager::Image* mask(std::size_t stokes) const {
    const std::vector<imager::Image>& masks = limited_.empty() ? masks_ : limited_;
    return masks.empty() ? nullptr : &masks[masks.size() == 1 ? 0 : stokes];
  }
  /// Sentences for the user on the mask's file, and on the band of the start model.
  std::vector<std::string> words_on_files() const;
  /// Words for the user on the state that the last run() went on from; mostly empty.
  const std::string& words_on_state() const { return words_on_state_; }
  /// A warning that the mask, or the primary beam's, allows no pixel; else empty.
  std::string closed_mask_warning() const;
  /// Sentences for the user before CLEAN begins; channels of a cube have them in the same words.
  std::vector<std::string> warnings() const;

  /// Throws what imager::clean and read_clean_state do.
  imager::CleanResult run(CleanScene scene, const StateOptionValues& option_values, const imager::CycleProgress& cycle_progress,
                          const imager::Context& context);

 private:
  std::string state_path(std::size_t stokes) const;
  imager::Image mask_of_files(const imager::PlaneIndex& at) const;
  std::string missing_states_warning() const;
  /// The state that a run before left, or the state of the start model, which it frees.
  imager::CleanState begin(std::size_t stokes, const CleanStateOwner& owner);
  std::uint64_t checksum_of(const CleanScene& scene) const;

  const ImageOptions& o_;
  imager::ImageHeader image_;
  std::string words_on_state_;
  int channel_ = -1;                                   ///< none yet
  std::vector<std::unique_ptr<MaskFile>> mask_files_;  ///< none without a mask
  std::unique_ptr<StartModel> start_model_;            ///< null without one
  std::vector<imager::Image> masks_;                   ///< none, one for all, or [Stokes]
  std::vector<imager::Image> limited_;  ///< masks_, or one mask, within the primary beam; none where that does not limit them
  imager::Image noise_within_;          ///< see CleanOptions; empty where that is null
};

}  // namespace misfit::tools
