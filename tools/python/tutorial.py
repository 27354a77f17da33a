# %% [markdown]
# # Gridding functions, and what they cost an image
#
# This file is a script, and a notebook where `# %%` begins a cell.
#
#     python3 build/tools/python/tutorial.py [FOLDER]
#
# With a folder the figures are written there; without one they are shown. The build puts this file beside the module. It wants
# numpy and matplotlib.

# %%
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import misfit

folder = Path(sys.argv[1]) if len(sys.argv) == 2 else None

COLOUR = {
    "least-misfit": "black",
    "prolate": "#0072b2",
    "kaiser-bessel": "#009e73",
    "exp-semicircle": "#d55e00",
    "spheroidal": "#cc79a7",
}
plt.rcParams.update({
    "figure.figsize": (10, 4.4), "figure.constrained_layout.use": True, "savefig.dpi": 110, "font.size": 10,
    "axes.grid": True, "grid.alpha": 0.3, "axes.spines.top": False, "axes.spines.right": False,
    "legend.frameon": False, "lines.linewidth": 1.4,
})


def style(name):
    """How the curve of a family looks: least misfit lies above the others."""
    return {"color": COLOUR[name], "label": name, "zorder": 3 if name == "least-misfit" else 2}


def shades(values):
    """Each value with its colour, from dark to light."""
    return zip(values, plt.cm.viridis(np.linspace(0, 0.8, len(values))))


def finish(figure, name):
    if folder is None:
        plt.show()
    else:
        folder.mkdir(parents=True, exist_ok=True)
        figure.savefig(folder / f"{name}.png")
        plt.close(figure)


# %% [markdown]
# ## A kernel
#
# An imager puts each visibility on a grid, W cells wide along each axis, and transforms the grid by an FFT. How much of the
# visibility a cell gets is C(u), where u is the distance between them in cells. An image that is n pixels wide is cut out of the
# middle of an FFT of n × padding: x, a pixel's offset from the phase centre over the size of the FFT, is at most
# x0 = 1 / (2 × padding), here 0.25.

# %%
kernel = misfit.kernel("least-misfit", width=7, x0=0.25)
print(kernel)
print("the taps of a visibility in the middle of its cell:", np.array2string(kernel.taps(0.0), precision=4))

# %% [markdown]
# `kernel(u)` is C(u). Families hardly differ where C is large; what tells them apart is how they end. Least-misfit functions
# are no formula: C is whatever has the smallest error, and it may jump from cell to cell, at the end the most.

# %%
WIDTH = 7
PADDING = 2
X0 = 1 / (2 * PADDING)
families = {name: misfit.kernel(name, WIDTH, X0) for name in COLOUR}

figure, (whole, end) = plt.subplots(1, 2)
for name, kernel in families.items():
    u = np.linspace(-4, 4, 2001)
    whole.plot(u, kernel(u), **style(name))
    u = np.linspace(WIDTH / 2 - 1, WIDTH / 2, 1001)
    end.semilogy(u, kernel(u), **style(name))
whole.set_ylabel("gridding function C(u)")
whole.legend(title=f"W = {WIDTH}, padding {PADDING}")
end.set_ylabel("C(u) in the last cell")
end.set_ylim(1e-8, 1e-1)
for axes in (whole, end):
    axes.set_xlabel("distance from the visibility, u / cells")
finish(figure, "functions")

# %% [markdown]
# ## The correction
#
# Spreading visibilities tapers the image, and `kernel.correction(x)` undoes it: the image is multiplied by h(x) h(y). The h
# that leaves the least error is not 1/c, where c is the Fourier transform of C, but c(x) / Σ c(x − n)², in which the aliases
# n ≠ 0 count too. Where h is large, rounding and aliases are amplified: that is why images are padded.

# %%
x = np.linspace(0, X0, 201)
figure, (by_family, by_width) = plt.subplots(1, 2, sharey=True)
for name, kernel in families.items():
    by_family.plot(x, kernel.correction(x), **style(name))
by_family.set_title(f"W = {WIDTH}")
by_family.set_ylabel("correction h(x)")
for width, shade in shades((4, 6, 8, 10, 12)):
    by_width.plot(x, misfit.kernel(width=width, x0=X0).correction(x), color=shade, label=f"W = {width}")
by_width.set_title("least-misfit")
for axes in (by_family, by_width):
    axes.set_xlabel("offset from the phase centre, x / size of the FFT")
    axes.legend()
finish(figure, "correction")

# %% [markdown]
# ## The map error
#
# `kernel.map_error(x)` is ℓ(x): the mean square of what gridding, FFT and correction make of a visibility, less what the direct
# Fourier transform makes of it, relative to the latter, along one axis. Least-misfit functions have the smallest mean of ℓ
# over the image, |x| ≤ x0; their error is largest at its border. What lies outside is cut off: there they may be as wrong as
# they like, and a function that does not know x0, as the spheroidal one, is good where it does not count.

