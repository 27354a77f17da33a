import os
from collections.abc import Sequence
from typing import Any, NamedTuple, Optional, Union, overload

import numpy as np
import numpy.typing as npt

__version__: str

_Mask = Union[npt.NDArray[np.uint8], npt.NDArray[np.bool_]]

class Kernel:
    @property
    def name(self) -> str: ...
    @property
    def width(self) -> int: ...
    @property
    def x0(self) -> float: ...
    @property
    def mean_error(self) -> float: ...
    @property
    def max_error(self) -> float: ...
    @property
    def degree(self) -> int: ...
    @property
    def coefficients(self) -> npt.NDArray[np.float64]: ...
    @overload
    def __call__(self, u: float) -> float: ...
    @overload
    def __call__(self, u: npt.ArrayLike) -> npt.NDArray[np.float64]: ...
    def taps(self, t: npt.ArrayLike) -> npt.NDArray[np.float64]: ...
    @overload
    def correction(self, x: float) -> float: ...
    @overload
    def correction(self, x: npt.ArrayLike) -> npt.NDArray[np.float64]: ...
    @overload
    def map_error(self, x: float) -> float: ...
    @overload
    def map_error(self, x: npt.ArrayLike) -> npt.NDArray[np.float64]: ...
    def write(self, path: Union[str, os.PathLike[str]], sampling: int = 128, interpolation: int = 3) -> None: ...

def kernel(name: str = "least-misfit", width: int = 7, x0: float = 0.25) -> Kernel: ...
def read_kernel(path: Union[str, os.PathLike[str]]) -> Kernel: ...
def kernel_names() -> list[str]: ...

class AccuracyWarning(UserWarning): ...

@overload
def vis2dirty(
    *,
    uvw: npt.ArrayLike,
    freq: npt.ArrayLike,
    vis: npt.NDArray[np.complex64],
    wgt: Optional[npt.NDArray[np.float32]] = None,
    mask: Optional[_Mask] = None,
    npix_x: int = 0,
    npix_y: int = 0,
    pixsize_x: float,
    pixsize_y: float,
    center_x: float = 0.0,
    center_y: float = 0.0,
    epsilon: float,
    do_wgridding: bool = False,
    flip_u: bool = False,
    flip_v: bool = False,
    flip_w: bool = False,
    divide_by_n: bool = True,
    sigma_min: float = 1.1,
    sigma_max: float = 2.6,
    nthreads: int = 1,
    verbosity: int = 0,
    double_precision_accumulation: bool = False,
    dirty: Optional[npt.NDArray[np.float32]] = None,
    kernel: Union[str, Kernel] = "least-misfit",
    kernel_width: int = 0,
) -> npt.NDArray[np.float32]: ...
@overload
def vis2dirty(
    *,
    uvw: npt.ArrayLike,
    freq: npt.ArrayLike,
    vis: npt.NDArray[np.complex128],
    wgt: Optional[npt.NDArray[np.float64]] = None,
    mask: Optional[_Mask] = None,
    npix_x: int = 0,
    npix_y: int = 0,
    pixsize_x: float,
    pixsize_y: float,
    center_x: float = 0.0,
    center_y: float = 0.0,
    epsilon: float,
    do_wgridding: bool = False,
    flip_u: bool = False,
    flip_v: bool = False,
    flip_w: bool = False,
    divide_by_n: bool = True,
    sigma_min: float = 1.1,
    sigma_max: float = 2.6,
    nthreads: int = 1,
    verbosity: int = 0,
    double_precision_accumulation: bool = False,
    dirty: Optional[npt.NDArray[np.float64]] = None,
    kernel: Union[str, Kernel] = "least-misfit",
    kernel_width: int = 0,
) -> npt.NDArray[np.float64]: ...
@overload
def dirty2vis(
    *,
    uvw: npt.ArrayLike,
    freq: npt.ArrayLike,
    dirty: npt.NDArray[np.float32],
    wgt: Optional[npt.NDArray[np.float32]] = None,
    mask: Optional[_Mask] = None,
    pixsize_x: float,
    pixsize_y: float,
    center_x: float = 0.0,
    center_y: float = 0.0,
    epsilon: float,
    do_wgridding: bool = False,
    flip_u: bool = False,
    flip_v: bool = False,
    flip_w: bool = False,
    divide_by_n: bool = True,
    sigma_min: float = 1.1,
    sigma_max: float = 2.6,
    nthreads: int = 1,
    verbosity: int = 0,
    double_precision_accumulation: bool = False,
    vis: Optional[npt.NDArray[np.complex64]] = None,
    kernel: Union[str, Kernel] = "least-misfit",
    kernel_width: int = 0,
) -> npt.NDArray[np.complex64]: ...
@overload
def dirty2vis(
    *,
    uvw: npt.ArrayLike,
    freq: npt.ArrayLike,
    dirty: npt.NDArray[np.float64],
    wgt: Optional[npt.NDArray[np.float64]] = None,
    mask: Optional[_Mask] = None,
    pixsize_x: float,
    pixsize_y: float,
    center_x: float = 0.0,
    center_y: float = 0.0,
    epsilon: float,
    do_wgridding: bool = False,
    flip_u: bool = False,
    flip_v: bool = False,
    flip_w: bool = False,
    divide_by_n: bool = True,
    sigma_min: float = 1.1,
    sigma_max: float = 2.6,
    nthreads: int = 1,
    verbosity: int = 0,
    double_precision_accumulation: bool = False,
    vis: Optional[npt.NDArray[np.complex128]] = None,
    kernel: Union[str, Kernel] = "least-misfit",
    kernel_width: int = 0,
) -> npt.NDArray[np.complex128]: ...

class CleanResult(NamedTuple):
    image: npt.NDArray[np.float64]
    residual: npt.NDArray[np.float64]
    model: npt.NDArray[np.float64]
    psf: npt.NDArray[np.float64]
    mask: Optional[npt.NDArray[np.float64]]
    beam: tuple[float, float, float]
    report: dict[str, Any]

def clean(
    *,
    uvw: npt.ArrayLike,
    freq: npt.ArrayLike,
    vis: Union[npt.NDArray[np.complex64], npt.NDArray[np.complex128]],
    wgt: Union[npt.NDArray[np.float32], npt.NDArray[np.float64], None] = None,
    mask: Optional[_Mask] = None,
    npix_x: int,
    npix_y: int,
    pixsize_x: float,
    pixsize_y: float,
    center_x: float = 0.0,
    center_y: float = 0.0,
    epsilon: float = 1e-6,
    niter: int = 1000,
    gain: float = 0.1,
    threshold: float = 0.0,
    nsigma: float = 0.0,
    deconvolver: str = "hogbom",
    scales: Sequence[float] = (0,),
    smallscalebias: float = 0.0,
    cyclefactor: float = 1.0,
    minpsffraction: float = 0.05,
    maxpsffraction: float = 0.8,
    cycleniter: int = -1,
    nmajor: int = -1,
    clean_mask: Optional[npt.ArrayLike] = None,
    usemask: str = "user",
    startmodel: Optional[npt.ArrayLike] = None,
    do_wgridding: bool = True,
    flip_u: bool = False,
    flip_v: bool = False,
    flip_w: bool = False,
    sigma_min: float = 1.1,
    sigma_max: float = 2.6,
    nthreads: int = 1,
    kernel: Union[str, Kernel] = "least-misfit",
    kernel_width: int = 0,
) -> CleanResult: ...
