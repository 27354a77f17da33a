#include <algorithm>
#include <cstring>
#include <iterator>

#include "ms_io/filled_data_internal.h"

namespace misfit::ms_io {
namespace {

/// A part that was read, and whether nothing but zeros was found in it.
struct ReadPart {
  SelectionPart part;
  bool zero = true;
};

/// Moves the parts of each id whose parts are all zero out of `zero`, and adds them, as one part, to `found`.
void take_whole(int SelectionPart::*id, const std::vector<ReadPart>& all, std::vector<ReadPart>& zero,
                std::vector<SelectionPart>& found) {
  std::map<int, ReadPart> whole;
  for (const ReadPart& one : all) {
    ReadPart& sum = whole[one.part.*id];
    sum.part.*id = one.part.*id;
    sum.part.rows += one.part.rows;
    sum.zero = sum.zero && one.zero;
  }
  const auto taken = [&](const ReadPart& one) { return whole.at(one.part.*id).zero; };
  for (const auto& [value, sum] : whole)
    if (sum.zero &&
        std::any_of(zero.begin(), zero.end(), [&, id_value = value](const ReadPart& one) { return one.part.*id == id_value; }))
      found.push_back(sum.part);
  zero.erase(std::remove_if(zero.begin(), zero.end(), taken), zero.end());
}

}  // namespace

FilledData::FilledData(const std::vector<Setup>& setups) {
  for (const Setup& setup : setups)
    for (const auto& [field, rows] : setup.rows_of_field) {
      const auto place = parts_.size();
      Part& part =
          parts_.try_emplace({setup.data_description, field}, Part{{setup.spectral_window, field, 0}, place}).first->second;
      part.part.rows += rows;
    }
  state_ = std::make_unique<std::atomic<int>[]>(parts_.size());
  for (std::size_t p = 0; p < parts_.size(); ++p) state_[p] = unread;
  doubts_ = parts_.size();
}

void FilledData::look_at(int data_description, int field, const RowData& row) {
  const auto found = parts_.find({data_description, field});
  if (found == parts_.end()) return;
  std::atomic<int>& state = state_[found->second.place];
  if (state == filled) return;
  const bool any = std::any_of(row.data, row.data + row.values,
                               [](const casacore::Complex& value) { return value != casacore::Complex(0); });
  if (any) {
    if (state.exchange(filled) != filled) --doubts_;
  } else if (row.flag == nullptr || std::memchr(row.flag, 0, row.values) != nullptr) {
    state = zero;
  }
}

Zeros FilledData::zeros(const imager::Ranks& ranks) const {
  std::vector<double> largest;  // [part], a state
  for (std::size_t p = 0; p < parts_.size(); ++p) largest.push_back(state_[p]);
  ranks.largest(largest.data(), largest.size());
  std::vector<ReadPart> all;
  for (const auto& [key, part] : parts_)
    if (const auto state = static_cast<State>(largest[part.place]); state != unread) all.push_back({part.part, state == zero});
  std::vector<ReadPart> left;
  std::copy_if(all.begin(), all.end(), std::back_inserter(left), [](const ReadPart& one) { return one.zero; });
  Zeros zeros;
  zeros.everywhere = !all.empty() && left.size() == all.size();
  if (zeros.everywhere) return zeros;
  take_whole(&SelectionPart::window, all, left, zeros.parts);
  take_whole(&SelectionPart::field, all, left, zeros.parts);
  for (const ReadPart& one : left) zeros.parts.push_back(one.part);
  return zeros;
}

}  // namespace misfit::ms_io
