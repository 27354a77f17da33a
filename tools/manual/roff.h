#pragma once

#include <string>

namespace misfit::tools {

/// Text as roff's man macros print it, in ASCII: other letters by their Unicode numbers, nothing taken for a request.
std::string roff_escaped(const std::string& text);

/// A manual page, section 1, as it grows.
class RoffPage {
 public:
  /// `name`: "misfit-image". `source`: the program with its version, at the foot.
  RoffPage(const std::string& name, const std::string& source);

  void section(const std::string& title);     ///< "OPTIONS"
  void subsection(const std::string& title);  ///< within a section
  void paragraph(const std::string& text);
  /// An explanation: the words that are typed, in bold, the words that are replaced, in italics, and the text.
  void item(const std::string& typed, const std::string& replaced, const std::string& text);
  void as_typed(const std::string& lines);                     ///< after a paragraph
  void raw(const std::string& line) { text_ += line + '\n'; }  ///< roff

  const std::string& text() const { return text_; }

 private:
  std::string text_;
  bool begun_ = false;  ///< whether the section has a paragraph
};

}  // namespace misfit::tools
