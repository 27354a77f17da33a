#include "tools/drawing/gnuplot.h"

#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include "tools/base/run_program.h"

namespace misfit::tools {

WorkFolder::WorkFolder(const std::filesystem::path& parent) {
  std::string name = (parent / ".pictures-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot write pictures in " + parent.string());
  path_ = name;
}

WorkFolder::~WorkFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string gnuplot_quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') result += '\'';
    result += c >= 0 && c < ' ' ? ' ' : c;
  }
  return result + "'";
}

std::string run_gnuplot(const WorkFolder& folder) {
  const std::optional<int> status = run_program({"gnuplot", "-d", "script"}, folder.path());  // -d: no user's settings
  if (!status) return "gnuplot is not installed";
  if (*status == 0) return "";
  std::ifstream said(folder.path() / "said");
  std::string line;
  while (line.find_first_not_of(" \t^") == std::string::npos && std::getline(said, line)) {
  }
  return "gnuplot failed: " + line;
}

}  // namespace misfit::tools
