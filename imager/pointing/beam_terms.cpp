#include "imager/pointing/beam_terms.h"

#include <algorithm>
#include <utility>

#include "imager/pointing/principal_terms.h"

namespace misfit::imager {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<double> list_of(const VectorXd& v) {
  return {v.begin(), v.end()};
}

}  // namespace

/// Makes spans of frequencies that follow one another.
class SpanMaker {
 public:
  SpanMaker(const std::vector<double>& frequency_hz, const ValuesAtFrequency& seen, double tolerance, std::size_t most_terms)
      : hz_(frequency_hz), seen_(seen), tolerance_(tolerance), most_(static_cast<Index>(most_terms)) {
    for (std::size_t c = 0; c < hz_.size(); ++c) {
      const std::vector<double> at = seen(hz_[c]);
      if (c == 0) values_.resize(static_cast<Index>(at.size()), static_cast<Index>(hz_.size()));
      values_.col(static_cast<Index>(c)) = Eigen::Map<const VectorXd>(at.data(), static_cast<Index>(at.size()));
    }
  }

  /// Adds the spans of `count` frequencies from `begin` on, in halves where they take too many terms.
  void add(Index begin, Index count, std::vector<BeamSpan>& spans) const {
    const PrincipalTerms found = principal_terms(values_.middleCols(begin, count), tolerance_, most_);
    if (found.enough || count == 1) {
      spans.push_back(span_of(found, begin, count));
      return;
    }
    add(begin, count / 2, spans);
    add(begin + count / 2, count - count / 2, spans);
  }

 private:
  double hz(Index column) const { return hz_[static_cast<std::size_t>(column)]; }

  BeamSpan span_of(const PrincipalTerms& found, Index begin, Index count) const {
    BeamSpan span;
    span.low_hz_ = hz(begin);
    span.high_hz_ = hz(begin + count - 1);
    span.seen_ = seen_;
    span.sizes_ = list_of(found.size);
    for (const Index column : found.node) span.node_hz_.push_back(hz(begin + column));
    for (Index k = 0; k < found.terms(); ++k) {
      span.of_nodes_.push_back(list_of(found.of_nodes.col(k)));
      span.share_of_seen_.push_back(list_of(found.share_of_value.col(k)));
    }
    for (Index c = 0; c < count; ++c) span.share_[hz(begin + c)] = list_of(found.share.col(c));
    return span;
  }

  const std::vector<double>& hz_;
  const ValuesAtFrequency& seen_;
  double tolerance_;
  Index most_;
  MatrixXd values_;  ///< [value][frequency]
};

BeamSpan::BeamSpan(double frequency_hz)
    : low_hz_(frequency_hz),
      high_hz_(frequency_hz),
      node_hz_{frequency_hz},
      of_nodes_{{1}},
      sizes_{1},
      share_{{frequency_hz, {1}}} {}

std::vector<double> BeamSpan::shares(double frequency_hz) const {
  const auto known = share_.find(frequency_hz);
  if (known != share_.end()) return known->second;
  const std::vector<double> values = seen_(frequency_hz);
  std::vector<double> share;
  for (const std::vector<double>& counts : share_of_seen_) {
    double sum = 0;
    for (std::size_t v = 0; v < values.size(); ++v) sum += counts[v] * values[v];
    share.push_back(sum);
  }
  return share;
}

std::vector<BeamSpan> beam_spans(std::vector<double> frequency_hz, const ValuesAtFrequency& seen, double tolerance,
                                 std::size_t most_terms) {
  std::sort(frequency_hz.begin(), frequency_hz.end());
  frequency_hz.erase(std::unique(frequency_hz.begin(), frequency_hz.end()), frequency_hz.end());
  std::vector<BeamSpan> spans;
  SpanMaker(frequency_hz, seen, tolerance, most_terms).add(0, static_cast<Index>(frequency_hz.size()), spans);
  return spans;
}

}  // namespace misfit::imager
