// Times calls of a transform of arrays in C++: misfit_arrays ROWS CHANNELS PIXELS EPSILON W THREADS, with uvw (float64), freq
// (float64), vis (complex64) and wgt (float32) in files of these names in the current folder, as numpy's tofile() writes them.
// For every line of its input, adjoint or predict, it prints the seconds that one took,
// planning included.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "imager/arrays/array_transform.h"
#include "imager/numerics/parallel.h"
#include "imager/numerics/stage_times.h"
#include "kernels/kernel_cache.h"

namespace {

using namespace misfit::imager;
namespace kernels = misfit::kernels;

template <typename T>
std::vector<T> read(const char* name, std::size_t size) {
  std::vector<T> values(size);
  std::ifstream file(name, std::ios::binary);
  if (!file.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(size * sizeof(T))))
    throw std::runtime_error(std::string(name) + " cannot be read, or is too short");
  return values;
}

int run(char** argument) {
  const std::size_t rows = std::stoul(argument[1]), channels = std::stoul(argument[2]);
  const int pixels = std::stoi(argument[3]);
  const auto uvw = read<double>("uvw", 3 * rows);
  const auto visibility = read<std::complex<float>>("vis", rows * channels);
  const auto weight = read<float>("wgt", rows * channels);
  ArrayCoordinates at;
  at.uvw_m = {uvw.data(), rows, 3, 3};
  at.frequency_hz = read<double>("freq", channels);
  at.w_sign = std::stoi(argument[5]);
  ArrayTransformOptions options;
  options.image = {pixels, pixels, 1e-6, 1e-6, 0, 0};
  options.accuracy = std::stod(argument[4]);
  options.threads = std::stoi(argument[6]);
  options.kernel = kernels::cached(options.kernel, "kernels");  // as the module has them
  const auto step = static_cast<std::ptrdiff_t>(channels);
  const Strided<const float> weights{weight.data(), rows, channels, step};
  std::vector<float> image(static_cast<std::size_t>(pixels) * static_cast<std::size_t>(pixels));
  std::vector<std::complex<float>> predicted(visibility.size());
  for (std::string what; std::getline(std::cin, what);) {
    const Stopwatch watch;
    const ArrayTransform transform(options, at);
    if (what == "adjoint") {
      const Image made = transform.adjoint(ArrayValues<float>{{visibility.data(), rows, channels, step}, weights}).image;
      const auto columns = static_cast<std::size_t>(pixels);
      parallel_for(columns, options.threads, [&](std::size_t row) {
        std::copy_n(made.row(static_cast<int>(row)), columns, image.begin() + static_cast<std::ptrdiff_t>(row * columns));
      });
    } else {
      const auto side = static_cast<std::size_t>(pixels);
      transform.predict<float>({image.data(), side, side, pixels}, weights, {predicted.data(), rows, channels, step});
    }
    std::cout << watch.seconds() << std::endl;
  }
  return 0;
}

}  // namespace

int main(int count, char** argument) {
  try {
    if (count == 7) return run(argument);
    std::fprintf(stderr, "misfit_arrays: expected ROWS CHANNELS PIXELS EPSILON W THREADS\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "misfit_arrays: %s\n", error.what());
  }
  return 1;
}
