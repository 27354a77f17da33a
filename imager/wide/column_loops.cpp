#include "imager/wide/column_loops.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "imager/wide/column_loops.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace misfit::imager::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Calls body(tag, i) for whole vectors, and for the rest one by one.
template <typename Body>
HWY_ATTR void for_vectors(int count, const Body& body) {
  const hn::ScalableTag<double> wide;
  const int lanes = static_cast<int>(hn::Lanes(wide));
  int i = 0;
  for (; i + lanes <= count; i += lanes) body(wide, i);
  for (; i < count; ++i) body(hn::CappedTag<double, 1>(), i);
}

/// n − 1 less the facet's plane.
struct CurvatureLoop {
  const Facet& f;
  double l;
  double* q;

  template <typename D>
  HWY_ATTR void operator()(D d, int row) const {
    const ImageGeometry& g = f.geometry;
    const auto rows = hn::Add(hn::Iota(d, 0), hn::Set(d, static_cast<double>(row - g.centre_row())));
    const auto dm = hn::Mul(rows, hn::Set(d, g.cell_height_rad()));
    const auto m = hn::Add(dm, hn::Set(d, g.centre.m));
    const auto r2 = hn::MulAdd(m, m, hn::Set(d, l * l));
    const auto one = hn::Set(d, 1.0);
    const auto drop = hn::Div(r2, hn::Add(one, hn::Sqrt(hn::Sub(one, r2))));  // 1 − n
    const auto plane = hn::MulAdd(hn::Set(d, f.slope_m), dm, hn::Set(d, f.slope_l * (l - g.centre.l) + f.middle));
    hn::StoreU(hn::Neg(hn::Add(drop, plane)), d, q + row);
  }
};

/// Clenshaw's rule.
struct CorrectionLoop {
  const SmoothCorrection& series;
  double scale;
  const double* q;
  double* h;

  template <typename D>
  HWY_ATTR void operator()(D d, int i) const {
    const auto x = hn::Mul(hn::LoadU(d, q + i), hn::Set(d, scale));
    const auto z = hn::MulSub(hn::Mul(x, x), hn::Set(d, series.scale), hn::Set(d, 1.0));
    const auto twice = hn::Add(z, z);
    auto last = hn::Zero(d), before = last;
    for (std::size_t k = series.coefficient.size(); k-- > 1;) {
      const auto now = hn::MulAdd(twice, last, hn::Sub(hn::Set(d, series.coefficient[k]), before));
      before = last;
      last = now;
    }
    hn::StoreU(hn::MulAdd(z, last, hn::Sub(hn::Set(d, series.coefficient[0]), before)), d, h + i);
  }
};

template <typename D, typename V>
HWY_ATTR void load_complex(D d, const std::complex<double>* z, V& real, V& imaginary) {
  hn::LoadInterleaved2(d, reinterpret_cast<const double*>(z), real, imaginary);
}
template <typename D, typename V>
HWY_ATTR void load_complex(D d, const std::complex<float>* z, V& real, V& imaginary) {
  const hn::Rebind<float, D> narrow;
  hn::Vec<decltype(narrow)> re, im;
  hn::LoadInterleaved2(narrow, reinterpret_cast<const float*>(z), re, im);
  real = hn::PromoteTo(d, re);
  imaginary = hn::PromoteTo(d, im);
}
template <typename D, typename V>
HWY_ATTR void store_complex(D d, V real, V imaginary, std::complex<double>* z) {
  hn::StoreInterleaved2(real, imaginary, d, reinterpret_cast<double*>(z));
}
template <typename D, typename V>
HWY_ATTR void store_complex(D /*tag*/, V real, V imaginary, std::complex<float>* z) {
  const hn::Rebind<float, D> narrow;
  hn::StoreInterleaved2(hn::DemoteTo(narrow, real), hn::DemoteTo(narrow, imaginary), narrow, reinterpret_cast<float*>(z));
}

template <typename D, typename V>
HWY_ATTR void load_step(D d, const ColumnPhasors& half_step, int i, V& real, V& imaginary) {
  const auto re = hn::LoadU(d, half_step.real + i), im = hn::LoadU(d, half_step.imaginary + i);
  real = hn::MulSub(re, re, hn::Mul(im, im));
  imaginary = hn::Mul(hn::Add(re, re), im);
}

template <typename Real>
struct AddLoop {
  ColumnPhasors sum, half_step;
  const std::complex<Real>* value;

