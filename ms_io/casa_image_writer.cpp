#include <casacore/casa/Arrays/Array.h>
#include <casacore/images/Images/PagedImage.h>
#include <casacore/tables/Tables/TableUtil.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "imager/files/written_planes.h"
#include "ms_io/casa_coordinates_internal.h"
#include "ms_io/casa_image.h"
#include "ms_io/image_folder_internal.h"
#include "ms_io/room.h"
#include "ms_io/storage_managers_internal.h"
#include "ms_io/table_access_internal.h"

namespace misfit::ms_io {
namespace {

casacore::GaussianBeam casa_beam(const imager::Beam& beam) {
  return {casacore::Quantity(beam.major_rad * 180 * 3600 / M_PI, "arcsec"),
          casacore::Quantity(beam.minor_rad * 180 * 3600 / M_PI, "arcsec"),
          casacore::Quantity(beam.position_angle_rad * 180 / M_PI, "deg")};
}

casacore::ImageBeamSet beam_set(const imager::PlaneBeams& beams) {
  const casacore::Quantity tiny(imager::no_beam_arcsec, "arcsec");
  casacore::ImageBeamSet set(static_cast<casacore::uInt>(beams.channels()), static_cast<casacore::uInt>(beams.stokes()),
                             casacore::GaussianBeam(tiny, tiny, casacore::Quantity(0, "deg")));
  for (int channel = 0; channel < beams.channels(); ++channel)
    for (int stokes = 0; stokes < beams.stokes(); ++stokes)
      if (const std::optional<imager::Beam>& beam = beams.at({channel, stokes})) set.setBeam(channel, stokes, casa_beam(*beam));
  return set;
}

casacore::ImageInfo image_info(const imager::PlaneBeams& beams, const imager::ImageHeader& header) {
  casacore::ImageInfo info;
  info.setImageType(casacore::ImageInfo::imageType(header.quantity));
  info.setObjectName(header.observation.object);
  if (const std::optional<imager::Beam> beam = beams.shared())
    info.setRestoringBeam(casa_beam(*beam));
  else if (beams.any())
    info.setBeams(beam_set(beams));
  return info;
}

constexpr const char* creator_key = "creator";
constexpr const char* creator = "misfit";

casacore::TableRecord misc_info(const imager::ImageHeader& header) {
  casacore::TableRecord record;
  record.define(creator_key, creator);
  if (!header.observation.moving_at.empty()) {
    record.define(moving_key, header.observation.moving_at);
    record.setComment(moving_key, "UTC of the reference value: the image moves along with its field");
  }
  if (header.taylor.several()) {
    record.define(imager::taylor_order_key, header.taylor.order);
    record.setComment(imager::taylor_order_key, "Taylor term, counted from 0");
    record.define(imager::taylor_terms_key, header.taylor.terms);
    record.setComment(imager::taylor_terms_key, "terms of spectra");
  }
  if (header.flat_noise) {
    record.define(imager::flat_noise_key, 1);
    record.setComment(imager::flat_noise_key, "pixels are the sky times sqrt(.weight / its maximum)");
  }
  for (const imager::HeaderCard& card : header.cards) {
    record.define(card.keyword, card.value);
    record.setComment(card.keyword, card.comment);
  }
  return record;
}

constexpr ssize_t tile_side = 512;

/// Some rows of a plane, with as many axes as the image has.
struct Band {
  casacore::IPosition first;
  casacore::IPosition shape;
  std::size_t begin;  ///< of its pixels in the plane
  std::size_t end;
};

/// The values of(pixel) of a band.
template <typename Value, typename Function>
casacore::Array<Value> values_of(const imager::Image& image, const Band& band, const Function& of) {
  casacore::Array<Value> values(band.shape);
  std::transform(image.pixel.data() + band.begin, image.pixel.data() + band.end, values.data(), of);
  return values;
}

template <typename Pixel>
class CasaImageWriter : public imager::ImageWriter {
 public:
  CasaImageWriter(const imager::ImageHeader& header, const std::string& path)
      : path_(path), folder_(path), header_(header), planes_(header) {
    layout_.shape = casacore::IPosition(4, header.geometry.width, header.geometry.height,
                                        static_cast<ssize_t>(header.stokes.size()), header.spectral.channels);
    layout_.stokes = 2;
    layout_.spectral = 3;
    constexpr std::uintmax_t tables = 1 << 20;
    require_room(path_, static_cast<std::uintmax_t>(layout_.shape.product()) * sizeof(Pixel) + tables);
    translated("cannot write " + path_, [&] { create(); });
  }

  CasaImageWriter(const CasaImageWriter&) = delete;
  CasaImageWriter& operator=(const CasaImageWriter&) = delete;
  ~CasaImageWriter() override { abandon(); }

  void write(const imager::PlaneIndex& at, const imager::Image& image, const std::optional<imager::Beam>& beam) override {
    planes_.add(at, image, beam);
    translated("cannot write " + path_, [&] { write_pixels(at, image); });
  }

  void mask_like(const imager::ImageReader& other) override {
    for (int channel = 0; channel < header_.spectral.channels; ++channel) {
      const imager::Image values = other.read({channel, 0});
      for (int stokes = 0; stokes < static_cast<int>(header_.stokes.size()); ++stokes)
        translated("cannot write " + path_, [&] {
          for_each_band({channel, stokes}, values, [&](const Band& band) { mask_band(values, band); });
        });
    }
  }

