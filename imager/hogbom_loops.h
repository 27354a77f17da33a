#pragma once

namespace misfit::imager {

/// residual[i] −= factor · psf[i] for i in [0, count); returns the largest |residual[i]| afterwards. NaN stays and is no peak.
float subtract_and_peak(float* residual, const float* psf, int count, float factor);

/// The largest |value[i]| for i in [0, count) that is not NaN; 0 where there is none.
float peak_magnitude(const float* value, int count);

}  // namespace misfit::imager
