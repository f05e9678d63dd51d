"""report.html: one file to open in a browser, offline: the ply on the part and flat to look into, and its numbers.

The page is a template in the folder ``report_page``, with style and scripts from the files beside it. The mesh is
quantised to 16 bits (``report_mesh``) and written in base 64; yarns are drawn where its fabric coordinates say.
"""

from __future__ import annotations

import base64
import json
from importlib import resources
from pathlib import Path
from string import Template
from typing import TYPE_CHECKING, Any

import numpy as np

from geomdrap import __version__
from geomdrap.export import palette
from geomdrap.export.flat_map import seams_of
from geomdrap.export.ply_corners import Box
from geomdrap.export.report_json import plain
from geomdrap.export.report_mesh import ReportMesh, report_mesh
from geomdrap.export.report_parts import cards, escaped, header, legend, notices, pattern_size, tiles
from geomdrap.export.whole import write_whole

if TYPE_CHECKING:
    from collections.abc import Sequence

    from geomdrap.fields import Drape

SCRIPTS = ("model", "camera", "pick", "shader", "painter", "overlay", "view", "input", "viewer", "start")
"""Files of ``report_page`` in the order in which they are joined."""
ARRAYS = ("position", "at", "normal", "shear", "triangles", "edges")
OBLIQUE = (0.4, -0.8, 0.5)
"""The first view: from the side of the normal at the seed, leant towards +x, -y and +z."""
PLACES = 3
"""Decimals of contours, mm."""


def write(result: Drape, path: Path, command: str = "") -> None:
    """Write the report of a drape; ``command`` is the one that made it, if any. Raises GeomdrapError if it cannot."""
    write_whole(path, page(result, command))


def page(result: Drape, command: str = "") -> str:
    """The report as one HTML document that loads nothing; the same text for the same drape and command."""
    mesh = report_mesh(result)
    arrays, blob = packed(result, mesh)
    about = {**description(result, mesh), "arrays": arrays}
    return Template(asset("page.html")).substitute(
        version=__version__,
        title=escaped(f"{Path(result.net.surface.source).name}: drape"),
        style=asset("style.css"),
        header=header(result),
        notices=notices(result),
        tiles=tiles(result),
        flat_size=pattern_size(result),
        legend=legend(result),
        cards=cards(result, command),
        about=json.dumps(plain(about), ensure_ascii=False, allow_nan=False).replace("<", "\\u003c"),
        mesh=base64.b64encode(blob).decode("ascii"),
        script="".join(asset(f"{name}.js") for name in SCRIPTS),
    )


def asset(name: str) -> str:
    """The text of a file of the page."""
    return (resources.files("geomdrap.export") / "report_page" / name).read_text(encoding="utf-8")


def packed(result: Drape, mesh: ReportMesh) -> tuple[list[Any], bytes]:
    """All arrays in one block of bytes, little-endian, and [name, type, offset, length] of each."""
    named = {name: getattr(mesh, name) for name in ARRAYS}
    tables = (palette.continuous_table(), palette.diverging_table())
    for name, table in zip(("table", "signedTable"), tables, strict=True):
        named[name] = np.rint(255 * table).astype(np.uint8)
    entries, blocks, offset = [], [], 0
    for name, array in named.items():
        data = np.ascontiguousarray(array, dtype=array.dtype.newbyteorder("<")).tobytes()
        entries.append([name, array.dtype.name, offset, array.size])
        blocks.append(data + bytes(-len(data) % 4))
        offset += len(blocks[-1])
    return entries, b"".join(blocks)


def description(result: Drape, mesh: ReportMesh) -> dict[str, Any]:
    """What the scripts need to know beside the arrays: names as they use them."""
    from geomdrap.fishnet import Status

    net = result.net
    seams = [seam.v for seam in seams_of(result)]
    return {
        **({"seams": seams} if seams else {}),
        "space": box(mesh.space),
        "fabric": box(mesh.fabric),
        "pitch": net.pitch,
        "reach": net.reach,
        "limit": result.limit_angle,
        "top": palette.top_of_scale(result.statistics.max, result.limit_angle),
        "origin": net.origin,
        "warp": net.warp0,
        "weft": net.weft0,
        "normal": net.normal0,
        "toward": first_view(net.normal0),
        "contour": contour_path((*result.flat.outer, *result.flat.inner)),
        "reasons": {str(int(code)): code.reason for code in Status},
        "beyond": Status.BLANK.reason,
        "bare": [{"center": r.center, "normal": normal_near(result, r.center)} for r in result.bare],
    }


def box(of: Box) -> dict[str, Any]:
    """Lower corner and size of a box."""
    return {"lower": of.lower, "size": of.size}


def first_view(normal: np.ndarray) -> np.ndarray:
    """Direction (3,) from which the part is first seen: on the side of the ply, from the front and above."""
    toward = normal + np.asarray(OBLIQUE) * np.where(np.abs(normal) > 0.9, 0.0, 1.0)
    return np.asarray(toward / np.linalg.norm(toward))


def normal_near(result: Drape, point: np.ndarray) -> np.ndarray:
    """Normal (3,) of the part at its point nearest to a place."""
    surface = result.net.surface
    return np.asarray(surface.normals[surface.nearest(point[None]).face[0]])


def contour_path(polygons: Sequence[np.ndarray]) -> str:
    """Closed polygons (k, 2) mm as the data of one SVG path."""
    rounded = [np.round(polygon, PLACES) + 0.0 for polygon in polygons]
    return "".join("M" + "L".join(f"{x:.6g},{y:.6g}" for x, y in polygon.tolist()) + "Z" for polygon in rounded)
