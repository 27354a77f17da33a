#include <cstdlib>
#include <stdexcept>
#include <string>

#include "kernels/fits_sizes_internal.h"

namespace misfit::kernels {
namespace {

constexpr std::size_t block = 2880, card_size = 80;
constexpr int most_axes = 999, most_columns = 999;

[[noreturn]] void fail(const std::string& reason) {
  throw std::runtime_error(reason);
}

/// Reads the cards at the head of an HDU, in their order.
class MandatoryCards {
 public:
  explicit MandatoryCards(std::string_view hdu) : rest_(hdu) {}

  void skip() { next(); }
  /// The value of the next card, which must have this key.
  long long whole(const std::string& key, long long least, long long most) {
    const std::string card(next());
    std::string padded = key;
    padded.resize(8, ' ');
    if (card.compare(0, 10, padded + "= ") != 0) fail("a header has no " + key + " where one is due");
    const std::string value = card.substr(10);
    const std::size_t first = value.find_first_not_of(' '), end = value.find_first_of(" /", first);
    const std::string number = first == std::string::npos ? "" : value.substr(first, end - first);
    char* parsed = nullptr;
    const long long found = std::strtoll(number.c_str(), &parsed, 10);  // saturates, and is refused
    if (number.empty() || *parsed != '\0') fail(key + " cannot be understood: it is no whole number");
    if (found < least || found > most)
      fail(key + " is " + number + ", expected " + std::to_string(least) + " to " + std::to_string(most));
    return found;
  }

 private:
  std::string_view next() {
    if (rest_.size() < card_size) fail("it was cut short within a header");
    const std::string_view card = rest_.substr(0, card_size);
    rest_.remove_prefix(card_size);
    return card;
  }
  std::string_view rest_;
};

std::size_t blocks(std::size_t bytes) {
  return (bytes + block - 1) / block * block;
}

std::size_t header_size(std::string_view hdu) {
  for (std::size_t at = 0; at + card_size <= hdu.size(); at += card_size) {
    const std::string_view card = hdu.substr(at, card_size);
    if (card.substr(0, 8) != "END     ") continue;
    if (card.find_first_not_of(' ', 3) != std::string_view::npos) fail("END has a value");
    return blocks(at + card_size);
  }
  fail("it was cut short within a header");
}

/// Header and data of the HDU at the start of `rest`.
std::size_t hdu_size(std::string_view rest, bool primary) {
  constexpr long long any = 1LL << 62;
  const std::size_t header = header_size(rest);
  MandatoryCards cards(rest.substr(0, header));
  cards.skip();
  const long long bits = cards.whole("BITPIX", -64, 64);
  const long long axes = cards.whole("NAXIS", 0, most_axes);
  double data = axes == 0 ? 0 : static_cast<double>(std::llabs(bits)) / 8;
  for (long long axis = 1; axis <= axes; ++axis)
    data *= static_cast<double>(cards.whole("NAXIS" + std::to_string(axis), 0, any));
  if (!primary) {
    const auto heap = static_cast<double>(cards.whole("PCOUNT", 0, any));
    data = (data + heap * static_cast<double>(std::llabs(bits)) / 8) * static_cast<double>(cards.whole("GCOUNT", 1, 1));
    if (rest.substr(10, 10) == "'BINTABLE'") cards.whole("TFIELDS", 0, most_columns);
  }
  if (data > static_cast<double>(rest.size() - header))
    fail("a header announces more data than the file has: it was cut short");
  return header + blocks(static_cast<std::size_t>(data));
}

}  // namespace

void check_fits_sizes(std::string_view file) {
  if (file.substr(0, 9) != "SIMPLE  =") fail("it is no FITS file, which begins with \"SIMPLE  =\"");
  if (file.size() % block != 0)
    fail("it has " + std::to_string(file.size()) + " bytes, expected a multiple of " + std::to_string(block) +
         ": it was cut short");
  std::size_t end = hdu_size(file, true);
  while (file.substr(end, 9) == "XTENSION=") end += hdu_size(file.substr(end), false);
}

}  // namespace misfit::kernels
