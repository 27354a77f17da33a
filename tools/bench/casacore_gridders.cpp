// CasacoreGridder against casacore's own ConvolveGridder in one thread, by turns: nanoseconds a visibility and the median of
// the ratios of neighbouring runs, as a markdown table. usage: casacore_gridders [TURNS]
#include <casacore/scimath/Mathematics/ConvolveGridder.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "kernels/catalogue.h"
#include "kernels/kernel_table.h"
#include "tools/hosts/casacore_gridder.h"

namespace {

using casacore::Complex;
using casacore::Double;
using Gridder = casacore::Gridder<Double, Complex>;
using Stock = casacore::ConvolveGridder<Double, Complex>;
using Array = casacore::Array<Complex>;

struct Cell {
  double u, v;
};

constexpr std::size_t visibilities = 200000;
constexpr double margin = 16;  ///< cells at the border that no visibility comes near

/// Visibilities at random places.
std::vector<Cell> scattered(int size) {
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> anywhere(margin, size - margin);
  std::vector<Cell> cells(visibilities);
  for (Cell& cell : cells) cell = {anywhere(generator), anywhere(generator)};
  return cells;
}

/// Visibilities in the order of a set: 351 baselines, each with 64 neighbouring channels on a ray from the centre, then the
/// next time.
std::vector<Cell> tracks(int size) {
  constexpr std::size_t baselines = 351, channels = 64;
  std::mt19937_64 generator(4);
  std::uniform_real_distribution<double> part(0, 1);
  std::vector<std::pair<double, double>> baseline(baselines);  // length and angle
  for (auto& [length, angle] : baseline) {
    length = (size / 2.0 - margin) * part(generator) * part(generator);
    angle = 2 * M_PI * part(generator);
  }
  std::vector<Cell> cells;
  for (int time = 0; cells.size() < visibilities; ++time)
    for (const auto& [length, angle] : baseline)
      for (std::size_t channel = 0; channel < channels; ++channel) {
        const double radius = length * (0.9 + 0.1 * static_cast<double>(channel) / channels), turned = angle + 0.01 * time;
        cells.push_back({size / 2.0 + radius * std::cos(turned), size / 2.0 + radius * std::sin(turned)});
      }
  cells.resize(visibilities);
  return cells;
}

template <typename Visit>
double nanoseconds(const std::vector<Cell>& cells, Visit&& visit) {
  casacore::Vector<Double> position(2);
  const auto start = std::chrono::steady_clock::now();
  for (const Cell& cell : cells) {
    position[0] = cell.u;
    position[1] = cell.v;
    visit(position);
  }
  return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count() /
         static_cast<double>(cells.size());
}

double gridding(Gridder& gridder, const std::vector<Cell>& cells, Array& grid) {
  return nanoseconds(cells, [&](const casacore::Vector<Double>& position) { gridder.grid(grid, position, Complex(1, -1)); });
}

double degridding(Gridder& gridder, const std::vector<Cell>& cells, const Array& grid) {
  Complex value, total;
  const double time = nanoseconds(cells, [&](const casacore::Vector<Double>& position) {
    gridder.degrid(grid, position, value);
    total += value;
  });
  if (std::isnan(total.real())) std::printf("not a number\n");
  return time;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Prints a row with both gridders, timed by turns.
template <typename Time>
void print_row(const std::string& what, int turns, Time&& time, Gridder& stock, Gridder& ours) {
  std::vector<double> stock_time, our_time, ratio;
  for (int turn = 0; turn < turns; ++turn) {
    stock_time.push_back(time(stock));
    our_time.push_back(time(ours));
    ratio.push_back(our_time.back() / stock_time.back());
  }
  std::printf("| %s | %.1f | %.1f | %.2f |\n", what.c_str(), median(stock_time), median(our_time), median(ratio));
}

void compare(int width, int size, int turns, const std::filesystem::path& file) {
  misfit::kernels::write_kernel_table(misfit::kernels::kernel_family("least-misfit").make(width, 0.25), {}, file);
  const casacore::IPosition shape(2, size, size);
  const casacore::Vector<Double> scale(2, 1.0), offset(2, 0.0);
  Stock stock(shape, scale, offset, "SF");
  misfit::hosts::CasacoreGridder ours(file, shape, scale, offset);
  Array grid(shape, Complex(0));
  for (const bool in_tracks : {false, true}) {
    const std::vector<Cell> cells = in_tracks ? tracks(size) : scattered(size);
    const std::string where = std::to_string(width) + " | " + std::to_string(size) + (in_tracks ? " | tracks" : " | scattered");
    print_row(
        where + " | grid", turns, [&](Gridder& gridder) { return gridding(gridder, cells, grid); }, stock, ours);
    print_row(
        where + " | degrid", turns, [&](Gridder& gridder) { return degridding(gridder, cells, grid); }, stock, ours);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int turns = argc > 1 ? std::max(1, std::atoi(argv[1])) : 15;
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("casacore_gridders_" + std::to_string(getpid()) + ".fits");
  int status = 0;
  try {
    std::printf("| W | grid | visibilities | operation | stock, ns | W's, ns | ratio |\n|---|---|---|---|---|---|---|\n");
    for (const int size : {1024, 4096})
      for (const int width : {4, 6, 7, 8, 10, 14}) compare(width, size, turns, file);
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "casacore_gridders: %s\n", failure.what());
    status = 1;
  }
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  return status;
}
