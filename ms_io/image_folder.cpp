#include <casacore/casa/OS/Path.h>
#include <casacore/tables/Tables/PlainTable.h>
#include <casacore/tables/Tables/TableCache.h>

#include <stdexcept>
#include <system_error>

#include "ms_io/casa_image.h"
#include "ms_io/image_folder_internal.h"

namespace misfit::ms_io {
namespace {

namespace fs = std::filesystem;

fs::path without_links(const std::string& path) {
  fs::path target = fs::path(path).lexically_normal();
  if (!target.has_filename()) target = target.parent_path();
  std::error_code error;
  return fs::exists(target, error) ? fs::canonical(target, error) : target;
}

}  // namespace

ImageFolder::ImageFolder(const std::string& path)
    : path_(path), target_(without_links(path)), unfinished_(target_.string() + ".part") {
  require_image_or_nothing();
  for (const fs::path& left : {unfinished_, old()}) remove_left(left);
}

ImageFolder::~ImageFolder() {
  std::error_code ignored;
  fs::remove_all(unfinished_, ignored);
}

void ImageFolder::fail(const std::string& reason) const {
  throw std::runtime_error("cannot write " + path_ + ": " + reason);
}

/// The place of the replaced image during the two renames.
fs::path ImageFolder::old() const {
  return target_.string() + ".old";
}

void ImageFolder::require_image_or_nothing() const {
  std::error_code error;
  if (fs::exists(target_, error) && !is_casa_image(target_.string()))
    fail("it is there already and no casacore image; expected another name");
}

/// Removes the remains of a table that a killed run left.
void ImageFolder::remove_left(const fs::path& left) const {
  std::error_code error;
  if (!fs::exists(left, error)) return;
  if (!fs::is_directory(left, error) || !(fs::is_empty(left, error) || fs::exists(left / "table.lock", error)))
    fail(left.string() + " is in the way, and no casacore table");
  fs::remove_all(left, error);
}

void ImageFolder::put_in_place() {
  require_image_or_nothing();
  std::error_code error, ignored;
  const bool replaces = fs::exists(target_, ignored);
  if (replaces) fs::rename(target_, old(), error);
  if (error) fail(error.message());
  fs::rename(unfinished_, target_, error);
  if (error && replaces) fs::rename(old(), target_, ignored);
  if (error) fail(error.message());
  fs::remove_all(old(), ignored);
  forget_open_tables();
}

/// Makes casacore forget open tables of this path: it would go on with a table of that name which is still open, in place of
/// the new one.
void ImageFolder::forget_open_tables() const {
  casacore::TableCache& open = casacore::PlainTable::tableCache();
  for (const char* part : {"", "/mask0", "/logtable"}) open.remove(casacore::Path(target_.string() + part).absoluteName());
}

}  // namespace misfit::ms_io
