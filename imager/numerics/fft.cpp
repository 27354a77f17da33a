#include "imager/numerics/fft.h"

#include <fftw3.h>

#include <mutex>
#include <stdexcept>
#include <string>

namespace misfit::imager {
namespace {

/// FFTW's two precisions under one name. FFTW_ESTIMATE plans do not depend on timings, and for one contiguous row they are as
/// fast as measured plans.
template <typename Real>
struct Fftw;

template <>
struct Fftw<double> {
  using Plan = fftw_plan;
  using Complex = fftw_complex;
  static constexpr auto complex_plan = fftw_plan_dft_1d;
  static constexpr auto forward_plan = fftw_plan_dft_r2c_1d;
  static constexpr auto backward_plan = fftw_plan_dft_c2r_1d;
  static constexpr auto execute_complex = fftw_execute_dft;
  static constexpr auto execute_forward = fftw_execute_dft_r2c;
  static constexpr auto execute_backward = fftw_execute_dft_c2r;
  static constexpr auto destroy = fftw_destroy_plan;
};

template <>
struct Fftw<float> {
  using Plan = fftwf_plan;
  using Complex = fftwf_complex;
  static constexpr auto complex_plan = fftwf_plan_dft_1d;
  static constexpr auto forward_plan = fftwf_plan_dft_r2c_1d;
  static constexpr auto backward_plan = fftwf_plan_dft_c2r_1d;
  static constexpr auto execute_complex = fftwf_execute_dft;
  static constexpr auto execute_forward = fftwf_execute_dft_r2c;
  static constexpr auto execute_backward = fftwf_execute_dft_c2r;
  static constexpr auto destroy = fftwf_destroy_plan;
};

/// FFTW's planner, unlike its plans, may be used by one thread at a time.
std::mutex& planner_mutex() {
  static std::mutex mutex;
  return mutex;
}

template <typename T>
T* allocate(std::size_t count) {
  void* memory = fftw_malloc(count * sizeof(T));
  if (memory == nullptr) throw std::bad_alloc();
  return static_cast<T*>(memory);
}

template <typename Real>
typename Fftw<Real>::Complex* fftw_cast(std::complex<Real>* z) {
  return reinterpret_cast<typename Fftw<Real>::Complex*>(z);
}

}  // namespace

int fast_fft_size(int size) {
  for (int candidate = (size + 3) / 4 * 4;; candidate += 4) {
    int rest = candidate;
    for (const int factor : {2, 3, 5, 7})
      while (rest % factor == 0) rest /= factor;
    if (rest == 1) return candidate;
  }
}

std::string fftw_library_version() {
  const std::string name = fftw_version;  // fftw-3.3.10-sse2-avx
  const std::size_t begin = name.find('-') + 1;
  return name.substr(begin, name.find('-', begin) - begin);
}

template <typename Real>
struct Fft<Real>::Plans {
  typename Fftw<Real>::Plan forward;
  typename Fftw<Real>::Plan backward;
  typename Fftw<Real>::Plan real_to_complex;
  typename Fftw<Real>::Plan complex_to_real;
};

template <typename Real>
void Fft<Real>::Free::operator()(void* memory) const {
  fftw_free(memory);
}

template <typename Real>
Fft<Real>::Fft(int length) : length_(length), plans_(std::make_unique<Plans>()) {
  const ComplexBuffer z = complex_buffer();
  const RealBuffer x = real_buffer();
  const std::lock_guard lock(planner_mutex());
  plans_->forward = Fftw<Real>::complex_plan(length, fftw_cast(z.get()), fftw_cast(z.get()), FFTW_FORWARD, FFTW_ESTIMATE);
  plans_->backward = Fftw<Real>::complex_plan(length, fftw_cast(z.get()), fftw_cast(z.get()), FFTW_BACKWARD, FFTW_ESTIMATE);
  plans_->real_to_complex = Fftw<Real>::forward_plan(length, x.get(), fftw_cast(z.get()), FFTW_ESTIMATE);
  plans_->complex_to_real = Fftw<Real>::backward_plan(length, fftw_cast(z.get()), x.get(), FFTW_ESTIMATE);
  if (!plans_->forward || !plans_->backward || !plans_->real_to_complex || !plans_->complex_to_real)
    throw std::runtime_error("FFTW has no plan for length " + std::to_string(length));
}

template <typename Real>
Fft<Real>::~Fft() {
  const std::lock_guard lock(planner_mutex());
  for (const auto plan : {plans_->forward, plans_->backward, plans_->real_to_complex, plans_->complex_to_real})
    Fftw<Real>::destroy(plan);
}

template <typename Real>
typename Fft<Real>::ComplexBuffer Fft<Real>::complex_buffer() const {
  return ComplexBuffer(allocate<std::complex<Real>>(static_cast<std::size_t>(length_)));
}

template <typename Real>
typename Fft<Real>::RealBuffer Fft<Real>::real_buffer() const {
  return RealBuffer(allocate<Real>(static_cast<std::size_t>(length_)));
}

template <typename Real>
void Fft<Real>::complex_to_complex(std::complex<Real>* buffer, Sign sign) const {
  Fftw<Real>::execute_complex(sign == Sign::forward ? plans_->forward : plans_->backward, fftw_cast(buffer), fftw_cast(buffer));
}

template <typename Real>
void Fft<Real>::real_to_complex(Real* in, std::complex<Real>* out) const {
  Fftw<Real>::execute_forward(plans_->real_to_complex, in, fftw_cast(out));
}

template <typename Real>
void Fft<Real>::complex_to_real(std::complex<Real>* in, Real* out) const {
  Fftw<Real>::execute_backward(plans_->complex_to_real, fftw_cast(in), out);
}

template class Fft<float>;
template class Fft<double>;

}  // namespace misfit::imager
