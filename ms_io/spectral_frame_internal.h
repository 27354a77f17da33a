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

/// By how much frequencies of a spectral window differ in another frame, at the place of one row of OBSERVATION and towards a
/// direction: all by one factor, that of Doppler's shift, which changes with time. The set and `selected` must outlive it.
class FrameRatio {
 public:
  FrameRatio(const FrameRatio&) = delete;
  FrameRatio& operator=(const FrameRatio&) = delete;
  /// Throws std::runtime_error, which begins with `path`, where the window's frame is not known or is that of the source.
  FrameRatio(const casacore::MeasurementSet& set, const std::string& path, const SelectedRows& selected, const Setup& setup,
             int observation);

  /// Frequency in the frame of the selection over that in the window's, at TIME in seconds as the set stores it.
  double at(double time_s);

 private:
  /// Where a field is that the image moves with.
  struct Towards {
    Towards(const casacore::MeasurementSet& set, const std::string& path, const SelectedRows& rows, int of)
        : fields(set, path), selected(rows), field(of) {}

    FieldDirections fields;
    const SelectedRows& selected;
    int field;
  };

  casacore::MeasFrame frame_;
  std::unique_ptr<Towards> moving_;                       ///< null where the direction stays
  std::optional<casacore::MFrequency::Convert> convert_;  ///< none where the frames are the same
  double time_s_ = 0;                                     ///< of ratio_
  double ratio_ = 0;                                      ///< 0: not known yet
};

}  // namespace misfit::ms_io
