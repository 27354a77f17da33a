#include "ms_io/measurement_set.h"

#include <utility>

#include "ms_io/metadata_internal.h"
#include "ms_io/table_access_internal.h"
#include "ms_io/uvw_scan_internal.h"
#include "ms_io/visibility_reader_internal.h"

namespace misfit::ms_io {
namespace {

std::shared_ptr<const OpenSet> open_selected(const std::string& path, const Selection& selection,
                                             const std::string& data_column, const std::vector<imager::Stokes>& stokes,
                                             std::uint64_t block_samples) {
  const auto opened = std::make_shared<OpenSet>();
  opened->path = path;
  opened->data_column = column_name(data_column);
  opened->set = open_measurement_set(path, Access::read);
  if (!data_column.empty()) require_visibility_column(opened->set, path, opened->data_column);
  opened->selected = select_rows(opened->set, path, selection, block_samples);
  if (data_column.empty()) return opened;
  for (const Setup& setup : opened->selected.setups) {
    try {
      opened->recipes.push_back(stokes_recipe(setup.correlation_types, stokes));
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(path + ", DATA_DESC_ID " + std::to_string(setup.data_description) + ": " + error.what());
    }
  }
  return opened;
}

}  // namespace

struct MeasurementSet::Impl {
  std::shared_ptr<const OpenSet> open_set;
  imager::Observation observation;
};

MeasurementSet::MeasurementSet(const std::string& path, const Selection& selection, const std::string& data_column,
                               const std::vector<imager::Stokes>& stokes, std::uint64_t block_samples) {
  const auto impl = std::make_shared<Impl>();
  impl->open_set = open_selected(path, selection, data_column, stokes, block_samples);
  impl->observation = describe(impl->open_set->set, path, impl->open_set->selected);
  impl_ = impl;
}

MeasurementSet::~MeasurementSet() = default;

const imager::Observation& MeasurementSet::observation() const {
  return impl_->observation;
}
std::uint64_t MeasurementSet::rows() const {
  return impl_->open_set->selected.rows;
}
std::uint64_t MeasurementSet::samples() const {
  return impl_->open_set->selected.samples;
}
imager::UvwReach MeasurementSet::reach(ReachOf rows) const {
  return scan_uvw(*impl_->open_set, rows);
}
void MeasurementSet::visit_coordinates(const std::function<void(const imager::SampleCoordinates&)>& visit) const {
  visit_uvw(*impl_->open_set, visit);
}
std::unique_ptr<imager::BlockStream> MeasurementSet::open() const {
  return read_blocks(impl_->open_set);
}

}  // namespace misfit::ms_io
