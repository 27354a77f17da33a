"""The sums that transforms of arrays are defined by, in numpy."""

import numpy as np

SPEED_OF_LIGHT = 299792458.0  # m/s


class Scene:
    """
    Random visibilities that fill the uv plane of an image's pixels, and those pixels.

    `fov` is in degrees. The sums are written down once more here, independently of the module: x and y of the pixels, phases
    2 pi (u x + v y - w (n - 1)).
    """

    def __init__(self, fov, size, rows, channels, single=False, do_wgridding=True, center=(0.0, 0.0), seed=1):
        random = np.random.default_rng(seed)
        self.size, self.do_wgridding, self.center = size, do_wgridding, center
        self.pixsize = np.radians(fov) / np.array(size)
        self.freq = 1e9 * (1 + np.arange(channels) / channels)
        self.uvw = (random.random((rows, 3)) - 0.5) * SPEED_OF_LIGHT / (self.pixsize.max() * 1e9)
        real, part = (np.float32, np.complex64) if single else (np.float64, np.complex128)
        self.vis = (random.random((rows, channels)) - 0.5 + 1j * (random.random((rows, channels)) - 0.5)).astype(part)
        self.wgt = random.uniform(0.9, 1.1, (rows, channels)).astype(real)
        self.mask = random.uniform(0, 1, (rows, channels)) > 0.2
        self.dirty = (random.random(size) - 0.5).astype(real)

    def options(self, epsilon, **others):
        """Keywords of both transforms."""
        return dict(
            uvw=self.uvw, freq=self.freq, epsilon=epsilon, do_wgridding=self.do_wgridding,
            pixsize_x=self.pixsize[0], pixsize_y=self.pixsize[1], center_x=self.center[0], center_y=self.center[1], **others,
        )

    def image_options(self, epsilon, **others):
        """Keywords of vis2dirty."""
        return self.options(epsilon, vis=self.vis, npix_x=self.size[0], npix_y=self.size[1], **others)

    def _pixels(self):
        x, y = (c + (np.arange(n) - n // 2) * p for c, n, p in zip(self.center, self.size, self.pixsize))
        x, y = (a.ravel() for a in np.meshgrid(x, y, indexing="ij"))
        r2 = x**2 + y**2
        n = np.sqrt(np.maximum(1 - r2, 0)) if self.do_wgridding else np.ones_like(r2)
        nm1 = np.where(r2 <= 1, -r2 / (1 + n), 0) if self.do_wgridding else 0 * r2
        return x, y, n, nm1

    def _phases(self, frequency):
        x, y, _, nm1 = self._pixels()
        return 2 * np.pi * frequency / SPEED_OF_LIGHT * (self.uvw @ np.array([x, y, -nm1]))

    def image(self, wgt=None, mask=None, divide_by_n=True):
        """What vis2dirty is to return; 0 beyond the horizon."""
        vis = self.vis.astype(np.complex128) * (1 if wgt is None else wgt.astype(np.float64)) * (1 if mask is None else mask)
        total = sum((vis[:, c] @ np.exp(1j * self._phases(f))).real for c, f in enumerate(self.freq))
        n = self._pixels()[2]
        above = n > 0
        return np.where(above, total / np.where(above, n, 1) if divide_by_n else total, 0).reshape(self.size)

    def visibilities(self, wgt=None, mask=None, divide_by_n=True):
        """What dirty2vis is to return."""
        n = self._pixels()[2]
        above = n > 0
        model = np.where(above, self.dirty.ravel().astype(np.float64) / np.where(above & divide_by_n, n, 1), 0)
        vis = np.stack([np.exp(-1j * self._phases(f)) @ model for f in self.freq], axis=1)
        return vis * (1 if wgt is None else wgt.astype(np.float64)) * (1 if mask is None else mask)


def relative_error(value, truth):
    """The norm of the difference over that of the truth."""
    return np.linalg.norm(np.asarray(value, truth.dtype) - truth) / np.linalg.norm(truth)
