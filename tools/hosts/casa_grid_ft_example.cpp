// An example, NOT COMPILED OR TESTED HERE, since it needs CASA's own sources (casatools): a GridFT, the transform of tclean's
// gridder='standard', that grids with a kernel table. It was written from public copies of
// synthesis/TransformMachines2/GridFT.{h,cc} and fgridft.f, and compiles to nothing where CASA's headers are lacking.
//
// GridFT has an own ConvolveGridder, but does not call its grid() and degrid(). put() and get() hand its table, convFunc_p's
// support and sampling, and cells and offsets found by CASA's own nint, to loops in Fortran; only correctX1D() is called,
// before degridding and after gridding. The loops divide the taps of a visibility by their sum as ConvolveGridder does, so that
// ConvolveGridderTable's correction is right for them. Such a subclass therefore changes the table (W ≤ 7) and the correction:
// convolve_gridder_table.h says what error remains. Entries a cell cost memory only: ask for 1e5.
//
// For polynomial taps and wider kernels, CasacoreGridder, put() and get() must be written anew around its grid() and degrid(),
// with all else that they do: interpolation in frequency, flags and weights, rotateUVW() and its phasor, the UVW's sign, maps
// of channels and polarisations, and sumWeight, to which a visibility adds its weight once. It takes griddedData, in single
// precision; for griddedData2, which useDoublePrec asks for, it would have to be made for DComplex.
//
// To be checked against the CASA that this is built with:
// - init() is virtual and protected, and makes `gridder`, a plain pointer to a ConvolveGridder that GridFT deletes;
// - nx and ny are set there, and uvScale and uvOffset, before the gridder is made;
// - the names convFunc_p, convSupport_p and convSampling_p, and that put() and get() look into gridder->cFunction();
// - that the loops (sectggrids, sectggridd, sectdgrid) divide by the sum of the taps both ways. Some versions sum in single
//   precision in get(), which adds 1e-7;
// - that copies are used only after init(), which initializeToVis() and initializeToSky() call: GridFT's own operator= gives a
//   copy the stock function;
// - where createFTMachine() of SynthesisImagerVi2 chooses "gridft", which must make this class instead; toRecord() does not
//   hold the path, so that workers of a parallel run need it by other means.
// x0 of the kernel must be that of the padding: 1 / (2 · padding), 0.4167 for tclean's 1.2, and padding more than 1.
#if __has_include(<synthesis/TransformMachines2/GridFT.h>)

#include <synthesis/TransformMachines2/GridFT.h>

#include <memory>
#include <string>

#include "tools/hosts/convolve_gridder_table.h"

namespace casa::refim {

class KernelTableGridFT : public GridFT {
 public:
  KernelTableGridFT(const std::string& kernel_table, casacore::Int per_cell, const GridFT& like)
      : GridFT(like), kernel_table_(kernel_table), per_cell_(per_cell) {}

  FTMachine* cloneFTM() override { return new KernelTableGridFT(*this); }

 protected:
  void init() override {
    GridFT::init();
    auto table = std::make_unique<misfit::hosts::ConvolveGridderTable>(kernel_table_, casacore::IPosition(2, nx, ny), uvScale,
                                                                       uvOffset, per_cell_);
    convFunc_p.resize();
    convFunc_p = table->cFunction();
    convSupport_p = table->cSupport()(0);
    convSampling_p = table->cSampling();
    delete gridder;
    gridder = table.release();
  }

 private:
  std::string kernel_table_;
  casacore::Int per_cell_;
};

}  // namespace casa::refim

#endif
