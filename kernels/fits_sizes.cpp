#include "kernels/fits_sizes.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace misfit::kernels {
namespace {

constexpr std::size_t block = 2880, card_size = 80;
constexpr int most_axes = 999, most_columns = 999;

[[noreturn]] void fail(const std::string& reason) {
  throw std::runtime_error(reason);
}

std::uint64_t blocks(std::uint64_t bytes) {
  return (bytes + block - 1) / block * block;
}

/// The cards of a header, of which a block at a time is read.
class Header {
 public:
  Header(const FitsBytes& file, std::uint64_t begin) : file_(file), begin_(begin) {}

  std::string next() {
    if (at_ % block == 0) read_ = file_.read(begin_ + at_, block);
    std::string card = read_.substr(std::min<std::size_t>(at_ % block, read_.size()), card_size);
    if (card.size() < card_size) fail("it was cut short within a header");
    at_ += card_size;
    return card;
  }
  /// The value of the next card, which must have this key.
  long long whole(const std::string& key, long long least, long long most) { return whole_of(next(), key, least, most); }
  /// Goes to the card END. Returns the size of the header. The heap of a table may begin anywhere in `data` bytes. Cards that
  /// give sizes, or begin a header, may occur once: a header that lacks its END goes on into the next one.
  /// CFITSIO believes PCOUNT and GCOUNT of a primary header, too, wherever they stand.
  std::uint64_t end(double data, bool is_extension) {
    constexpr std::array once{"SIMPLE", "XTENSION", "BITPIX", "NAXIS"};
    std::string card = next();
    for (std::string key = key_of(card); key != "END"; key = key_of(card)) {
      const bool counts = key == "PCOUNT" || key == "GCOUNT";
      if (std::find(once.begin(), once.end(), key) != once.end() || (counts && is_extension))
        fail("a header has " + key + " where no other begins");
      if (counts) whole_of(card, key, key == "GCOUNT" ? 1 : 0, key == "GCOUNT" ? 1 : 0);
      if (key == "THEAP") whole_of(card, "THEAP", 0, static_cast<long long>(std::min(data, 1e18)));
      card = next();
    }
    if (card.find_first_not_of(' ', 3) != std::string::npos) fail("END has a value");
    return blocks(at_);
  }

 private:
  /// The keyword as CFITSIO reads it, whatever follows.
  static std::string key_of(const std::string& card) {
    return card.substr(0, std::min<std::size_t>(8, card.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-")));
  }
  static long long whole_of(const std::string& card, const std::string& key, long long least, long long most) {
    std::string padded = key;
    padded.resize(8, ' ');
    if (card.compare(0, 10, padded + "= ") != 0) fail("a header has no " + key + " where one is due");
    const std::string value = card.substr(10);
    const std::size_t first = value.find_first_not_of(' '), end = value.find_first_of(" /", first);
    const std::string number = first == std::string::npos ? "" : value.substr(first, end - first);
    char* parsed = nullptr;
    const long long found = std::strtoll(number.c_str(), &parsed, 10);  // saturates, and is refused
    const bool is_whole = number.find_first_not_of("+-0123456789") == std::string::npos && *parsed == '\0';
    if (number.empty() || !is_whole) fail(key + " cannot be understood: it is no whole number");
    if (found < least || found > most)
      fail(key + " is " + number + ", expected " + std::to_string(least) + " to " + std::to_string(most));
    return found;
  }
  const FitsBytes& file_;
  std::uint64_t begin_;
  std::uint64_t at_ = 0;
  std::string read_;  ///< the block that holds at_ − 1
};

/// Header and data of the HDU that begins at `begin`.
std::uint64_t hdu_size(const FitsBytes& file, std::uint64_t begin) {
  constexpr long long any = 1LL << 62;
  Header cards(file, begin);
  const std::string first = cards.next();
  const long long bits = cards.whole("BITPIX", -64, 64);
  const long long axes = cards.whole("NAXIS", 0, most_axes);
  double data = axes == 0 ? 0 : static_cast<double>(std::llabs(bits)) / 8;
  for (long long axis = 1; axis <= axes; ++axis)
    data *= static_cast<double>(cards.whole("NAXIS" + std::to_string(axis), 0, any));
  const bool is_extension = first.starts_with("XTENSION");
  if (is_extension) {
    const auto heap = static_cast<double>(cards.whole("PCOUNT", 0, any));
    data = (data + heap * static_cast<double>(std::llabs(bits)) / 8) * static_cast<double>(cards.whole("GCOUNT", 1, 1));
    if (first.substr(10, 10) == "'BINTABLE'") cards.whole("TFIELDS", 0, most_columns);
  }
  const std::uint64_t header = cards.end(data, is_extension);
  if (data > static_cast<double>(file.size) - static_cast<double>(begin + header))
    fail("a header announces more data than the file has: it was cut short");
  return header + blocks(static_cast<std::uint64_t>(data));
}

/// True if a reader would take the bytes there for a header.
bool is_header(const FitsBytes& file, std::uint64_t at) {
  const std::string key = at < file.size ? file.read(at, 8) : "";
  return key == "XTENSION" || key == "SIMPLE  ";
}

}  // namespace

void check_fits_sizes(const FitsBytes& file) {
  if (file.read(0, 9) != "SIMPLE  =") fail("it is no FITS file, which begins with \"SIMPLE  =\"");
  std::uint64_t end = hdu_size(file, 0);
  while (is_header(file, end)) end += hdu_size(file, end);
}

void check_fits_sizes(std::string_view file) {
  check_fits_sizes({file.size(), [file](std::uint64_t at, std::size_t count) {
                      return std::string(file.substr(std::min<std::uint64_t>(at, file.size()), count));
                    }});
  if (file.size() % block != 0)
    fail("it has " + std::to_string(file.size()) + " bytes, expected a multiple of " + std::to_string(block) +
         ": it was cut short");
}

}  // namespace misfit::kernels
