"""
Gridding functions, transforms and CLEAN of the imager misfit, for numpy arrays.

help() of each name says more; tutorial.py, among the sources and in share/doc/misfit, shows them at work.
"""

from ._clean import CleanResult, clean
from ._kernels import kernel, kernel_names, read_kernel
from ._misfit import Kernel, __version__
from ._transforms import AccuracyWarning, dirty2vis, vis2dirty

__all__ = [
    "AccuracyWarning",
    "CleanResult",
    "Kernel",
    "__version__",
    "clean",
    "dirty2vis",
    "kernel",
    "kernel_names",
    "read_kernel",
    "vis2dirty",
]