# %%
x = np.linspace(0, 0.5, 401)
figure, (by_width, by_family) = plt.subplots(1, 2)
for width, shade in shades((4, 6, 8, 10, 12)):
    error = misfit.kernel(width=width, x0=X0).map_error(x)
    by_width.semilogy(x, error, color=shade)
    by_width.text(0, 4 * error[0], f"W = {width}", color=shade, va="bottom")
by_width.set_title("least-misfit")
by_width.set_ylim(1e-27, 3)
for name, kernel in families.items():
    by_family.semilogy(x, kernel.map_error(x), **style(name))
by_family.set_title(f"W = {WIDTH}")
by_family.set_ylim(1e-17, 3)
by_family.legend(loc="upper left")
by_family.secondary_yaxis("right", functions=(np.sqrt, np.square)).set_ylabel("RMS error of one axis, √ℓ")
for axes in (by_width, by_family):
    axes.axvspan(X0, 0.5, color="0.93", zorder=0)
    axes.text(0.75, 0.04, "cut off", ha="center", color="0.4", transform=axes.transAxes)
    axes.set_xlabel("offset from the phase centre, x / size of the FFT")
    axes.set_ylabel("map error ℓ(x)")
finish(figure, "map-error")

# %% [markdown]
# ## Width, padding and mean error
#
# `kernel.mean_error` is E, the mean of ℓ over the image; √E is the RMS relative error along one axis. At padding 2 each cell of
# width takes a factor of about ten off it, and costs time for every visibility; padding costs time and memory for every pixel.

# %%
widths = np.arange(2, 13)


def mean_errors(name, x0):
    """√E at each of `widths`; NaN where the family has none."""
    offered = range(4, 9) if name == "spheroidal" else widths
    return np.array([np.sqrt(misfit.kernel(name, int(w), x0).mean_error) if w in offered else np.nan for w in widths])


table = {name: mean_errors(name, X0) for name in COLOUR}
print(f"\nRMS error of one axis at padding {PADDING}")
print("width", *(f"{name:>14}" for name in table))
for i, width in enumerate(widths):
    print(f"{width:5d}", *(f"{table[name][i]:14.3e}" for name in table))

figure, (by_family, by_padding) = plt.subplots(1, 2, sharey=True)
for name, errors in table.items():
    by_family.semilogy(widths, errors, "o-", markersize=4, **style(name))
by_family.set_title(f"padding {PADDING}")
by_family.set_ylabel("RMS error of one axis, √E")
for padding, shade in shades((1.1, 1.2, 1.5, 2, 3)):
    errors = mean_errors("least-misfit", 0.5 / padding)
    by_padding.semilogy(widths, errors, "o-", markersize=4, color=shade, label=f"padding {padding}")
by_padding.set_title("least-misfit")
for axes in (by_family, by_padding):
    axes.set_xlabel("width W / cells")
    axes.set_xticks(widths)
    axes.legend(loc="lower left")
finish(figure, "mean-error")

# %% [markdown]
# ## What that means for an image
#
# So far all was theory. Here it is tried, in one dimension: random visibilities are put on a grid by hand, transformed,
# corrected, and compared with the direct sum over visibilities, pixel by pixel, over many images. `kernel.taps(t)` are the
# values that a visibility gives to its W cells.

