#include <casacore/measures/TableMeasures/ScalarMeasColumn.h>
#include <casacore/tables/Tables/ScalarColumn.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "imager/numerics/constants.h"
#include "ms_io/capitals.h"
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
  const std::string wanted = capitals(name);
  std::string known;
  for (const FrameName& frame : frames) {
    if (frame.casa[0] == '\0') continue;
    if (wanted == frame.casa) return frame.fits;
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
                       const Setup& setup, int observation)
    : selected_(selected), fields_(set, path, selected.body) {
  if (setup.spectral_frame == selected.spectral_frame) {
    ratio_ = 1;
    return;
  }
  if (setup.spectral_frame.empty() || setup.spectral_frame == source_frame)
    throw std::runtime_error(path + ": spectral window " + std::to_string(setup.spectral_window) + " has frequencies " +
                             (setup.spectral_frame.empty() ? "of no frame that is known"
                                                           : "at rest in the source, whose velocity it does not tell") +
                             "; expected a frame that can be converted to " + selected.spectral_frame);
  translated("cannot find the frame of frequencies of " + path, [&] {
    field_ = selected.by_field ? setup.field : first_field(set, selected);
    row_ = selected.first_row_of_field.at(field_);
    const double first_s = casacore::ScalarColumn<double>(set, "TIME")(row_);
    frame_ = casacore::MeasFrame(fields_.epoch(first_s));  // shared with `convert_`
    frame_.set(observing_place(set, observation).position);
    if (selected.phase_centre) {
      frame_.set(measure_of(*selected.phase_centre));
    } else if (selected.follows_field) {
      frame_.set(casacore::MDirection());  // until at() says where, which may not be known of a flagged first row
    } else {
      frame_.set(measure_of(fields_.centre(field_, {first_s, row_}).direction));
    }
    const auto to =
        selected.spectral_frame == source_frame ? fields_.velocity_frame(field_) : spectral_frame_code(selected.spectral_frame);
    convert_.emplace(casacore::MFrequency::Ref(spectral_frame_code(setup.spectral_frame), frame_),
                     casacore::MFrequency::Ref(to, frame_));
  });
}

/// The factor from where a source's velocity is measured to the source's own frame; 1 for other frames.
double FrameRatio::doppler(double time_s) {
  if (selected_.spectral_frame != source_frame) return 1;
  const double of_light = fields_.recession_m_s(field_, time_s) / imager::speed_of_light_m_s;
  return std::sqrt((1 + of_light) / (1 - of_light));
}

double FrameRatio::at(double time_s) {
  if (!convert_ || (ratio_ != 0 && time_s == time_s_)) return ratio_;
  constexpr double any_hz = 1e9;
  frame_.resetEpoch(casacore::MVEpoch(casacore::Quantity(time_s, "s")));
  if (selected_.follows_field)
    frame_.resetDirection(measure_of(followed_centre(fields_, selected_, field_, {time_s, row_}).direction));
  ratio_ = (*convert_)(any_hz).getValue().getValue() / any_hz * doppler(time_s);
  time_s_ = time_s;
  return ratio_;
}

}  // namespace misfit::ms_io
