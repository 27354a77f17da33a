#pragma once

#include <string>

#include "imager/clean/clean.h"
#include "imager/data/extent.h"
#include "imager/plan/plan.h"
#include "ms_io/measurement_set.h"
#include "tools/run/run_report.h"

namespace misfit::tools {

/// The words of `misfit image` while it runs and at its end.

/// How many samples were left out, and why.
imager::Decision left_out_decision(const imager::SampleCounts& counts);

/// A warning that the antennas hardly see the image, since it lies 3 λ/D beyond where they pointed in the nearest field, or 10
/// degrees where D is unknown; else empty.
std::string pointing_warning(const ms_io::FieldPointing& nearest, const imager::ImageGeometry& geometry, double frequency_hz);

/// A warning that the image could not be made to the accuracy asked.
std::string accuracy_warning(double asked, double expected);

/// A line on the last major cycle: components, residual, noise, and whether it was taken back.
std::string cycle_message(const imager::CleanState& state);

/// A line on a plane of a cube that is done.
std::string channel_line(const ChannelReport& channel, int channels);

/// A line or two on a run that is over: samples, errors, and what CLEAN found.
std::string summary(const RunReport& report);

}  // namespace misfit::tools
