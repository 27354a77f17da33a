"""usage: arrays.py   with the Python module `misfit` on PYTHONPATH
Leaves what the module makes of random visibilities as .npy files, its CLEAN's report as JSON, and a kernel as a table."""
import json

import misfit
import numpy

random = numpy.random.default_rng(1)
SIZE, PIXEL, HZ = (96, 80), 2e-5, numpy.array([1e9, 1.05e9])
uvw = random.normal(size=(3000, 3)) * [1500, 1200, 800]
points = [(1.0, 10, -12), (0.6, -20, 9)]  # Jy, pixels
wavelengths = uvw[:, None, :] * HZ[:, None] / 299792458
data = sum(flux * numpy.exp(-2j * numpy.pi * (wavelengths @ [x * PIXEL, y * PIXEL, 1 - numpy.sqrt(1 - (x * x + y * y) * PIXEL**2)]))
           for flux, x, y in points)
field = {"uvw": uvw, "freq": HZ, "pixsize_x": PIXEL, "pixsize_y": PIXEL}
sized = {**field, "npix_x": SIZE[0], "npix_y": SIZE[1]}

for epsilon in (1e-3, 1e-6, 1e-10):
    dirty = misfit.vis2dirty(**sized, vis=data, epsilon=epsilon, nthreads=2)
    numpy.save(f"dirty-{epsilon}.npy", dirty)
    numpy.save(f"vis-{epsilon}.npy", misfit.dirty2vis(**field, dirty=dirty, epsilon=epsilon, nthreads=2))
for deconvolver in ({"deconvolver": "hogbom"}, {"deconvolver": "clark"}, {"deconvolver": "multiscale", "scales": (0, 5)}):
    result = misfit.clean(**sized, vis=data, niter=200, threshold=1e-3, **deconvolver)
    name = deconvolver["deconvolver"]
    for kind in ("image", "residual", "model", "psf"):
        numpy.save(f"{name}-{kind}.npy", getattr(result, kind))
    with open(f"{name}.json", "w", encoding="utf-8") as file:
        json.dump({"beam": result.beam, "report": result.report}, file, indent=1, default=str)
