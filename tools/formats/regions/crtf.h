#pragma once

#include <string>
#include <string_view>

#include "imager/files/image_header.h"
#include "tools/formats/regions/canvas.h"
#include "tools/formats/regions/region.h"

namespace misfit::tools::regions {

/// CASA region text (CRTF), version 0, as casadocs' "Region File Format" defines it and CARTA and CASA's viewer write it:
///
///     #CRTFv0
///     global coord=ICRS, corr=[I, Q]
///     circle [[12h30m49.42s, +12d23m28.0s], 10arcsec]
///     -rotbox [[187.70deg, 12.39deg], [4arcsec, 2arcsec], 30deg] range=[3chan, 7chan], color=red
///     ellipse [[100pix, 80pix], [20pix, 10pix], 45deg], coord=GALACTIC
///
/// Pixels count from 0. Angles turn from north through east, which is anticlockwise: they turn the width of a box, which lies
/// east-west at 0, and the first half axis of an ellipse, which lies north-south at 0. North is that of the place's own frame
/// at the centre, or the columns' direction where the centre is given in pixels. A box by its corners has sides of constant
/// coordinates, drawn as straight lines. Keywords: see keywords.h; those of a line `global` hold for all lines that follow,
/// unless they have their own. Annotations (`ann`), lines, vectors, texts and symbols have no pixels, and all but annotations
/// are reported.
class CrtfReader : public RegionReader {
 public:
  explicit CrtfReader(const imager::ImageHeader& image);
  RegionLine read(std::string_view line) override;

 private:
  RegionLine read_shape(std::string_view line) const;

  Canvas canvas_;
  imager::SpectralAxis axis_;
  std::vector<imager::Stokes> stokes_;
  RegionKeywords global_;
};

}  // namespace misfit::tools::regions
