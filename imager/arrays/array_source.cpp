#include "imager/arrays/array_source.h"

#include <atomic>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

/// True if single precision holds a value.
bool is_single(double value) {
  return std::abs(value) <= std::numeric_limits<float>::max();
}

/// Fills in a row's values and weights where the mask allows; false where one of them is invalid.
template <typename Real>
bool set_row(const ArrayValues<Real>& values, std::size_t row, std::size_t first, VisibilityBlock& block) {
  bool good = true;
  for (std::size_t channel = 0; channel < block.channels(); ++channel) {
    const std::size_t i = first + channel;
    if (block.weight[i] == 0) continue;
    const double weight = values.weight ? double{values.weight.at(row, channel)} : 1;
    const std::complex<double> v(values.visibility.at(row, channel));
    block.weight[i] = static_cast<float>(weight);
    if (block.weight[i] == 0) continue;
    good = good && weight >= 0 && is_single(weight) && is_single(v.real()) && is_single(v.imag());
    block.visibility[i] = std::complex<float>(v);
  }
  return good;
}

}  // namespace

template <typename Real>
class ArraySource<Real>::Stream : public BlockStream {
 public:
  explicit Stream(const ArraySource& source) : source_(source), pieces_(pieces_of(source.at_)) {}

  std::shared_ptr<const VisibilityBlock> next() override {
    if (at_ == pieces_.size()) return nullptr;
    const RowsOfArray rows = pieces_[at_++];
    auto block = std::make_shared<VisibilityBlock>(block_of(source_.at_, rows, source_.options_));
    block->visibility.resize(block->samples());
    std::atomic<bool> good = true;
    for_rows(rows, source_.options_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row < end; ++row)
        if (!set_row(source_.values_, row, (row - rows.begin) * block->channels(), *block)) good = false;
    });
    if (!good)
      throw std::invalid_argument(
          "vis or wgt cannot be cleaned somewhere; expected finite visibilities, and finite weights of 0 or more");
    count(*block);
    return block;
  }

 private:
  static void count(VisibilityBlock& block) {
    block.counts.rows_read = block.rows();
    block.counts.samples_read = block.samples();
    for (const float weight : block.weight) ++(weight == 0 ? block.counts.zero_weight : block.counts.used);
  }

  const ArraySource& source_;
  std::vector<RowsOfArray> pieces_;
  std::size_t at_ = 0;
};

template <typename Real>
ArraySource<Real>::ArraySource(const ArrayCoordinates& at, const ArrayValues<Real>& values, const ArrayBlockOptions& options)
    : at_(at), values_(values), options_(options) {
  check_values(at, values);
}

template <typename Real>
std::unique_ptr<BlockStream> ArraySource<Real>::open() const {
  return std::make_unique<Stream>(*this);
}

template class ArraySource<float>;
template class ArraySource<double>;

}  // namespace misfit::imager
