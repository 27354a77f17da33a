#include "imager/plane_stack.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>

#include "imager/column_loops.h"
#include "imager/fft.h"
#include "imager/parallel.h"
#include "imager/phasors.h"

namespace misfit::imager {
namespace {

constexpr int columns_at_once = 16;  // a cache line or two of each row while columns are brought to contiguous memory

std::size_t index(int row, int columns) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns);
}

int groups_of(int columns) {
  return (columns + columns_at_once - 1) / columns_at_once;
}

/// What lies between the two transforms: rows of the grid, columns of the image: [group][plane][grid][q][column in group].
template <typename Real>
struct KeptRows {
  int planes;
  int grids;
  int rows;
  std::complex<Real>* value;

  std::complex<Real>* at(int group, int plane, int grid, int q) const {
    return value + index((group * planes + plane) * grids + grid, rows * columns_at_once) + index(q, columns_at_once);
  }
};

template <typename Real>
KeptRows<Real> kept_rows(PlaneStack<Real>& stack, int width) {
  const int grids = stack.components / 2;
  stack.between.reserve(index(groups_of(width) * stack.planes * grids, stack.shape.nv * columns_at_once));
  return {stack.planes, grids, stack.shape.nv, stack.between.data()};
}

/// Things that threads use one after the other, made when none is free: memory fresh from the system is dear.
template <typename T>
class Spares {
 public:
  template <typename Make>
  std::unique_ptr<T> take(const Make& make) {
    const std::lock_guard lock(mutex_);
    if (spare_.empty()) return make();
    std::unique_ptr<T> one = std::move(spare_.back());
    spare_.pop_back();
    return one;
  }
  void give_back(std::unique_ptr<T> one) {
    const std::lock_guard lock(mutex_);
    spare_.push_back(std::move(one));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<T>> spare_;
};

/// Calls body(group, begin, end) for groups of columns, or of rows, in [0, count), shared among threads.
template <typename Body>
void in_groups(int count, int threads, const Body& body) {
  parallel_for(static_cast<std::size_t>(groups_of(count)), threads, [&](std::size_t i) {
    const int group = static_cast<int>(i), begin = group * columns_at_once;
    body(group, begin, std::min(begin + columns_at_once, count));
  });
}

/// Calls visit(r) for the rows of storage that stand for canonical row q.
template <typename Visit>
void for_rows(const StackShape& s, int q, const Visit& visit) {
  for (const int other : {q - s.nv, q, q + s.nv})
    if (other >= -s.margin() && other <= s.nv + s.margin()) visit(other + s.margin());
}

template <typename Real>
bool row_is_used(const PlaneStack<Real>& stack, int q) {
  bool used = false;
  for_rows(stack.shape, q, [&](int r) { used |= stack.row_used[static_cast<std::size_t>(r)] != 0; });
  return used;
}

/// Storage rows of every grid of a stack, one after the other: [plane][grid][column].
template <typename Real>
class Lines {
 public:
  explicit Lines(const PlaneStack<Real>& stack)
      : shape_(stack.shape), grids_(stack.planes * stack.components / 2), value_(index(grids_, shape_.columns())) {}

  std::complex<Real>* line(int grid) { return value_.data() + index(grid, shape_.columns()); }

  /// Canonical row q of every grid, margins folded in, from line[margin] on.
  void gather(const PlaneStack<Real>& stack, int q) {
    std::fill(value_.begin(), value_.end(), std::complex<Real>(0));
    for_rows(shape_, q, [&](int r) {
      for (int chunk = 0; chunk < shape_.chunks(); ++chunk)
        for (int grid = 0; grid < grids_; ++grid) {
          const Real* part = stack.chunk(r, chunk, 0, 2 * grid);
          add_interleaved(part, part + shape_.tile, line(grid) + chunk * shape_.tile, shape_.tile);
        }
    });
    const int margin = shape_.margin();
    for (int grid = 0; grid < grids_; ++grid) {
      std::complex<Real>* values = line(grid);
      for (int i = 0; i < margin; ++i) values[shape_.nu + i] += values[i];
      for (int i = 0; i <= margin; ++i) values[margin + i] += values[shape_.nu + margin + i];
    }
  }
  /// Its transpose: stores row q of every grid, margins filled by periodicity.
  void scatter(int q, PlaneStack<Real>& stack) {
    const int margin = shape_.margin();
    for (int grid = 0; grid < grids_; ++grid) {
      std::complex<Real>* values = line(grid);
      for (int i = 0; i < margin; ++i) values[i] = values[shape_.nu + i];
      for (int i = shape_.nu + margin; i < shape_.columns(); ++i) values[i] = values[i - shape_.nu];
    }
    for_rows(shape_, q, [&](int r) {
      for (int chunk = 0; chunk < shape_.chunks(); ++chunk)
        for (int grid = 0; grid < grids_; ++grid) {
          Real* part = stack.chunk(r, chunk, 0, 2 * grid);
          split(line(grid) + chunk * shape_.tile, part, part + shape_.tile, shape_.tile);
        }
    });
  }

