import os
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple, Optional, Union, overload

import numpy as np
import numpy.typing as npt

__version__: str

_Path = Union[str, os.PathLike[str]]
_Selection = Union[str, Sequence[str]]
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

def tclean(
    vis: Union[_Path, Sequence[_Path]],
    selectdata: bool = True,
    field: _Selection = "",
    spw: _Selection = "",
    timerange: _Selection = "",
    uvrange: _Selection = "",
    antenna: _Selection = "",
    scan: _Selection = "",
    observation: _Selection = "",
    intent: _Selection = "",
    datacolumn: str = "corrected",
    imagename: _Path = "",
    imsize: Union[float, Sequence[float]] = (100,),
    cell: Union[str, float, Sequence[Union[str, float]]] = "1arcsec",
    phasecenter: Union[str, int] = "",
    stokes: str = "I",
    projection: str = "SIN",
    startmodel: Union[_Path, Sequence[_Path]] = "",
    specmode: str = "mfs",
    reffreq: Union[str, float] = "",
    nchan: int = -1,
    start: Union[str, int, dict[str, Any]] = "",
    width: Union[str, int, dict[str, Any]] = "",
    outframe: str = "LSRK",
    veltype: str = "radio",
    restfreq: Union[str, float, Sequence[Union[str, float]]] = (),
    interpolation: str = "linear",
    perchanweightdensity: bool = True,
    gridder: str = "standard",
    facets: int = 1,
    psfphasecenter: Union[str, int] = "",
    wprojplanes: int = 1,
    vptable: str = "",
    mosweight: bool = True,
    aterm: bool = True,
    psterm: bool = False,
    wbawp: bool = True,
    conjbeams: bool = False,
    cfcache: str = "",
    usepointing: bool = False,
    computepastep: float = 360.0,
    rotatepastep: float = 360.0,
    pointingoffsetsigdev: Sequence[float] = (),
    pblimit: float = 0.2,
    normtype: str = "flatnoise",
    deconvolver: str = "hogbom",
    scales: Sequence[float] = (),
    nterms: int = 2,
    smallscalebias: float = 0.0,
    restoration: bool = True,
    restoringbeam: Union[str, Sequence[str]] = (),
    pbcor: bool = False,
    outlierfile: str = "",
    weighting: str = "natural",
    robust: float = 0.5,
    noise: str = "1.0Jy",
    npixels: int = 0,
    uvtaper: Union[str, Sequence[str]] = ("",),
    niter: float = 0,
    gain: float = 0.1,
    threshold: Union[str, float, dict[str, Any]] = 0.0,
    nsigma: float = 0.0,
    cycleniter: int = -1,
    cyclefactor: float = 1.0,
    minpsffraction: float = 0.05,
    maxpsffraction: float = 0.8,
    interactive: Union[bool, int] = False,
    nmajor: int = -1,
    fullsummary: bool = False,
    usemask: str = "user",
    mask: Union[_Path, Sequence[_Path]] = "",
    pbmask: float = 0.0,
    sidelobethreshold: float = 3.0,
    noisethreshold: float = 5.0,
    lownoisethreshold: float = 1.5,
    negativethreshold: float = 0.0,
    smoothfactor: float = 1.0,
    minbeamfrac: float = 0.3,
    cutthreshold: float = 0.01,
    growiterations: int = 75,
    dogrowprune: bool = True,
    minpercentchange: float = -1.0,
    verbose: bool = False,
    fastnoise: bool = True,
    restart: bool = True,
    savemodel: str = "none",
    calcres: bool = True,
    calcpsf: bool = True,
    psfcutoff: float = 0.35,
    parallel: bool = False,
    *,
    beam: Optional[_Path] = None,
    outformat: str = "casa",
    accuracy: Optional[float] = None,
    threads: Optional[int] = None,
    memory: Optional[float] = None,
    verify: Optional[int] = None,
    dryrun: bool = False,
) -> dict[str, Any]: ...
class CleanCycle:
    number: int
    residual: npt.NDArray[np.float64]
    mask: Optional[npt.ArrayLike]
    noise: float
    result: dict[str, Any]

def clean_cycles(vis: Union[_Path, Sequence[_Path]], **parameters: Any) -> Iterator[CleanCycle]: ...
def predict(
    vis: _Path,
    *,
    model: Optional[_Path] = None,
    components: Optional[_Path] = None,
    column: str = "MODEL_DATA",
    field: str = "",
    spw: str = "",
    timerange: str = "",
    uvrange: str = "",
    antenna: str = "",
    scan: str = "",
    intent: str = "",
    observation: str = "",
    phasecenter: str = "",
    apply_beam: bool = False,
    beam: str = "",
    accuracy: Optional[float] = None,
    kernel: Optional[str] = None,
    threads: Optional[int] = None,
) -> dict[str, Any]: ...
def subtract(
    vis: _Path,
    *,
    model: Optional[_Path] = None,
    components: Optional[_Path] = None,
    datacolumn: Optional[str] = None,
    column: Optional[str] = None,
    field: str = "",
    spw: str = "",
    timerange: str = "",
    uvrange: str = "",
    antenna: str = "",
    scan: str = "",
    intent: str = "",
    observation: str = "",
    phasecenter: str = "",
    apply_beam: bool = False,
    beam: str = "",
    accuracy: Optional[float] = None,
    kernel: Optional[str] = None,
    threads: Optional[int] = None,
) -> dict[str, Any]: ...
