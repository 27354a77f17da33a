#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

namespace misfit::fuzz {

/// Ends the process where a promise does not hold: fuzzers and replays count that as a find.
inline void require(bool holds, const std::string& promise) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", promise.c_str());
  std::abort();
}

/// A file that holds what was handed in, in the folder for temporary files; every input has the same name.
class InputFile {
 public:
  InputFile(const std::uint8_t* data, std::size_t size, const std::string& name) {
    static const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("misfit-fuzz-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    path_ = (folder / name).string();
    std::ofstream file(path_, std::ios::binary);
    file.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    file.close();
    require(file.good(), "input can be written to " + path_);
  }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  ~InputFile() { std::filesystem::remove_all(folder()); }

  const std::string& path() const { return path_; }
  std::filesystem::path folder() const { return std::filesystem::path(path_).parent_path(); }

 private:
  std::string path_;
};

/// Whether the program can print this as its one line, of text and tabs, and it says what it is about.
inline void require_message(const std::exception& error, const std::string& about) {
  const std::string_view said = error.what();
  const auto control = [](char c) { return (static_cast<unsigned char>(c) < ' ' && c != '\t') || c == '\x7f'; };
  require(!said.empty(), "a message says something");
  for (const char c : said) require(!control(c), "a message is one line of text: " + std::string(said));
  require(said.find(about) != std::string_view::npos, "a message names " + about + ": " + std::string(said));
}

/// What `read` returns, or nothing where it throws what the program prints. `about`: what the message must name.
template <typename Read>
auto read_or_refused(const std::string& about, const Read& read) -> std::optional<decltype(read())> {
  try {
    return read();
  } catch (const std::exception& error) {
    require_message(error, about);
  }
  return std::nullopt;
}

}  // namespace misfit::fuzz
