#pragma once

#include <complex>
#include <cstddef>
#include <memory>
#include <string>

namespace misfit::imager {

/// The smallest multiple of 4 that is a product of 2, 3, 5 and 7 and at least `size`: a length that FFTs take quickly
/// (FFTW 3.3.10 takes two to three times as long for 2250 as for 2240).
int fast_fft_size(int size);

/// Version of the FFTW that is linked: "3.3.10".
std::string fftw_library_version();

/// Unnormalised one-dimensional transforms of a fixed length, in place in a buffer of their own type. Any number of threads may
/// execute one plan at a time, each in its own buffer. `Real` is float or double.
template <typename Real>
class Fft {
 public:
  /// Memory aligned as the plans need it.
  struct Free {
    void operator()(void* memory) const;
  };
  using RealBuffer = std::unique_ptr<Real[], Free>;
  using ComplexBuffer = std::unique_ptr<std::complex<Real>[], Free>;

  /// Σ_p x_p exp(sign · 2πi pk/length), complex to complex.
  enum class Sign { forward = -1, backward = 1 };

  explicit Fft(int length);
  ~Fft();

  ComplexBuffer complex_buffer() const;  ///< [length]
  RealBuffer real_buffer() const;        ///< [length]
  void complex_to_complex(std::complex<Real>* buffer, Sign sign) const;
  /// X_k = Σ_p x_p exp(−2πi pk/length) for k = 0 … length/2.
  void real_to_complex(Real* in, std::complex<Real>* out) const;
  /// x_p = Re X_0 + 2 Σ_{0<k<length/2} Re(X_k exp(+2πi pk/length)) + Re X_{length/2} (−1)^p; destroys `in`.
  void complex_to_real(std::complex<Real>* in, Real* out) const;

 private:
  struct Plans;
  int length_;
  std::unique_ptr<Plans> plans_;
};

}  // namespace misfit::imager
