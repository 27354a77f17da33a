#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "imager/clean/found_flux.h"
#include "imager/clean/scaled_psf.h"
#include "imager/clean/scaled_residual.h"
#include "imager/taylor/taylor_expansion.h"

namespace misfit::imager {

/// The brightest places of a residual at all its scales, among which components are found without a look at the others. They
/// lie in tiles; a component is taken off places in near tiles at once, and off the others when enough has gathered. Brightness
/// is √merit in units of the residual: the residual's magnitude where components are points of one term.
class BrightPlaces {
 public:
  /// Finds the places of at least this brightness. Residual and PSF must outlive this.
  BrightPlaces(const ScaledResidual& residual, const ScaledPsf& psf, double brightness, int threads);

  /// The best place for the next component.
  struct Place {
    std::size_t index = 0;
    std::size_t tile = 0;
    std::size_t scale = 0;
    int row = 0;
    int column = 0;
    TaylorValues residual{};
  };
  Place brightest() const;
  double brightness() const;        ///< of that place; 0 where there is none
  double point_brightness() const;  ///< of the brightest point, whether components may be points or not; 0 where there is none

  /// Takes a component of a spectrum off tiles near its place.
  void subtract(const Place& at, const TaylorValues& coefficient);
  /// The change, as a brightness, that is outstanding in far tiles, off which components have not been taken yet: three
  /// standard deviations, as if sidelobes met at random, or the strongest sidelobe alone.
  double outstanding() const;
  /// How bright other places may have become by all components that are not near them: as many deviations above what they were
  /// as in outstanding().
  double of_others() const;
  /// True if every place of this brightness or more is in the list and up to date. Other places may have brightened since: nine
  /// standard deviations are allowed for, of sidelobes that meet at random where the fluxes of neighbours have one sign.
  bool sees_all_above(double brightness) const;
  /// Takes the outstanding components off far tiles. Returns false, and does nothing, where the PSF is not known that far, or a
  /// convolution of the whole residual costs less.
  bool subtract_outstanding();

 private:
  struct Tile {
    int row;  ///< of its first pixel
    int column;
    float brightest = -1;  ///< merits
    float brightest_point = -1;
  };
  struct Found;

  void find(const ScaledResidual& residual, float merit, int tile_row, std::vector<Found>& found) const;
  void keep(std::vector<Found>& found);
  std::size_t range_at(std::size_t tile, std::size_t scale) const { return tile * psf_.scales().size() + scale; }
  BrightRange range(std::size_t tile, std::size_t scale);
  ReachingComponent component(const Place& from, const TaylorValues& coefficient, std::size_t to_scale, const Tile& tile) const;
  void subtract(const Place& at, const TaylorValues& coefficient, std::size_t tile);
  void look_at(std::size_t tile, std::size_t scale, float merit);
  void look_at_row(int tile_row);
  /// The change of a place's brightness by sidelobes of this flux: the standard deviation where they meet at random.
  double change(const FoundFlux& flux) const;
  bool is_near(const Tile& a, const Tile& b) const;

  const ScaledPsf& psf_;
  int threads_;
  int near_tiles_;
  int tiles_u_;
  int tiles_v_;
  int width_;  ///< of the residual
  int height_;
  double brightness_;                            ///< of the faintest place
  std::vector<Tile> tile_;                       ///< [row][column]
  std::vector<std::size_t> first_;               ///< [tile][scale], and one more
  std::vector<std::int32_t> offset_;             ///< [place]
  std::vector<float> value_[most_taylor_terms];  ///< [term][place]
  std::vector<float> merit_;
  std::vector<float> brightest_in_row_, brightest_point_in_row_;  ///< [row of tiles]

  struct Outstanding {
    Place place;
    TaylorValues coefficient{};
  };
  std::vector<Outstanding> outstanding_;
  std::vector<std::int32_t> outstanding_at_;  ///< [place], in outstanding_; −1

  FoundFlux outstanding_flux_;
  FoundFlux flux_;  ///< of all components
  FoundFlux flux_magnitude_;
};

}  // namespace misfit::imager
