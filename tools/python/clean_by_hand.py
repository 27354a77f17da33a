"""
CLEAN a MeasurementSet major cycle by major cycle, within a mask that follows what the residual shows.

    python3 clean_by_hand.py my.ms out 1024 0.2arcsec

In place of the rule for the mask below there may be a person who looks at cycle.residual, and draws one.
"""

import sys

import numpy as np

import misfit


def near(mask, pixels):
    """The mask, and what lies within so many pixels of it."""
    for _ in range(pixels):
        padded = np.pad(mask, [(0, 0), (0, 0), (1, 1), (1, 1)])
        mask = mask | padded[..., :-2, 1:-1] | padded[..., 2:, 1:-1] | padded[..., 1:-1, :-2] | padded[..., 1:-1, 2:]
    return mask


def main(vis, imagename, imsize, cell):
    for cycle in misfit.clean_cycles(vis, imagename=imagename, imsize=int(imsize), cell=cell, niter=10000, nsigma=4):
        peak = np.nanmax(np.abs(cycle.residual))
        print(f"after {cycle.number} major cycles: peak residual {peak:.3g} Jy/beam, noise {cycle.noise:.3g}")
        shown = near(cycle.residual > 0.3 * peak, 3)
        cycle.mask = shown if cycle.mask is None else shown | cycle.mask


if __name__ == "__main__":
    main(*sys.argv[1:])
