#pragma once

#include <sys/resource.h>

#include <boost/test/unit_test.hpp>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>

namespace misfit::ms_io::testing {

inline std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline double peak_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// The header of the table's tiles, which is the only one that is `manager`'s.
inline std::string header_of(const std::string& table, const std::string& manager) {
  for (const auto& entry : std::filesystem::directory_iterator(table))
    if (entry.is_regular_file() && bytes_of(entry.path()).find(manager) < 64) return entry.path();
  BOOST_FAIL(table << " has no " << manager);
  return "";
}

/// Puts bytes of a file in the place of others.
inline void put_bytes(const std::string& path, std::size_t at, const std::string& bytes) {
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(static_cast<std::streamoff>(at));
  file << bytes;
}

/// Puts bytes in the place of the only others that are these, which are as many.
inline void replace_bytes(const std::string& path, const std::string& held, const std::string& bytes) {
  const std::string whole = bytes_of(path);
  const std::size_t at = whole.find(held);
  BOOST_REQUIRE(at != std::string::npos);
  BOOST_REQUIRE(whole.find(held, at + 1) == std::string::npos);
  put_bytes(path, at, bytes);
}

/// Has `read` read the table with every four bytes of a file of it as each of some numbers: it returns, or refuses.
inline void check_every_number(const std::string& file, const std::function<void()>& read) {
  const std::string whole = bytes_of(file);
  read();
  const double before = peak_mib();
  int refused = 0;
  for (const std::string& number : {std::string("\0\0\0\0", 4), std::string("\x7f\xff\xff\xff"),
                                    std::string("\xff\xff\xff\xff"), std::string("\0\0\x01\0", 4)})
    for (std::size_t at = 0; at + 4 <= whole.size(); ++at) {
      const std::string held = whole.substr(at, 4);
      if (held == number) continue;
      put_bytes(file, at, number);
      BOOST_TEST_CONTEXT("byte " << at) try { read(); } catch (const std::exception&) {  // casacore's, where it is not ours
        ++refused;
      }
      put_bytes(file, at, held);
    }
  BOOST_TEST(refused > 0);
  const double reached = 400;  // sanitizers keep what was given back
  BOOST_TEST(peak_mib() < before + reached);
  read();
}

}  // namespace misfit::ms_io::testing
