#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/eigen.hpp>
#include <limits>
#include <type_traits>

#if defined(__SIZEOF_FLOAT128__) && !defined(__STRICT_ANSI__) && __has_include(<quadmath.h>)
#include <boost/multiprecision/float128.hpp>
#endif

namespace misfit::kernels {

/// IEEE binary128: the compiler's type where it has one, which is five times as fast as a class.
#if defined(__SIZEOF_FLOAT128__) && !defined(__STRICT_ANSI__) && __has_include(<quadmath.h>)
using Quadruple = boost::multiprecision::number<boost::multiprecision::float128_backend, boost::multiprecision::et_off>;
#else
using Quadruple = std::conditional_t<
    std::numeric_limits<long double>::digits == 113, long double,
    boost::multiprecision::number<boost::multiprecision::cpp_bin_float<113, boost::multiprecision::digit_base_2>,
                                  boost::multiprecision::et_off> >;
#endif

/// 256 bits of mantissa, 77 digits.
using Binary256 = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<256, boost::multiprecision::digit_base_2>,
                                                boost::multiprecision::et_off>;

}  // namespace misfit::kernels
