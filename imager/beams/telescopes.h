#pragma once

#include <stdexcept>
#include <string>

#include "imager/beams/primary_beam.h"
#include "imager/data/antennas.h"

namespace misfit::imager {

/// The dish that stands for antennas, and why it does.
struct DishModel {
  Dish dish;
  std::string because;
  std::string doubt = {};  ///< a sentence where the beam may be wrong by more than a few percent at half power; else empty
};

/// Antennas that have no beam which a dish describes.
struct NoSimpleBeam : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Of antennas of a telescope that is known, the dish as wide as its measured beam asks, or that CASA takes; of others, one of
/// their own diameter, uniformly lit, with a doubt. Throws NoSimpleBeam, naming the telescope and the reason, for stations and
/// tiles of dipoles, cylinders and dishes that do not track, and for antennas that are not known and whose diameter is none
/// that a dish has. Names count as CASA writes them, whatever their capitals, blanks and dashes.
DishModel dish_model(const AntennaSort& antennas);

}  // namespace misfit::imager
