#include <casacore/measures/TableMeasures/ScalarMeasColumn.h>
#include <casacore/tables/Tables/ScalarColumn.h>

#include <array>
#include <stdexcept>

#include "ms_io/celestial_frame_internal.h"
#include "ms_io/field_centres_internal.h"
#include "ms_io/observing_place_internal.h"
#include "ms_io/spectral_frame_internal.h"
#include "ms_io/table_access_internal.h"

namespace misfit::ms_io {
namespace {

struct FrameName {
  const char* casa;  ///< what tasks call it; empty where they do not
  const char* fits;
};

/// In the order of casacore's codes.
constexpr std::array<FrameName, 9> frames{{{"", "SOURCE"},
                                           {"LSRK", "LSRK"},
                                           {"LSRD", "LSRD"},
                                           {"BARY", "BARYCENT"},
                                           {"GEO", "GEOCENTR"},
                                           {"TOPO", "TOPOCENT"},
                                           {"GALACTO", "GALACTOC"},
                                           {"LGROUP", "LOCALGRP"},
                                           {"CMB", "CMBDIPOL"}}};

}  // namespace

std::string parse_spectral_frame(const std::string& name) {
  std::string capitals = name, known;
  for (char& c : capitals)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  for (const FrameName& frame : frames) {
    if (frame.casa[0] == '\0') continue;
    if (capitals == frame.casa) return frame.fits;
    known += (known.empty() ? "" : ", ") + std::string(frame.casa);
  }
  throw std::invalid_argument("spectral frame '" + name + "'; expected one of " + known);
}

casacore::MFrequency::Types spectral_frame_code(const std::string& spectral_frame) {
  for (std::size_t code = 0; code < frames.size(); ++code)
    if (spectral_frame == frames[code].fits) return static_cast<casacore::MFrequency::Types>(code);
  return casacore::MFrequency::Undefined;
}

std::string spectral_frame_of(int code) {
  return code >= 0 && static_cast<std::size_t>(code) < frames.size() ? frames[static_cast<std::size_t>(code)].fits : "";
}

FrameRatio::FrameRatio(const casacore::MeasurementSet& set, const std::string& path, const SelectedRows& selected,
                       const Setup& setup, int observation) {
  if (setup.spectral_frame == selected.spectral_frame) {
    ratio_ = 1;
    return;
  }
  if (setup.spectral_frame.empty() || setup.spectral_frame == "SOURCE")
    throw std::runtime_error(path + ": spectral window " + std::to_string(setup.spectral_window) + " has frequencies " +
                             (setup.spectral_frame.empty() ? "of no frame that is known"
                                                           : "at rest in the source, whose velocity it does not tell") +
                             "; expected a frame that can be converted to " + selected.spectral_frame);
  translated("cannot find the frame of frequencies of " + path, [&] {
    const std::uint64_t row = selected.first_row;
    frame_ = casacore::MeasFrame(casacore::ScalarMeasColumn<casacore::MEpoch>(set, "TIME")(row));  // shared with `convert_`
    frame_.set(observing_place(set, observation).position);
    const int field = first_field(set, selected);
    frame_.set(measure_of(selected.phase_centre.value_or(field_centre(set, path, field, row).direction)));
    if (selected.follows_field) moving_ = std::make_unique<Towards>(set, path, selected, field);
    convert_.emplace(casacore::MFrequency::Ref(spectral_frame_code(setup.spectral_frame), frame_),
                     casacore::MFrequency::Ref(spectral_frame_code(selected.spectral_frame), frame_));
  });
}

double FrameRatio::at(double time_s) {
  if (!convert_ || (ratio_ != 0 && time_s == time_s_)) return ratio_;
  constexpr double any_hz = 1e9;
  frame_.resetEpoch(casacore::MVEpoch(casacore::Quantity(time_s, "s")));
  if (moving_) {
    const Moment moment{time_s, moving_->selected.first_row};
    const FieldCentre centre = followed_centre(moving_->fields, moving_->selected, moving_->field, moment);
    frame_.resetDirection(measure_of(centre.direction));
  }
  ratio_ = (*convert_)(any_hz).getValue().getValue() / any_hz;
  time_s_ = time_s;
  return ratio_;
}

}  // namespace misfit::ms_io
