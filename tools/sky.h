#pragma once

#include <string>
#include <vector>

#include "imager/source.h"

namespace misfit::tools {

/// The sources of a CSV file. Its first line names the columns, in any order: `flux_jy`, and either `ra_deg` and `dec_deg`, in
/// the frame of `phase_centre`, or `l_arcsec` and `m_arcsec`, direction cosines in units of an arcsecond. Blank lines and lines
/// that begin with # are skipped. Throws std::runtime_error that names the file, the line and what was expected.
std::vector<imager::Source> read_component_list(const std::string& path, const imager::SkyDirection& phase_centre);

/// The 34 sources of Ye, Gull, Tan & Nikolic (2020, MNRAS 491, 1146) on cells of `cell_rad`.
std::vector<imager::Source> test_card(double cell_rad);

}  // namespace misfit::tools
