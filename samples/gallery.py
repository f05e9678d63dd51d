"""The paper's examples 3.4 and 3.5: a CAD part and a car hood, each draped at 0/90 and at ±45.

Usage: python samples/gallery.py FOLDER
Writes a figure per part in the manner of figures 17 and 18 (above, the draped part; below, its flat pattern;
colour: shear) and prints shear, fabric and coverage side by side.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

import geomdrap as gd

PARTS = {"bracket": (38.0, -62.0), "hood": (42.0, 150.0)}  # elevation and azimuth of the view
PITCH = {"bracket": 5.0, "hood": 10.0}
ANGLES = {0.0: "0/90", 45.0: "±45"}


def compute(name, pitch=None):
    """Drape a part from its centroid at both angles: angle -> drape."""
    part = gd.read_surface(Path(__file__).parent / "parts" / f"{name}.stl")
    pitch = PITCH[name] if pitch is None else pitch
    return {angle: gd.evaluate(gd.drape(part, "centroid", angle, pitch)) for angle in ANGLES}


def blank(drape):
    """Area of the smallest rectangle along the yarns that holds the flat pattern, mm²."""
    outline = np.concatenate(drape.flat.outer)
    return float(np.prod(np.ptp(outline, axis=0)))


def table(results):
    """The results of several parts, a line per drape."""
    names = ["part", "angle", "max", "p95", "part", "fabric", "blank", "coverage"]
    rows = [names, ["", "", "deg", "deg", "cm²", "cm²", "cm²", "%"]]
    for name, drapes in results.items():
        for angle, drape in drapes.items():
            shear, area = drape.statistics, drape.area
            sizes = [f"{mm2 / 100.0:.0f}" for mm2 in (area.part, area.fabric, blank(drape))]
            degrees = [f"{shear.max:.1f}", f"{shear.p95:.1f}"]
            rows.append([name, ANGLES[angle], *degrees, *sizes, f"{100.0 * area.coverage:.1f}"])
    return "\n".join("{:8} {:5} {:>6} {:>6} {:>7} {:>7} {:>7} {:>9}".format(*row) for row in rows)


def visualize(name, drapes, path):
    """Figure of 2 x 2: the draped part above its flat pattern, 0/90 left and ±45 right."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize
    from matplotlib.figure import Figure

    figure = Figure(figsize=(13.0, 10.0), dpi=110, layout="constrained")
    top = max(drape.statistics.max for drape in drapes.values())
    colours = ScalarMappable(Normalize(0.0, max(top, 1.0)), "YlGnBu")
    for column, (angle, drape) in enumerate(drapes.items()):
        above = figure.add_subplot(2, 2, column + 1, projection="3d")
        draw_part(above, drape, colours, PARTS[name])
        above.set_title(f"{name} at {ANGLES[angle]}: max. shear {drape.statistics.max:.1f}°")
        below = figure.add_subplot(2, 2, column + 3)
        draw_pattern(below, drape, colours)
        below.set_title(f"flat pattern: {drape.area.fabric / 100.0:.0f} cm² of fabric")
    figure.colorbar(colours, ax=figure.axes, label="shear angle [deg]", shrink=0.6)
    figure.savefig(path)


def draw_part(axes, drape, colours, view):
    """The facets of the part coloured by the shear on them (grey where bare), and the cells of the net over them."""
    net, part = drape.net, drape.net.surface
    axes.view_init(*view)
    up, round_z = np.radians(view)
    toward = np.array([np.cos(up) * np.cos(round_z), np.cos(up) * np.sin(round_z), np.sin(up)])
    p = net.points + 1.5 * net.pitch * toward  # so that a cell is drawn after the facets under it
    cells = np.stack([p[:-1, :-1], p[1:, :-1], p[1:, 1:], p[:-1, 1:]], axis=2)[net.cell_valid]
    # With as many corners as a cell: matplotlib pads shorter polygons with what the memory holds, and scales by it.
    facets = part.points[part.triangles[:, [0, 1, 2, 2]]]
    shades = colours.to_rgba(np.abs(drape.face_shear))
    shades[np.isnan(drape.face_shear)] = 0.8, 0.8, 0.8, 1.0
    axes.add_collection3d(
        Poly3DCollection(
            np.concatenate([facets, cells]),
            facecolors=np.vstack([shades, np.zeros((len(cells), 4))]),
            edgecolors=np.vstack([shades, np.tile([0.0, 0.0, 0.0, 0.35], (len(cells), 1))]),
            linewidths=0.3,
            clip_on=False,
        )
    )
    low, high = part.bounds
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    axes.set_box_aspect(high - low, zoom=1.3)
    axes.set_axis_off()


def draw_pattern(axes, drape, colours):
    """The flat pattern coloured by the shear of its cells, out to its contour."""
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path as Outline
    from scipy.ndimage import distance_transform_edt

    net, loops = drape.net, (*drape.flat.outer, *drape.flat.inner)
    shear = np.pad(np.abs(net.cell_shear), 3, constant_values=np.nan)
    nearest = distance_transform_edt(np.isnan(shear), return_distances=False, return_indices=True)
    u, v = (x[0] + net.pitch * np.arange(-3, len(x) + 3) for x in (net.u, net.v))
    cells = axes.pcolormesh(u, v, shear[tuple(nearest)].T, cmap=colours.cmap, norm=colours.norm)
    outline = Outline.make_compound_path(*(Outline(np.vstack([k, k[:1]]), closed=True) for k in loops))
    cells.set_clip_path(axes.add_patch(PathPatch(outline, facecolor="none", edgecolor="k", linewidth=1.0)))
    axes.plot(0.0, 0.0, "k+")
    low, high = (side(np.concatenate(drape.flat.outer), axis=0) for side in (np.min, np.max))
    axes.set(aspect="equal", xlabel="u, along the warp [mm]", ylabel="v, along the weft [mm]")
    axes.set(xlim=(low[0] - 3 * net.pitch, high[0] + 3 * net.pitch))
    axes.set(ylim=(low[1] - 3 * net.pitch, high[1] + 3 * net.pitch))


def main(folder):
    """Drape all parts, print the table, save the figures in ``folder``."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    results = {name: compute(name) for name in PARTS}
    print(table(results))
    for name, drapes in results.items():
        visualize(name, drapes, folder / f"{name}.png")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python samples/gallery.py FOLDER")
    main(sys.argv[1])
