// Changes FITS files card by card, so that most of what fuzzers make of them is still made of headers.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

constexpr std::size_t card_size = 80, block = 2880;

constexpr std::array keywords{
    "SIMPLE",  "XTENSION", "BITPIX",  "NAXIS",    "NAXIS1",   "NAXIS2",   "NAXIS3", "NAXIS4",   "PCOUNT",  "GCOUNT", "TFIELDS",
    "TFORM1",  "TFORM2",   "TTYPE1",  "TTYPE2",   "TSCAL1",   "TZERO1",   "TNULL1", "TDIM1",    "TBCOL1",  "THEAP",  "EXTNAME",
    "EXTEND",  "GROUPS",   "BZERO",   "BSCALE",   "BLANK",    "CTYPE1",   "CTYPE2", "CUNIT1",   "CROTA2",  "PC2_1",  "CD1_1",
    "CD2_2",   "LONPOLE",  "PV2_1",   "EQUINOX",  "CTYPE3",   "CTYPE4",   "CUNIT3", "CRVAL1",   "CRVAL2",  "CRVAL3", "CRPIX1",
    "CDELT1",  "CDELT2",   "CDELT3",  "CDELT4",   "BUNIT",    "BMAJ",     "BMIN",   "BPA",      "RADESYS", "CD1_2",  "RESTFRQ",
    "SPECSYS", "ZIMAGE",   "ZBITPIX", "CHECKSUM", "DATASUM",  "CONTINUE", "END",    "HIERARCH", "COMMENT", "KERNEL", "W",
    "X0",      "MS",       "INTERP",  "SOLVER",   "LONGSTRN", "INHERIT",  ""};

constexpr std::array values{
    "0",          "1",      "-1",         "2",           "3",          "4",           "8",          "16",
    "-32",        "-64",    "64",         "7",           "80",         "2880",        "999",        "1000",
    "T",          "F",      "32767",      "2147483647",  "2147483648", "-2147483648", "4294967296", "9223372036854775807",
    "1e18",       "1e308",  "1e-320",     "1e400",       "NaN",        "INF",         "0.5",        "1D5",
    "''",         "'",      "'1D'",       "'0D'",        "'1E'",       "'1J'",        "'1PD(3)'",   "'1QD(9)'",
    "'1X'",       "'9A'",   "'1M'",       "'99999999D'", "'IMAGE   '", "'BINTABLE'",  "'TABLE   '", "'BEAMS'",
    "'I8'",       "'POLY'", "'COEFF'",    "'STOKES'",    "'FREQ'",     "'VRAD'",      "'RA---SIN'", "'RA---TAN'",
    "'DEC--TAN'", "'rad'",  "'Jy/pixel'", "&",           "'abc&'",     "(1,2)",       "/",          "",
    "1 2",        "0x10",   "+5"};

/// A FITS file that is changed in place.
class Cards {
 public:
  Cards(std::uint8_t* data, std::size_t size, unsigned seed) : data_(data), count_(size / card_size), random_(seed) {}

  void change() {
    std::uint8_t* const card = any();
    switch (below(8)) {
      case 0:
        return set_keyword(card);
      case 1:
        std::memcpy(card, any(), card_size);
        return;
      case 2:
        std::swap_ranges(card, card + card_size, any());
        return;
      case 3:
        return remove(card);
      case 4:
        return insert(card);
      case 5:
        LLVMFuzzerMutate(card, card_size, card_size);
        return;
      default:
        return set_value(card);
    }
  }
  std::size_t below(std::size_t end) { return std::uniform_int_distribution<std::size_t>(0, end - 1)(random_); }

 private:
  /// A card of a header, unless many tries meet data alone.
  std::uint8_t* any() {
    std::uint8_t* card = data_;
    for (int tries = 0; tries < 20; ++tries) {
      card = data_ + card_size * below(count_);
      if (std::all_of(card, card + card_size, [](std::uint8_t c) { return c >= ' ' && c <= '~'; }) && card[0] != ' ') break;
    }
    return card;
  }
  void set_keyword(std::uint8_t* card) {
    std::string keyword = keywords[below(keywords.size())];
    keyword.resize(8, ' ');
    std::copy(keyword.begin(), keyword.end(), card);
  }
  void set_value(std::uint8_t* card) {
    const std::string value = values[below(values.size())];
    std::string field =
        "= " + std::string(value.front() == '\'' ? 0 : 20 - std::min<std::size_t>(20, value.size()), ' ') + value;
    field.resize(card_size - 8, ' ');
    std::copy(field.begin(), field.end(), card + 8);
  }
  /// The cards behind it in its block move up.
  void remove(std::uint8_t* card) {
    std::uint8_t* const end = end_of_block(card);
    std::copy(card + card_size, end, card);
    std::fill(end - card_size, end, std::uint8_t{' '});
  }
  /// A new one in front of it; the last of the block is lost.
  void insert(std::uint8_t* card) {
    std::uint8_t* const end = end_of_block(card);
    std::copy_backward(card, end - card_size, end);
    set_keyword(card);
    set_value(card);
  }
  std::uint8_t* end_of_block(std::uint8_t* card) const {
    const std::size_t end = (static_cast<std::size_t>(card - data_) / block + 1) * block;
    return data_ + std::min(end, count_ * card_size);
  }

  std::uint8_t* data_;
  std::size_t count_;
  std::minstd_rand random_;
};

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
  if (size < card_size) return LLVMFuzzerMutate(data, size, most);
  Cards cards(data, size, seed);
  switch (cards.below(16)) {
    case 0:
      return LLVMFuzzerMutate(data, size, most);
    case 1:
      return size < block ? size : block * (1 + cards.below(size / block));
    case 2:  // a block more, which was there before
      if (size < block || size + block > most) break;
      std::memcpy(data + size, data + block * cards.below(size / block), block);
      return size + block;
    default:
      break;
  }
  for (std::size_t changes = 1 + cards.below(3); changes > 0; --changes) cards.change();
  return size;
}
