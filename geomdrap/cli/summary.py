"""The readable summary of a drape."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from geomdrap.fields import Drape
    from geomdrap.fields.strips import Roll

_MOST_BARE = 8  # regions listed one by one


def summary(result: Drape, files: Mapping[str, Path]) -> str:
    """Give the summary as text: a labelled line per fact, in mm, mm² and degrees."""
    return "\n".join(f"{label:<11}{text}".rstrip() for label, text in _lines(result, files))


def _lines(result: Drape, files: Mapping[str, Path]) -> Iterator[tuple[str, str]]:
    net, area, shear = result.net, result.area, result.statistics
    size = " x ".join(f"{length:.4g}" for length in net.surface.bounds[1] - net.surface.bounds[0])
    nodes = int((net.points[..., 0] == net.points[..., 0]).sum())
    yield "part", f"{net.surface.source}, {len(net.surface.triangles):,} facets, {size} mm"
    side = f"normal {_point(net.normal0)}"
    yield "seed", f"{_point(net.origin)}, warp at {net.angle:g}°, {side}"
    yield "net", f"pitch {net.pitch:g} mm, {nodes:,} nodes, {int(net.cell_valid.sum()):,} cells"
    yield "shear", f"max {shear.max:.2f}°, 95 % below {shear.p95:.2f}°, mean {shear.mean:.2f}°"
    yield (
        "",
        f"{_percent(shear.over_half_limit)} over {result.limit_angle / 2:g}°, "
        f"{_percent(shear.over_limit)} over the limit angle {result.limit_angle:g}°",
    )
    yield "area", f"part {_area(area.part)}, draped {_area(area.draped)}, fabric {_area(area.fabric)}"
    yield "coverage", _percent(area.coverage)
    if result.roll is not None:
        yield from _roll(result.roll)
    yield from _bare(result)
    yield "checks", ", ".join(_checks(result))
    if files:
        yield "files", f"{next(iter(files.values())).parent}: {', '.join(f.name for f in files.values())}"


def _roll(roll: Roll) -> Iterator[tuple[str, str]]:
    """What of the roll is used, and a line per seam."""
    many = "one strip, no seam" if len(roll.strips) == 1 else f"{len(roll.strips)} strips"
    if not roll.strips:
        many = "no fabric to lay"
    yield "roll", f"{roll.width:g} mm wide: {many}, {roll.length:.1f} mm used, {_percent(roll.waste)} of it wasted"
    for number, strip in enumerate(roll.strips, start=1):
        if strip.pieces > 1:
            yield "", f"strip {number} is of {strip.pieces} loose pieces; the gaps between them count as used"
    for seam in roll.seams:
        yield "", f"seam at v = {seam.v:.1f} mm, {seam.length:.1f} mm long, crosses shear up to {seam.max_shear:.2f}°"


def _checks(result: Drape) -> Iterator[str]:
    """Name the checks that could be made on this part."""
    checks = result.checks
    yield f"sides too long by {checks.edge_error:.1g} of the pitch"
    yield f"nodes off the surface by {checks.off_surface:.1g} mm"
    if checks.curvature_residual is not None:
        yield f"shear off the curvature by {checks.curvature_residual:.2g}°"


def _bare(result: Drape) -> Iterator[tuple[str, str]]:
    regions = sorted(result.bare, key=lambda region: -region.area)
    for number, region in enumerate(regions[:_MOST_BARE]):
        label = "bare" if number == 0 else ""
        yield label, f"{_area(region.area)} at {_point(region.center)}: {region.reason}"
    rest = regions[_MOST_BARE:]
    if rest:
        yield "", f"{_area(sum(region.area for region in rest))} in {len(rest)} smaller regions"


def _point(point: Iterable[float]) -> str:
    return "(" + ", ".join(f"{round(float(x), 2) + 0.0:.2f}" for x in point) + ")"


def _area(square_mm: float) -> str:
    """Give an area in mm², as the files and pictures do, whatever its size."""
    return f"{square_mm:,.1f} mm²" if square_mm >= 10.0 else f"{square_mm:.4g} mm²"


def _percent(share: float) -> str:
    return f"{100 * share:.2f} %"
