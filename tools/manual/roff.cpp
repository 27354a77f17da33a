#include "tools/manual/roff.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdio>
#include <map>

namespace misfit::tools {
namespace {

/// The letter of UTF-8 text that begins at `at`, which moves behind it.
std::uint32_t next_letter(const std::string& text, std::size_t& at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const std::uint32_t first = byte(at++);
  if (first < 0x80) return first;
  const int more = first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : 1;
  std::uint32_t letter = first & (0x3fU >> more);
  for (int i = 0; i < more && at < text.size(); ++i) letter = letter << 6 | (byte(at++) & 0x3fU);
  return letter;
}

/// Letters that roff would take for others: hyphens for places to break a line, quotes for curly ones.
const std::map<std::uint32_t, const char*> special{{'\\', "\\e"},  {'-', "\\-"},   {'\'', "\\(aq"}, {'`', "\\(ga"},
                                                   {'^', "\\(ha"}, {'~', "\\(ti"}, {'"', "\\(dq"}};

}  // namespace

std::string roff_escaped(const std::string& text) {
  std::string escaped;
  for (std::size_t at = 0; at < text.size();) {
    const std::uint32_t letter = next_letter(text, at);
    if (const auto found = special.find(letter); found != special.end()) {
      escaped += found->second;
    } else if (letter < 0x80) {
      if (letter == '.' && (escaped.empty() || escaped.back() == '\n')) escaped += "\\&";
      escaped += static_cast<char>(letter);
    } else {
      char code[16];
      std::snprintf(code, sizeof code, "\\[u%04X]", letter);
      escaped += code;
    }
  }
  return escaped;
}

RoffPage::RoffPage(const std::string& name, const std::string& source) {
  std::string title = name;
  std::transform(title.begin(), title.end(), title.begin(), [](unsigned char c) { return std::toupper(c); });
  raw(".TH " + roff_escaped(title) + " 1 \"\" \"" + roff_escaped(source) + "\" \"User commands\"");
  raw(".nh");    // words are broken nowhere,
  raw(".ad l");  // and lines not filled with blanks, which leaves them their lengths
}

void RoffPage::section(const std::string& title) {
  begun_ = false;
  raw(".SH " + roff_escaped(title));
}

void RoffPage::subsection(const std::string& title) {
  raw(".SS \"" + roff_escaped(title) + '"');
}

void RoffPage::paragraph(const std::string& text) {
  if (begun_) raw(".PP");
  begun_ = true;
  raw(roff_escaped(text));
}

void RoffPage::item(const std::string& typed, const std::string& replaced, const std::string& text) {
  raw(".TP");
  raw("\\fB" + roff_escaped(typed) + "\\fR" + (replaced.empty() ? "" : " \\fI" + roff_escaped(replaced) + "\\fR"));
  raw(roff_escaped(text));
}

void RoffPage::as_typed(const std::string& lines) {
  raw(".RS 4");
  raw(".nf");
  raw(roff_escaped(lines));
  raw(".fi");
  raw(".RE");
}

}  // namespace misfit::tools
