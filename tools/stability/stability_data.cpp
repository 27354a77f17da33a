#include "tools/stability/stability_data.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "imager/direct/source_sums.h"
#include "imager/numerics/constants.h"
#include "imager/numerics/parallel.h"
#include "ms_io/measurement_set.h"
#include "tools/base/array.h"
#include "tools/base/numbers.h"
#include "tools/run/named_data.h"

namespace misfit::tools {
namespace {

imager::VisibilityBlock empty_block() {
  imager::VisibilityBlock block;
  block.frequency_hz = {imager::speed_of_light_m_s};
  return block;
}

void append(double u, double v, float weight, imager::VisibilityBlock& block) {
  block.uvw_m.append({u, v, 0});
  block.weight.push_back(weight);
}

}  // namespace

double StabilityData::cell_rad() const {
  double largest = 0;
  for (std::size_t row = 0; row < block.rows(); ++row)
    largest = std::max({largest, std::abs(block.uvw_m[3 * row]), std::abs(block.uvw_m[3 * row + 1])});
  return reach / (2 * largest);
}

StabilityData made_data(std::size_t samples) {
  StabilityData data{empty_block(), ""};
  const AntennaArray array = antenna_array("vla-a");
  constexpr double dec_rad = 0.6, wavelength_m = 0.06;
  const std::size_t baselines = array.itrf_m.size() * (array.itrf_m.size() - 1) / 2;
  const std::size_t times = std::max<std::size_t>(1, samples / baselines);
  for (std::size_t t = 0; t < times; ++t) {
    const double hour_angle_rad = times == 1 ? 0 : -0.7 + 1.4 * static_cast<double>(t) / static_cast<double>(times - 1);
    const std::vector<double> uvw_m = uvw(array, {hour_angle_rad, dec_rad});
    for (std::size_t i = 0; i < baselines; ++i)
      append(uvw_m[3 * i] / wavelength_m, uvw_m[3 * i + 1] / wavelength_m, 1, data.block);
  }
  data.description = "the array vla-a at " + std::to_string(times) + " hour angles, " +
                     grouped(static_cast<long long>(data.block.samples())) + " samples";
  return data;
}

namespace {

StabilityData every_so_many(const std::string& vis, std::size_t samples) {
  const ms_io::MeasurementSet set(vis, {}, "data");
  const std::uint64_t step = (set.samples() + samples - 1) / samples;
  StabilityData data{empty_block(), ""};
  std::uint64_t at = 0;
  imager::SampleCounts counts;
  const auto stream = set.open();
  while (const auto block = stream->next()) {
    counts += block->counts;
    for (std::size_t i = 0; i < block->samples(); ++i) {
      if (at++ % step != 0 || block->weight[i] == 0) continue;
      const double* const uvw_m = &block->uvw_m[3 * (i / block->channels())];
      const double per_m = block->frequency_hz[i % block->channels()] / imager::speed_of_light_m_s;
      append(uvw_m[0] * per_m, uvw_m[1] * per_m, block->weight[i], data.block);
    }
  }
  if (counts.used == 0) throw imager::NothingUsable(counts);
  if (data.block.rows() == 0)
    throw std::runtime_error(vis + ": every " + std::to_string(step) + "th sample was looked at, and none can be used; " +
                             std::to_string(counts.used) + " others could be; expected data that are not flagged so evenly");
  data.description = "one of " + std::to_string(step) + " samples of " + vis + ", " +
                     grouped(static_cast<long long>(data.block.samples())) + " usable ones";
  return data;
}

std::vector<imager::Source> sky_of(const imager::ImageGeometry& g, double peak_jy) {
  const int row = g.centre_row(), column = g.centre_column();
  return {{g.at(row + 4, column + 5), peak_jy}, {g.at(row + 12, column - 15), 0.5}, {g.at(row - 7, column + 10), 0.3}};
}

}  // namespace

StabilityData sampled_data(const std::string& vis, std::size_t samples) {
  return naming(vis, [&] { return every_so_many(vis, samples); });
}

StabilityCase case_of(const std::string& name, imager::VisibilityBlock block, const imager::ImageGeometry& geometry,
                      double peak_jy) {
  const auto exact = imager::predict_sources(sky_of(geometry, peak_jy), block, imager::available_threads());
  block.visibility.assign(exact.begin(), exact.end());
  StabilityCase made;
  made.name = name;
  made.block = std::make_shared<imager::VisibilityBlock>(std::move(block));
  made.geometry = geometry;
  return made;
}

StabilityCase case_of(const std::string& name, imager::VisibilityBlock block, const StabilityData& data, double peak_jy) {
  return case_of(name, std::move(block), {stability_pixels, stability_pixels, data.cell_rad(), {}, {}}, peak_jy);
}

}  // namespace misfit::tools
