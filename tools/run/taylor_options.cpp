#include "tools/run/taylor_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <set>
#include <stdexcept>

#include "imager/data/stokes.h"
#include "tools/base/numbers.h"
#include "tools/base/option_checks.h"
#include "tools/base/quantity.h"
#include "tools/run/image_options.h"

namespace misfit::tools {
namespace {

bool is_frequency(const std::string& text) {
  try {
    return parse_frequency_hz(text) > 0;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

}  // namespace

void declare(CLI::App& command, TypedTaylor& o) {
  command.add_option(
      "--nterms", o.nterms,
      "Number of terms of the spectrum, 1 to 3: I(f) is a polynomial of (f - reffreq)/reffreq. 2 or 3 write images .tt0, .tt1, "
      "…, where .image includes the principal solution of the residuals; .alpha, the spectral index as the antennas saw it "
      "(--pbcor writes .alpha.pbcor, freed from the beam's narrowing with frequency); .alpha.error, its error by noise, NaN "
      "where .image.tt0 is below 5 times its noise; and for 3 .beta, the curvature. Components are points, or Gaussians with "
      "--deconvolver multiscale; no list of them is written");
  command.add_option(
      "--reffreq", o.reffreq,
      "Reference frequency of the terms, such as 1.4GHz. When empty: the middle between the edges of the outermost channels");
}

void settle_mtmfs(CLI::App& command, ImageOptions& o) {
  if (o.clean.deconvolver != "mtmfs") return;
  const bool points = std::all_of(o.clean.scales.begin(), o.clean.scales.end(), [](double scale) { return scale == 0; });
  if (points) o.clean.scales.clear();
  o.clean.deconvolver = points ? "hogbom" : "multiscale";
  CLI::Option* terms = command.get_option("--nterms");
  if (terms->count() > 0) return;
  o.taylor.nterms = 2;
  terms->default_str("2");
}

void check_taylor(const ImageOptions& image) {
  const TypedTaylor& o = image.taylor;
  if (o.nterms < 1 || o.nterms > imager::most_taylor_terms)
    refuse_option("nterms", std::to_string(o.nterms), "1 to " + std::to_string(imager::most_taylor_terms));
  if (o.nterms == 1 && !o.reffreq.empty()) refuse_option("reffreq", o.reffreq, "--nterms 2 or 3 beside it");
  if (!o.reffreq.empty() && !is_frequency(o.reffreq))
    refuse_option("reffreq", o.reffreq, "a frequency above 0, such as 1.4GHz");
  if (o.nterms > 1 && image.cube.is_cube()) refuse_option("nterms", std::to_string(o.nterms), "1 with --specmode cube");
  if (o.nterms > 1 && imager::parse_stokes(image.stokes).size() > 1)
    refuse_option("nterms", std::to_string(o.nterms), "--stokes of one parameter beside it, not " + image.stokes);
}

void check_taylor_band(const TypedTaylor& o, const std::vector<ms_io::SpectralWindow>& windows) {
  std::set<double> frequencies_hz;
  for (const ms_io::SpectralWindow& window : windows)
    frequencies_hz.insert(window.frequency_hz.begin(), window.frequency_hz.end());
  if (o.nterms == 1 || frequencies_hz.size() >= static_cast<std::size_t>(o.nterms)) return;
  std::string found;
  for (const double hz : frequencies_hz) found += (found.empty() ? "" : ", ") + frequency_text(hz, 8);
  throw std::runtime_error("--nterms " + std::to_string(o.nterms) + ": the channels selected have " +
                           (frequencies_hz.size() == 1 ? "one frequency, " : "two frequencies, ") + found + "; expected " +
                           std::to_string(o.nterms) + " or more, or fewer terms");
}

imager::TaylorExpansion taylor_expansion(const TypedTaylor& o, const imager::Observation& observation) {
  return {o.reffreq.empty() ? observation.frequency_hz : parse_frequency_hz(o.reffreq), o.nterms};
}

}  // namespace misfit::tools
