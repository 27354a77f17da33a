#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace misfit::imager {

/// A vector whose copies share its values until one of them is edited.
template <typename T>
class SharedVector {
 public:
  using value_type = T;

  SharedVector() = default;
  SharedVector(std::vector<T> values) : values_(std::make_shared<std::vector<T>>(std::move(values))) {}
  SharedVector(std::initializer_list<T> values) : SharedVector(std::vector<T>(values)) {}

  std::size_t size() const { return values_ ? values_->size() : 0; }
  bool empty() const { return size() == 0; }
  const T* data() const { return values_ ? values_->data() : nullptr; }
  const T& operator[](std::size_t i) const { return (*values_)[i]; }
  const T* begin() const { return data(); }
  const T* end() const { return data() + size(); }
  const T& front() const { return values_->front(); }
  const T& back() const { return values_->back(); }

  /// The values, to be changed by one thread: this copy shares them no longer.
  std::vector<T>& edit() {
    if (!values_)
      values_ = std::make_shared<std::vector<T>>();
    else if (values_.use_count() > 1)
      values_ = std::make_shared<std::vector<T>>(*values_);
    return *values_;
  }

  void append(std::initializer_list<T> values) { append(values.begin(), values.end()); }
  void append(const T* first, const T* last) { edit().insert(values_->end(), first, last); }

  friend bool operator==(const SharedVector& a, const SharedVector& b) {
    return a.values_ == b.values_ || std::equal(a.begin(), a.end(), b.begin(), b.end());
  }
  friend bool operator!=(const SharedVector& a, const SharedVector& b) { return !(a == b); }

 private:
  std::shared_ptr<std::vector<T>> values_;  ///< null: none
};

}  // namespace misfit::imager