  template <typename D>
  HWY_ATTR void operator()(D d, int i) const {
    hn::Vec<D> re, im;
    load_complex(d, value + i, re, im);
    const auto sum_re = hn::LoadU(d, sum.real + i), sum_im = hn::LoadU(d, sum.imaginary + i);
    hn::Vec<D> step_re, step_im;
    load_step(d, half_step, i, step_re, step_im);
    hn::StoreU(hn::NegMulAdd(sum_im, step_im, hn::MulAdd(sum_re, step_re, re)), d, sum.real + i);
    hn::StoreU(hn::MulAdd(sum_im, step_re, hn::MulAdd(sum_re, step_im, im)), d, sum.imaginary + i);
  }
};

template <typename Real>
struct StoreLoop {
  ColumnPhasors sum, half_step;
  std::complex<Real>* value;

  template <typename D>
  HWY_ATTR void operator()(D d, int i) const {
    const auto sum_re = hn::LoadU(d, sum.real + i), sum_im = hn::LoadU(d, sum.imaginary + i);
    hn::Vec<D> step_re, step_im;
    load_step(d, half_step, i, step_re, step_im);
    store_complex(d, sum_re, sum_im, value + i);
    hn::StoreU(hn::MulAdd(sum_im, step_im, hn::Mul(sum_re, step_re)), d, sum.real + i);
    hn::StoreU(hn::NegMulAdd(sum_re, step_im, hn::Mul(sum_im, step_re)), d, sum.imaginary + i);
  }
};

HWY_ATTR void curvature(const Facet& f, double l, double* q) {
  for_vectors(f.geometry.height, CurvatureLoop{f, l, q});
}
HWY_ATTR void correction(const SmoothCorrection& series, double scale, const double* q, int count, double* h) {
  for_vectors(count, CorrectionLoop{series, scale, q, h});
}
HWY_ATTR void add_float(const ColumnPhasors& sum, const ColumnPhasors& half_step, const std::complex<float>* value, int count) {
  for_vectors(count, AddLoop<float>{sum, half_step, value});
}
HWY_ATTR void add_double(const ColumnPhasors& sum, const ColumnPhasors& half_step, const std::complex<double>* value,
                         int count) {
  for_vectors(count, AddLoop<double>{sum, half_step, value});
}
HWY_ATTR void store_float(const ColumnPhasors& sum, const ColumnPhasors& half_step, std::complex<float>* value, int count) {
  for_vectors(count, StoreLoop<float>{sum, half_step, value});
}
HWY_ATTR void store_double(const ColumnPhasors& sum, const ColumnPhasors& half_step, std::complex<double>* value, int count) {
  for_vectors(count, StoreLoop<double>{sum, half_step, value});
}

}  // namespace misfit::imager::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace misfit::imager {

HWY_EXPORT(curvature);
HWY_EXPORT(correction);
HWY_EXPORT(add_float);
HWY_EXPORT(add_double);
HWY_EXPORT(store_float);
HWY_EXPORT(store_double);

void curvature_of_column(const Facet& facet, int column, double* q) {
  HWY_DYNAMIC_DISPATCH(curvature)(facet, facet.geometry.l(column), q);
}
void correction_of_column(const SmoothCorrection& series, double scale, const double* q, int count, double* h) {
  HWY_DYNAMIC_DISPATCH(correction)(series, scale, q, count, h);
}
void turn_and_add(const ColumnPhasors& sum, const ColumnPhasors& half_step, const std::complex<float>* value, int count) {
  HWY_DYNAMIC_DISPATCH(add_float)(sum, half_step, value, count);
}
void turn_and_add(const ColumnPhasors& sum, const ColumnPhasors& half_step, const std::complex<double>* value, int count) {
  HWY_DYNAMIC_DISPATCH(add_double)(sum, half_step, value, count);
}
void store_and_turn(const ColumnPhasors& sum, const ColumnPhasors& half_step, std::complex<float>* value, int count) {
  HWY_DYNAMIC_DISPATCH(store_float)(sum, half_step, value, count);
}
void store_and_turn(const ColumnPhasors& sum, const ColumnPhasors& half_step, std::complex<double>* value, int count) {
  HWY_DYNAMIC_DISPATCH(store_double)(sum, half_step, value, count);
}

}  // namespace misfit::imager
#endif  // HWY_ONCE
