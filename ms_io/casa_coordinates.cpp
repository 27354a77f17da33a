#include <casacore/casa/Arrays/Matrix.h>
#include <casacore/casa/Quanta/MVTime.h>
#include <casacore/coordinates/Coordinates/DirectionCoordinate.h>
#include <casacore/coordinates/Coordinates/SpectralCoordinate.h>
#include <casacore/coordinates/Coordinates/StokesCoordinate.h>

#include <cctype>
#include <cmath>
#include <stdexcept>

#include "imager/numerics/constants.h"
#include "imager/numerics/julian_date.h"
#include "ms_io/casa_coordinates_internal.h"
#include "ms_io/celestial_frame_internal.h"
#include "ms_io/spectral_frame_internal.h"

namespace misfit::ms_io {
namespace {

constexpr double degree = imager::pi / 180;

[[noreturn]] void refuse(const std::string& path, const std::string& reason) {
  throw std::runtime_error("cannot read " + path + ": " + reason);
}

casacore::DirectionCoordinate direction_coordinate(const imager::ImageGeometry& g) {
  casacore::Matrix<double> unrotated(2, 2, 0.0);
  unrotated.diagonal() = 1.0;
  // LONPOLE of 180 degrees as in the FITS header: beside a pole casacore would take another.
  return {direction_type(g.phase_centre.frame),
          casacore::Projection(casacore::Projection::SIN, casacore::Vector<double>(2, 0.0)),
          g.phase_centre.ra_rad,
          g.phase_centre.dec_rad,
          -g.cell_rad,
          g.cell_height_rad(),
          unrotated,
          g.centre_column() + g.centre.l / g.cell_rad,
          g.centre_row() - g.centre.m / g.cell_height_rad(),
          imager::pi,
          g.phase_centre.dec_rad};
}

casacore::StokesCoordinate stokes_coordinate(const std::vector<imager::Stokes>& list) {
  casacore::Vector<casacore::Int> codes(list.size());
  for (std::size_t s = 0; s < list.size(); ++s) codes[s] = static_cast<int>(list[s]);
  return casacore::StokesCoordinate(codes);
}

casacore::SpectralCoordinate spectral_coordinate(const imager::ImageHeader& header) {
  const imager::SpectralAxis& axis = header.spectral;
  const double rest_hz = axis.rest_frequency_hz > 0 ? axis.rest_frequency_hz : header.observation.frequency_hz;
  const casacore::MFrequency::Types frame = spectral_frame_code(axis.frame);
  if (!axis.in_wavelength || axis.channels == 1) return {frame, axis.reference_hz, axis.step_hz(), 0, rest_hz};
  casacore::Vector<double> listed(static_cast<std::size_t>(axis.channels));
  for (int plane = 0; plane < axis.channels; ++plane) listed[static_cast<std::size_t>(plane)] = axis.frequency_hz(plane);
  return {frame, listed, rest_hz};
}

casacore::ObsInfo obs_info(const imager::Observation& observation, const imager::SkyDirection& phase_centre) {
  casacore::ObsInfo info;
  info.setTelescope(observation.telescope);
  info.setObserver(observation.observer);
  if (const auto date = imager::modified_julian_date(observation.date_obs))
    info.setObsDate(casacore::MEpoch(casacore::Quantity(*date, "d"), casacore::MEpoch::UTC));
  info.setPointingCenter(casacore::MVDirection(phase_centre.ra_rad, phase_centre.dec_rad));
  return info;
}

/// The slant of a SIN projection; 0 for others, which have no parameters.
std::array<double, 2> slant_of(const casacore::Projection& projection, const std::string& path) {
  const casacore::Vector<double>& parameters = projection.parameters();
  if (projection.type() == casacore::Projection::SIN && parameters.size() == 2) return {parameters[0], parameters[1]};
  for (const double parameter : parameters)
    if (parameter != 0)
      refuse(path, "its projection " + std::string(projection.name()) + " has the parameter " + std::to_string(parameter) +
                       "; expected none");
  return {};
}

imager::SkyGrid grid_of(casacore::DirectionCoordinate direction, const casacore::IPosition& shape, const std::string& path) {
  direction.setWorldAxisUnits(casacore::Vector<casacore::String>(2, "rad"));
  const casacore::Projection projection = direction.projection();
  const auto known = imager::projection_named(projection.name());
  if (!known) refuse(path, "its projection is " + projection.name() + "; expected SIN, TAN, STG, ARC or ZEA");
  const auto value = direction.referenceValue(), pixel = direction.referencePixel(), increment = direction.increment();
  const casacore::Matrix<double> turn = direction.linearTransform();
  imager::SkyGrid grid;
  grid.width = static_cast<int>(shape[0]);
  grid.height = static_cast<int>(shape[1]);
  grid.projection = *known;
  grid.reference = {value[0] < 0 ? value[0] + 2 * imager::pi : value[0], value[1], frame_name(direction.directionType())};
  grid.reference_pixel = {pixel[0], pixel[1]};
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j) grid.step[i][j] = increment[i] * turn(j, i);  // casacore holds PC transposed
  grid.slant = slant_of(projection, path);
  imager::set_pole(grid, direction.longLatPoles()[2] * degree);
  if (!grid.is_regular()) refuse(path, "its pixels have no area, or lie farther away than numbers reach");
  return grid;
}

/// True if the name of an axis that is neither of directions, frequencies nor Stokes parameters means nothing.
bool says_nothing(std::string name) {
  for (char& letter : name) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return name.empty() || name.rfind("linear", 0) == 0 || name.rfind("pixel", 0) == 0 || name.rfind("axis", 0) == 0;
}

bool lie_on(const imager::SpectralAxis& axis, const casacore::Vector<double>& listed_hz) {
  for (std::size_t k = 0; k < listed_hz.size(); ++k) {
    const int plane = static_cast<int>(k);
    if (!(std::abs(listed_hz[k] - axis.frequency_hz(plane)) < 1e-3 * axis.width_hz(plane))) return false;
  }
  return true;
}

/// The axis evenly spaced in wavelength from the first to the last of listed frequencies.
imager::SpectralAxis through_ends_in_wavelength(imager::SpectralAxis axis, const casacore::Vector<double>& listed_hz) {
  const double first = listed_hz[0], last = listed_hz[listed_hz.size() - 1];
  axis.in_wavelength = true;
  axis.reference_hz = first;
  axis.increment_hz = first * (1 - first / last) / static_cast<double>(listed_hz.size() - 1);
  return axis;
}

imager::SpectralAxis spectral_axis_of(casacore::SpectralCoordinate spectral, int channels, const std::string& path) {
  spectral.setWorldAxisUnits(casacore::Vector<casacore::String>(1, "Hz"));
  imager::SpectralAxis axis;
  axis.increment_hz = spectral.increment()[0] * spectral.linearTransform()(0, 0);
  axis.reference_hz = spectral.referenceValue()[0] - spectral.referencePixel()[0] * axis.increment_hz;
  axis.channels = channels;
  axis.frame = spectral_frame_of(spectral.frequencySystem(false));
  axis.rest_frequency_hz = spectral.restFrequency();
  const casacore::Vector<double> listed = spectral.worldValues();
  if (lie_on(axis, listed)) return axis;
  imager::SpectralAxis in_wavelength = through_ends_in_wavelength(axis, listed);
  if (!lie_on(in_wavelength, listed))
    refuse(path, "the frequencies of its planes are evenly spaced neither in frequency nor in wavelength");
  return in_wavelength;
}

std::vector<imager::Stokes> stokes_of(const casacore::StokesCoordinate& coordinate, const std::string& path) {
  std::vector<imager::Stokes> list;
  for (const casacore::Int code : coordinate.stokes()) {
    if (!imager::is_stokes_code(code))
      refuse(path, "it has a plane of " + casacore::Stokes::name(casacore::Stokes::type(code)) +
                       "; expected planes of I, Q, U and V, or of correlations");
    list.push_back(static_cast<imager::Stokes>(code));
  }
  return list;
}

/// The value that a coordinate has for all pixels, where it has a world axis and no pixel axis; else none.
std::optional<double> value_without_pixels(const casacore::CoordinateSystem& coordinates, casacore::Coordinate::Type type) {
  const casacore::Int coordinate = coordinates.findCoordinate(type);
  if (coordinate < 0) return std::nullopt;
  const casacore::Int world_axis = coordinates.worldAxes(static_cast<casacore::uInt>(coordinate))[0];
  if (world_axis < 0 || coordinates.pixelAxes(static_cast<casacore::uInt>(coordinate))[0] >= 0) return std::nullopt;
  casacore::Vector<double> world(coordinates.nWorldAxes());
  const casacore::Vector<double> first(coordinates.nPixelAxes(), 0.0);
  if (!coordinates.toWorld(world, first)) throw std::runtime_error(coordinates.errorMessage());
  return casacore::Quantity(world[static_cast<std::size_t>(world_axis)],
                            coordinates.worldAxisUnits()[static_cast<std::size_t>(world_axis)])
      .getBaseValue();
}

/// Reads values that hold for all pixels, see header_of().
void read_axes_without_pixels(const casacore::CoordinateSystem& coordinates, imager::ImageHeader& header,
                              const std::string& path) {
  if (const auto frequency_hz = value_without_pixels(coordinates, casacore::Coordinate::SPECTRAL)) {
    header.spectral = spectral_axis_of(coordinates.spectralCoordinate(), 1, path);
    header.spectral.reference_hz = *frequency_hz;
  }
  if (const auto code = value_without_pixels(coordinates, casacore::Coordinate::STOKES))
    header.stokes = stokes_of(
        casacore::StokesCoordinate(casacore::Vector<casacore::Int>(1, static_cast<casacore::Int>(std::lround(*code)))), path);
}

imager::Observation observation_of(const casacore::ObsInfo& info, const imager::SpectralAxis& axis) {
  imager::Observation observation;
  observation.telescope = info.telescope();
  observation.observer = info.observer();
  const casacore::MVEpoch date = info.obsDate().getValue();
  if (date.get() > 0) observation.date_obs = casacore::MVTime(date).string(casacore::MVTime::FITS, 9);
  observation.frequency_hz = axis.band().middle_hz();
  observation.bandwidth_hz = axis.band().width_hz();
  observation.spectral_frame = axis.frame;
  return observation;
}

}  // namespace

