"""A ply that spans hollows which are too tight for it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from geomdrap.effects.derived import derived
from geomdrap.effects.rolling_ball import closed_points
from geomdrap.errors import EffectError
from geomdrap.fishnet import Effect, Parameter

if TYPE_CHECKING:
    from geomdrap.surface import Surface

FINE = 0.5  # of the radius: facets in hollows must not be longer, or they are split
SHALLOW = 0.01  # of the radius: hollows that are filled by less, as by rounded coordinates, are left as they are
MOST_FACETS = 400_000


class Bridging(Effect):
    """The net is draped on the tool closed by a ball."""

    name = "bridging"
    summary = "The ply spans concave radii that are tighter than it can follow."
    equation = "tool → closing of the tool by a ball of the radius, on the side of the normal"
    physics = (
        "A stiff ply, or one under tension, does not go into a tight hollow: it touches both walls and spans the "
        "corner. The surface on which it lies is what a rolling ball of the bridging radius leaves of the tool. "
        "Convex stretches, and concave ones of a larger radius, stay as they are."
    )
    source = "closing by a ball, J. Serra, Image Analysis and Mathematical Morphology (1982)"
    stage = "surface"
    seen_by = "positions: a gap to the tool in hollows; shear beyond them, weakly"
    confounded_with = ("thickness",)
    rank = 10.0
    parameters = (Parameter("radius", "mm", 0.0, 1000.0, 10.0, 0.0, "least concave radius that the ply follows"),)

    def on_surface(self, surface: Surface) -> Surface:
        """The tool, closed by a ball."""
        radius = self.values["radius"]
        return derived(surface, self.name, radius, lambda: closed_surface(surface, radius))


def closed_surface(surface: Surface, radius: float) -> Surface:
    """The part closed by a ball of ``radius`` mm, its large facets split in hollows; itself if it has none."""
    closed = closed_points(surface, radius)
    if _longest_lifted(surface, closed, SHALLOW * radius) > FINE * radius:
        surface = _split(surface, FINE * radius)
        closed = closed_points(surface, radius)
    return surface.moved(closed) if (closed != surface.points).any() else surface


def _longest_lifted(surface: Surface, closed: np.ndarray, least: float) -> float:
    """Longest edge, mm, of the facets of which a vertex moves by ``least`` mm; 0 where none does."""
    moves = (np.linalg.norm(closed - surface.points, axis=1) > least)[surface.triangles].any(axis=1)
    corners = surface.points[surface.triangles[moves]]
    lengths = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    return float(lengths.max(initial=0.0))


def _split(surface: Surface, longest: float) -> Surface:
    """The same part with no edge longer than ``longest`` mm. Raises EffectError where it would have too many."""
    from geomdrap.fields.refine import refine
    from geomdrap.surface import Surface

    if surface.cuts:
        raise EffectError(
            f"effect bridging: the facets of {surface.source} are too large for a radius of {2 * longest:g} mm, and "
            "splitting them would close its cuts; use a finer mesh in the hollows, or a larger radius"
        )
    many = len(surface.triangles) + 2.0 * surface.area / (0.25 * longest**2)
    if many > MOST_FACETS:
        raise EffectError(
            f"effect bridging: the facets of {surface.source} are too large for a radius of {2 * longest:g} mm, and "
            "splitting them would take too many; use a finer mesh in the hollows, or a larger radius"
        )
    fine = refine(surface.points, surface.triangles, surface.neighbours, surface.neighbour_edge, longest)
    numbers = surface.source_face[fine.parent]
    split = Surface(fine.points, fine.triangles, source=surface.source, face_numbers=numbers, notes=surface.notes)
    return split.numbered_by(surface.vertex_of_input)
