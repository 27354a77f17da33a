#pragma once

#include <cmath>
#include <cstddef>
#include <map>
#include <mutex>
#include <vector>

#include "imager/beams/frequency_nodes.h"
#include "imager/coplanar/sample_shares.h"
#include "imager/numerics/constants.h"

namespace misfit::imager {

/// Directions off the axes of beams, in which what beams are tells all of them.
struct BeamDirections {
  std::vector<double> sine;  ///< [direction]: of its angle θ off the axis
  ValuesAtFrequency values;  ///< [direction]: a beam, in parts of what counts there
  double largest_sine = 0;
};

/// Beams over the curved sky: with q(θ) = cos θ − 1 + middle, |q| ≤ middle over the beams,
///   B(θ, ν) exp(2πi w q(θ)) = Σ_k c_k(ν, w) t_k(θ)
/// for all ν of some frequencies and |w| ≤ most_abs_w: real terms t_k, each of which is a sum of few of the products B
/// cos(2πwq) and B sin(2πwq), and complex shares c_k of 1 in magnitude at most, or hardly more. Over a tangent plane at a
/// beam's axis that is all that w does: with the axis at (l_0, m_0, n_0), n = (cos θ − l l_0 − m m_0)/n_0 in every direction.
class CurvedTerms {
 public:
  /// A product that terms are sums of.
  struct Node {
    double frequency_hz;
    double w;
    bool is_sine;

    /// The factor that B has in it.
    double wave(double q) const { return is_sine ? std::sin(2 * pi * w * q) : std::cos(2 * pi * w * q); }
  };

  /// To a tolerance, with so many terms at most. Without frequencies B is 1 at all of them, and the terms are those of w alone.
  CurvedTerms(const std::vector<double>& frequency_hz, const BeamDirections& directions, double most_abs_w, double tolerance,
              std::size_t most_terms);

  /// True if so many terms are enough; if not, there are no terms.
  bool enough() const { return enough_; }
  std::size_t terms() const { return of_nodes_.size(); }
  /// Nodes of one frequency follow one another.
  const std::vector<Node>& nodes() const { return nodes_; }
  /// [term]: the RMS of its values, falling.
  const std::vector<double>& sizes() const { return sizes_; }
  /// By how much each node counts in a term.
  const std::vector<double>& of_nodes(std::size_t term) const { return of_nodes_[term]; }
  double middle() const { return middle_; }
  double q(double sine) const { return middle_ - sine * sine / (1 + std::sqrt(1 - sine * sine)); }
  double most_abs_w() const { return most_abs_w_; }
  double most_phase_rad() const { return 2 * pi * most_abs_w_ * middle_; }

  /// The shares at a frequency, which have no beam in them where the terms have none.
  const ShareTable& shares(double frequency_hz) const;
  /// The memory that the shares at a frequency take.
  double table_bytes() const;
  /// Steps of the tables of shares that a wavelength of w takes.
  double steps_a_wavelength() const { return 1 / step_; }

 private:
  BeamDirections directions_;
  bool waves_alone_;
  double most_abs_w_;
  double middle_;
  double step_ = 0;  ///< of w between points of shares
  bool enough_ = false;
  std::vector<Node> nodes_;
  std::vector<std::vector<double>> of_nodes_;  ///< [term][node]
  std::vector<double> sizes_;
  std::vector<std::vector<double>> share_of_value_;  ///< [term][direction]
  std::vector<double> wave_;                         ///< [point of shares][cosine, sine][direction]
  mutable std::mutex mutex_;                         ///< of what follows
  mutable std::map<double, ShareTable> shares_;
};

}  // namespace misfit::imager
