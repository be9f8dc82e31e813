"""Pictures of a cooling gas that forms clusters."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.patches import Rectangle
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.axes_grid1.anchored_artists import AnchoredSizeBar

from roughgas import theory
from roughgas.plotting import LINE_STYLES, THEORY, Style, add_circles, move_circles

SHOWN = 0.05, 0.25, 1.0  # instants in the picture, as shares of the film
SMOOTHING = 6.0  # a: standard deviation of the Gaussian that smooths the packing
PACKING: Style = {"cmap": "cividis", "vmin": 0.0, "vmax": 0.8, "interpolation": "bilinear"}
SPIN = {"cmap": "RdBu_r", "clim": (-2.0, 2.0)}
SPIN_LABEL, PACKING_LABEL = "spin / its r.m.s.", "packing fraction"
VOID = "#222222"
CLOSEUP = 160.0  # a: side of the close-up of single disks
TRANSLATION, ROTATION, UNEVENNESS = (look.colour for look in LINE_STYLES[:3])
DOTTED: Style = {"color": THEORY, "linestyle": ":"}
LETTERS, TITLE = "abc", 8
SIZE = (7.0, 5.0)  # inches, of the picture
PER_PARTICLE = "collisions per particle"


def draw(film: xr.Dataset) -> Figure:
    """Draw maps of packing at three instants, single disks, and energies, R and unevenness over
    time."""
    figure = Figure(figsize=SIZE, layout="constrained")
    above, below = np.asarray(figure.subfigures(2, 1, height_ratios=(1, 1.02)))
    frames = [round(share * (film.sizes["frame"] - 1)) for share in SHOWN]
    maps = above.subplots(1, 3, sharey=True)
    for axes, frame, letter in zip(maps, frames, LETTERS, strict=True):
        image = draw_map(axes, film, frame)
        axes.set_title(f"{letter}   {collisions_label(film, frame)}", loc="left", fontsize=TITLE)
        axes.label_outer()
    above.colorbar(image, ax=maps, label=PACKING_LABEL, pad=0.01)
    square = outline(maps[-1], film)
    above.suptitle(caption(film), fontsize=TITLE)
    zoom, cooling, graphs_column = below.subfigures(1, 3, width_ratios=(1.15, 1, 1))
    disks = draw_disks(axes := zoom.subplots(), film, frames[-1], square)
    axes.set_title("d   the square in c", loc="left", fontsize=TITLE)
    zoom.colorbar(disks, ax=axes, label=SPIN_LABEL, shrink=0.62, pad=0.02)
    graphs = [cooling.subplots(), *graphs_column.subplots(2, 1, sharex=True)]
    for axes, draw_graph in zip(graphs, (energies, share, unevenness), strict=True):
        draw_graph(axes, film)
        axes.xaxis.set_major_locator(
            MaxNLocator(5, prune="upper")
        )  # the last label would be cut off
        for collisions in collisions_so_far(film)[frames]:
            axes.axvline(collisions, ymax=0.05, color=THEORY, linewidth=0.8)
        axes.label_outer()
    return figure


def packing(film: xr.Dataset, frame: int) -> np.ndarray:
    """Return the packing fraction (y, x) at each cell of the map, averaged with a Gaussian."""
    count = film["count"].values[frame]
    dx, dy = film.attrs["box"][0] / count.shape[1], film.attrs["box"][1] / count.shape[0]
    kx = 2 * np.pi * np.fft.rfftfreq(count.shape[1], dx)
    ky = 2 * np.pi * np.fft.fftfreq(count.shape[0], dy)
    kernel = np.exp(-0.5 * SMOOTHING**2 * (kx**2 + ky[:, None] ** 2))
    return np.fft.irfft2(np.fft.rfft2(count * (np.pi / (dx * dy))) * kernel, s=count.shape)


def closeup_square(film: xr.Dataset) -> tuple[float, float, float]:
    """Return the square of the close-up of single disks: left, bottom and side, in a.

    It lies where the gas is densest in the last frame, within the window for which disks are
    stored.
    """
    box, window = np.asarray(film.attrs["box"]), film.attrs["window"]
    side = min(CLOSEUP, window, *box)
    room = max(0.0, min(window, *box) - side) / 2
    x, y = film.x.values, film.y.values
    dense = packing(film, -1)
    dense[abs(y - box[1] / 2) > room] = 0.0
    dense[:, abs(x - box[0] / 2) > room] = 0.0
    j, i = np.unravel_index(dense.argmax(), dense.shape)
    middle = (x[i], y[j]) if dense[j, i] > 0.0 else box / 2
    return float(middle[0] - side / 2), float(middle[1] - side / 2), float(side)


def draw_map(axes: Axes, film: xr.Dataset, frame: int) -> AxesImage:
    width, height = film.attrs["box"]
    shown = packing(film, frame)
    image = axes.imshow(shown, origin="lower", extent=(0, width, 0, height), **PACKING)
    _add_scale_bar(axes)
    return image


def _add_scale_bar(axes: Axes) -> None:
    """Add a bar with its length in a, in place of numbers along the axes."""
    low, high = axes.get_xlim()
    power = 10.0 ** np.floor(np.log10((high - low) / 4))
    length = max(step * power for step in (1, 2, 5) if step * power <= (high - low) / 4)
    bar = AnchoredSizeBar(axes.transData, length, f"${length:g}\\,a$", "lower left", pad=0.3)
    axes.add_artist(bar)
    axes.set(xticks=[], yticks=[])


def outline(axes: Axes, film: xr.Dataset) -> tuple[float, float, float]:
    """Outline the square on a map, and return it."""
    left, bottom, side = square = closeup_square(film)
    axes.add_patch(Rectangle((left, bottom), side, side, fill=False, edgecolor="white"))
    return square


def draw_disks(axes: Axes, film: xr.Dataset, frame: int, square: tuple) -> EllipseCollection:
    left, bottom, side = square
    axes.set(xlim=(left, left + side), ylim=(bottom, bottom + side), aspect="equal")
    axes.set(facecolor=VOID)
    _add_scale_bar(axes)
    disks = add_circles(axes, edgecolor=VOID, linewidth=0.2, rasterized=True, **SPIN)
    move_disks(disks, film, frame)
    return disks


def move_disks(disks: EllipseCollection, film: xr.Dataset, frame: int) -> None:
    x, y, spin = _disks_in_window(film, frame)
    axes: Any = disks.axes
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    visible = (x > left - 1) & (x < right + 1) & (y > bottom - 1) & (y < top + 1)
    move_circles(disks, x[visible], y[visible])
    disks.set_array(spin[visible])


def collisions_so_far(film: xr.Dataset) -> np.ndarray:
    return film.collisions_per_particle.values


def _homogeneous_gas(film: xr.Dataset) -> tuple[np.ndarray, theory.Relaxation]:
    """Return collisions per particle, and the temperatures of a gas that stays homogeneous."""
    n, attributes = np.linspace(0, collisions_so_far(film)[-1], 1000), film.attrs
    return n, theory.relax(0.0, attributes["r"], attributes["beta"], n, 2, attributes["inertia"])


def energies(axes: Axes, film: xr.Dataset) -> None:
    n, (smooth, haff) = collisions_so_far(film), _homogeneous_gas(film)
    axes.plot(n, film.E_trans, color=TRANSLATION, label="translation")
    axes.plot(n[1:], film.E_rot[1:], color=ROTATION, linestyle="--", label="rotation")
    axes.plot(smooth, haff.T_tr, label="homogeneous", **DOTTED)
    axes.plot(smooth[1:], haff.T_rot[1:], **DOTTED)
    low = film.E_rot.values[1:].min()
    axes.set(yscale="log", ylim=(low / 4, 3), xlim=(0, n[-1]))
    axes.set(xlabel=PER_PARTICLE, ylabel=r"energies / initial $E_\mathrm{trans}$")
    axes.set_title("e   energies, and Haff's law", loc="left", fontsize=TITLE)
    axes.legend()


def share(axes: Axes, film: xr.Dataset) -> None:
    smooth, haff = _homogeneous_gas(film)
    axes.plot(collisions_so_far(film), film.R, color=ROTATION)
    axes.plot(smooth, haff.theta / (1 + haff.theta), label="homogeneous", **DOTTED)
    axes.set(
        ylabel=r"$R$", xlabel=PER_PARTICLE, xlim=(0, collisions_so_far(film)[-1]), ylim=(0, None)
    )
    axes.set_title("f   share of rotation", loc="left", fontsize=TITLE)
    axes.legend(loc="best")


def unevenness(axes: Axes, film: xr.Dataset) -> None:
    maps = [packing(film, frame) for frame in range(film.sizes["frame"])]
    contrast = [field.std() / field.mean() for field in maps]
    axes.plot(collisions_so_far(film), contrast, color=UNEVENNESS, label="this gas")
    axes.set(xlabel=PER_PARTICLE, ylabel=r"$\delta\phi/\phi$", ylim=(0, None))
    axes.set_title("g   uneven packing", loc="left", fontsize=TITLE)
    axes.legend()


def collisions_label(film: xr.Dataset, frame: int) -> str:
    return f"{collisions_so_far(film)[frame]:.0f} {PER_PARTICLE}"


def caption(film: xr.Dataset) -> str:
    attrs = film.attrs
    return (
        f"Cooling gas of $N = {attrs['particles']:,}$ rough disks, "
        rf"$r = {attrs['r']:g}$, $\beta = {attrs['beta']:g}$, packing {attrs['packing']:.2g}"
    )


def _disks_in_window(film: xr.Dataset, frame: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return x and y (a) and spin (in units of its root mean square) of the disks in the window."""
    ends = np.cumsum(film.disks.values)
    disks_of_frame = slice(ends[frame] - film.disks.values[frame], ends[frame])
    return (
        film.disk_x.values[disks_of_frame],
        film.disk_y.values[disks_of_frame],
        film.disk_spin.values[disks_of_frame],
    )
