#include "imager/data/phase_shift.h"

#include <cmath>

#include "imager/numerics/phasors.h"

namespace misfit::imager {
namespace {

double dot(const UvwAxes::Vector& a, const UvwAxes::Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

UvwAxes uvw_axes(const SkyDirection& phase_centre) {
  const double sin_ra = std::sin(phase_centre.ra_rad), cos_ra = std::cos(phase_centre.ra_rad);
  const double sin_dec = std::sin(phase_centre.dec_rad), cos_dec = std::cos(phase_centre.dec_rad);
  return {{-sin_ra, cos_ra, 0}, {-sin_dec * cos_ra, -sin_dec * sin_ra, cos_dec}, {cos_dec * cos_ra, cos_dec * sin_ra, sin_dec}};
}

PhaseShift::PhaseShift(const UvwAxes& from, const UvwAxes& to) : none_(from.u == to.u && from.v == to.v && from.w == to.w) {
  const auto seen = [&](const UvwAxes::Vector& axis) {
    return UvwAxes::Vector{dot(axis, from.u), dot(axis, from.v), dot(axis, from.w)};
  };
  rotation_ = {seen(to.u), seen(to.v), seen(to.w)};
  // From the difference of the two, which small shifts do not cancel in: |a − b|² = 2 − 2ab.
  const UvwAxes::Vector moved{to.w[0] - from.w[0], to.w[1] - from.w[1], to.w[2] - from.w[2]};
  to_ = {dot(moved, from.u), dot(moved, from.v), -dot(moved, moved) / 2};
}

void PhaseShift::rotate(std::vector<double>& uvw_m, RowRun rows) const {
  if (none_) return;
  for (std::size_t i = 3 * rows.first; i < 3 * (rows.first + rows.count); i += 3) {
    const UvwAxes::Vector old{uvw_m[i], uvw_m[i + 1], uvw_m[i + 2]};
    for (std::size_t axis = 0; axis < 3; ++axis) uvw_m[i + axis] = dot(rotation_[axis], old);
  }
}

template <typename T>
void PhaseShift::turn(const SampleCoordinates& old, const Turn& how, std::complex<T>* visibilities) const {
  const std::size_t channels = old.channels();
  std::vector<double> turns(channels), cosine(channels), sine(channels);
  for (std::size_t row = how.rows.first; row < how.rows.first + how.rows.count; ++row) {
    const double per_hz = how.sign * turns_per_hz(old.uvw_m.data() + 3 * row, to_);
    for (std::size_t c = 0; c < channels; ++c) turns[c] = per_hz * old.frequency_hz[c];
    phasors(turns.data(), static_cast<int>(channels), cosine.data(), sine.data());
    for (std::size_t c = 0; c < channels; ++c) {
      std::complex<T>& visibility = visibilities[row * channels + c];
      visibility = std::complex<T>(std::complex<double>(visibility) * std::complex<double>(cosine[c], sine[c]));
    }
  }
}

void PhaseShift::apply(VisibilityBlock& block, RowRun rows) const {
  if (none_) return;
  for (std::size_t s = 0; s < block.stokes(); ++s) turn(block, {-1, rows}, block.visibility.data() + s * block.samples());
  rotate(block.uvw_m.edit(), rows);
}

void PhaseShift::undo(const SampleCoordinates& old, std::vector<std::complex<double>>& visibilities, RowRun rows) const {
  if (!none_) turn(old, {1, rows}, visibilities.data());
}

void RowShifts::append(const PhaseShift& shift, std::size_t rows) {
  if (!runs_.empty() && runs_.back().shift == &shift) {
    runs_.back().rows.count += rows;
  } else {
    runs_.push_back({&shift, {runs_.empty() ? 0 : runs_.back().rows.first + runs_.back().rows.count, rows}});
  }
}

void RowShifts::rotate(std::vector<double>& uvw_m) const {
  for (const Run& run : runs_) run.shift->rotate(uvw_m, run.rows);
}

void RowShifts::apply(VisibilityBlock& block) const {
  for (const Run& run : runs_) run.shift->apply(block, run.rows);
}

void RowShifts::undo(const SampleCoordinates& old, std::vector<std::complex<double>>& visibilities) const {
  for (const Run& run : runs_) run.shift->undo(old, visibilities, run.rows);
}

}  // namespace misfit::imager
