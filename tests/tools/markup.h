#pragma once

#include <set>
#include <string>
#include <vector>

namespace misfit::tools::testing {

inline bool contains(const std::string& page, const std::string& text) {
  return page.find(text) != std::string::npos;
}

/// Whether every element that is opened is closed, in the right order; attributes hold no '>'.
inline bool balanced(const std::string& page) {
  const std::set<std::string> empty_elements{"meta", "img", "!DOCTYPE", "?xml"};
  std::vector<std::string> open;
  for (std::size_t at = page.find('<'); at != std::string::npos; at = page.find('<', at + 1)) {
    const bool closes = page[at + 1] == '/';
    const std::size_t start = at + (closes ? 2 : 1);
    const std::string name = page.substr(start, page.find_first_of(" >\n\t", start) - start);
    const bool closes_itself = page[page.find('>', at) - 1] == '/';
    if (closes) {
      if (open.empty() || open.back() != name) return false;
      open.pop_back();
    } else if (!empty_elements.contains(name) && !closes_itself) {
      open.push_back(name);
    }
  }
  return open.empty();
}

/// The ids of all elements, in quotes of either kind.
inline std::vector<std::string> ids_of(const std::string& page) {
  std::vector<std::string> ids;
  for (std::size_t at = page.find(" id="); at != std::string::npos; at = page.find(" id=", at + 1))
    ids.push_back(page.substr(at + 5, page.find(page[at + 4], at + 5) - at - 5));
  return ids;
}

}  // namespace misfit::tools::testing
