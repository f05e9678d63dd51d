"""The sample parts by name: what each is, where its dimensions come from, and how to write it as STL."""

from __future__ import annotations

import os
import secrets
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from geomdrap.errors import SurfaceError
from geomdrap.surface import shapes
from geomdrap.surface.surface import Surface

MOSTFACETS = 5_000_000
FACET = np.dtype(
    [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")]
)  # 50 bytes in an STL


@dataclass(frozen=True)
class Sample:
    """A part that ``geomdrap sample NAME`` writes.

    part: what it is; dimensions: the main ones; source: where they come from; edge: length of the
    facets' edges as shipped [mm]; make: builds the part for a length of edge.
    """

    name: str
    part: str
    dimensions: str
    source: str
    edge: float
    make: Callable[[float], Surface]


_OURS = "our own choice"
_ALL = (
    Sample(
        "hemisphere",
        "hemisphere on a flat round flange, with a fillet between",
        "sphere radius 75 mm, fillet 10 mm, flange to radius 145 mm",
        "the size of a usual forming test; " + _OURS,
        4.3,
        lambda edge: shapes.hemisphere_on_flange(75.0, 10.0, 60.0, edge),
    ),
    Sample(
        "double-dome",
        "two domes joined by a ridge with a waist, on a flat flange",
        "flange 470 × 270 mm, domes of radius 75 mm, 140 mm apart, 67 mm high, fillet 15 mm",
        "in the manner of the double dome of the woven-fabric forming benchmark: the flange has the size of"
        " the blank used there, radii and heights are approximate, not from its drawing",
        5.5,
        lambda edge: shapes.double_dome(edge=edge),
    ),
    Sample(
        "hood",
        "car-hood-like panel: crowned, two character lines, a power bulge, edges turned down",
        "950 mm long, 900 to 1300 mm wide before the edge bends (radius 45 mm, 80°)",
        "in place of example 3.5 of the paper, which gives no dimensions; " + _OURS,
        16.5,
        lambda edge: shapes.car_hood(edge=edge),
    ),
    Sample(
        "bracket",
        "CAD-like bracket: curved and straight wall, fillets, lip, raised pad, round hole, slot",
        "316 × 259 × 96 mm, fillets 18 mm, hole diameter 44 mm, slot 60 × 20 mm",
        "in place of example 3.4 of the paper, whose surface is not published; " + _OURS,
        5.0,
        lambda edge: shapes.bracket(edge=edge),
    ),
    Sample(
        "cone",
        "cone with a sharp apex; developable elsewhere",
        "slope 0.5, base radius 150 mm, height 75 mm",
        "z = −0.5 r: 38.0° of shear behind the apex; " + _OURS,
        6.0,
        lambda edge: shapes.cone(0.5, 150.0, edge),
    ),
    Sample(
        "cylinder",
        "half cylinder; developable, no shear at any heading",
        "radius 100 mm, length 300 mm",
        _OURS,
        6.0,
        lambda edge: shapes.cylinder(100.0, 300.0, edge, angle=180.0),
    ),
    Sample(
        "saddle",
        "hyperbolic paraboloid, negatively curved",
        "300 × 300 mm in plan, principal radii ±300 mm in the middle",
        "z = (x² − y²)/600; " + _OURS,
        6.0,
        lambda edge: shapes.saddle(300.0, 300.0, edge),
    ),
    Sample(
        "l-shape",
        "L in plan on a crowned panel: the front must turn the re-entrant corner",
        "400 × 400 mm, arms 160 mm, radius of curvature 800 mm",
        "z = −(x² + y²)/1600; " + _OURS,
        7.0,
        lambda edge: shapes.l_shape(400.0, 160.0, 800.0, edge),
    ),
)
_BY_NAME = {sample.name: sample for sample in _ALL}


def names() -> list[str]:
    """Return the names of all samples."""
    return list(_BY_NAME)


def find(name: str) -> Sample:
    """Return the sample of this name. Raises SurfaceError, with the names there are, if there is none."""
    if name not in _BY_NAME:
        raise SurfaceError(f"there is no sample '{name}'; the samples are {', '.join(_BY_NAME)}")
    return _BY_NAME[name]


def describe(name: str) -> str:
    """Return one line on a sample: what it is and its dimensions."""
    sample = find(name)
    return f"{sample.part}; {sample.dimensions}"


def build(name: str, facets: int | None = None, *, edge: float | None = None) -> Surface:
    """Return a sample as a Surface.

    edge: length of the facets' edges, mm; or facets: how many facets, met within 5 %. Without either, the
    mesh that is shipped in ``samples/parts``. Raises SurfaceError for an unknown name, both given, or
    a size that makes no sense.
    """
    sample = find(name)
    if facets is None:
        return _named(sample, sample.edge if edge is None else edge)
    if edge is not None:
        raise SurfaceError("give either facets or edge, not both")
    if not 200 <= facets <= MOSTFACETS:
        raise SurfaceError(f"facets must be from 200 to {MOSTFACETS:,}, not {facets:,}")
    return _with_facets(sample, facets)


def _with_facets(sample: Sample, facets: int) -> Surface:
    """Correct the edge until the number of facets, which goes with 1/edge², is met."""
    surface = _named(sample, sample.edge)
    edge = sample.edge
    for _ in range(6):
        miss = len(surface.triangles) / facets
        if abs(miss - 1.0) <= 0.04:
            break
        edge *= float(np.sqrt(miss))
        surface = _named(sample, edge)
    return surface


def _named(sample: Sample, edge: float) -> Surface:
    surface = sample.make(edge)
    return Surface(surface.points, surface.triangles, source=sample.name)


def write(name: str, folder: str | os.PathLike[str], facets: int | None = None) -> list[Path]:
    """Write a sample as binary STL, ``<name>.stl``, and return the paths of the files.

    folder must exist. The bytes depend on the name and the number of facets only. The file is whole or
    not there. Raises SurfaceError if it cannot be written.
    """
    surface = build(name, facets)
    path = Path(folder) / f"{name}.stl"
    temporary = path.with_name(f".{path.stem}-{secrets.token_hex(4)}.stl")
    try:
        temporary.write_bytes(stl_bytes(surface))
        os.replace(temporary, path)
    except OSError as error:
        raise SurfaceError(f"cannot write {path}: {error.strerror or error}") from error
    finally:
        temporary.unlink(missing_ok=True)
    return [path]


def stl_bytes(surface: Surface) -> bytes:
    """Return a surface as binary STL (single precision, the file's own unit: mm)."""
    rows = np.zeros(len(surface.triangles), FACET)
    rows["normal"] = surface.normals
    rows["corners"] = surface.points[surface.triangles]
    header = f"geomdrap sample {surface.source} (mm)".encode("ascii", "replace")[:80].ljust(80)
    return header + np.uint32(len(rows)).tobytes() + rows.tobytes()
