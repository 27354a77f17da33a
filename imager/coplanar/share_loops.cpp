#include "imager/coplanar/share_loops.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "imager/numerics/constants.h"

// Highway compiles what stands inside HWY_NAMESPACE once for every instruction set and chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "imager/coplanar/share_loops.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace misfit::imager::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <typename Real>
using ShareTag = hn::CappedTag<Real, 16>;

constexpr std::size_t room = most_shared_images + 16;  // for whole vectors

/// Shares of one sample, in vectors from image to image.
template <typename Real>
class OneShare {
 public:
  HWY_INLINE OneShare(const SharePlaces<Real>& places, int sample)
      : from_(places.from[sample]), part_(places.part_stride), point_(places.point_stride) {
    for (int p = 0; p < ShareTable::points; ++p) weight_[p] = places.weight[p][sample];
    phase_real_ = places.phase_real[sample];
    phase_imaginary_ = places.phase_imaginary[sample];
    sign_ = places.sign[sample];
  }

  /// c of the images from k on.
  template <typename Vector>
  HWY_ATTR HWY_INLINE void get(std::size_t k, Vector& real, Vector& imaginary) const {
    const ShareTag<Real> d;
    Vector re = hn::Mul(hn::Set(d, weight_[0]), hn::LoadU(d, from_ + k));
    Vector im = hn::Mul(hn::Set(d, weight_[0]), hn::LoadU(d, from_ + part_ + k));
    for (std::size_t p = 1; p < ShareTable::points; ++p) {
      const auto weight = hn::Set(d, weight_[p]);
      re = hn::MulAdd(weight, hn::LoadU(d, from_ + p * point_ + k), re);
      im = hn::MulAdd(weight, hn::LoadU(d, from_ + p * point_ + part_ + k), im);
    }
    im = hn::Mul(im, hn::Set(d, sign_));
    const auto cosine = hn::Set(d, phase_real_), sine = hn::Set(d, phase_imaginary_);
    real = hn::NegMulAdd(sine, im, hn::Mul(cosine, re));
    imaginary = hn::MulAdd(sine, re, hn::Mul(cosine, im));
  }

 private:
  const Real* from_;
  std::size_t part_;
  std::size_t point_;
  Real weight_[ShareTable::points];
  Real phase_real_;
  Real phase_imaginary_;
  Real sign_;
};

template <typename Real, int Capacity>
HWY_ATTR void share_out_all(const SharePlaces<Real>& places, const SharedValues<Real>& values, Real (*planes)[Capacity]) {
  const ShareTag<Real> d;
  Real real[room], imaginary[room];
  for (int i = 0; i < places.count; ++i) {
    const OneShare<Real> share(places, i);
    const auto v_real = hn::Set(d, values.real[i]), v_imaginary = hn::Set(d, values.imaginary[i]);
    for (std::size_t k = 0; k < places.images; k += hn::Lanes(d)) {
      auto c = hn::Zero(d), s = hn::Zero(d);
      share.get(k, c, s);
      hn::StoreU(hn::MulAdd(c, v_real, hn::Mul(s, v_imaginary)), d, real + k);
      hn::StoreU(hn::NegMulAdd(s, v_real, hn::Mul(c, v_imaginary)), d, imaginary + k);
    }
    for (std::size_t k = 0; k < places.images; ++k) {
      planes[2 * k][i] = real[k];
      planes[2 * k + 1][i] = places.on_grid[i] * imaginary[k];
    }
  }
}

template <typename Real, int Capacity>
HWY_ATTR void bring_together_all(const SharePlaces<Real>& places, Real (*planes)[Capacity], SharedValues<Real>& values) {
  const ShareTag<Real> d;
  Real real[room] = {}, imaginary[room] = {};
  for (int i = 0; i < places.count; ++i) {
    for (std::size_t k = 0; k < places.images; ++k) {
      real[k] = planes[2 * k][i];
      imaginary[k] = places.on_grid[i] * planes[2 * k + 1][i];
    }
    const OneShare<Real> share(places, i);
    auto sum_real = hn::Zero(d), sum_imaginary = hn::Zero(d);
    for (std::size_t k = 0; k < places.images; k += hn::Lanes(d)) {
      auto c = hn::Zero(d), s = hn::Zero(d);
      share.get(k, c, s);
      const auto re = hn::LoadU(d, real + k), im = hn::LoadU(d, imaginary + k);
      sum_real = hn::NegMulAdd(s, im, hn::MulAdd(c, re, sum_real));
      sum_imaginary = hn::MulAdd(s, re, hn::MulAdd(c, im, sum_imaginary));
    }
    values.real[i] = hn::GetLane(hn::SumOfLanes(d, sum_real));
    values.imaginary[i] = hn::GetLane(hn::SumOfLanes(d, sum_imaginary));
  }
}

/// Lagrange's weights of points at −2, −1 … 3 for t in [0, 1).
template <typename Real>
HWY_ATTR void set_weights(const Real* t, int count, Real (*weight)[SharePlaces<Real>::capacity]) {
  const ShareTag<Real> tag;
  const auto times = [&](auto x, double factor) { return hn::Mul(x, hn::Set(tag, static_cast<Real>(factor))); };
  for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(tag))) {
    const auto c = hn::LoadU(tag, t + i);
    const auto a = hn::Add(c, hn::Set(tag, Real(2))), b = hn::Add(c, hn::Set(tag, Real(1)));
    const auto d = hn::Sub(c, hn::Set(tag, Real(1))), e = hn::Sub(c, hn::Set(tag, Real(2))),
               f = hn::Sub(c, hn::Set(tag, Real(3)));
    const auto ab = hn::Mul(a, b), ef = hn::Mul(e, f), cd = hn::Mul(c, d);
    hn::StoreU(times(hn::Mul(hn::Mul(b, cd), ef), -1.0 / 120), tag, weight[0] + i);
    hn::StoreU(times(hn::Mul(hn::Mul(a, cd), ef), 1.0 / 24), tag, weight[1] + i);
    hn::StoreU(times(hn::Mul(hn::Mul(ab, d), ef), -1.0 / 12), tag, weight[2] + i);
    hn::StoreU(times(hn::Mul(hn::Mul(ab, c), ef), 1.0 / 12), tag, weight[3] + i);
    hn::StoreU(times(hn::Mul(hn::Mul(ab, cd), f), -1.0 / 24), tag, weight[4] + i);
    hn::StoreU(times(hn::Mul(hn::Mul(ab, cd), e), 1.0 / 120), tag, weight[5] + i);
  }
}

