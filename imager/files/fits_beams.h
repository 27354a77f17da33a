#pragma once

#include "imager/files/fits_file.h"
#include "imager/files/plane_beams.h"

namespace misfit::imager {

/// Cards of the primary header that write_beams() may add.
constexpr int fits_beam_cards = 3;

/// Writes the beams of planes: BMAJ, BMIN and BPA in degrees where all share one, CASAMBM = T where they do not. To be called
/// before write_beam_table().
void write_beams(FitsFile& file, const PlaneBeams& beams);

/// Appends the binary table BEAMS where the planes do not share one beam: a row for each with BMAJ and BMIN in arcsec, BPA in
/// degrees, CHAN and POL, the plane counted from 0. A plane without
/// beam has BMAJ = BMIN = no_beam_arcsec. It is the convention of CASA, which casacore and spectral-cube read.
void write_beam_table(FitsFile& file, const PlaneBeams& beams);

/// The beams that the file states, of an image of so many planes. Leaves the file at its primary image.
PlaneBeams read_beams(FitsFile& file, int channels, int stokes);

}  // namespace misfit::imager
