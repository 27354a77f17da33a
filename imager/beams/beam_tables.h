#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "imager/beams/polar_table.h"
#include "imager/beams/primary_beam.h"
#include "imager/beams/radial_function.h"

namespace misfit::imager {

/// A primary beam around its axis, Σ w f(ν) Vₒₙₑ Vₒₜₕₑᵣ for each of some factors f, as tables that images are drawn from.
class BeamTables {
 public:
  using Factor = std::function<double(double frequency_hz)>;
  /// Makes one number of the values for all factors, about 1 on the axis: where it falls to the limit the tables end.
  using Level = std::function<double(const double* value)>;
  using Visit = std::function<void(std::size_t pixel, const double* value)>;

  /// The tables reach as far from the axis as `level` has not fallen to `limit`; for patterns that are not round, also no
  /// farther than they are known.
  BeamTables(const PrimaryBeam& beam, const std::vector<Factor>& factors, double limit, const Level& level, int threads);

  /// Calls visit(pixel, value [factor]) for all pixels of an image within the tables, from several threads.
  void for_each_pixel(DirectionCosines axis, const ImageGeometry& geometry, int threads, const Visit& visit) const;

 private:
  void make_round(const PrimaryBeam& beam, const std::vector<Factor>& factors, double limit, const Level& level, int threads);
  void make_turned(const PrimaryBeam& beam, const std::vector<Factor>& factors, double limit, const Level& level, int threads);

  std::vector<RadialTable> radial_;  ///< [factor], for round beams
  std::vector<PolarTable> polar_;    ///< [factor], for other beams
  std::optional<LobeEdge> edge_;     ///< for other beams
};

}  // namespace misfit::imager
