#include <casacore/casa/Arrays/Array.h>
#include <casacore/images/Images/PagedImage.h>
#include <casacore/tables/Tables/ArrayColumn.h>
#include <casacore/tables/Tables/TableAttr.h>
#include <casacore/tables/Tables/TableDesc.h>
#include <casacore/tables/Tables/TableRecord.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "imager/files/plane_beams.h"
#include "ms_io/casa_coordinates_internal.h"
#include "ms_io/casa_image.h"
#include "ms_io/table_access_internal.h"

namespace misfit::ms_io {
namespace {

/// The number of any type that `info` holds under a name, or `otherwise`.
double number_in(const casacore::TableRecord& info, const std::string& name, double otherwise) {
  if (!info.isDefined(name)) return otherwise;
  switch (info.dataType(name)) {
    case casacore::TpInt:
    case casacore::TpInt64:
    case casacore::TpFloat:
    case casacore::TpDouble:
      return info.asDouble(name);
    default:
      return otherwise;
  }
}

/// Throws where the files of an image cannot hold its pixels: memory is taken for a plane at once.
void check_size(const casacore::IPosition& shape, std::size_t pixel_bytes, const std::string& path) {
  double held = 0, needed = static_cast<double>(pixel_bytes);
  for (const std::filesystem::directory_entry& entry : std::filesystem::directory_iterator(path))
    if (entry.is_regular_file()) held += static_cast<double>(entry.file_size());
  for (const auto length : shape) needed *= static_cast<double>(length);
  if (needed <= held) return;
  std::ostringstream message;
  message << "cannot read " << path << ": its pixels take " << needed << " bytes, expected no more than the " << held
          << " that it has";
  throw std::runtime_error(message.str());
}

template <typename Pixel>
class CasaImageReader : public imager::ImageReader {
 public:
  CasaImageReader(const std::string& path, casacore::Table& table, imager::Grids grids, Masks masks)
      : path_(path), image_(table), masks_(masks) {
    check_size(image_.shape(), sizeof(Pixel), path);
    planes_ = find_planes(image_.coordinates(), image_.shape(), path);
    header_ = header_of(image_.coordinates(), planes_, path);
    grid_ = grid_of(image_.coordinates(), planes_, path);
    header_.geometry = geometry(grids);
    header_.observation.phase_centre = header_.geometry.phase_centre;
    header_.unit = image_.units().getName();
    header_.observation.object = image_.imageInfo().objectName();
    header_.quantity = casacore::ImageInfo::imageType(image_.imageInfo().imageType());
    const casacore::TableRecord& others = image_.miscInfo();
    header_.taylor = imager::stated_taylor_term(number_in(others, imager::taylor_order_key, 0),
                                                number_in(others, imager::taylor_terms_key, 1));
    header_.flat_noise = number_in(others, imager::flat_noise_key, 0) == 1;
    if (others.isDefined(moving_key) && others.dataType(moving_key) == casacore::TpString)
      header_.observation.moving_at = others.asString(moving_key);
  }

  const imager::ImageHeader& header() const override { return header_; }
  std::optional<imager::Beam> beam(const imager::PlaneIndex& at) const override {
    return translated("cannot read " + path_, [&]() -> std::optional<imager::Beam> {
      const casacore::ImageInfo& info = image_.imageInfo();
      if (!info.hasBeam()) return std::nullopt;
      const casacore::GaussianBeam beam = info.restoringBeam(at.channel, at.stokes);
      if (imager::stands_for_no_beam(beam.getMajor("arcsec"))) return std::nullopt;
      return imager::Beam{beam.getMajor("rad"), beam.getMinor("rad"), beam.getPA("rad", true)};
    });
  }

  const std::optional<imager::SkyGrid>& grid() const override { return grid_; }

