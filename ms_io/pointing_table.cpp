#include <casacore/casa/Arrays/Matrix.h>
#include <casacore/measures/Measures/MCDirection.h>
#include <casacore/measures/Measures/MEpoch.h>
#include <casacore/measures/Measures/MeasConvert.h>
#include <casacore/measures/Measures/MeasFrame.h>
#include <casacore/measures/TableMeasures/ArrayMeasColumn.h>
#include <casacore/measures/TableMeasures/ScalarMeasColumn.h>
#include <casacore/tables/Tables/ArrayColumn.h>
#include <casacore/tables/Tables/ScalarColumn.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "ms_io/celestial_frame_internal.h"
#include "ms_io/metadata_internal.h"
#include "ms_io/observing_place_internal.h"
#include "ms_io/pointing_table_internal.h"
#include "ms_io/table_access_internal.h"

namespace misfit::ms_io {

using casacore::MDirection;
using casacore::MEpoch;
using casacore::MVDirection;

/// Longitude and latitude Σ c_k (t − origin)^k.
struct PointingTable::Course {
  double origin_s = 0;
  casacore::Matrix<double> coefficients;  ///< (axis, k), rad

  double at(std::size_t axis, double time_s) const {
    double value = 0;
    for (std::size_t k = coefficients.ncolumn(); k-- > 0;) value = value * (time_s - origin_s) + coefficients(axis, k);
    return value;
  }
};

struct PointingTable::Entry {
  double time_s = 0;
  double interval_s = 0;
  double longitude_rad = 0, latitude_rad = 0;
  MDirection::Types frame = MDirection::J2000;
  std::shared_ptr<const Course> course;  ///< null where it has no polynomial

  double reach_s(double row_interval_s) const {
    return interval_s > 0 ? std::max(interval_s, row_interval_s) : std::numeric_limits<double>::infinity();
  }
  /// True if this entry alone gives the antenna's direction at a time.
  bool decides(double at_s, double row_interval_s) const {
    const bool stays = course || interval_s > 1.5 * row_interval_s;
    return stays && interval_s > 0 && std::abs(at_s - time_s) <= interval_s / 2;
  }
  MVDirection at(double at_s) const {
    return course ? MVDirection(course->at(0, at_s), course->at(1, at_s)) : MVDirection(longitude_rad, latitude_rad);
  }
};

namespace {

constexpr const char* remedy = "; expected entries of all antennas at the times of their rows, or no --usepointing";

std::string doing(const OpenSet& open_set) {
  return "cannot read POINTING of " + open_set.path;
}

MEpoch::Types clock_of(const casacore::Table& table) {
  return MEpoch::castType(casacore::ScalarMeasColumn<MEpoch>(table, "TIME").getMeasRef().getType());
}

/// (1 − t) a + t b, on the sphere.
MVDirection between(const MVDirection& a, const MVDirection& b, double t) {
  if (t == 0) return a;
  MVDirection mean((1 - t) * a(0) + t * b(0), (1 - t) * a(1) + t * b(1), (1 - t) * a(2) + t * b(2));
  mean.adjust();
  return mean;
}

}  // namespace

/// The places of antennas, and the turn from their own sky to the sky of the stars.
class PointingTable::Places {
 public:
  explicit Places(const OpenSet& open_set)
      : set_(open_set.set),
        telescope_(observing_place(set_, observation_of(set_, open_set.selected.first_row))),
        row_clock_(clock_of(set_)),
        clock_(clock_of(set_.pointing())) {}

  MEpoch epoch(double time_s) const { return {casacore::MVEpoch(casacore::Quantity(time_s, "s")), row_clock_}; }
  /// A TIME of the main table, as POINTING counts it.
  double pointing_time_s(double time_s) const {
    return clock_ == row_clock_ ? time_s : MEpoch::Convert(epoch(time_s), clock_)().get("s").getValue();
  }

  imager::SkyDirection on_sky(const MVDirection& towards, MDirection::Types frame, int antenna, double time_s) {
    std::string name = frame_name(frame);
    if (name.empty()) name = still_frame_name(frame);
    imager::SkyDirection sky = sky_direction(MDirection(towards, frame));
    sky.frame = name;
    return name.empty() ? turned(towards, frame, antenna, time_s) : sky;
  }

 private:
  struct View {
    casacore::MeasFrame here;
    MDirection::Convert to_j2000;
  };

  imager::SkyDirection turned(const MVDirection& towards, MDirection::Types frame, int antenna, double time_s) {
    auto found = views_.find({antenna, frame});
    if (found == views_.end()) {
      const auto place = antenna_place(set_, antenna, telescope_);
      if (!place)
        throw casacore::AipsError("its frame " + std::string(MDirection::showType(frame)) + " turns with the Earth, and " +
                                  telescope_.doubt);
      const casacore::MeasFrame here(epoch(time_s), *place);
      const MDirection::Convert convert(MDirection::Ref(frame, here), MDirection::Ref(MDirection::J2000, here));
      found = views_.insert({{antenna, frame}, {here, convert}}).first;
    }
    found->second.here.resetEpoch(epoch(time_s));
    return sky_direction(found->second.to_j2000(towards));
  }