 private:
  StackShape shape_;
  int grids_;
  std::vector<std::complex<Real>> value_;
};

/// What a thread needs for transforms along u.
template <typename Real>
struct RowWork {
  typename Fft<Real>::ComplexBuffer buffer;
  Lines<Real> lines;
  std::vector<std::complex<Real>> row;  ///< of the image, whole groups of columns

  RowWork(const Fft<Real>& fft, const PlaneStack<Real>& stack, int width)
      : buffer(fft.complex_buffer()), lines(stack), row(index(groups_of(width), columns_at_once)) {}
};

template <typename Real>
KeptRows<Real> transform_rows(PlaneStack<Real>& stack, int width, int threads) {
  const StackShape& s = stack.shape;
  const KeptRows<Real> kept = kept_rows(stack, width);
  const Fft<Real> along_u(s.nu);
  const int left = width / 2;  // pixels of an image's row that lie at the end of an FFT's
  Spares<RowWork<Real>> spares;
  in_groups(s.nv, threads, [&](int, int begin, int end) {
    auto work = spares.take([&] { return std::make_unique<RowWork<Real>>(along_u, stack, width); });
    auto& [buffer, lines, row] = *work;
    for (int q = begin; q < end; ++q) {
      if (!row_is_used(stack, q)) continue;
      lines.gather(stack, q);
      for (int plane = 0; plane < stack.planes; ++plane)
        for (int grid = 0; grid < kept.grids; ++grid) {
          std::copy_n(lines.line(plane * kept.grids + grid) + s.margin(), s.nu, buffer.get());
          along_u.complex_to_complex(buffer.get(), Fft<Real>::Sign::backward);
          std::copy_n(buffer.get() + s.nu - left, left, row.begin());
          std::copy_n(buffer.get(), width - left, row.begin() + left);
          for (int group = 0; group < groups_of(width); ++group)
            std::copy_n(row.begin() + group * columns_at_once, columns_at_once, kept.at(group, plane, grid, q));
        }
    }
    spares.give_back(std::move(work));
  });
  return kept;
}

/// The pixels of a group of columns, each column [row]: their corrections, and the phasors that lead from plane to plane.
class ColumnGroup {
 public:
  explicit ColumnGroup(const StackedFacet& facet) : height_(facet.facet.geometry.height) {
    for (auto* values : {&h_, &step_re_, &step_im_, &sum_re_, &sum_im_, &q_}) values->resize(index(columns_at_once, height_));
  }

  void begin(const StackedFacet& facet, int begin, int end) {
    begin_ = begin;
    end_ = end;
    for (int c = begin; c < end; ++c) {
      double* q = q_.data() + at(c);
      curvature_of_column(facet.facet, c, q);
      if (crosses_horizon(facet.facet.geometry))  // where a last bit decides, every part of the transform decides alike
        for (int r = 0; r < height_; ++r) q[r] = facet.facet.curvature(c, r);
      for (int r = 0; r < height_; ++r) q[r] *= facet.plane_step;
      correction_of_column(facet.h_w, 1, q, height_, h_.data() + at(c));
      const double h_u = facet.h_u[static_cast<std::size_t>(c)];
      for (int r = 0; r < height_; ++r) h_[at(c) + static_cast<std::size_t>(r)] *= h_u * facet.h_v[static_cast<std::size_t>(r)];
      phasors(q, height_, step_re_.data() + at(c), step_im_.data() + at(c));
    }
  }

