"""How many pieces the facets of a part are cut into for its fields, before they are cut."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from geomdrap.errors import DrapeError

if TYPE_CHECKING:
    from geomdrap.surface import Surface

MOST_PIECES = 10_000_000  # some 5 GB, and a minute
SLIVER = np.log2(3.0)  # a facet much longer than wide falls into three each time that its long edges are halved


def require_few_pieces(surface: Surface, longest: float) -> None:
    """Raise DrapeError where edges of at most ``longest`` mm cut the part into more pieces than there is room for.

    One vertex that lies a kilometre away is enough: its facets alone are a million times as large as the rest.
    """
    edges = surface.points[surface.triangles] - surface.points[np.roll(surface.triangles, 1, axis=1)]
    lengths = np.linalg.norm(edges, axis=2)
    pieces = (lengths.max(axis=1) / longest) ** SLIVER + surface.areas / (0.5 * longest**2)
    if pieces.sum() > MOST_PIECES:
        worst = int(pieces.argmax())
        x, y, z = surface.points[surface.triangles[worst]].mean(axis=0)
        raise DrapeError(
            f"{surface.source} would be cut into about {pieces.sum():.2g} pieces of {longest:.4g} mm, too many: use "
            f"a larger pitch, or mend its largest facet, {lengths[worst].max():.4g} mm long, around "
            f"({x:.4g}, {y:.4g}, {z:.4g})"
        )
