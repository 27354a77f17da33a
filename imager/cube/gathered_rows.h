#pragma once

#include <complex>
#include <cstdint>
#include <memory>
#include <vector>

#include "imager/cube/channel_map.h"
#include "imager/data/visibilities.h"

namespace misfit::imager {

/// Consecutive rows of a block, of one frame ratio, with the samples that they give to planes.
struct MappedRows {
  std::size_t first = 0;
  std::size_t end = 0;
  std::shared_ptr<const ChannelMap> map;
};

/// Rows of one spectral window, with the samples that they give to the planes of a cube. UVW, sights
/// and the order in which planes are gridded are held once for all of them.
///
/// An interpolated visibility (1 − t) V + t V' needs both samples, and has the sum's weight, 1/((1 − t)²/w + t²/w').
class GatheredRows {
 public:
  /// Planes are counted from the first of a range. `expected_rows` make room for as many beforehand.
  GatheredRows(int planes, std::size_t expected_rows);

  /// `rows` cover the block, which tells the sights of its rows if other blocks do. Threads share the planes.
  void add(const VisibilityBlock& block, const std::vector<MappedRows>& rows, int threads);
  std::size_t rows() const { return uvw_m_.size() / 3; }
  /// To be called after the last add(), and before blocks().
  void set_order();

  /// The blocks of one plane, made anew, their rows in an order in which neighbours lie near each other in the uv plane. Rows
  /// without a usable sample for the plane are left out, and so are blocks without rows.
  std::vector<std::shared_ptr<const VisibilityBlock>> blocks(int plane) const;
  /// Frees the samples of one plane. May be called for different planes at the same time, as blocks() may.
  void release(int plane) { planes_[static_cast<std::size_t>(plane)] = {}; }

 private:
  struct Span {
    std::size_t first = 0;
    std::size_t end = 0;
  };
  /// The samples of rows that have the same frequencies for a plane.
  struct Piece {
    std::vector<double> frequency_hz;
    std::vector<Span> spans;                                   ///< of rows, ascending; rows in between belong to other pieces
    std::vector<float> weight;                                 ///< [row of spans][frequency]
    std::vector<std::vector<std::complex<float>>> visibility;  ///< [Stokes][row of spans][frequency]
  };
  /// A row of a piece: its place among all rows, in order, and among the piece's rows.
  struct Place {
    std::uint32_t ordered;
    std::uint32_t in_piece;
  };

  Piece& piece_of(std::vector<Piece>& plane, const std::vector<double>& frequency_hz, std::size_t stokes) const;
  /// The rows of a piece that have a usable sample, in order.
  std::vector<Place> places_of(const Piece& piece) const;
  std::shared_ptr<const VisibilityBlock> block_of(const Piece& piece, const std::vector<Place>& places) const;

  SharedVector<double> uvw_m_;              ///< [row][3], scaled as ChannelMap says; in order after set_order()
  std::vector<RowSight> sights_;            ///< [row], in order after set_order(); empty where blocks tell none
  std::vector<std::uint32_t> order_;        ///< [row]
  std::vector<std::vector<Piece>> planes_;  ///< [plane]
  std::size_t expected_rows_;
};

}  // namespace misfit::imager
