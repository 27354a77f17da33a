#pragma once

#include <casacore/measures/Measures/MCFrequency.h>
#include <casacore/measures/Measures/MeasConvert.h>
#include <casacore/measures/Measures/MeasFrame.h>
#include <casacore/ms/MeasurementSets/MeasurementSet.h>

#include <memory>
#include <optional>
#include <string>

#include "ms_io/field_directions_internal.h"
#include "ms_io/selection_internal.h"
#include "ms_io/spectral_frame.h"

namespace misfit::ms_io {

/// FITS SPECSYS of casacore's frequency frames (MFrequency::Types), whose codes are those of MEAS_FREQ_REF; empty where it has
/// none.
std::string spectral_frame_of(int code);
/// The code of such a frame; Undefined where casacore has none.
casacore::MFrequency::Types spectral_frame_code(const std::string& spectral_frame);

/// FITS SPECSYS of the source's rest frame, as in SelectedRows::spectral_frame.
constexpr const char* source_frame = "SOURCE";

/// The factor between frequencies of a spectral window in another frame and its own, at the place of one row of OBSERVATION and
/// towards a direction: the Doppler factor, which changes with time. To the source's frame it is √((1 + v/c)/(1 − v/c)) for the
/// velocity v at which the source recedes, times the factor of the frame that v is measured in. The set and `selected` must
/// outlive it.
class FrameRatio {
 public:
  FrameRatio(const FrameRatio&) = delete;
  FrameRatio& operator=(const FrameRatio&) = delete;
  /// Throws std::runtime_error, which begins with `path`, where the window's frame is not known or is the source's, or the
  /// source's velocity is not known.
  FrameRatio(const casacore::MeasurementSet& set, const std::string& path, const SelectedRows& selected, const Setup& setup,
             int observation);

  /// Frequency in the frame of the selection over that in the window's, at TIME in seconds as the set stores it.
  double at(double time_s);

 private:
  double doppler(double time_s);

  const SelectedRows& selected_;
  int field_ = 0;          ///< of the rows; or of the first
  std::uint64_t row_ = 0;  ///< its first
  FieldDirections fields_;

  casacore::MeasFrame frame_;
  std::optional<casacore::MFrequency::Convert> convert_;  ///< none where the frames are the same
  double time_s_ = 0;                                     ///< of ratio_
  double ratio_ = 0;                                      ///< 0: not known yet
};

}  // namespace misfit::ms_io