casacore::CoordinateSystem casa_coordinates(const imager::ImageHeader& header) {
  casacore::CoordinateSystem coordinates;
  coordinates.addCoordinate(direction_coordinate(header.geometry));
  coordinates.addCoordinate(stokes_coordinate(header.stokes));
  coordinates.addCoordinate(spectral_coordinate(header));
  coordinates.setObsInfo(obs_info(header.observation, header.geometry.phase_centre));
  return coordinates;
}

void check_frames(const casacore::RecordInterface& coordinates, const std::string& path) {
  for (casacore::uInt field = 0; field < coordinates.nfields(); ++field) {
    if (coordinates.name(field).find("direction") != 0 || coordinates.dataType(field) != casacore::TpRecord) continue;
    const casacore::RecordInterface& direction = coordinates.asRecord(field);
    const casacore::String system = direction.isDefined("system") ? direction.asString("system") : casacore::String();
    casacore::MDirection::Types type{};
    if (!casacore::MDirection::getType(type, system) || frame_name(type).empty())
      refuse(path,
             "its directions are in " + (system.empty() ? "no frame" : system) + "; expected J2000, ICRS, B1950 or GALACTIC");
  }
}

casacore::IPosition CasaPlanes::first_pixel(const imager::PlaneIndex& at) const {
  casacore::IPosition first(shape.size(), 0);
  if (stokes >= 0) first[static_cast<std::size_t>(stokes)] = at.stokes;
  if (spectral >= 0) first[static_cast<std::size_t>(spectral)] = at.channel;
  return first;
}