  casacore::MeasurementSet set_;
  ObservingPlace telescope_;
  MEpoch::Types row_clock_, clock_;
  std::map<std::pair<int, MDirection::Types>, View> views_;
};

PointingTable::PointingTable(const OpenSet& open_set) : open_set_(open_set) {
  const casacore::Table& table = open_set.set.pointing();
  if (table.isNull()) throw std::runtime_error(open_set.path + " has no table POINTING" + remedy);
  if (table.nrow() == 0) throw std::runtime_error(open_set.path + ": POINTING has no rows" + remedy);
  translated(doing(open_set), [&] {
    places_ = std::make_unique<Places>(open_set);
    read();
  });
}

PointingTable::~PointingTable() = default;

void PointingTable::read() {
  const casacore::Table& table = open_set_.set.pointing();
  const casacore::ScalarColumn<int> antenna(table, "ANTENNA_ID");
  const casacore::ScalarColumn<double> time(table, "TIME"), interval(table, "INTERVAL"), origin(table, "TIME_ORIGIN");
  const casacore::ArrayColumn<double> direction(table, "DIRECTION");
  const casacore::ArrayMeasColumn<MDirection> measures(table, "DIRECTION");
  const bool frames_vary = measures.measDesc().isRefCodeVariable();
  const auto frame = MDirection::castType(measures.getMeasRef().getType());
  const auto antennas = static_cast<int>(open_set_.set.antenna().nrow());
  casacore::Matrix<double> cell;
  for (casacore::rownr_t row = 0; row < table.nrow(); ++row) {
    const int id = antenna(row);
    if (id < 0 || id >= antennas) {
      ++strange_;
      continue;
    }
    Entry entry{time(row), interval(row), 0, 0, frame, nullptr};
    if (!std::isfinite(entry.time_s) || !direction.isDefined(row)) continue;
    const casacore::IPosition shape = direction.shape(row);
    if (shape.nelements() != 2 || shape(0) != 2 || shape(1) < 1) continue;
    direction.get(row, cell, true);
    entry.longitude_rad = cell(0, 0);
    entry.latitude_rad = cell(1, 0);
    if (!std::isfinite(entry.longitude_rad) || !std::isfinite(entry.latitude_rad)) continue;
    if (frames_vary) entry.frame = MDirection::castType((*measures(row).begin()).getRef().getType());
    if (shape(1) > 1) entry.course = std::make_shared<Course>(Course{origin(row), cell.copy()});
    of_antenna_[id].push_back(std::move(entry));
  }
  for (auto& [id, entries] : of_antenna_)
    std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.time_s < b.time_s; });
}

std::string PointingTable::label(int antenna) const {
  const casacore::ScalarColumn<casacore::String> names(open_set_.set.antenna(), "NAME");
  const std::string name = names(static_cast<casacore::rownr_t>(antenna));
  return "antenna " + std::to_string(antenna) + " (" + name + ")";
}

void PointingTable::refuse(const std::string& lack) const {
  const std::string strange = strange_ == 0 ? "" : ", and " + std::to_string(strange_) + " of antennas that ANTENNA lacks";
  throw std::runtime_error(open_set_.path + ": POINTING has no entries " + lack + strange + remedy);
}

imager::SkyDirection PointingTable::at(int antenna, const RowTime& when) {
  const auto found = of_antenna_.find(antenna);
  if (found == of_antenna_.end()) refuse("of " + label(antenna) + ", which the selected rows have");
  const std::vector<Entry>& entries = found->second;
  const auto on_sky = [&](const MVDirection& towards, const Entry& entry) {
    return translated("cannot find where antenna " + std::to_string(antenna) + " of " + open_set_.path + " pointed",
                      [&] { return places_->on_sky(towards, entry.frame, antenna, when.time_s); });
  };
  const double at_s = places_->pointing_time_s(when.time_s), row_s = when.interval_s;
  const auto after = std::upper_bound(entries.begin(), entries.end(), at_s,
                                      [](double time_s, const Entry& entry) { return time_s < entry.time_s; });
  const Entry* near = after == entries.end() ? &entries.back() : &*after;
  const Entry* far = after == entries.begin() ? near : &*(after - 1);
  if (std::abs(far->time_s - at_s) <= std::abs(near->time_s - at_s)) std::swap(near, far);
  for (const Entry* entry : {near, far})
    if (entry->decides(at_s, row_s)) return on_sky(entry->at(at_s), *entry);
  const double apart_s = std::abs(far->time_s - near->time_s);
  const bool is_way = !near->course && !far->course && near->frame == far->frame && apart_s > 0 &&
                      (at_s - near->time_s) * (far->time_s - at_s) >= 0 &&
                      apart_s <= near->reach_s(row_s) + far->reach_s(row_s);
  if (is_way) return on_sky(between(near->at(at_s), far->at(at_s), std::abs(at_s - near->time_s) / apart_s), *near);
  if (std::abs(at_s - near->time_s) > near->reach_s(row_s))
    refuse("that tell where " + label(antenna) + " pointed at " + utc_text(utc_s(places_->epoch(when.time_s))));
  return on_sky(near->at(at_s), *near);
}

}  // namespace misfit::ms_io