  void add_cards(const std::vector<imager::HeaderCard>& cards) override {
    header_.cards.insert(header_.cards.end(), cards.begin(), cards.end());
  }

  void finish() override {
    translated("cannot write " + path_, [&] {
      if (const std::vector<imager::PlaneIndex> missing = planes_.missing(); !missing.empty()) {
        const imager::Image blank = planes_.blank();
        for (const imager::PlaneIndex& at : missing) write_pixels(at, blank);
      }
      if (!image_->setImageInfo(image_info(planes_.beams(), header_)))
        throw std::runtime_error("cannot write " + path_ + ": casacore keeps no beams of it");
      image_->setMiscInfo(misc_info(header_));
      for (const std::string& line : header_.history)
        image_->logger().sink().postLocally(casacore::LogMessage(line, casacore::LogOrigin("misfit")));
      image_->flush();
    });
    image_.reset();
    folder_.put_in_place();
  }

 private:
  void create() {
    casacore::IPosition tile = layout_.plane_shape();  // planes are written, and shown, one by one
    for (const std::size_t axis : {0, 1}) tile[axis] = std::min(tile[axis], tile_side);
    image_ = std::make_unique<casacore::PagedImage<Pixel>>(casacore::TiledShape(layout_.shape, tile), casa_coordinates(header_),
                                                           folder_.name(),
                                                           casacore::TableLock(casacore::TableLock::PermanentLocking));
    image_->setUnits(casacore::Unit(header_.unit));
  }

  void write_pixels(const imager::PlaneIndex& at, const imager::Image& image) {
    for_each_band(at, image, [&](const Band& band) {
      image_->putSlice(values_of<Pixel>(image, band, [](double pixel) { return static_cast<Pixel>(pixel); }), band.first);
      mask_band(image, band);
    });
  }

  /// Calls visit(band) for bands as high as tiles are, so that little is copied at a time.
  template <typename Visit>
  void for_each_band(const imager::PlaneIndex& at, const imager::Image& image, const Visit& visit) {
    for (int row = 0; row < image.height; row += tile_side) {
      Band band{layout_.first_pixel(at), layout_.plane_shape(), static_cast<std::size_t>(image.row(row) - image.row(0)), 0};
      band.first[1] = row;
      band.shape[1] = std::min<ssize_t>(tile_side, image.height - row);
      band.end = band.begin + static_cast<std::size_t>(band.shape.product());
      visit(band);
    }
  }

  /// Masks pixels of a band that have no value in `image`, besides those that are masked already.
  void mask_band(const imager::Image& image, const Band& band) {
    const auto valueless = [](double pixel) { return std::isnan(pixel); };
    if (std::none_of(image.pixel.data() + band.begin, image.pixel.data() + band.end, valueless)) return;
    if (!image_->hasPixelMask()) image_->makeMask("mask0", true, true, true, true);
    casacore::Array<bool> mask = image_->pixelMask().getSlice(casacore::Slicer(band.first, band.shape));
    mask = mask && values_of<bool>(image, band, [&](double pixel) { return !valueless(pixel); });
    image_->pixelMask().putSlice(mask, band.first);
  }

  /// Marks the tables for deletion: they are then not written when they are closed, which on a full disk would throw where
  /// nobody catches.
  void abandon() {
    if (!image_) return;
    for (const char* part : {"", "/logtable", "/mask0"}) try {
        casacore::Table(folder_.name() + part, casacore::Table::Update).markForDelete();
      } catch (const casacore::AipsError&) {  // it was not made yet
      }
    image_.reset();
  }

  std::string path_;
  ImageFolder folder_;  ///< outlives the image in it
  imager::ImageHeader header_;
  imager::WrittenPlanes planes_;
  CasaPlanes layout_;
  std::unique_ptr<casacore::PagedImage<Pixel>> image_;
};

}  // namespace

bool is_casa_image(const std::string& path) {
  silence_casacore();
  check_storage_managers(path);
  return casacore::Table::isReadable(path) &&
         casacore::TableUtil::tableInfo(path).type() == casacore::TableInfo::type(casacore::TableInfo::PAGEDIMAGE);
}

bool is_own_casa_image(const std::string& path) {
  if (!is_casa_image(path)) return false;
  return translated("cannot read " + path, [&] {
    const casacore::Table table(path, casacore::TableLock(casacore::TableLock::NoLocking));
    const casacore::TableRecord& keywords = table.keywordSet();
    if (!keywords.isDefined("miscinfo")) return false;
    const casacore::RecordInterface& info = keywords.asRecord("miscinfo");
    return info.isDefined(creator_key) && info.dataType(creator_key) == casacore::TpString &&
           info.asString(creator_key) == creator;
  });
}

std::unique_ptr<imager::ImageWriter> create_casa_image(const imager::ImageHeader& header, const std::string& path,
                                                       imager::PixelFormat format) {
  silence_casacore();
  if (format == imager::PixelFormat::float64) return std::make_unique<CasaImageWriter<double>>(header, path);
  return std::make_unique<CasaImageWriter<float>>(header, path);
}

}  // namespace misfit::ms_io