  void clear() {
    std::fill(sum_re_.begin(), sum_re_.end(), 0);
    std::fill(sum_im_.begin(), sum_im_.end(), 0);
  }
  /// sum = h · image · exp(−2πi q w_first); 0 beyond the horizon.
  void load(const Image& image, const Facet& facet, int first_plane) {
    for (int c = begin_; c < end_; ++c) {
      first_phasors(c, first_plane);
      for (std::size_t i = at(c), r = 0; i < at(c + 1); ++i, ++r) {
        const double pixel = image.at(facet.first_row + static_cast<int>(r), facet.first_column + c) * h_[i];
        const bool seen = !std::isnan(h_[i]);
        sum_re_[i] = seen ? pixel * first_re_[r] : 0;
        sum_im_[i] = seen ? -pixel * first_im_[r] : 0;
        if (!seen) step_re_[i] = step_im_[i] = 0;
      }
    }
  }
  /// image += h · Re(sum · exp(+2πi q w_first)).
  void store(const Facet& facet, int first_plane, Image& image) {
    for (int c = begin_; c < end_; ++c) {
      first_phasors(c, first_plane);
      for (std::size_t i = at(c), r = 0; i < at(c + 1); ++i, ++r)
        image.at(facet.first_row + static_cast<int>(r), facet.first_column + c) +=
            h_[i] * (sum_re_[i] * first_re_[r] - sum_im_[i] * first_im_[r]);
    }
  }
  /// One plane of column c, in the order of an FFT of length n: Horner's rule, and its transpose.
  template <typename Real>
  void turn_and_add(int c, const std::complex<Real>* column, int n) {
    in_fft_order(c, n, [&](std::size_t i, int place, int count) {
      imager::turn_and_add(sum().from(i), step().from(i), column + place, count);
    });
  }
  template <typename Real>
  void store_and_turn(int c, std::complex<Real>* column, int n) {
    in_fft_order(c, n, [&](std::size_t i, int place, int count) {
      imager::store_and_turn(sum().from(i), step().from(i), column + place, count);
    });
  }

 private:
  std::size_t at(int c) const { return index(c - begin_, height_); }
  ColumnPhasors sum() { return {sum_re_.data(), sum_im_.data()}; }
  ColumnPhasors step() { return {step_re_.data(), step_im_.data()}; }

  template <typename Visit>
  void in_fft_order(int c, int n, const Visit& visit) {
    const int below = height_ / 2;
    visit(at(c), n - below, below);
    visit(at(c) + static_cast<std::size_t>(below), 0, height_ - below);
  }
  void first_phasors(int c, int first_plane) {
    turns_.resize(static_cast<std::size_t>(height_));
    first_re_.resize(turns_.size());
    first_im_.resize(turns_.size());
    for (std::size_t r = 0; r < turns_.size(); ++r) turns_[r] = (first_plane + 0.5) * q_[at(c) + r];
    phasors(turns_.data(), height_, first_re_.data(), first_im_.data());
  }

  int begin_ = 0, end_ = 0, height_;
  std::vector<double> q_, h_, step_re_, step_im_, sum_re_, sum_im_;  ///< [column in group][row]; q in planes
  std::vector<double> turns_, first_re_, first_im_;                  ///< [row]
};

/// What a thread needs for transforms along v.
template <typename Real>
struct ColumnWork {
  std::vector<typename Fft<Real>::ComplexBuffer> column;  ///< [column in group]
  ColumnGroup pixels;

  ColumnWork(const Fft<Real>& fft, const StackedFacet& facet) : pixels(facet) {
    for (int i = 0; i < columns_at_once; ++i) column.push_back(fft.complex_buffer());
  }
};

template <typename Real>
KeptRows<Real> transform_image_columns(const Image& image, const StackedFacet& stacked, int first_plane, int threads,
                                       PlaneStack<Real>& stack) {
  const StackShape& s = stack.shape;
  const int width = stacked.facet.geometry.width;
  const KeptRows<Real> kept = kept_rows(stack, width);
  const Fft<Real> along_v(s.nv);
  Spares<ColumnWork<Real>> spares;
  in_groups(width, threads, [&](int group, int begin, int end) {
    auto work = spares.take([&] { return std::make_unique<ColumnWork<Real>>(along_v, stacked); });
    auto& [column, pixels] = *work;
    pixels.begin(stacked, begin, end);
    pixels.load(image, stacked.facet, first_plane);
    for (int plane = 0; plane < stack.planes; ++plane) {
      for (int c = begin; c < end; ++c) {
        std::complex<Real>* values = column[static_cast<std::size_t>(c - begin)].get();
        std::fill_n(values, s.nv, std::complex<Real>(0));
        pixels.store_and_turn(c, values, s.nv);
        along_v.complex_to_complex(values, Fft<Real>::Sign::forward);
      }
      for (int q = 0; q < s.nv; ++q) {
        std::complex<Real>* row = kept.at(group, plane, 0, q);
        for (int c = 0; c < end - begin; ++c) row[c] = column[static_cast<std::size_t>(c)].get()[q];
      }
    }
    spares.give_back(std::move(work));
  });
  return kept;
}

}  // namespace

template <typename Real>
void PlaneStack<Real>::reserve(int plane_count) {
  planes = plane_count;
  cell_.reserve(shape.cells() * static_cast<std::size_t>(planes * components));
  row_used.assign(static_cast<std::size_t>(shape.rows()), 0);
}