HWY_ATTR void weights_float(const float* t, int count, float (*weight)[SharePlaces<float>::capacity]) {
  set_weights(t, count, weight);
}
HWY_ATTR void weights_double(const double* t, int count, double (*weight)[SharePlaces<double>::capacity]) {
  set_weights(t, count, weight);
}
HWY_ATTR void share_out_float(const SharePlaces<float>& places, const SharedValues<float>& values,
                              float (*planes)[SharedValues<float>::capacity]) {
  share_out_all(places, values, planes);
}
HWY_ATTR void share_out_double(const SharePlaces<double>& places, const SharedValues<double>& values,
                               double (*planes)[SharedValues<double>::capacity]) {
  share_out_all(places, values, planes);
}
HWY_ATTR void bring_together_float(const SharePlaces<float>& places, float (*planes)[SharedValues<float>::capacity],
                                   SharedValues<float>& values) {
  bring_together_all(places, planes, values);
}
HWY_ATTR void bring_together_double(const SharePlaces<double>& places, double (*planes)[SharedValues<double>::capacity],
                                    SharedValues<double>& values) {
  bring_together_all(places, planes, values);
}

}  // namespace misfit::imager::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace misfit::imager {

HWY_EXPORT(weights_float);
HWY_EXPORT(weights_double);
HWY_EXPORT(share_out_float);
HWY_EXPORT(share_out_double);
HWY_EXPORT(bring_together_float);
HWY_EXPORT(bring_together_double);

namespace {

void weights(const float* t, int count, float (*weight)[SharePlaces<float>::capacity]) {
  HWY_DYNAMIC_DISPATCH(weights_float)(t, count, weight);
}
void weights(const double* t, int count, double (*weight)[SharePlaces<double>::capacity]) {
  HWY_DYNAMIC_DISPATCH(weights_double)(t, count, weight);
}

}  // namespace

template <typename Real>
SharePlaces<Real>::SharePlaces(const SampleShares& shares, const SampleCoordinates& at, const std::size_t* sample,
                               const bool* conjugate, int samples)
    : count(samples),
      images(shares.images),
      point_stride(shares.of_channel.front()->point_stride()),
      part_stride(shares.of_channel.front()->part_stride()) {
  const std::size_t channels = at.channels();
  const double steps = shares.steps_a_wavelength / speed_of_light_m_s;
  Real within[capacity];
  std::size_t row = 0, channel = 0, next = 0;  // samples mostly follow one another along a row
  for (int i = 0; i < samples; ++i) {
    if (i > 0 && sample[i] == next && channel + 1 < channels) {
      ++channel;
    } else {
      row = sample[i] / channels;
      channel = sample[i] % channels;
    }
    next = sample[i] + 1;
    const double w = at.uvw_m[3 * row + 2] * at.frequency_hz[channel] * steps, place = std::abs(w);
    const ShareTable& table = *shares.of_channel[channel];
    if (!(place < static_cast<double>(table.last()) + 1))
      throw std::invalid_argument("a sample has w of " + std::to_string(place / shares.steps_a_wavelength) +
                                  " wavelengths over its pointing's plane; expected " +
                                  std::to_string(static_cast<double>(table.last()) / shares.steps_a_wavelength) + " at most");
    const auto step = static_cast<std::size_t>(place);
    within[i] = static_cast<Real>(place - static_cast<double>(step));
    from[i] = table.at(step, Real()) + shares.first;
    sign[i] = w < 0 ? Real(-1) : Real(1);
    on_grid[i] = conjugate[i] ? Real(1) : Real(-1);
    phase_real[i] = static_cast<Real>(shares.phase[sample[i]].real());
    phase_imaginary[i] = static_cast<Real>(shares.phase[sample[i]].imag());
  }
  weights(within, samples, weight);
}
template struct SharePlaces<float>;
template struct SharePlaces<double>;

void share_out(const SharePlaces<float>& places, const SharedValues<float>& values,
               float (*planes)[SharedValues<float>::capacity]) {
  HWY_DYNAMIC_DISPATCH(share_out_float)(places, values, planes);
}
void share_out(const SharePlaces<double>& places, const SharedValues<double>& values,
               double (*planes)[SharedValues<double>::capacity]) {
  HWY_DYNAMIC_DISPATCH(share_out_double)(places, values, planes);
}
void bring_together(const SharePlaces<float>& places, float (*planes)[SharedValues<float>::capacity],
                    SharedValues<float>& values) {
  HWY_DYNAMIC_DISPATCH(bring_together_float)(places, planes, values);
}
void bring_together(const SharePlaces<double>& places, double (*planes)[SharedValues<double>::capacity],
                    SharedValues<double>& values) {
  HWY_DYNAMIC_DISPATCH(bring_together_double)(places, planes, values);
}

}  // namespace misfit::imager
#endif  // HWY_ONCE
