#include "imager/files/fits_file.h"

#include <fitsio.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>

#include "imager/files/fits_text.h"
#include "kernels/cfitsio_call.h"
#include "kernels/fits_sizes.h"

namespace misfit::imager {

std::string cfitsio_version() {
  float version = 0;  // 4.0200 is 4.2.0
  fits_get_version(&version);
  const long parts = std::lround(1e4 * version);
  return std::to_string(parts / 10000) + '.' + std::to_string(parts / 100 % 100) + '.' + std::to_string(parts % 100);
}

struct FitsFile::Handle {
  fitsfile* file = nullptr;
};

namespace {

/// A call of CFITSIO, after which errno tells of a failure that the system caused.
class CallOfCfitsio : kernels::CfitsioCall {
 public:
  CallOfCfitsio() { errno = 0; }
};

/// True if a disk failed. CFITSIO 4.2 does not check that its buffers could be written before it moves to another place of the
/// file, and goes on without them.
bool is_lost_write(int error) {
  constexpr std::array errors{ENOSPC, EDQUOT, EIO, EFBIG};
  return std::find(errors.begin(), errors.end(), error) != errors.end();
}

/// True if the system refused something: CFITSIO leaves other numbers in errno as well.
bool is_of_the_system(int error) {
  constexpr std::array errors{EROFS, EACCES, EPERM, ENOMEM, EMFILE, ENFILE, ENAMETOOLONG};
  return is_lost_write(error) || std::find(errors.begin(), errors.end(), error) != errors.end();
}

/// Throws std::runtime_error where headers are not to be trusted.
void check_sizes(const std::string& path) {
  std::error_code none;
  const std::filesystem::file_status status = std::filesystem::status(path, none);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw std::runtime_error("it is no regular file");
  const std::uintmax_t size = std::filesystem::file_size(path, none);
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(std::strerror(errno != 0 ? errno : EIO));
  if (none) return;
  const auto read = [&file](std::uint64_t at, std::size_t count) {
    std::string bytes(count, '\0');
    file.clear();
    file.seekg(static_cast<std::streamoff>(at)).read(bytes.data(), static_cast<std::streamsize>(count));
    bytes.resize(static_cast<std::size_t>(file.gcount()));
    return bytes;
  };
  if (const std::string how = compression_of(read(0, 8)); !how.empty())
    throw std::runtime_error("it is no FITS file, but one compressed by " + how);
  kernels::check_fits_sizes({size, read});
}

}  // namespace

FitsFile::FitsFile(std::string doing, std::string path)
    : doing_(std::move(doing)), path_(std::move(path)), handle_(std::make_unique<Handle>()) {
  const CallOfCfitsio call;
  fits_clear_errmsg();
}

FitsFile::~FitsFile() {
  const CallOfCfitsio call;
  int status = 0;
  if (handle_->file != nullptr) fits_close_file(handle_->file, &status);
  fits_clear_errmsg();
}

// CFITSIO's "disk file" calls take the name as it stands; an absolute one keeps them from expanding a tilde.
void FitsFile::create(const std::string& name) {
  const CallOfCfitsio call;
  int status = 0;
  check(fits_create_diskfile(&handle_->file, std::filesystem::absolute(name).c_str(), &status));
}

void FitsFile::open(const std::string& name) {
  try {
    check_sizes(name);
  } catch (const std::runtime_error& error) {
    fail(error.what());
  }
  const CallOfCfitsio call;
  int status = 0;
  check(fits_open_diskfile(&handle_->file, std::filesystem::absolute(name).c_str(), READONLY, &status));
}

void FitsFile::abandon() {
  if (handle_->file == nullptr) return;
  FITSfile& file = *handle_->file->Fptr;
  file.writemode = READONLY;
  std::fill(std::begin(file.dirty), std::end(file.dirty), 0);
}

void FitsFile::close() {
  const CallOfCfitsio call;
  int status = 0;
  fits_close_file(handle_->file, &status);
  handle_->file = nullptr;
  check(status);
}

void FitsFile::fail(const std::string& reason) const {
  throw std::runtime_error("cannot " + doing_ + " " + path_ + ": " + reason);
}

void FitsFile::check(int status) const {
  const int error = errno;
  if (status == 0 && !is_lost_write(error)) return;
  if (is_of_the_system(error)) {
    fits_clear_errmsg();
    fail(std::strerror(error));
  }
  std::array<char, FLEN_STATUS> text{};
  fits_get_errstatus(status, text.data());
  std::string reason = text.data();
  std::array<char, FLEN_ERRMSG> detail{};
  if (fits_read_errmsg(detail.data())) reason += " (" + header_text(detail.data()) + ")";
  fail(reason);
}

void FitsFile::write_number(const std::string& key, double value, const std::string& comment) {
  const CallOfCfitsio call;
  int status = 0;
  check(fits_update_key(handle_->file, TDOUBLE, key.c_str(), &value, comment.c_str(), &status));
}

void FitsFile::write_text(const std::string& key, const std::string& value, const std::string& comment) {
  const CallOfCfitsio call;
  int status = 0;
  if (value.empty()) return;
  check(fits_update_key_str(handle_->file, key.c_str(), header_text(value).c_str(), comment.c_str(), &status));
}

void FitsFile::write_integer(const std::string& key, int value, const std::string& comment) {
  const CallOfCfitsio call;
  int status = 0;
  check(fits_update_key(handle_->file, TINT, key.c_str(), &value, comment.c_str(), &status));
}

void FitsFile::write_flag(const std::string& key, bool value, const std::string& comment) {
  const CallOfCfitsio call;
  int status = 0, logical = value ? 1 : 0;
  check(fits_update_key(handle_->file, TLOGICAL, key.c_str(), &logical, comment.c_str(), &status));
}

void FitsFile::write_history(const std::string& line) {
  const CallOfCfitsio call;
  int status = 0;
  check(fits_write_history(handle_->file, header_text(line).c_str(), &status));
}

void FitsFile::reserve_cards(int count) {
  const CallOfCfitsio call;
  int status = 0;
  check(fits_set_hdrsize(handle_->file, count, &status));
}

std::string FitsFile::text(const std::string& key) const {
  const CallOfCfitsio call;
  int status = 0;
  std::array names{const_cast<char*>(key.c_str())};
  std::array<char, FLEN_CARD> card{};
  std::array<char, FLEN_VALUE> value{};
  std::optional<std::string> first;
  check(fits_read_record(handle_->file, 0, card.data(), &status));  // goes to the beginning
  while (fits_find_nextkey(handle_->file, names.data(), 1, nullptr, 0, card.data(), &status) == 0) {
    check(fits_parse_value(card.data(), value.data(), nullptr, &status));
    const std::string text = header_text(bare_header_value(value.data()));
    if (!first) first = text;
    if (!same_header_value(*first, text))
      fail("its header has " + key + " twice, as " + *first + " and as " + text + "; expected one of them");
  }
  fits_clear_errmsg();
  return first.value_or("");
}

std::optional<double> FitsFile::number(const std::string& key) const {
  const std::string stated = text(key);
  if (stated.empty()) return std::nullopt;
  const std::optional<double> value = header_number(stated);
  if (!value) fail("its " + key + " is '" + stated + "'; expected a number");
  if (!std::isfinite(*value)) fail("its " + key + " is not finite");
  return value;
}

double FitsFile::needed_number(const std::string& key) const {
  const std::optional<double> value = number(key);
  if (!value) fail("it has no " + key);
  return *value;
}

void FitsFile::create_image(std::vector<long> size, PixelFormat format) {
  const CallOfCfitsio call;
  int status = 0;
  check(fits_create_img(handle_->file, format == PixelFormat::float32 ? FLOAT_IMG : DOUBLE_IMG, static_cast<int>(size.size()),
                        size.data(), &status));
}

void FitsFile::write_pixels(std::vector<long> first, const std::vector<double>& pixels) {
  const CallOfCfitsio call;
  int status = 0;
  check(fits_write_pix(handle_->file, TDOUBLE, first.data(), static_cast<LONGLONG>(pixels.size()),
                       const_cast<double*>(pixels.data()), &status));
}

std::vector<long> FitsFile::size() const {
  const CallOfCfitsio call;
  int status = 0, axes = 0;
  check(fits_get_img_dim(handle_->file, &axes, &status));
  std::vector<long> size(static_cast<std::size_t>(axes));
  check(fits_get_img_size(handle_->file, axes, size.data(), &status));
  return size;
}

void FitsFile::read_pixels(std::vector<long> first, std::vector<double>& pixels) const {
  const CallOfCfitsio call;
  int status = 0, type = 0, any_blank = 0;
  check(fits_get_img_type(handle_->file, &type, &status));
  // Asked to look for blanks, CFITSIO rounds subnormal numbers to zero; only integers need it.
  double blank = std::numeric_limits<double>::quiet_NaN();
  check(fits_read_pix(handle_->file, TDOUBLE, first.data(), static_cast<LONGLONG>(pixels.size()), type > 0 ? &blank : nullptr,
                      pixels.data(), &any_blank, &status));
}

void FitsFile::append_table(const std::string& name, const std::vector<FitsColumn>& columns) {
  const CallOfCfitsio call;
  std::vector<char*> names, forms, units;
  std::string whole = "1J", real = "1E";
  for (const FitsColumn& column : columns) {
    names.push_back(const_cast<char*>(column.name.c_str()));
    forms.push_back(column.whole ? whole.data() : real.data());
    units.push_back(const_cast<char*>(column.unit.c_str()));
  }
  int status = 0;
  const auto rows = static_cast<LONGLONG>(columns.front().values.size());
  check(fits_create_tbl(handle_->file, BINARY_TBL, rows, static_cast<int>(columns.size()), names.data(), forms.data(),
                        units.data(), name.c_str(), &status));
  for (std::size_t i = 0; i < columns.size(); ++i)
    check(fits_write_col(handle_->file, TDOUBLE, static_cast<int>(i) + 1, 1, 1, rows,
                         const_cast<double*>(columns[i].values.data()), &status));
}

bool FitsFile::open_table(const std::string& name) {
  const CallOfCfitsio call;
  int status = 0;
  std::string text = name;
  fits_movnam_hdu(handle_->file, BINARY_TBL, text.data(), 0, &status);
  if (status == BAD_HDU_NUM) {
    fits_clear_errmsg();
    return false;
  }
  check(status);
  return true;
}

void FitsFile::open_image() {
  const CallOfCfitsio call;
  int status = 0;
  check(fits_movabs_hdu(handle_->file, 1, nullptr, &status));
}

std::vector<double> FitsFile::column(const std::string& name, std::size_t most) const {
  const CallOfCfitsio call;
  int status = 0, number = 0, any_null = 0;
  std::string text = name;
  check(fits_get_colnum(handle_->file, CASEINSEN, text.data(), &number, &status));
  long rows = 0;
  check(fits_get_num_rows(handle_->file, &rows, &status));
  if (static_cast<std::size_t>(rows) > most)
    fail("its column " + name + " has " + std::to_string(rows) + " rows, expected at most " + std::to_string(most));
  std::vector<double> values(static_cast<std::size_t>(rows));
  check(fits_read_col(handle_->file, TDOUBLE, number, 1, 1, rows, nullptr, values.data(), &any_null, &status));
  return values;
}

}  // namespace misfit::imager
