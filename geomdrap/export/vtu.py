"""net.vtu and part.vtu: the net and the part with their fields, for ParaView and the like."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.export.whole import whole_file

if TYPE_CHECKING:
    from geomdrap.fields import Drape

_Fields = dict[str, np.ndarray]


def write_net(result: Drape, path: Path) -> None:
    """Write the net: a quad per valid cell, corners in the order (i, j), (i+1, j), (i+1, j+1), (i, j+1).

    Point data: u, v [mm], shear [deg]. Cell data: shear [deg], thickness and fibre_volume [factors, see
    ``write_part``], class (0 below half the limit angle, 1 up to the limit, 2 beyond).
    """
    net = result.net
    i, j = np.nonzero(net.cell_valid)
    corners = np.stack([_number(net, i + a, j + b) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))], axis=1)
    used, quads = np.unique(corners, return_inverse=True)
    row, column = np.unravel_index(used, net.status.shape)
    shear = net.cell_shear[i, j]
    fibre = 1.0 / np.cos(np.radians(shear))
    _write(
        path,
        net.points[row, column],
        ("quad", quads.reshape(-1, 4)),
        {"u": net.u[row], "v": net.v[column], "shear": net.shear[row, column]},
        {
            "shear": shear,
            "thickness": fibre,
            "fibre_volume": fibre,
            "class": shear_class(shear, result.limit_angle),
        },
    )


def write_part(result: Drape, path: Path) -> None:
    """Write the part's own triangles with the ply on them: NaN where they are bare.

    Cell data: shear [deg], thickness (factor on the flat fabric's, where the share of fibres stays), fibre_volume
    (factor on the flat fabric's fibre volume fraction, where the thickness stays; there is as much more fibre on the
    area in either case, so the two are the same number and never both apply), warp and weft (unit vectors), class,
    coverage (0 to 1), reason (the number of the `Status` why it is bare), source_face (the number of the
    face in the input file).
    """
    surface = result.net.surface
    _write(
        path,
        surface.points,
        ("triangle", surface.triangles),
        {},
        {
            "shear": result.face_shear,
            "thickness": result.face_thickness,
            "fibre_volume": result.face_fibre_volume,
            "warp": result.face_warp,
            "weft": result.face_weft,
            "class": shear_class(result.face_shear, result.limit_angle),
            "coverage": result.face_coverage,
            "reason": result.face_reason.astype(np.int32),
            "source_face": np.asarray(surface.source_face, dtype=np.int64),
        },
    )


def shear_class(shear: np.ndarray, limit: float) -> np.ndarray:
    """Sort shear [deg] (k,) into 0 below half the limit, 1 up to the limit, 2 beyond, −1 where it is NaN."""
    size = np.abs(shear)
    classes = np.where(size > limit, 2, np.where(size >= limit / 2, 1, 0))
    return np.where(np.isnan(size), -1, classes).astype(np.int32)


def _number(net: object, i: np.ndarray, j: np.ndarray) -> np.ndarray:
    return i * net.status.shape[1] + j  # type: ignore[attr-defined]


def _write(
    path: Path, points: np.ndarray, cells: tuple[str, np.ndarray], at_points: _Fields, at_cells: _Fields
) -> None:
    import meshio

    mesh = meshio.Mesh(
        np.asarray(points),
        [(cells[0], cells[1].astype(np.int64))],
        point_data=at_points,
        cell_data={name: [np.ascontiguousarray(values)] for name, values in at_cells.items()},
    )
    with whole_file(path) as temporary:
        # zlib would take ten times as long as the rest to save half of the bytes
        mesh.write(temporary, file_format="vtu", compression=None)
