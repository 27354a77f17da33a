#include "imager/pointing/mosaic_beams.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "imager/numerics/constants.h"
#include "imager/numerics/parallel.h"
#include "imager/pointing/beam_steps.h"

namespace misfit::imager {
namespace {

double largest(const std::map<std::tuple<const VoltagePattern*, const VoltagePattern*>, double>& reaches) {
  double all = 0;
  for (const auto& [pair, reach] : reaches) all = std::max(all, reach);
  return all;
}

/// Where a component of the unit vectors within an angle, whose sine is `reach`, of an axis ends.
struct Extent {
  double low;
  double high;
};
Extent extent(double axis, double reach) {
  const double cosine = std::sqrt(1 - reach * reach), middle = axis * cosine;
  const double half = std::sqrt(std::max(0.0, 1 - axis * axis)) * reach;
  // Where the cap holds the end of the axis along which the component is measured, that is where it ends.
  return {-axis >= cosine ? -1 : middle - half, axis >= cosine ? 1 : middle + half};
}

/// The first of `size` pixels among `all` that hold those from `low` to `high`, as far as there are any; −1 where none is.
int first_of(double low, double high, int size, int all) {
  if (high < 0 || low > all - 1) return -1;
  const double first = std::floor((low + high - size + 1) / 2);
  return static_cast<int>(std::clamp(first, 0.0, double(all - size)));
}

/// Writes `count` curved terms from `first` on at a radius; seen(frequency) is the beam there.
template <typename Seen>
void add_up(const CurvedTerms& terms, double sine, const Seen& seen, std::size_t first, std::size_t count, double* values) {
  std::fill_n(values, count, 0.0);
  double of_hz = -1, beam = 0;
  for (std::size_t j = 0; j < terms.nodes().size(); ++j) {
    const CurvedTerms::Node& node = terms.nodes()[j];
    if (node.frequency_hz != of_hz) beam = seen(node.frequency_hz);
    of_hz = node.frequency_hz;
    const double product = beam * node.wave(terms.q(sine));
    for (std::size_t k = 0; k < count; ++k) values[k] += terms.of_nodes(first + k)[j] * product;
  }
}

/// Brings sizes of terms to those of others where these are larger.
void raise(std::vector<double>& sizes, const std::vector<double>& others) {
  sizes.resize(std::max(sizes.size(), others.size()));
  for (std::size_t k = 0; k < others.size(); ++k) sizes[k] = std::max(sizes[k], others[k]);
}

/// Where beams are looked at.
constexpr int radii = 96;
double sine_of(double reach, int radius) {
  return reach * std::sqrt(double(radius) / radii);
}
int angles_of(const VoltagePattern& one, const VoltagePattern& other) {
  return one.is_round() && other.is_round() ? 1 : 8;
}

}  // namespace

MosaicBeams::MosaicBeams(MosaicScene scene) : scene_(std::move(scene)) {
  std::sort(scene_.frequency_hz.begin(), scene_.frequency_hz.end());
  if (scene_.frequency_hz.empty()) throw std::invalid_argument("beams of no frequency; expected one at least");
  if (!(scene_.cut > 0 && scene_.cut < 1))
    throw std::invalid_argument("beams cut off at " + std::to_string(scene_.cut) +
                                " of their peak; expected above 0 and below 1");
  std::set<const VoltagePattern*> patterns;
  for (const Pattern& pattern : scene_.beams.of_antennas())
    if (pattern) patterns.insert(pattern.get());
  for (const VoltagePattern* one : patterns)
    for (const VoltagePattern* other : patterns) reach_[{one, other}] = found_reach(*one, *other);
  turn_rad_ = turn_step(scene_.beams, largest(reach_), scene_.frequency_hz.back(), scene_.tolerance);
  term_sizes_ = {1};
  if (!scene_.at_each) {
    spans_ = beam_spans(scene_.frequency_hz, directions(scene_.frequency_hz).values, scene_.tolerance);
    for (const BeamSpan& span : spans_) raise(term_sizes_, span.sizes());
  }
  find_curved_terms();
}

/// Beams are taken relative to the largest that any is in a direction at these frequencies: an image of flat noise divides by
/// what is seen, so that errors count in parts of that.
BeamDirections MosaicBeams::directions(const std::vector<double>& frequency_hz) const {
  BeamDirections all;
  for (const auto& [pair, reach] : reach_) {
    const auto& [one, other] = pair;
    if (std::less<>()(other, one)) continue;
    const int angles = angles_of(*one, *other);
    for (int r = 0; r <= radii; ++r) all.sine.insert(all.sine.end(), static_cast<std::size_t>(angles), sine_of(reach, r));
  }
  std::vector<double> most(all.sine.size(), scene_.cut * scene_.cut);
  for (const double hz : frequency_hz) {
    const std::vector<double> values = seen(hz);
    for (std::size_t v = 0; v < most.size(); ++v) most[v] = std::max(most[v], std::abs(values[v]));
  }
  all.values = [this, most](double hz) {
    std::vector<double> values = seen(hz);
    for (std::size_t v = 0; v < most.size(); ++v) values[v] /= most[v];
    return values;
  };
  all.largest_sine = largest(reach_);
  return all;
}

void MosaicBeams::find_curved_terms() {
  constexpr double least_n = 0.2;  // a tangent plane farther from the centre makes much of w
  if (!scene_.max_abs_w) return;
  std::set<Pattern> patterns(scene_.beams.of_antennas().begin(), scene_.beams.of_antennas().end());
  patterns.erase(nullptr);
  double n = 1;
  for (const AxisFrame& frame : scene_.beams.of_fields())
    for (const Pattern& one : patterns)
      for (const Pattern& other : patterns)
        if (window({one, other, frame, 0})) n = std::min(n, 1 + n_minus_1(frame.axis()));
  if (n < least_n) return;
  constexpr double rounding = 1e-9;
  most_abs_w_ = (1 + rounding) * *scene_.max_abs_w / n;
  std::vector<const BeamSpan*> all{nullptr};
  if (!scene_.at_each) all.clear();
  for (const BeamSpan& span : spans_) all.push_back(&span);
  for (const BeamSpan* span : all) {
    std::vector<double> hz;
    if (span != nullptr)
      std::copy_if(scene_.frequency_hz.begin(), scene_.frequency_hz.end(), std::back_inserter(hz),
                   [&](double f) { return span->holds(f); });
    const auto& made = curved_.emplace_back(new CurvedSpan{
        span, CurvedTerms(hz, directions(scene_.frequency_hz), most_abs_w_, scene_.tolerance, most_shared_images), {}, {}});
    if (!made->terms.enough()) {
      curved_sizes_.clear();
      return;
    }
    raise(curved_sizes_, made->terms.sizes());
  }
}

double MosaicBeams::curved_bytes() const {
  double bytes = 0;
  for (const double hz : scene_.frequency_hz)
    for (const auto& of : curved_)
      if (of->span != nullptr && of->span->holds(hz)) bytes += of->terms.table_bytes();
  return bytes;
}

MosaicBeams::CurvedSpan& MosaicBeams::curved_span(const BeamSpan& span) const {
  return **std::find_if(curved_.begin(), curved_.end(),
                        [&](const auto& of) { return of->span == nullptr || of->span == &span; });
}

/// What all pairs of patterns see, each as far as it reaches, at radii and angles of equal parts of its disc.
std::vector<double> MosaicBeams::seen(double frequency_hz) const {
  std::vector<double> values;
  for (const auto& [pair, reach] : reach_) {
    const auto& [one, other] = pair;
    if (std::less<>()(other, one)) continue;  // both ways round they see the same
    const int angles = angles_of(*one, *other);
    for (int r = 0; r <= radii; ++r)
      for (int a = 0; a < angles; ++a) {
        const double sine = sine_of(reach, r), angle_rad = 2 * pi * a / angles;
        const auto voltage = [&](const VoltagePattern& p) {
          return p.is_round() ? p.voltage(sine, frequency_hz) : p.voltage_at(sine, angle_rad, frequency_hz);
        };
        values.push_back(voltage(*one) * voltage(*other));
      }
  }
  return values;
}

double MosaicBeams::found_reach(const VoltagePattern& one, const VoltagePattern& other) const {
  const double low = scene_.frequency_hz.front(), high = scene_.frequency_hz.back();
  const double step = 0.02 * std::min(one.detail_sine(low), other.detail_sine(low));
  const double lobe =
      first_sine_at(scene_.cut, step, [&](double sine) { return one.voltage(sine, low) * other.voltage(sine, low); });
  constexpr double before_end = 0.97;                 // at its very end a fit may be the root of what falls to 0
  std::vector<double> between = scene_.frequency_hz;  // fits have ends of their own
  constexpr int steps = 256;
  for (int i = 1; scene_.at_each && i < steps; ++i) between.push_back(low + (high - low) * i / steps);
  double ends = 1;
  for (const double hz : between) ends = std::min({ends, one.continuous_sine(hz), other.continuous_sine(hz)});
  return ends < 1 ? std::min(lobe, before_end * ends) : lobe;
}

std::vector<const BeamSpan*> MosaicBeams::spans(const std::vector<double>& frequency_hz) const {
  std::vector<const BeamSpan*> found;
  if (scene_.at_each) {
    const std::lock_guard lock(mutex_);
    for (const double hz : std::set<double>(frequency_hz.begin(), frequency_hz.end()))
      found.push_back(&at_each_.try_emplace(hz, hz).first->second);
    return found;
  }
  for (const double hz : frequency_hz)
    if (std::none_of(spans_.begin(), spans_.end(), [hz](const BeamSpan& span) { return span.holds(hz); }))
      throw std::invalid_argument("a mosaic seen at " + std::to_string(hz) +
                                  " Hz; expected one of the frequencies of its beams");
  for (const BeamSpan& span : spans_)
    if (std::any_of(frequency_hz.begin(), frequency_hz.end(), [&](double hz) { return span.holds(hz); }))
      found.push_back(&span);
  return found;
}

double MosaicBeams::largest_reach() const {
  return largest(reach_);
}

double MosaicBeams::reach(const PairBeam& beam) const {
  return reach_.at({beam.one.get(), beam.other.get()});
}

double MosaicBeams::power(const PairBeam& beam, DirectionCosines at, double frequency_hz) const {
  return beam.frame.sine(at) <= reach(beam) ? beam.power(at, frequency_hz) : 0;
}

std::optional<Window> MosaicBeams::window(const PairBeam& beam) const {
  const ImageGeometry& g = scene_.geometry;
  const double radius = reach(beam);
  const DirectionCosines axis = beam.frame.axis();
  const Extent l = extent(axis.l, radius), m = extent(axis.m, radius);
  constexpr int margin = 4;
  const auto size_of = [radius](double cell, int all) {
    return static_cast<int>(std::min(double(all), 2 * std::floor(radius / cell) + margin));
  };
  Window window{0, 0, g};
  window.geometry.width = size_of(g.cell_rad, g.width);
  window.geometry.height = size_of(g.cell_height_rad(), g.height);
  const auto column = [&](double at) { return g.centre_column() - (at - g.centre.l) / g.cell_rad; };
  const auto row = [&](double at) { return g.centre_row() + (at - g.centre.m) / g.cell_height_rad(); };
  window.first_column = first_of(column(l.high), column(l.low), window.geometry.width, g.width);
  window.first_row = first_of(row(m.low), row(m.high), window.geometry.height, g.height);
  if (window.first_column < 0 || window.first_row < 0) return std::nullopt;
  window.geometry.centre =
      g.at(window.first_row + window.geometry.centre_row(), window.first_column + window.geometry.centre_column());
  return window;
}

const RadialTables& MosaicBeams::tables(const PairBeam& beam, const BeamSpan& span, int threads) const {
  const std::lock_guard lock(mutex_);
  std::unique_ptr<const RadialTables>& made = tables_[{beam.one.get(), beam.other.get(), &span}];
  if (!made)
    made = std::make_unique<const RadialTables>(reach(beam), threads, span.terms(), [&](double sine, double* values) {
      std::fill_n(values, span.terms(), 0.0);
      for (std::size_t j = 0; j < span.node_hz().size(); ++j) {
        const double seen = beam.one->voltage(sine, span.node_hz()[j]) * beam.other->voltage(sine, span.node_hz()[j]);
        for (std::size_t k = 0; k < span.terms(); ++k) values[k] += span.of_nodes(k)[j] * seen;
      }
    });
  return *made;
}

const RadialTables& MosaicBeams::curved_tables(const PairBeam& beam, CurvedSpan& curved, int threads) const {
  constexpr double bend_of_a_beam = 2;  // radians of phase that a table bears besides
  const CurvedTerms& terms = curved.terms;
  const std::lock_guard lock(curved.mutex);
  std::unique_ptr<const RadialTables>& made = curved.tables[{beam.one.get(), beam.other.get()}];
  if (!made)
    made = std::make_unique<const RadialTables>(
        reach(beam), threads, terms.terms(),
        [&](double sine, double* values) {
          const auto seen = [&](double hz) {
            return curved.span == nullptr ? 1 : beam.one->voltage(sine, hz) * beam.other->voltage(sine, hz);
          };
          add_up(terms, sine, seen, 0, terms.terms(), values);
        },
        std::max(1.0, terms.most_phase_rad() / bend_of_a_beam));
  return *made;
}

template <typename Write>
std::vector<Image> MosaicBeams::images(const PairBeam& beam, const Window& window, std::size_t count, int threads,
                                       const Write& write) const {
  const ImageGeometry& g = window.geometry;
  std::vector<Image> made(count, Image(g.width, g.height));
  const double radius = reach(beam);
  parallel_for(static_cast<std::size_t>(g.height), threads, [&](std::size_t r) {
    const int row = static_cast<int>(r);
    std::vector<double> values(count);
    std::vector<double*> to;
    for (Image& image : made) to.push_back(image.row(row));
    for (int column = 0; column < g.width; ++column) {
      const DirectionCosines at = g.at(row, column);
      const double sine = beam.frame.sine(at);  // not a number beyond the horizon
      if (!(sine <= radius)) continue;
      write(sine, at, values.data());
      for (std::size_t k = 0; k < count; ++k) to[k][column] = values[k];
    }
  });
  return made;
}

std::vector<Image> MosaicBeams::curved_images(const PairBeam& beam, const Window& window, const BeamSpan& span,
                                              std::size_t first, std::size_t count, int threads) const {
  CurvedSpan& curved = curved_span(span);
  if (!beam.is_round())
    return images(beam, window, count, threads, [&](double sine, DirectionCosines at, double* values) {
      const auto seen = [&](double hz) { return beam.power(at, curved.span == nullptr ? span.node_hz().front() : hz); };
      add_up(curved.terms, sine, seen, first, count, values);
    });
  const RadialTables& table = curved_tables(beam, curved, threads);
  if (curved.span != nullptr)
    return images(beam, window, count, threads,
                  [&](double sine, DirectionCosines, double* values) { table.write(sine, first, count, values); });
  const RadialTables& of_beam = tables(beam, span, threads);
  return images(beam, window, count, threads, [&](double sine, DirectionCosines, double* values) {
    double power = 0;
    of_beam.write(sine, 0, 1, &power);
    table.write(sine, first, count, values);
    for (std::size_t k = 0; k < count; ++k) values[k] *= power;
  });
}

std::vector<Image> MosaicBeams::terms(const PairBeam& beam, const Window& window, const BeamSpan& span, int threads) const {
  if (beam.is_round()) {
    const RadialTables& table = tables(beam, span, threads);
    return images(beam, window, span.terms(), threads,
                  [&](double sine, DirectionCosines, double* values) { table.write(sine, 0, span.terms(), values); });
  }
  return images(beam, window, span.terms(), threads, [&](double, DirectionCosines at, double* values) {
    const std::vector<double> seen = terms(beam, at, span);
    std::copy(seen.begin(), seen.end(), values);
  });
}

Image MosaicBeams::squares(const PairBeam& beam, const Window& window, const BeamSpan& span, const std::vector<double>& weight,
                           int threads) const {
  const std::size_t count = span.terms();
  const RadialTables* const table = beam.is_round() ? &tables(beam, span, threads) : nullptr;
  return std::move(images(beam, window, 1, threads, [&](double sine, DirectionCosines at, double* value) {
                     double term[most_terms_of_a_span];
                     if (table != nullptr) {
                       table->write(sine, 0, count, term);
                     } else {
                       const std::vector<double> seen = terms(beam, at, span);
                       std::copy(seen.begin(), seen.end(), term);
                     }
                     *value = 0;
                     for (std::size_t k = 0; k < count; ++k)
                       for (std::size_t j = 0; j <= k; ++j) *value += weight[k * count + j] * term[k] * term[j];
                   }).front());
}

std::vector<double> MosaicBeams::terms(const PairBeam& beam, DirectionCosines at, const BeamSpan& span) const {
  std::vector<double> terms(span.terms());
  for (std::size_t j = 0; j < span.node_hz().size(); ++j) {
    const double seen = power(beam, at, span.node_hz()[j]);
    for (std::size_t k = 0; k < terms.size(); ++k) terms[k] += span.of_nodes(k)[j] * seen;
  }
  return terms;
}

}  // namespace misfit::imager
