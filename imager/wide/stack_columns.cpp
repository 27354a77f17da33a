#include "imager/wide/stack_columns.h"

#include <algorithm>
#include <array>

#include "imager/numerics/fft.h"
#include "imager/numerics/parallel.h"
#include "imager/numerics/spares.h"

namespace misfit::imager {
namespace {

/// Calls body(group, begin, end) for groups of columns in [0, count), shared among threads.
template <typename Body>
void in_groups(int count, int threads, const Body& body) {
  const int groups = (count + columns_at_once - 1) / columns_at_once;
  parallel_for(static_cast<std::size_t>(groups), threads, [&](std::size_t i) {
    const int group = static_cast<int>(i), begin = group * columns_at_once;
    body(group, begin, std::min(begin + columns_at_once, count));
  });
}

/// The columns of a group, each [q].
template <typename Real>
using Columns = std::array<typename Fft<Real>::ComplexBuffer, columns_at_once>;

/// Brings rows [begin, end) of a group of columns to contiguous memory, a few at a time, so that what is written lies together
/// too. Rows beyond nv/2 are the conjugates of the opposite plane's.
template <typename Real, bool beyond>
void gather_rows(const ImagePlanes<Real>& image, int group, int plane, int grid, int begin, int end,
                 const Columns<Real>& column) {
  constexpr int rows_at_once = 8;
  const std::array<std::complex<Real>, columns_at_once> zeros{};
  for (; begin < end; begin += rows_at_once) {
    const int rows = std::min(rows_at_once, end - begin);
    const std::complex<Real>* row[rows_at_once];
    for (int i = 0; i < rows; ++i) {
      const int q = beyond ? image.nv - begin - i : begin + i;
      row[i] = image.holds[static_cast<std::size_t>(q)] == 0
                   ? zeros.data()
                   : image.row(group, beyond ? image.opposite(plane) : plane, grid, q);
    }
    for (int c = 0; c < columns_at_once; ++c) {
      std::complex<Real>* to = column[static_cast<std::size_t>(c)].get() + begin;
      for (int i = 0; i < rows; ++i) to[i] = beyond ? std::conj(row[i][c]) : row[i][c];
    }
  }
}

template <typename Real>
void gather_columns(const ImagePlanes<Real>& image, int group, int plane, int grid, const Columns<Real>& column) {
  gather_rows<Real, false>(image, group, plane, grid, 0, image.rows(), column);
  gather_rows<Real, true>(image, group, plane, grid, image.rows(), image.nv, column);
}

/// The transpose of gather_rows(), to a plane and the opposite one.
template <typename Real>
void scatter_columns(const Columns<Real>& column, int group, int plane, ImagePlanes<Real>& image) {
  for (int q = 0; q < image.rows(); ++q) {
    const int mirrored = q == 0 ? 0 : image.nv - q;
    std::complex<Real>* row = image.row(group, plane, 0, q);
    std::complex<Real>* opposite = image.row(group, image.opposite(plane), 0, q);
    for (std::size_t c = 0; c < columns_at_once; ++c) {
      row[c] = column[c].get()[q];
      opposite[c] = std::conj(column[c].get()[mirrored]);
    }
  }
}

/// The buffers of one thread.
template <typename Real>
struct ColumnWork {
  Columns<Real> column;
  ColumnGroup pixels;

  ColumnWork(const Fft<Real>& fft, const StackedFacet& facet) : pixels(facet) {
    for (auto& one : column) one = fft.complex_buffer();
  }
};

}  // namespace

template <typename Real>
void planes_to_images(const ImagePlanes<Real>& planes, const StackedFacet& stacked, int first_plane, int threads,
                      const std::vector<Image*>& images) {
  const Fft<Real> along_v(planes.nv);
  Spares<ColumnWork<Real>> spares;
  in_groups(stacked.facet.geometry.width, threads, [&](int group, int begin, int end) {
    auto work = spares.take([&] { return std::make_unique<ColumnWork<Real>>(along_v, stacked); });
    auto& [column, pixels] = *work;
    pixels.begin(stacked, begin, end);
    for (int grid = 0; grid < planes.grids; ++grid) {
      pixels.clear();
      for (int plane = planes.planes - 1; plane >= planes.planes / 2; --plane) {
        gather_columns(planes, group, plane, grid, column);
        for (int c = begin; c < end; ++c) {
          std::complex<Real>* values = column[static_cast<std::size_t>(c - begin)].get();
          along_v.complex_to_complex(values, Fft<Real>::Sign::backward);
          pixels.turn_and_add(c, values, planes.nv);
        }
      }
      pixels.store(stacked.facet, first_plane, *images[static_cast<std::size_t>(grid)]);
    }
    spares.give_back(std::move(work));
  });
}

template <typename Real>
void image_to_planes(const Image& image, const StackedFacet& stacked, int first_plane, int threads, ImagePlanes<Real>& planes) {
  const Fft<Real> along_v(planes.nv);
  Spares<ColumnWork<Real>> spares;
  in_groups(stacked.facet.geometry.width, threads, [&](int group, int begin, int end) {
    auto work = spares.take([&] { return std::make_unique<ColumnWork<Real>>(along_v, stacked); });
    auto& [column, pixels] = *work;
    pixels.begin(stacked, begin, end);
    pixels.load(image, stacked.facet, first_plane);
    for (int plane = planes.planes / 2; plane < planes.planes; ++plane) {
      for (int c = begin; c < end; ++c) {
        std::complex<Real>* values = column[static_cast<std::size_t>(c - begin)].get();
        std::fill_n(values, planes.nv, std::complex<Real>(0));
        pixels.store_and_turn(c, values, planes.nv);
        along_v.complex_to_complex(values, Fft<Real>::Sign::forward);
      }
      scatter_columns(column, group, plane, planes);
    }
    spares.give_back(std::move(work));
  });
}

template void planes_to_images(const ImagePlanes<float>&, const StackedFacet&, int, int, const std::vector<Image*>&);
template void planes_to_images(const ImagePlanes<double>&, const StackedFacet&, int, int, const std::vector<Image*>&);
template void image_to_planes(const Image&, const StackedFacet&, int, int, ImagePlanes<float>&);
template void image_to_planes(const Image&, const StackedFacet&, int, int, ImagePlanes<double>&);

}  // namespace misfit::imager
