#pragma once

#include <optional>
#include <string>
#include <vector>

namespace misfit::imager {

/// The kind of an image: a Stokes parameter, or one correlation of the feeds. The values are casacore's codes
/// (Stokes::StokesTypes).
enum class Stokes { I = 1, Q, U, V, RR, RL, LR, LL, XX, XY, YX, YY };

/// "I", "XX", …
std::string stokes_name(Stokes stokes);

/// Its value on a FITS STOKES axis: 1 to 4 for I to V, −1 to −8 for RR LL RL LR XX YY XY YX (Greisen & Calabretta 2002, table
/// 29).
int fits_stokes_code(Stokes stokes);

/// True if a code stands for a Stokes parameter or correlation here, as in CORR_TYPE of a MeasurementSet and on a FITS STOKES
/// axis.
bool is_stokes_code(int casacore_code);
bool is_fits_stokes_code(int fits_code);
Stokes stokes_of_fits_code(int fits_code);

/// The place of `wanted` in a list; nothing where it is not there.
std::optional<int> plane_of(const std::vector<Stokes>& list, Stokes wanted);

/// "IQUV" for I, Q, U and V.
std::string stokes_names(const std::vector<Stokes>& list);

/// The list that a text such as "I", "IQUV", "RRLL" or "XX,YY" names. Throws std::invalid_argument that says what was expected
/// where it names none, one twice, or some that do not lie evenly on a FITS axis (I Q V). If they lie evenly in another order
/// than the text's, the list has that order. "pseudoI" is I, see is_pseudo_i().
std::vector<Stokes> parse_stokes(const std::string& text);

/// True if a text, in capitals or not, asks for CASA's pseudoI: Stokes I also of samples that have one parallel hand alone.
bool is_pseudo_i(const std::string& text);

}  // namespace misfit::imager
