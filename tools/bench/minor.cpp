// Seconds of one minor cycle on a dirty image and PSF, as misfit writes them with --niter 0: no visibilities, no major cycles.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "imager/clean/deconvolver.h"
#include "imager/files/fits_image.h"
#include "imager/numerics/parallel.h"

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void measure(const misfit::imager::MinorCycle& minor, const misfit::imager::Image& dirty, int components) {
  misfit::imager::MinorCycleOptions options;
  options.max_iterations = components;
  const auto start = Clock::now();
  const misfit::imager::MinorCycleReport report = minor.clean(dirty, options);
  std::printf("%8d components  %8.3f s  peak %.4g Jy/beam\n", report.iterations(), seconds_since(start), report.peak_jy);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program("Seconds of a minor cycle, image in, model out");
  std::string dirty, psf;
  misfit::imager::DeconvolverChoice choice;
  choice.threads = misfit::imager::available_threads();
  std::vector<int> components{1000, 10000, 100000};
  program.add_option("dirty", dirty, "FITS image")->required();
  program.add_option("psf", psf, "FITS image of as many pixels")->required();
  program.add_option("--deconvolver", choice.name)->capture_default_str();
  program.add_option("--scales", choice.scale_pixels)->delimiter(',');
  program.add_option("--components", components, "how many, for each run")->delimiter(',')->capture_default_str();
  program.add_option("--threads", choice.threads);
  CLI11_PARSE(program, argc, argv);
  try {
    const misfit::imager::Image image = misfit::imager::read_fits(dirty).image;
    const auto start = Clock::now();
    const misfit::imager::Image beam = misfit::imager::read_fits(psf).image;
    const auto minor = misfit::imager::make_deconvolver(choice, {&beam});
    std::printf("%d × %d pixels, %s, %d threads, made ready in %.3f s\n", image.width, image.height, choice.name.c_str(),
                choice.threads, seconds_since(start));
    for (const int most : components) measure(*minor, image, most);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "misfit_minor: %s\n", error.what());
    return 1;
  }
}
