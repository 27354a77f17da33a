#pragma once

#include <string>

namespace misfit::tools {

/// `text` with & < > " ' replaced by their entities, and control characters by ?.
std::string html_escaped(const std::string& text);

/// The bytes as base64 (RFC 4648, section 4).
std::string base64(const std::string& bytes);

/// `value` as "3.2 × 10⁻⁷" in HTML, to so many significant digits; plain notation from 0.01 to 1000.
std::string html_power(double value, int digits = 2);

}  // namespace misfit::tools
