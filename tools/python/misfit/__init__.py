"""
The imager misfit: tclean() and others for MeasurementSets; gridding functions, transforms and CLEAN for numpy arrays.

help() of each name says more; tutorial.py, among the sources and in share/doc/misfit, shows them at work.
"""

from ._clean import CleanResult, clean
from ._cycles import CleanCycle, clean_cycles
from ._kernels import kernel, kernel_names, read_kernel
from ._misfit import Kernel, __version__
from ._predict import predict, subtract
from ._tclean import tclean
from ._transforms import AccuracyWarning, dirty2vis, vis2dirty

__all__ = [
    "AccuracyWarning",
    "CleanCycle",
    "CleanResult",
    "Kernel",
    "__version__",
    "clean",
    "clean_cycles",
    "dirty2vis",
    "kernel",
    "kernel_names",
    "predict",
    "read_kernel",
    "subtract",
    "tclean",
    "vis2dirty",
]
