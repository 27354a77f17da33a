#include "imager/numerics/fft.h"

#include <boost/mpl/list.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

BOOST_AUTO_TEST_SUITE(fft)

using namespace misfit::imager;

namespace {

using Exact = std::complex<long double>;
using Precisions = boost::mpl::list<float, double>;

constexpr int lengths[] = {2, 6, 64, 210, 3360};

/// exp(2πi k/n) for k = 0 … n − 1.
std::vector<Exact> roots(int n) {
  std::vector<Exact> root(static_cast<std::size_t>(n));
  for (std::size_t k = 0; k < root.size(); ++k)
    root[k] = std::polar(1.0L, 2 * std::acos(-1.0L) * static_cast<long double>(k) / n);
  return root;
}

/// Σ_p x_p exp(sign · 2πi pk/n), k = 0 … n − 1.
std::vector<Exact> plain_sum(const std::vector<Exact>& x, int sign) {
  const auto n = static_cast<int>(x.size());
  const std::vector<Exact> root = roots(n);
  std::vector<Exact> sum(x.size());
  for (int k = 0; k < n; ++k)
    for (int p = 0; p < n; ++p) {
      const Exact& turn = root[static_cast<std::size_t>(static_cast<long>(p) * k % n)];
      sum[static_cast<std::size_t>(k)] += x[static_cast<std::size_t>(p)] * (sign > 0 ? turn : std::conj(turn));
    }
  return sum;
}

template <typename Real>
std::vector<Exact> random_values(int n, bool complex) {
  std::mt19937_64 random(static_cast<unsigned>(n));
  std::normal_distribution<Real> normal;
  std::vector<Exact> x(static_cast<std::size_t>(n));
  for (Exact& value : x) value = {normal(random), complex ? normal(random) : Real(0)};
  return x;
}

/// ‖is − should‖₂ / ‖should‖₂ over the first values.
template <typename T>
double relative_error(const T& is, const std::vector<Exact>& should, std::size_t count) {
  long double difference = 0, size = 0;
  for (std::size_t i = 0; i < count; ++i) {
    difference += std::norm(Exact(is[i]) - should[i]);
    size += std::norm(should[i]);
  }
  return static_cast<double>(std::sqrt(difference / size));
}

/// Each of the log2(n) stages rounds once and multiplies by a rounded root.
template <typename Real>
double rounding(int n) {
  return 2 * std::numeric_limits<Real>::epsilon() * std::log2(2.0 * n);
}

bool is_seven_smooth(int n) {
  for (const int factor : {2, 3, 5, 7})
    while (n % factor == 0) n /= factor;
  return n == 1;
}

}  // namespace

BOOST_AUTO_TEST_CASE_TEMPLATE(complex_transforms_equal_the_plain_sum_with_either_sign, Real, Precisions) {
  using Sign = typename Fft<Real>::Sign;
  for (const int n : lengths)
    for (const Sign sign : {Sign::forward, Sign::backward}) {
      const Fft<Real> fft(n);
      const std::vector<Exact> x = random_values<Real>(n, true);
      const auto buffer = fft.complex_buffer();
      for (std::size_t i = 0; i < x.size(); ++i) buffer[i] = std::complex<Real>(x[i]);
      fft.complex_to_complex(buffer.get(), sign);
      BOOST_TEST_INFO("length " << n << " sign " << static_cast<int>(sign));
      BOOST_TEST(relative_error(buffer, plain_sum(x, static_cast<int>(sign)), x.size()) < rounding<Real>(n));
    }
}

BOOST_AUTO_TEST_CASE_TEMPLATE(real_to_complex_is_the_forward_sum_of_half_the_frequencies, Real, Precisions) {
  for (const int n : lengths) {
    const Fft<Real> fft(n);
    const std::vector<Exact> x = random_values<Real>(n, false);
    const auto in = fft.real_buffer();
    for (std::size_t i = 0; i < x.size(); ++i) in[i] = static_cast<Real>(x[i].real());
    const auto out = fft.complex_buffer();
    fft.real_to_complex(in.get(), out.get());
    BOOST_TEST_INFO("length " << n);
    BOOST_TEST(relative_error(out, plain_sum(x, -1), x.size() / 2 + 1) < rounding<Real>(n));
  }
}

BOOST_AUTO_TEST_CASE_TEMPLATE(complex_to_real_doubles_all_but_the_first_and_last_frequency, Real, Precisions) {
  for (const int n : lengths) {
    const Fft<Real> fft(n);
    const std::vector<Exact> x = random_values<Real>(n, true);
    const auto half = static_cast<std::size_t>(n / 2);
    const auto in = fft.complex_buffer();
    for (std::size_t k = 0; k <= half; ++k) in[k] = std::complex<Real>(x[k]);
    // The documented sum is that of the spectrum made Hermitian.
    std::vector<Exact> spectrum = x;
    spectrum[0] = x[0].real();
    spectrum[half] = x[half].real();
    for (std::size_t k = 1; k < half; ++k) spectrum[x.size() - k] = std::conj(x[k]);
    const auto out = fft.real_buffer();
    fft.complex_to_real(in.get(), out.get());
    BOOST_TEST_INFO("length " << n);
    BOOST_TEST(relative_error(out, plain_sum(spectrum, 1), x.size()) < rounding<Real>(n));
  }
}

BOOST_AUTO_TEST_CASE(fast_size_is_the_smallest_multiple_of_four_that_is_seven_smooth_and_suffices) {
  for (int size = 1; size <= 5000; ++size) {
    int expected = size;
    while (expected % 4 != 0 || !is_seven_smooth(expected)) ++expected;
    BOOST_REQUIRE_EQUAL(fast_fft_size(size), expected);
  }
}

BOOST_AUTO_TEST_SUITE_END()
