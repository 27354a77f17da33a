#pragma once

#include <optional>
#include <string>

namespace misfit::imager {

/// `text` as a FITS header may hold it (FITS 4.0, section 4.1.2): other letters, of UTF-8 or of one byte, become ?.
std::string header_text(const std::string& text);

/// A number as headers hold it (FITS 4.0, section 4.2.4), whatever the locale: "1.5", "+1.5D3"; infinite where it is too large.
/// None where the text is anything else.
std::optional<double> header_number(std::string text);

/// A value as it stands on a card without the quotes of a text, two of which are one within it, and blanks at its end.
std::string bare_header_value(std::string value);

/// True if two such values say the same: "33" and "33.0".
bool same_header_value(const std::string& one, const std::string& other);

/// The compression of a file that begins like this, and the program that uncompresses it, in words; empty where it is not
/// compressed.
std::string compression_of(const std::string& begin);

}  // namespace misfit::imager
