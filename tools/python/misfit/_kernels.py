"""Gridding functions by name and from files."""

from . import _misfit


def kernel(name="least-misfit", width=7, x0=0.25):
    """
    Make a gridding function.

    Least-misfit and minimax functions are solved for: in milliseconds up to a width of about 10, in seconds at 20, or minimax
    ones in half a minute. Solved ones are kept where the program keeps them, in ``$MISFIT_CACHE`` or ``misfit`` in the user's
    cache folder, and have the same bits from there. Ctrl-C ends the wait; the solution is kept all the same if the process
    lives on.

    Parameters
    ----------
    name : str
        One of `kernel_names()`, or ``spheroidal-exact-<order>`` for any order from 0 to 10.
    width : int
        W, the cells of the grid that a visibility touches per axis.
    x0 : float
        Half the part of the FFT image that is kept: image size / (2 FFT size), below 1/2; 0.25 is a padding of 2.

    Returns
    -------
    Kernel

    Raises
    ------
    ValueError
        For a name that is not known, or a width or x0 that this family does not have.

    Examples
    --------
    >>> import misfit
    >>> kernel = misfit.kernel(width=6)
    >>> kernel.mean_error < 1e-11
    True
    >>> kernel.taps(0.25).shape
    (6,)
    """
    return _misfit.kernel(name, width, x0)


def read_kernel(path):
    """
    Read a gridding function from a kernel-table file, as `Kernel.write` and `misfit kernel --output` write it.

    Parameters
    ----------
    path : str or os.PathLike
        The file.

    Returns
    -------
    Kernel
        The same bit for bit.

    Raises
    ------
    FileNotFoundError
        Where there is no such file.
    OSError
        For a file that is no kernel table, or whose checksum does not match.
    """
    return _misfit.read_kernel(path)


def kernel_names():
    """
    Name the families of gridding functions that there are.

    Returns
    -------
    list of str
    """
    return _misfit.kernel_names()
