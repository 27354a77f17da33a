#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "imager/weighting/uv_cells.h"

namespace misfit::imager {

/// A value of each cell, row-major [v][u]. CellTiles has the same functions, for planes that samples touch in few places.
template <typename Value>
class DenseCells {
 public:
  using value_type = Value;

  explicit DenseCells(const UvCells& cells) : cells_(cells), value_(cells.count()) {}

  const UvCells& cells() const { return cells_; }
  std::size_t size() const { return value_.size(); }
  Value operator[](std::size_t cell) const { return value_[cell]; }
  Value& operator[](std::size_t cell) { return value_[cell]; }
  Value* data() { return value_.data(); }
  const Value* data() const { return value_.data(); }
  bool operator==(const DenseCells& other) const { return value_ == other.value_; }

  void set(int row, int column, Value value) { value_[first(row) + static_cast<std::size_t>(column)] = value; }
  /// The values of a row, [column]; `room` may hold them.
  const Value* row(int row, std::vector<Value>& /*room*/) const { return &value_[first(row)]; }
  /// Calls visit(value) in the order [v][u] for all that may not be 0.
  template <typename Visit>
  void for_each(const Visit& visit) const {
    for (const Value value : value_) visit(value);
  }
  /// of(value) where the value is above 0, else 0.
  template <typename Of>
  DenseCells<float> map(const Of& of) const {
    DenseCells<float> made(cells_);
    for (std::size_t k = 0; k < value_.size(); ++k) made[k] = value_[k] > 0 ? static_cast<float>(of(value_[k])) : 0;
    return made;
  }

 private:
  std::size_t first(int row) const { return static_cast<std::size_t>(row) * static_cast<std::size_t>(cells_.columns()); }

  UvCells cells_;
  std::vector<Value> value_;
};

/// A value of each cell, of which only the tiles that were touched take memory; all others are 0. Places are those of
/// UvCells::place(). Threads may touch different tiles at the same time.
template <typename Value>
class CellTiles {
 public:
  using value_type = Value;
  using Tile = std::array<Value, UvCells::tile_cells>;

  explicit CellTiles(const UvCells& cells) : cells_(cells), tile_(cells.tiles()) {}

  const UvCells& cells() const { return cells_; }
  Value at(std::uint32_t place) const {
    const auto& tile = tile_[place / UvCells::tile_cells];
    return tile ? (*tile)[place % UvCells::tile_cells] : Value{};
  }
  Value& touch(std::uint32_t place) { return touch_tile(place / UvCells::tile_cells)[place % UvCells::tile_cells]; }
  /// A tile; null where it was not touched.
  const Tile* tile(std::size_t number) const { return tile_[number].get(); }
  Tile& touch_tile(std::size_t number) {
    if (!tile_[number]) tile_[number] = std::make_unique<Tile>();
    return *tile_[number];
  }

  void set(int row, int column, Value value) { touch(cells_.place(row, column)) = value; }
  const Value* row(int row, std::vector<Value>& room) const {
    room.resize(tiles_across() * UvCells::tile_side);
    for (std::size_t t = 0; t < tiles_across(); ++t) {
      Value* const to = &room[t * UvCells::tile_side];
      if (const Value* const from = in_tile(row, t))
        std::copy_n(from, UvCells::tile_side, to);
      else
        std::fill_n(to, UvCells::tile_side, Value{});
    }
    return room.data();
  }
  template <typename Visit>
  void for_each(const Visit& visit) const {
    for (int row = 0; row < cells_.rows(); ++row)
      for (std::size_t t = 0; t < tiles_across(); ++t)
        if (const Value* const value = in_tile(row, t))
          for (std::size_t i = 0; i < UvCells::tile_side; ++i) visit(value[i]);
  }
  template <typename Of>
  CellTiles<float> map(const Of& of) const {
    CellTiles<float> made(cells_);
    for (std::size_t t = 0; t < tile_.size(); ++t) {
      if (!tile_[t]) continue;
      const Tile& from = *tile_[t];
      auto& to = made.touch_tile(t);
      for (std::size_t i = 0; i < from.size(); ++i) to[i] = from[i] > 0 ? static_cast<float>(of(from[i])) : 0;
    }
    return made;
  }

 private:
  std::size_t tiles_across() const { return cells_.tiles_across(); }
  /// The part of a row that lies in the row's t-th tile; null where that tile was not touched.
  const Value* in_tile(int row, std::size_t t) const {
    const auto v = static_cast<std::size_t>(row);
    const auto& tile = tile_[v / UvCells::tile_side * tiles_across() + t];
    return tile ? &(*tile)[v % UvCells::tile_side * UvCells::tile_side] : nullptr;
  }

  UvCells cells_;
  std::vector<std::unique_ptr<Tile>> tile_;  ///< [v][u]
};

}  // namespace misfit::imager
