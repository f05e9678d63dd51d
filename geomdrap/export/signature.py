"""signature-NAME.png: what an effect does to a net, against the geometric one."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from geomdrap.fishnet import Effect, Net

PITCH = 8.0
LONGEST = 2.5  # pitches: what the longest arrow is drawn as
HALF, HEIGHT, WIDTH = (
    120.0,
    60.0,
    45.0,
)  # mm: half a side of the sample, and of its bump the height and standard width
SEED, HEADING = (12.0, 6.0, 57.0), 15.0  # off the symmetry of the sample, on which several effects would not show

SHOWN = {  # where typical values would not show on the bump
    "bridging": {"radius": 120.0},
    "locking": {"angle": 20.0},
    "crossing-slip": {"share": 0.3, "onset": 15.0},
}


def shown_values(effect: Effect) -> dict[str, float]:
    """Values at which an effect shows on the sample: typical ones, mostly."""
    return {p.name: p.typical for p in effect.parameters} | SHOWN.get(effect.name, {})


def write_signature(effect: Effect, folder: Path) -> Path:
    """Draw how an effect moves the crossings of a net on a bump and changes their shear; the file."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    plain, changed = _nets(effect)
    u, v = np.meshgrid(plain.u, plain.v, indexing="ij")
    points, shear = changed.interpolate(u.ravel(), v.ravel())
    moved = points.reshape(plain.points.shape) - plain.points
    more = shear.reshape(plain.shear.shape) - plain.shear
    figure = Figure(figsize=(12.0, 5.2), layout="constrained")
    canvas = FigureCanvasAgg(figure)
    values = ", ".join(f"{k} = {x:g}" for k, x in effect.values.items())
    figure.suptitle(f"{effect.title()} ({values}): {effect.summary}", fontsize=11)
    left, right = figure.subplots(1, 2)
    _arrows(left, plain, moved)
    _change(figure, right, plain, more)
    file = folder / f"signature-{effect.title()}.png"
    canvas.print_png(str(file))
    return file


def _nets(effect: Effect) -> tuple[Net, Net]:
    """The sample draped without and with the effect."""
    from geomdrap.fishnet import drape
    from geomdrap.surface import shapes

    lines = np.linspace(-HALF, HALF, 81)
    part = shapes.grid_surface(lambda x, y: HEIGHT * np.exp(-0.5 * (x**2 + y**2) / WIDTH**2), lines, lines)
    plain, changed = (drape(part, SEED, HEADING, PITCH, effects=e, project=True) for e in ([], [effect]))
    return plain, changed


def _arrows(axes: Any, net: Net, moved: np.ndarray) -> None:
    """The net from above, with the way each crossing goes, and how far off the surface in colour."""
    x, y = net.points[..., 0], net.points[..., 1]
    for line in (*zip(x, y, strict=True), *zip(x.T, y.T, strict=True)):
        axes.plot(*line, color="0.8", linewidth=0.5, zorder=1)
    length = np.linalg.norm(moved, axis=2)
    most = float(np.nanmax(length, initial=0.0))
    scale = LONGEST * net.pitch / most if most > 1e-6 else 1.0
    axes.quiver(
        x, y, scale * moved[..., 0], scale * moved[..., 1], length, cmap="viridis", angles="xy", scale_units="xy",
        scale=1.0, width=0.0022, zorder=2,
    )  # fmt: skip
    words = f"crossings move by up to {most:.3g} mm (arrows × {scale:.3g})"
    axes.set_title(words if most > 1e-6 else "no crossing moves")
    axes.set_xlabel("x [mm]")
    axes.set_ylabel("y [mm]")
    axes.set_aspect("equal")


def _change(figure: Any, axes: Any, net: Net, more: np.ndarray) -> None:
    """The change of shear at the crossings in the flat fabric."""
    most = max(float(np.nanpercentile(np.abs(more), 99)), 0.05) if np.isfinite(more).any() else 1.0
    shown = axes.pcolormesh(net.u, net.v, more.T, cmap="RdBu_r", vmin=-most, vmax=most, shading="nearest")
    figure.colorbar(shown, ax=axes, label="change of shear [degrees]")
    axes.plot(0.0, 0.0, "k+")
    axes.set_title("change of shear in the flat fabric")
    axes.set_xlabel("u along warp [mm]")
    axes.set_ylabel("v along weft [mm]")
    axes.set_aspect("equal")
