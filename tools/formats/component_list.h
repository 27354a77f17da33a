#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "imager/data/source.h"
#include "imager/data/stokes.h"

namespace misfit::tools {

/// Frames of directions, by their names in lists and in FITS RADESYS; the first name of a RADESYS is written.
inline constexpr std::array<std::pair<const char*, const char*>, 5> frames_of_lists{
    {{"J2000", "FK5"}, {"ICRS", "ICRS"}, {"B1950", "FK4"}, {"FK5", "FK5"}, {"FK4", "FK4"}}};

/// The sources of a CSV file. Its first line names the columns, in any order: `flux_jy`; either `ra_deg` and `dec_deg`, with
/// `frame`, J2000, ICRS or B1950 (as it was in 1950), where that is not the frame of `phase_centre`, or `l_arcsec` and
/// `m_arcsec`, direction cosines in units of an arcsecond; and, if there are
/// extended sources, `scale_arcsec`, the full width at half maximum of a circular Gaussian, 0 for a point; and, if there are
/// spectra, `spectral_index` and `reference_frequency_hz`, the frequency of flux_jy. Blank lines and lines that begin with #
/// are skipped. Throws std::runtime_error that names the file, the line, the value and what was
/// expected.
std::vector<imager::Source> read_component_list(const std::string& path, const imager::SkyDirection& phase_centre);

/// The sources of a list that may also have the columns `flux_q_jy`, `flux_u_jy` and `flux_v_jy`, with their fluxes in I, Q, U
/// and V; none where a Stokes parameter has no column.
std::array<std::vector<imager::Source>, 4> read_stokes_components(const std::string& path,
                                                                  const imager::SkyDirection& phase_centre);

/// True if the list has columns of right ascension and declination, whatever else is wrong with it. Throws std::runtime_error
/// where it cannot be read.
bool lists_directions(const std::string& path);

/// FITS RADESYS of the frame that all lines of the list state; empty where they do not. Throws std::runtime_error where they
/// differ, and where the list cannot be read.
std::string listed_frame(const std::string& path);

/// Writes a list that `read_component_list` takes, with the columns ra_deg,dec_deg,flux_jy,scale_arcsec,frame and as many
/// digits as give each number back exactly; 0 ≤ ra_deg < 360, in the frame of `phase_centre`. The file appears under its name
/// only when complete. Throws std::runtime_error that names the path, and the line of a source that has no place on the sky, or
/// whose numbers are not finite.
void write_component_list(const std::string& path, const std::vector<imager::Source>& sources,
                          const imager::SkyDirection& phase_centre);

/// The sources of one Stokes parameter or correlation.
struct SourcesOf {
  imager::Stokes stokes = imager::Stokes::I;
  std::vector<imager::Source> sources;
};
/// Writes the lists of several Stokes parameters or correlations into one, one after the other, with a column for each besides
/// `flux_jy`: flux_q_jy, flux_xx_jy and so on. A line has 0 in all columns but its own. Without a phase centre, as where that
/// moves, places are in the columns l_arcsec,m_arcsec.
void write_stokes_components(const std::string& path, const std::vector<SourcesOf>& lists,
                             const std::optional<imager::SkyDirection>& phase_centre);

}  // namespace misfit::tools
