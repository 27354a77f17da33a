#include "tools/formats/regions/ds9_properties.h"

#include <algorithm>
#include <array>
#include <string>

#include "tools/base/text.h"
#include "tools/formats/regions/words.h"

namespace misfit::tools::regions {
namespace {

/// Properties that viewers know, with one value.
constexpr std::array<std::string_view, 18> viewed{"text",     "color", "dash",   "width",     "font",       "select",
                                                  "highlite", "fixed", "edit",   "move",      "rotate",     "delete",
                                                  "tag",      "fill",  "format", "textangle", "textrotate", "composite"};
/// Properties of several values.
constexpr std::array<std::string_view, 11> viewed_lists{"dashlist", "callback", "line",   "vector", "ruler", "point",
                                                        "compass",  "panda",    "cpanda", "epanda", "bpanda"};

template <std::size_t count>
bool is_one_of(const std::array<std::string_view, count>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// The end of a text that begins at `begin` with a brace or a quote: behind its counterpart, or at the end of the text.
std::size_t end_of_quoted(std::string_view text, std::size_t begin) {
  const std::size_t end = text.find(text[begin] == '{' ? '}' : text[begin], begin + 1);
  return end == std::string_view::npos ? text.size() : end + 1;
}

/// The first place of `mark` outside of braces, and outside of quotes behind a #; or the end.
std::size_t find_mark(std::string_view text, char mark) {
  bool in_properties = false;
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] == mark) return i;
    in_properties = in_properties || text[i] == '#';
    const bool quoted = text[i] == '{' || (in_properties && (text[i] == '"' || text[i] == '\''));
    i = quoted ? end_of_quoted(text, i) : i + 1;
  }
  return text.size();
}

/// Takes a value off the beginning of `rest`: in braces or quotes, or up to white space.
std::string_view take_ds9_value(std::string_view& rest) {
  if (rest.empty()) return {};
  const bool quoted = rest.front() == '{' || rest.front() == '"' || rest.front() == '\'';
  const std::size_t end = quoted ? end_of_quoted(rest, 0) : std::min(rest.find_first_of(" \t"), rest.size());
  const std::string_view value = rest.substr(0, end);
  if (quoted && (end < 2 || value.back() != (value.front() == '{' ? '}' : value.front())))
    refuse(rest, "a closing quote or brace");
  rest = trimmed(rest.substr(end));
  return value;
}

bool yes_or_no(std::string_view name, std::string_view value) {
  if (value != "0" && value != "1") refuse(std::string(name) + "=" + std::string(value), "0 or 1");
  return value == "1";
}

/// True if `text` does not go on with a property: a name and an equals sign, or one of the two words.
bool goes_on(std::string_view text) {
  const std::string word = small_letters(take_word(text));
  return !text.starts_with('=') && word != "source" && word != "background";
}

void set(Ds9Properties& properties, const std::string& name, std::string_view value) {
  if (name == "include")
    properties.included = yes_or_no(name, value);
  else if (name == "source")
    properties.background = !yes_or_no(name, value);
  else if (name == "background")
    properties.background = yes_or_no(name, value);
  else if (name == "wcs" && small_letters(value) != "wcs")
    refuse("wcs=" + std::string(value), "wcs, which is all that images have here");
}

}  // namespace

std::vector<std::string_view> ds9_statements(std::string_view line) {
  std::vector<std::string_view> statements;
  while (!line.empty()) {
    const std::size_t end = find_mark(line, ';');
    if (const std::string_view statement = trimmed(line.substr(0, end)); !statement.empty()) statements.push_back(statement);
    line.remove_prefix(std::min(end + 1, line.size()));
  }
  return statements;
}

std::pair<std::string_view, std::string_view> split_ds9_properties(std::string_view statement) {
  const std::size_t end = find_mark(statement, '#');
  return {trimmed(statement.substr(0, end)), trimmed(statement.substr(std::min(end + 1, statement.size())))};
}

Ds9Properties parse_ds9_properties(std::string_view text) {
  Ds9Properties properties;
  std::string_view rest = trimmed(text);
  while (!rest.empty()) {
    const std::string_view whole = rest;
    const std::string name = small_letters(take_word(rest));
    const bool flag = name == "source" || name == "background", counts = flag || name == "include" || name == "wcs";
    if (flag && !rest.starts_with('=')) {
      set(properties, name, "1");
      continue;
    }
    if (whole.find('=') == std::string_view::npos && !name.empty()) break;  // a comment, which may stand behind properties
    const bool list = is_one_of(viewed_lists, name);
    if (!rest.starts_with('=') || !(counts || list || is_one_of(viewed, name)))
      refuse(whole, "properties of DS9's regions, such as color=green, text={a note} or source");
    rest = trimmed(rest.substr(1));
    const std::string_view value = take_ds9_value(rest);
    if (counts) set(properties, name, value);
    while (list && !rest.empty() && goes_on(rest)) take_ds9_value(rest);
  }
  return properties;
}

}  // namespace misfit::tools::regions