casacore::IPosition CasaPlanes::plane_shape() const {
  casacore::IPosition plane(shape.size(), 1);
  plane[0] = shape[0];
  plane[1] = shape[1];
  return plane;
}

CasaPlanes find_planes(const casacore::CoordinateSystem& coordinates, const casacore::IPosition& shape,
                       const std::string& path) {
  CasaPlanes planes;
  planes.shape = shape;
  planes.stokes = coordinates.polarizationAxisNumber();
  planes.spectral = coordinates.spectralAxisNumber();
  planes.celestial = coordinates.findCoordinate(casacore::Coordinate::DIRECTION) >= 0;
  const casacore::Vector<casacore::Int> direction = coordinates.directionAxesNumbers();
  if (planes.celestial && (direction.size() != 2 || direction[0] != 0 || direction[1] != 1))
    refuse(path, "its first two axes are not right ascension and declination");
  if (shape.size() < 2 || (planes.stokes >= 0 && planes.stokes < 2) || (planes.spectral >= 0 && planes.spectral < 2))
    refuse(path, "its first two axes are no axes of pixels");
  for (int axis = 2; axis < static_cast<int>(shape.size()); ++axis) {
    if (axis == planes.stokes || axis == planes.spectral) continue;
    const casacore::Int world = coordinates.pixelAxisToWorldAxis(static_cast<casacore::uInt>(axis));
    const std::string name = world < 0 ? "" : coordinates.worldAxisNames()[static_cast<casacore::uInt>(world)];
    const auto length = shape[static_cast<std::size_t>(axis)];
    if (length > 1 || !says_nothing(name))
      refuse(path, "its axis " + std::to_string(axis + 1) + " of type '" + name + "' has length " + std::to_string(length) +
                       "; expected one Stokes axis, one spectral axis, and others of length 1 without a name");
  }
  return planes;
}

imager::ImageHeader header_of(const casacore::CoordinateSystem& coordinates, const CasaPlanes& planes,
                              const std::string& path) {
  imager::ImageHeader header;
  read_axes_without_pixels(coordinates, header, path);
  if (planes.spectral >= 0)
    header.spectral = spectral_axis_of(coordinates.spectralCoordinate(),
                                       static_cast<int>(planes.shape[static_cast<std::size_t>(planes.spectral)]), path);
  if (planes.stokes >= 0) header.stokes = stokes_of(coordinates.stokesCoordinate(), path);
  header.observation = observation_of(coordinates.obsInfo(), header.spectral);
  return header;
}

std::optional<imager::SkyGrid> grid_of(const casacore::CoordinateSystem& coordinates, const CasaPlanes& planes,
                                       const std::string& path) {
  if (!planes.celestial) return std::nullopt;
  return grid_of(coordinates.directionCoordinate(), planes.shape, path);
}

}  // namespace misfit::ms_io