# %%
random = np.random.default_rng(1)
FFT_SIZE = 512
pixels = np.arange(-FFT_SIZE // (2 * PADDING), FFT_SIZE // (2 * PADDING))
position = random.uniform(0, FFT_SIZE, 1000)  # u / cells
visibilities = random.normal(size=(100, 1000)) + 1j * random.normal(size=(100, 1000))  # [image][visibility]
direct = visibilities @ np.exp(-2j * np.pi * np.outer(position, pixels / FFT_SIZE))


def image_by_fft(kernel):
    first = np.ceil(position - kernel.width / 2)
    t = position - first - (kernel.width - 1) / 2
    cells = (first[:, np.newaxis] + np.arange(kernel.width)).astype(int) % FFT_SIZE  # the grid is periodic
    spread = np.zeros((len(position), FFT_SIZE))
    np.put_along_axis(spread, cells, kernel.taps(t), axis=1)
    whole = np.fft.fft(visibilities @ spread)
    return whole[:, pixels] * kernel.correction(pixels / FFT_SIZE)


def rms(values, axis=None):
    return np.sqrt(np.mean(np.abs(values) ** 2, axis=axis))


figure, axes = plt.subplots(figsize=(7.5, 4.6))
print()
for name, kernel in families.items():
    error = image_by_fft(kernel) - direct
    axes.semilogy(pixels, rms(error, axis=0) / rms(direct), ".", markersize=3, color=COLOUR[name])
    axes.semilogy(pixels, np.sqrt(kernel.map_error(pixels / FFT_SIZE)), **style(name))
    print(f"{name}: RMS error measured {rms(error) / rms(direct):.3e}, expected {np.sqrt(kernel.mean_error):.3e}")
axes.plot([], [], ".", color="0.4", label="measured over 100 images")
axes.set_xlabel("pixel from the phase centre")
axes.set_ylabel("RMS error / RMS of the image")
axes.set_ylim(1e-8, 1e-2)
axes.legend(ncol=2, title=f"W = {WIDTH}, padding {PADDING}; lines: √ℓ", loc="upper center")
finish(figure, "measured")

# %% [markdown]
# An image has two axes, each of which adds its own: √(2E). So the narrowest function that keeps an image to an accuracy is

# %%
for accuracy in (1e-3, 1e-4, 1e-5, 1e-6, 1e-7):
    enough = {name: widths[np.sqrt(2) * errors <= accuracy] for name, errors in table.items()}
    print(f"accuracy {accuracy:g}:", ", ".join(f"{name} {min(w)}" if len(w) else f"{name} none" for name, w in enough.items()))

# %% [markdown]
# ## Images of visibilities
#
# `vis2dirty` and `dirty2vis` take the keywords of ducc0.wgridder, and an accuracy in place of a width: the function that is
# wide enough is solved for. Here is an hour of some antennas on a plane that the Earth turns, and three sources. The image keeps
# to its `epsilon`, compared with direct sums.

# %%
SPEED_OF_LIGHT = 299792458.0  # m/s
PIXELS, PIXEL = 256, np.radians(1 / 3600)
antennas = random.normal(size=(24, 2)) * 1500  # m, east and north
pairs = np.array([antennas[i] - antennas[j] for i in range(24) for j in range(i)])
turn = np.radians(15) * np.linspace(-0.5, 0.5, 40)[:, np.newaxis]
u = pairs[:, 0] * np.cos(turn) - 0.6 * pairs[:, 1] * np.sin(turn)
v = 0.6 * pairs[:, 0] * np.sin(turn) + 0.6 * pairs[:, 1] * np.cos(turn)
w = 0.8 * pairs[:, 0] * np.sin(turn) + 0.8 * pairs[:, 1] * np.cos(turn)
uvw = np.stack([u, v, w], axis=-1).reshape(-1, 3)
freq = np.linspace(1.4e9, 1.5e9, 8)

sky = np.zeros((PIXELS, PIXELS))
sky[100, 140], sky[170, 90], sky[60, 60] = 1, 0.5, 0.2  # Jy
scene = {"uvw": uvw, "freq": freq, "pixsize_x": PIXEL, "pixsize_y": PIXEL, "do_wgridding": True}
exact = misfit.dirty2vis(**scene, dirty=sky, epsilon=1e-12, divide_by_n=False)
noise = 0.5 * (random.normal(size=exact.shape) + 1j * random.normal(size=exact.shape))
vis = exact + noise

checked = random.integers(0, PIXELS, (20, 2))
x, y = (checked - PIXELS // 2).T * PIXEL
n_minus_1 = -(x**2 + y**2) / (1 + np.sqrt(1 - x**2 - y**2))
turns = uvw @ np.array([x, y, -n_minus_1])
direct = sum((vis[:, c] @ np.exp(2j * np.pi * f / SPEED_OF_LIGHT * turns)).real for c, f in enumerate(freq))
print()
for epsilon in (1e-3, 1e-6, 1e-9):
    dirty = misfit.vis2dirty(**scene, vis=vis, npix_x=PIXELS, npix_y=PIXELS, epsilon=epsilon, divide_by_n=False)
    error = rms(dirty[tuple(checked.T)] - direct) / rms(dirty)
    print(f"epsilon {epsilon:g}: measured {error:.1e}")

# %% [markdown]
# `clean` takes the dirty beam off again, with tclean's parameters, and says why it stopped.

# %%
cleaned = misfit.clean(**scene, vis=vis, npix_x=PIXELS, npix_y=PIXELS, niter=2000, nsigma=4)
print()
print(f"CLEAN: {cleaned.report['iterations']} components, {cleaned.report['stop_reason']}")
for pixel in zip(*np.nonzero(sky)):
    print(f"source of {sky[pixel]:.3f} Jy: {cleaned.image[pixel]:.3f} Jy/beam")

figure, columns = plt.subplots(1, 3, figsize=(12, 4.2))
extent = np.array([-1, 1, -1, 1]) * PIXELS // 2
for axes, (title, image) in zip(columns, (
    ("dirty image", dirty / vis.size), ("restored", cleaned.image), ("residual", cleaned.residual),
)):
    shown = axes.imshow(1000 * image.T, origin="lower", extent=extent, vmin=-40, vmax=200, cmap="gray_r")
    axes.set_title(title)
    axes.set_xlabel("x / arcsec")
    axes.grid(False)
columns[0].set_ylabel("y / arcsec")
figure.colorbar(shown, ax=columns, label="mJy/beam", shrink=0.85)
finish(figure, "images")
