#include "imager/pointing/beam_terms.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

namespace misfit::imager {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<double> list_of(const VectorXd& v) {
  return {v.begin(), v.end()};
}

/// An orthonormal basis of columns of a matrix that explain all others to a tolerance.
struct Explained {
  std::vector<Index> column;  ///< that were taken
  MatrixXd basis;             ///< [row][taken]
  bool all = false;           ///< whether they explain enough
};

Explained explain(const MatrixXd& values, double tolerance, Index most) {
  Explained found{{}, MatrixXd(values.rows(), 0), false};
  MatrixXd left = values;
  for (;;) {
    found.all = !found.column.empty() && left.cwiseAbs().maxCoeff() <= tolerance;
    if (found.all || static_cast<Index>(found.column.size()) == std::min(most, values.cols())) return found;
    Index next = 0;
    left.colwise().squaredNorm().maxCoeff(&next);
    VectorXd direction = left.col(next);
    direction -= found.basis * (found.basis.transpose() * direction);  // again, for what rounding left
    direction.normalize();
    found.column.push_back(next);
    found.basis.conservativeResize(Eigen::NoChange, found.basis.cols() + 1);
    found.basis.rightCols(1) = direction;
    left -= direction * (direction.transpose() * left);
  }
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
    const MatrixXd values = values_.middleCols(begin, count);
    const Explained found = explain(values, tolerance_, most_);
    if (found.all || count == 1) {
      spans.push_back(span_of(values, found, begin));
      return;
    }
    add(begin, count / 2, spans);
    add(begin + count / 2, count - count / 2, spans);
  }

 private:
  double hz(Index column) const { return hz_[static_cast<std::size_t>(column)]; }

  BeamSpan span_of(const MatrixXd& values, const Explained& found, Index begin) const {
    const auto terms = static_cast<Index>(found.column.size());
    const MatrixXd in_basis = found.basis.transpose() * values;  // [taken][frequency]
    const Eigen::JacobiSVD<MatrixXd> parts(in_basis, Eigen::ComputeThinU | Eigen::ComputeThinV);
    const MatrixXd principal = found.basis * parts.matrixU();       // [value][term], orthonormal
    const MatrixXd along = parts.matrixU().transpose() * in_basis;  // [term][frequency]
    const VectorXd most = along.cwiseAbs().rowwise().maxCoeff();    // of which shares are parts
    MatrixXd nodes(terms, terms);                                   // [term][node], of orthonormal terms
    for (Index j = 0; j < terms; ++j) nodes.col(j) = along.col(found.column[static_cast<std::size_t>(j)]);
    const MatrixXd of_nodes = nodes.inverse();  // [node][term]: principal = values at nodes · this
    BeamSpan span;
    span.low_hz_ = hz(begin);
    span.high_hz_ = hz(begin + values.cols() - 1);
    span.seen_ = seen_;
    for (const Index column : found.column) span.node_hz_.push_back(hz(begin + column));
    for (Index k = 0; k < terms; ++k) {
      span.of_nodes_.push_back(list_of(most[k] * of_nodes.col(k)));
      span.sizes_.push_back(most[k] / std::sqrt(static_cast<double>(values.rows())));
      span.share_of_seen_.push_back(list_of(principal.col(k) / most[k]));
    }
    for (Index c = 0; c < values.cols(); ++c) span.share_[hz(begin + c)] = list_of(along.col(c).cwiseQuotient(most));
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
