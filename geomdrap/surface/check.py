"""Is a mesh fit to be draped: what was found in it, what was repaired, what stands in the way."""

from __future__ import annotations

from typing import Any

from geomdrap.errors import SurfaceError
from geomdrap.surface.findings import count
from geomdrap.surface.surface import Surface


def report(surface: Surface) -> dict[str, Any]:
    """Size, verdict and findings as plain numbers and strings (JSON); lengths in mm, areas in mm²."""
    problem = _problem(surface)
    return {
        "schema": "geomdrap.check/1",
        "part": surface.source,
        "drapable": problem is None,
        "problem": problem,
        "faces": len(surface.triangles),
        "vertices": len(surface.points),
        "area": surface.area,
        "bounds": surface.bounds.tolist(),
        "diagonal": surface.diagonal,
        "mean_edge": surface.mean_edge,
        "closed": surface.closed,
        "messages": list(surface.findings.lines()),
        "findings": surface.findings.as_dict(),
    }


def text(surface: Surface) -> str:
    """Write the same for a reader: a line for the part, one for each finding, and the verdict."""
    size = surface.bounds[1] - surface.bounds[0]
    shape = "closed" if surface.closed else "open"
    lines = [
        f"{surface.source}: {count(len(surface.triangles), 'face')}, {shape}, "
        f"{size[0]:.6g} × {size[1]:.6g} × {size[2]:.6g} mm, "
        f"area {surface.area:.6g} mm², mean edge {surface.mean_edge:.4g} mm"
    ]
    lines += [f"- {line}" for line in surface.findings.lines()]
    problem = _problem(surface)
    lines.append("fit to be draped" if problem is None else f"not fit to be draped: {problem}")
    return "\n".join(lines)


def _problem(surface: Surface) -> str | None:
    try:
        surface.require_drapable()
    except SurfaceError as error:
        return str(error)
    return None
