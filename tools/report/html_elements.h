#pragma once

#include <string>
#include <vector>

namespace misfit::tools::html {

/// All that is given here as content is HTML already.
std::string tag(const std::string& name, const std::string& content, const std::string& kind = "");

/// A heading and what follows; nothing without content.
std::string section(const std::string& title, const std::string& content);

using Row = std::vector<std::string>;

/// A table that scrolls sideways where it is too wide. Columns whose heading begins with # hold numbers.
std::string table(const Row& headings, const std::vector<Row>& rows);

/// The page's first line: its title, and what made it.
std::string header(const std::string& title, const std::string& made_by);

/// A whole page in the one style of all reports, without scripts or links.
std::string page(const std::string& title, const std::string& content);

}  // namespace misfit::tools::html
