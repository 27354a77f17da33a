#pragma once

#include <pybind11/numpy.h>

#include <functional>

#include "imager/arrays/strided.h"
#include "imager/numerics/page_pool.h"
#include "imager/numerics/parallel.h"

namespace misfit::python {

/// A numpy array of one or two axes as it lies in memory; None: no table. misfit/_arrays.py has seen to type and alignment.
template <typename T>
imager::Strided<const T> table_of(const pybind11::object& array) {
  if (array.is_none()) return {};
  const auto a = pybind11::reinterpret_borrow<pybind11::array>(array);
  const auto size = static_cast<pybind11::ssize_t>(sizeof(T));
  const bool plane = a.ndim() > 1;
  return {static_cast<const T*>(a.data()), static_cast<std::size_t>(a.shape(0)),
          plane ? static_cast<std::size_t>(a.shape(1)) : 1, a.strides(0) / size, plane ? a.strides(1) / size : 1};
}

/// table_of() for an array that is to be written; std::invalid_argument where it may not be.
template <typename T>
imager::Strided<T> writable_table_of(pybind11::array& array) {
  T* const data = static_cast<T*>(array.mutable_data());
  const imager::Strided<const T> table = table_of<T>(array);
  return {data, table.rows, table.columns, table.row_step, table.column_step};
}

/// Returns or throws what `work` does, while other Python threads run. Ctrl-C ends it within some hundredths of a second where
/// it is in a loop of parallel_for: its Python exception comes as pybind11::error_already_set.
template <typename Work>
auto without_gil(const Work& work) {
  const pybind11::gil_scoped_release others_run;
  const imager::StopCheck check([] {
    const pybind11::gil_scoped_acquire python;
    if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
  });
  struct Release {  // grids are no use to Python until the next call
    ~Release() { imager::PagePool::release(); }
  };
  const Release at_the_end;
  return work();
}

}  // namespace misfit::python
