// Damaged MeasurementSets, by the whole program.
#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <vector>

#include "ms_io/simulated_set.h"
#include "tests/fuzz/fuzzing.h"
#include "tests/fuzz/set_damage.h"
#include "tools/program.h"

namespace {

namespace fs = std::filesystem;
using namespace misfit;
using Arguments = std::vector<std::string>;

constexpr std::size_t antennas = 4, baselines = 6, times = 3;

/// A set to damage, made once.
void make_set(const std::string& path) {
  ms_io::SimulatedObservation observation;
  observation.fields.front().phase_centre = {1.25, 0.5, "FK5"};
  for (std::size_t a = 0; a < antennas; ++a) {
    observation.antenna_name.push_back("A" + std::to_string(a));
    observation.antenna_itrf_m.push_back({-1601185.0 + 100.0 * static_cast<double>(a * a), -5041977.0, 3554875.0});
  }
  for (std::size_t t = 0; t < times; ++t) observation.time_mjd_s.push_back(4.9e9 + 10.0 * static_cast<double>(t));
  observation.frequency_hz = {1e9, 1.001e9};
  observation.channel_width_hz = 1e6;
  const auto uvw = [](std::size_t t) {
    std::vector<double> metres;
    for (std::size_t b = 0; b < baselines; ++b) {
      const double row = static_cast<double>(t * baselines + b);
      metres.insert(metres.end(), {10 * row + 1, 50 - 7 * row, 0.5 * row});
    }
    return metres;
  };
  const auto ones = [](const imager::SampleCoordinates& where) {
    return std::vector<std::complex<double>>(where.samples(), {1, 0});
  };
  ms_io::write_simulated_set(path, observation, uvw, ones, {});
}

/// One of what the program does with a set.
Arguments command(std::size_t which, const std::string& set, const fs::path& folder) {
  const auto image = [&](const Arguments& more) {
    Arguments all{"image",  "--vis",     set,       "--imagename", folder / "a", "--imsize", "16",
                  "--cell", "300arcsec", "--quiet", "--threads",   "1",          "--memory", "0.5"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  const auto predict = [&](const Arguments& more) {
    Arguments all{"predict", "--vis", set, "--components", folder / "sky.csv", "--quiet"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  switch (which) {
    case 0:
      return image({});
    case 1:
      return image({"--niter", "3", "--weighting", "briggs", "--savemodel", "modelcolumn"});
    case 2:
      return image({"--specmode", "cube", "--outframe", "TOPO"});
    case 3:
      return image({"--stokes", "IV", "--pbcor", "--phasecenter", "J2000 1.25rad 0.5rad"});
    case 4:
      return image({"--field", "0", "--spw", "0:0~1", "--timerange", ">2000/01/01", "--antenna", "A0&A1"});
    case 5:
      return image({"--specmode", "cube", "--outframe", "LSRK"});
    case 6:
      return predict({});
    default:
      return predict({"--subtract", "--column", "REST"});
  }
}

/// The folder of everything, with the whole set, until the program ends.
struct Workplace {
  Workplace() {
    fs::create_directories(folder);
    setenv("MISFIT_CACHE", (folder / "cache").c_str(), 1);
    setenv("PATH", "", 1);  // no pictures, which take most of the time
    make_set(folder / "whole.ms");
    std::ofstream(folder / "sky.csv") << "l_arcsec,m_arcsec,flux_jy\n1,2,1\n";
  }
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;
  ~Workplace() { fs::remove_all(folder); }

  fs::path folder = fs::temp_directory_path() / ("misfit-fuzz-set-" + std::to_string(getpid()));
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0 || size > 64) return 0;
  static const Workplace workplace;
  static std::size_t runs = 0;
  const fs::path folder = workplace.folder / std::to_string(++runs);  // casacore remembers tables by name
  fs::create_directories(folder);
  const std::string set = folder / "a.ms";
  fs::copy(workplace.folder / "whole.ms", set, fs::copy_options::recursive);
  fs::copy(workplace.folder / "sky.csv", folder / "sky.csv");
  fuzz::damage(set, data + 1, size - 1);
  const Arguments typed = command(data[0] % 8, set, folder);
  try {
    Arguments last_first(typed.rbegin(), typed.rend());
    tools::make_program({"misfit"})->parse(last_first);
  } catch (const CLI::Error& error) {
    fuzz::require(false, std::string("options are right: ") + error.what());
  } catch (const std::exception& error) {
    const std::string said = error.what();  // what is in it that is no text, the program makes legible
    fuzz::require(!said.empty() && said.find('\n') == std::string::npos, "a message is one line: " + said);
  }
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    fuzz::require(entry.path().extension() != ".fits" || fs::file_size(entry.path()) % 2880 == 0, "images are whole");
  fs::remove_all(folder);
  return 0;
}
