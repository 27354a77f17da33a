#pragma once

#include <vector>

#include "imager/beams/beam.h"

namespace misfit::imager {

/// An ellipse that encloses all of `beams`, so that images with these can be brought to one resolution; its area is the least
/// there is, to a thousandth. Frank–Wolfe steps lead towards the Löwner ellipse (Khachiyan 1996, Math. Oper. Res. 21, 307), and
/// the last ellipse is enlarged to enclose all. Throws std::invalid_argument where there are no beams, or one has an axis that
/// is not positive.
Beam common_beam(const std::vector<Beam>& beams);

}  // namespace misfit::imager