template <typename Real>
void PlaneStack<Real>::clear(int threads) {
  const std::size_t row_cells = index(shape.columns(), planes * components);
  parallel_for(static_cast<std::size_t>(shape.rows()), threads,
               [&](std::size_t r) { std::fill_n(cell_.data() + r * row_cells, row_cells, Real(0)); });
}

template <typename Real>
double bytes_a_plane(const StackShape& s, int components, int width) {
  return static_cast<double>(sizeof(Real)) * components *
         (static_cast<double>(s.cells()) + static_cast<double>(s.nv) * groups_of(width) * columns_at_once);
}

template <typename Real>
void add_stack_to_images(PlaneStack<Real>& stack, const StackedFacet& stacked, int first_plane, int threads,
                         const std::vector<Image*>& images) {
  const StackShape& s = stack.shape;
  const int width = stacked.facet.geometry.width;
  const KeptRows<Real> kept = transform_rows(stack, width, threads);
  std::vector<char> used;
  for (int q = 0; q < s.nv; ++q) used.push_back(row_is_used(stack, q));
  const Fft<Real> along_v(s.nv);
  Spares<ColumnWork<Real>> spares;
  in_groups(width, threads, [&](int group, int begin, int end) {
    auto work = spares.take([&] { return std::make_unique<ColumnWork<Real>>(along_v, stacked); });
    auto& [column, pixels] = *work;
    pixels.begin(stacked, begin, end);
    for (int grid = 0; grid < kept.grids; ++grid) {
      pixels.clear();
      for (int plane = stack.planes - 1; plane >= 0; --plane) {
        for (int q = 0; q < s.nv; ++q) {
          const std::complex<Real>* row = kept.at(group, plane, grid, q);
          for (int c = 0; c < end - begin; ++c)
            column[static_cast<std::size_t>(c)].get()[q] = used[static_cast<std::size_t>(q)] != 0 ? row[c] : Real(0);
        }
        for (int c = begin; c < end; ++c) {
          std::complex<Real>* values = column[static_cast<std::size_t>(c - begin)].get();
          along_v.complex_to_complex(values, Fft<Real>::Sign::backward);
          pixels.turn_and_add(c, values, s.nv);
        }
      }
      pixels.store(stacked.facet, first_plane, *images[static_cast<std::size_t>(grid)]);
    }
    spares.give_back(std::move(work));
  });
}

template <typename Real>
void image_to_stack(const Image& image, const StackedFacet& stacked, int first_plane, int threads, PlaneStack<Real>& stack) {
  const StackShape& s = stack.shape;
  const int width = stacked.facet.geometry.width;
  const KeptRows<Real> kept = transform_image_columns(image, stacked, first_plane, threads, stack);
  const Fft<Real> along_u(s.nu);
  const int left = width / 2;
  Spares<RowWork<Real>> spares;
  in_groups(s.nv, threads, [&](int, int begin, int end) {
    auto work = spares.take([&] { return std::make_unique<RowWork<Real>>(along_u, stack, width); });
    auto& [buffer, lines, row] = *work;
    for (int q = begin; q < end; ++q) {
      for (int plane = 0; plane < stack.planes; ++plane) {
        for (int group = 0; group < groups_of(width); ++group)
          std::copy_n(kept.at(group, plane, 0, q), columns_at_once, row.begin() + group * columns_at_once);
        std::fill_n(buffer.get(), s.nu, std::complex<Real>(0));
        std::copy_n(row.begin(), left, buffer.get() + s.nu - left);
        std::copy_n(row.begin() + left, width - left, buffer.get());
        along_u.complex_to_complex(buffer.get(), Fft<Real>::Sign::forward);
        std::copy_n(buffer.get(), s.nu, lines.line(plane) + s.margin());
      }
      lines.scatter(q, stack);
    }
    spares.give_back(std::move(work));
  });
}

template class PlaneStack<float>;
template class PlaneStack<double>;
template double bytes_a_plane<float>(const StackShape&, int, int);
template double bytes_a_plane<double>(const StackShape&, int, int);
template void add_stack_to_images(PlaneStack<float>&, const StackedFacet&, int, int, const std::vector<Image*>&);
template void add_stack_to_images(PlaneStack<double>&, const StackedFacet&, int, int, const std::vector<Image*>&);
template void image_to_stack(const Image&, const StackedFacet&, int, int, PlaneStack<float>&);
template void image_to_stack(const Image&, const StackedFacet&, int, int, PlaneStack<double>&);

}  // namespace misfit::imager
