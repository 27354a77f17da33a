#pragma once

#include <complex>
#include <cstdint>
#include <memory>
#include <vector>

#include "imager/cube/channel_map.h"
#include "imager/data/visibilities.h"

namespace misfit::imager {

/// Consecutive rows of a block, of one frame ratio, with what they give to planes.
struct MappedRows {
  std::size_t first = 0;
  std::size_t end = 0;
  std::shared_ptr<const ChannelMap> map;
};

/// Rows of one spectral window, with the samples that they give to the planes of a cube. UVW, sights
/// and the order in which planes are gridded are held once for all of them.
///
/// An interpolated visibility (1 − t) V + t V' needs both samples, and has the weight of that sum, 1/((1 − t)²/w + t²/w').
class GatheredRows {
 public:
  /// Planes are counted from the first of a range. `expected_rows` make room for as many beforehand.
  GatheredRows(int planes, std::size_t expected_rows);

  /// `rows` cover the block, which tells the sights of its rows if others do. What planes get is shared among threads.
  void add(const VisibilityBlock& block, const std::vector<MappedRows>& rows, int threads);
  std::size_t rows() const { return uvw_m_.size() / 3; }
  /// To be called after the last add(), and before what follows.
  void set_order();

  /// Of one plane, made anew, its rows in an order in which neighbours lie near each other in the uv plane. Rows without a
  /// usable sample for it are left out; blocks without rows, too.
  std::vector<std::shared_ptr<const VisibilityBlock>> blocks(int plane) const;
  /// Frees what is held for one plane. May be called for different planes at the same time, as blocks() may.
  void release(int plane) { planes_[static_cast<std::size_t>(plane)] = {}; }

 private:
  struct Span {
    std::size_t first = 0;
    std::size_t end = 0;
  };
  /// Samples of those rows that have the same frequencies for a plane.
  struct Piece {
    std::vector<double> frequency_hz;
    std::vector<Span> spans;                                   ///< of rows, ascending; those in between have other pieces
    std::vector<float> weight;                                 ///< [row of spans][frequency]
    std::vector<std::vector<std::complex<float>>> visibility;  ///< [Stokes][row of spans][frequency]
  };
  /// A row of a piece: its place among all rows, in their order, and among the piece's.
  struct Place {
    std::uint32_t ordered;
    std::uint32_t in_piece;
  };

  Piece& piece_of(std::vector<Piece>& plane, const std::vector<double>& frequency_hz, std::size_t stokes) const;
  /// Those rows of a piece that have a usable sample, in order.
  std::vector<Place> places_of(const Piece& piece) const;
  std::shared_ptr<const VisibilityBlock> block_of(const Piece& piece, const std::vector<Place>& places) const;

  SharedVector<double> uvw_m_;              ///< [row][3], scaled as ChannelMap says; in order once that is set
  std::vector<RowSight> sights_;            ///< [row], in order once that is set; empty where blocks tell none
  std::vector<std::uint32_t> order_;        ///< [row]
  std::vector<std::vector<Piece>> planes_;  ///< [plane]
  std::size_t expected_rows_;
};

}  // namespace misfit::imager
