#pragma once

#include <string>

namespace misfit::ms_io {

/// `text` with the letters a to z as A to Z, whatever the locale.
inline std::string capitals(std::string text) {
  for (char& letter : text)
    if (letter >= 'a' && letter <= 'z') letter = static_cast<char>(letter - 'a' + 'A');
  return text;
}

}  // namespace misfit::ms_io