  imager::Image read_rows(const imager::PlaneIndex& at, int first, int count) const override {
    return translated("cannot read " + path_, [&] {
      casacore::IPosition from = planes_.first_pixel(at), shape = planes_.plane_shape();
      from[1] = first;
      shape[1] = count;
      const casacore::Slicer plane(from, shape);
      const casacore::Array<Pixel> pixels = image_.getSlice(plane);
      imager::Image image(header_.geometry.width, count);
      std::copy(pixels.begin(), pixels.end(), image.pixel.begin());
      if (masks_ == Masks::ignored || !image_.isMasked()) return image;
      const casacore::Array<bool> mask = image_.getMaskSlice(plane);
      std::transform(image.pixel.begin(), image.pixel.end(), mask.begin(), image.pixel.begin(),
                     [](double value, bool valid) { return valid ? value : std::numeric_limits<double>::quiet_NaN(); });
      return image;
    });
  }

 private:
  imager::ImageGeometry geometry(imager::Grids wanted) const {
    try {
      return imager::geometry_on(grid_, wanted,
                                 {static_cast<int>(planes_.shape[0]), static_cast<int>(planes_.shape[1]), 0, {}});
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error("cannot read " + path_ + ": " + error.what());
    }
  }

  std::string path_;
  casacore::PagedImage<Pixel> image_;
  Masks masks_;
  CasaPlanes planes_;
  std::optional<imager::SkyGrid> grid_;
  imager::ImageHeader header_;
};

/// Throws unless the tables of an image, its masks and its log, lie in its folder: casacore would look for them wherever the
/// image says.
void check_tables(const casacore::TableRecord& keywords, const std::string& image, const std::string& path) {
  for (casacore::uInt field = 0; field < keywords.nfields(); ++field) {
    if (keywords.dataType(field) == casacore::TpRecord) check_tables(keywords.subRecord(field), image, path);
    if (keywords.dataType(field) != casacore::TpTable) continue;
    const std::string name = keywords.name(field), table = keywords.tableAttributes(field).name();
    if (table.rfind(image + "/", 0) != 0 || table.find("/../") != std::string::npos)
      throw std::runtime_error("cannot read " + path + ": its " + name + " is the table " + table +
                               ", expected one in the image's own folder");
  }
}

/// Throws where the image's default mask cannot be used: it may be an expression about other images.
void check_mask(const casacore::TableRecord& keywords, const std::string& path) {
  if (!keywords.isDefined("Image_defaultmask") || !keywords.isDefined("masks")) return;
  const std::string mask = keywords.asString("Image_defaultmask");
  const casacore::TableRecord& masks = keywords.subRecord("masks");
  if (mask.empty() || !masks.isDefined(mask)) return;
  const std::string kind = masks.subRecord(mask).asString("name");
  if (kind != "LCPagedMask")
    throw std::runtime_error("cannot read " + path + ": its " + mask + " is a " + kind +
                             ", expected a stored mask, LCPagedMask");
}

std::unique_ptr<imager::ImageReader> open_table(const std::string& path, imager::Grids grids, Masks masks) {
  casacore::Table table(path, casacore::TableLock(casacore::TableLock::NoLocking));
  if (!table.tableDesc().isColumn("map")) throw std::runtime_error("cannot read " + path + ": it has no column of pixels");
  check_tables(table.keywordSet(), table.tableName(), path);
  check_mask(table.keywordSet(), path);
  const casacore::TableRecord& keywords = table.keywordSet();
  if (keywords.isDefined("coords") && keywords.dataType("coords") == casacore::TpRecord)
    check_frames(keywords.subRecord("coords"), path);
  const casacore::DataType type = table.tableDesc()["map"].dataType();
  if (type == casacore::TpFloat) return std::make_unique<CasaImageReader<float>>(path, table, grids, masks);
  if (type == casacore::TpDouble) return std::make_unique<CasaImageReader<double>>(path, table, grids, masks);
  throw std::runtime_error("cannot read " + path + ": its pixels are no real numbers");
}

}  // namespace

std::unique_ptr<imager::ImageReader> open_casa_image(const std::string& path, imager::Grids grids, Masks masks) {
  if (!is_casa_image(path))
    throw std::runtime_error("cannot read " + path + ": it is no casacore image; expected the folder of one");
  return translated("cannot read " + path, [&] { return open_table(path, grids, masks); });
}

}  // namespace misfit::ms_io
