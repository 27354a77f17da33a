"""What functions on arrays expect of them."""

import numpy as np


def table(array, name, dtypes, axes=2):
    """
    Return `array` as the compiled functions take it: itself wherever they can.

    Raises TypeError unless its type is one of `dtypes`, ValueError unless it has so many axes.
    """
    array = np.asanyarray(array)
    if isinstance(array, np.ma.MaskedArray):
        raise TypeError(f"{name} is a masked array, expected an array, and mask for what is left out")
    if array.dtype not in dtypes:
        expected = " or ".join(str(np.dtype(each)) for each in dtypes)
        raise TypeError(f"{name} has the type {array.dtype}, expected {expected}")
    if array.ndim != axes:
        raise ValueError(f"{name} has {array.ndim} axes, expected {axes}")
    return array if usable(array) else np.ascontiguousarray(array)


def optional_table(array, name, dtypes):
    """Return the same for an array, None for None."""
    return None if array is None else table(array, name, dtypes)


def result(array, name, dtype, shape):
    """Return the array that a result is to be written to, or a new one where there is none."""
    if array is None:
        return np.empty(shape, dtype)
    if not isinstance(array, np.ndarray) or array.dtype != dtype:
        raise TypeError(f"{name} is {describe(array)}, expected an array of type {np.dtype(dtype)}")
    if array.shape != tuple(shape):
        raise ValueError(f"{name} has the shape {array.shape}, expected {tuple(shape)}")
    repeated = any(step == 0 and size > 1 for step, size in zip(array.strides, array.shape))
    if not array.flags.writeable or not usable(array) or repeated:
        raise ValueError(f"{name} cannot be written to, expected a writable and aligned array")
    return array


def describe(thing):
    """Return what a thing is, for messages."""
    return f"an array of type {thing.dtype}" if isinstance(thing, np.ndarray) else f"of type {type(thing).__name__}"


def usable(array):
    """Tell whether compiled functions can look at the array where it lies."""
    return array.flags.aligned and all(step % array.itemsize == 0 for step in array.strides)


def mask_table(mask):
    """Return a mask as uint8, which a bool is looked at as; None for None."""
    if mask is None:
        return None
    mask = np.asanyarray(mask)
    return table(mask.view(np.uint8) if mask.dtype == bool else mask, "mask", (np.uint8,))


def coordinates(uvw, freq):
    """Return UVW and frequencies as float64, copied only where they are of another type."""
    uvw = table(np.asanyarray(uvw, np.float64), "uvw", (np.float64,))
    freq = table(np.asanyarray(freq, np.float64), "freq", (np.float64,), 1)
    return uvw, freq


def image(pixels, name, shape):
    """Return pixels as float64, of the shape that is expected; None for None."""
    if pixels is None:
        return None
    if isinstance(pixels, (str, bytes)):
        raise TypeError(
            f"{name} is {pixels!r}, expected an array of shape {tuple(shape)}: its pixels have no place on the sky, where files and "
            "region text lie, as misfit image --mask takes them"
        )
    pixels = np.ascontiguousarray(pixels, np.float64)
    if pixels.shape != tuple(shape):
        raise ValueError(f"{name} has the shape {pixels.shape}, expected {tuple(shape)}")
    return pixels
