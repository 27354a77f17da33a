#include <algorithm>
#include <utility>

#include "ms_io/beam_rows_internal.h"
#include "ms_io/field_pointings_internal.h"
#include "ms_io/row_pointings_internal.h"
#include "ms_io/sight_numbers_internal.h"

namespace misfit::ms_io {
namespace {

/// One pointing of each field: of several in the course of time the middle one.
std::vector<FieldPointing> one_of_each_field(const OpenSet& open_set, const imager::SkyDirection& centre) {
  std::map<int, std::vector<FieldPointing>> of_field;
  for (FieldPointing& pointing : field_pointings(open_set, centre)) of_field[pointing.id].push_back(std::move(pointing));
  std::vector<FieldPointing> middle;
  for (auto& [field, pointings] : of_field) middle.push_back(std::move(pointings[pointings.size() / 2]));
  return middle;
}

}  // namespace

int SightNumbers::pointing(std::uint64_t row, int field) const {
  if (of_rows.empty()) {
    const auto found = of_field.find(field);
    return found == of_field.end() ? -1 : found->second;
  }
  const auto after = std::upper_bound(of_rows.begin(), of_rows.end(), row,
                                      [](std::uint64_t one, const NumberedRows& some) { return one < some.first; });
  return after == of_rows.begin() ? -1 : (after - 1)->pointing;
}

std::shared_ptr<const SightNumbers> numbers_by_id(const OpenSet& open_set, const imager::SkyDirection& centre) {
  const auto numbers = std::make_shared<SightNumbers>();
  for (const FieldPointing& pointing : one_of_each_field(open_set, centre)) {
    numbers->of_field[pointing.id] = pointing.id;
    numbers->direction[pointing.id] = pointing.direction;
  }
  return numbers;
}

SightTable number_sights(const OpenSets& sets, const imager::SkyDirection& centre, std::optional<double> tolerance_rad,
                         std::vector<std::string>& remarks) {
  SightTable table;
  for (const auto& set : sets) {
    SightNumbers& numbers = *set->sights;
    numbers.first_antenna = static_cast<int>(table.antennas.size());
    for (imager::AntennaSort& antenna : antenna_sorts(*set)) table.antennas.push_back(std::move(antenna));
    const auto before = static_cast<int>(table.pointings.size());
    RowPointings own;
    if (tolerance_rad) {
      own = row_pointings(*set, centre, *tolerance_rad);
      for (NumberedRows& some : own.rows) some.pointing += some.pointing < 0 ? 0 : before;
      numbers.of_rows = std::move(own.rows);
      if (!own.remark.empty()) remarks.push_back(std::move(own.remark));
    } else {
      own.pointings = one_of_each_field(*set, centre);
    }
    for (FieldPointing& pointing : own.pointings) {
      const auto number = static_cast<int>(table.pointings.size());
      if (!tolerance_rad) numbers.of_field[pointing.id] = number;
      numbers.direction[number] = pointing.direction;
      table.pointings.push_back(std::move(pointing));
    }
  }
  return table;
}

}  // namespace misfit::ms_io
