#include "imager/clean/clean.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace misfit::imager {
void check(const CleanOptions& o, const std::string& prefix) {
  const auto expect = [&](bool holds, const char* name, double value, const char* expected) {
    if (holds) return;
    std::ostringstream typed;
    typed << value;
    throw std::invalid_argument(prefix + name + " " + typed.str() + ": expected " + expected);
  };
  expect(o.max_iterations >= 0, "niter", o.max_iterations, "0 or more");
  expect(o.gain > 0 && o.gain <= 1, "gain", o.gain, "more than 0 and at most 1");
  expect(o.threshold_jy >= 0, "threshold", o.threshold_jy, "0 or more");
  expect(o.nsigma >= 0, "nsigma", o.nsigma, "0 or more");
  expect(o.cycle_factor > 0, "cyclefactor", o.cycle_factor, "more than 0");
  expect(o.min_psf_fraction > 0 && o.min_psf_fraction <= 1, "minpsffraction", o.min_psf_fraction, "more than 0 and at most 1");
  expect(o.max_psf_fraction >= o.min_psf_fraction && o.max_psf_fraction <= 1, "maxpsffraction", o.max_psf_fraction,
         "minpsffraction to 1");
  expect(o.cycle_iterations == -1 || o.cycle_iterations >= 1, "cycleniter", o.cycle_iterations, "-1 (no limit), 1 or more");
  expect(o.max_major_cycles >= -1, "nmajor", o.max_major_cycles, "-1 (no limit) or more");
}

double largest_sidelobe(const Image& psf, const Image& beam) {
  double largest = 0;
  for (std::size_t i = 0; i < psf.pixel.size(); ++i) largest = std::max(largest, std::abs(psf.pixel[i] - beam.pixel[i]));
  return largest;
}

double largest_sidelobe(const Image& psf, const Beam& beam, double cell_rad, int threads) {
  Image point(psf.width, psf.height);
  point.at(psf.height / 2, psf.width / 2) = 1;
  return largest_sidelobe(psf, convolve_with_beam(point, beam, cell_rad, threads));
}

CleanState first_state(const ComponentModel& model) {
  CleanState state;
  state.model = state.best_model = model;
  return state;
}

}  // namespace misfit::imager
