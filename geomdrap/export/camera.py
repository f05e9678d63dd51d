"""Orthographic cameras, and the choice of the two directions that show most of a drape."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from collections.abc import Callable

    from geomdrap.surface.surface import Surface

Floats = NDArray[np.float64]

SAMPLES = 2500
"""Points of the part on which directions are judged."""

AXES = ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))


@dataclass(frozen=True)
class Camera:
    """An orthographic view: `toward` points from the part to the viewer; all (3,) unit vectors."""

    toward: Floats
    right: Floats
    up: Floats

    @classmethod
    def looking_from(cls, direction: tuple[float, float, float] | Floats) -> Camera:
        """Camera on that side of the part, +z upright (+y where the view is along z)."""
        toward = np.asarray(direction, dtype=float)
        toward = toward / np.linalg.norm(toward)
        upright = np.array([0.0, 0.0, 1.0]) if abs(toward[2]) < 0.99 else np.array([0.0, 1.0, 0.0])
        right = np.cross(upright, toward)
        right /= np.linalg.norm(right)
        return cls(toward=toward, right=right, up=np.cross(toward, right))

    def project(self, points: Floats) -> Floats:
        """(…, 3) mm on the picture: to the right, up, and towards the viewer."""
        axes = np.stack([self.right, self.up, self.toward], axis=1)
        return np.asarray(np.einsum("...i,ij->...j", points, axes))  # threads of BLAS cost more than they bring here

    @property
    def name(self) -> str:
        """The direction in words: 'from above (+z)', 'from +x −y +z'."""
        signs = [
            f"{'+' if t > 0 else '−'}{axis}"
            for t, axis in zip(self.toward, "xyz", strict=True)
            if abs(t) > 0.15
        ]
        words = {"+z": "from above (+z)", "−z": "from below (−z)"}
        return words.get(" ".join(signs), "from " + " ".join(signs))


@dataclass(frozen=True)
class Viewport:
    """Where a camera's millimetres fall in an image of columns × rows pixels."""

    camera: Camera
    left: float
    top: float
    scale: float
    columns: int
    rows: int

    @classmethod
    def around(
        cls, camera: Camera, points: Floats, columns: int, rows: int, margin: float = 0.03
    ) -> Viewport:
        """The points (n, 3) centred, as large as the image allows, `margin` of its size left free."""
        lower, upper = extent(camera, points)
        size = np.maximum(upper - lower, 1e-9 * max(float(np.max(upper - lower)), 1e-300))
        scale = float(min(columns / size[0], rows / size[1]) * (1.0 - 2.0 * margin))
        middle = 0.5 * (lower + upper)
        return cls(
            camera,
            float(middle[0] - 0.5 * columns / scale),
            float(middle[1] + 0.5 * rows / scale),
            scale,
            columns,
            rows,
        )

    def pixels(self, points: Floats) -> Floats:
        """(…, 3): x and y in pixels from the upper left corner, depth in mm towards the viewer."""
        seen = self.camera.project(points)
        seen[..., 0] = (seen[..., 0] - self.left) * self.scale
        seen[..., 1] = (self.top - seen[..., 1]) * self.scale
        return seen


def extent(camera: Camera, points: Floats) -> tuple[Floats, Floats]:
    """Lower left and upper right corner (2,) of the points (n, 3) on the camera's picture, mm."""
    x, y = points @ camera.right, points @ camera.up
    return np.array([x.min(), y.min()]), np.array([x.max(), y.max()])


def oblique_directions() -> list[Floats]:
    """Directions such as draughtsmen like them, best liked first."""
    directions = []
    for elevation in (35.0, -35.0):
        for azimuth in (-60.0, -30.0, 30.0, 60.0, 120.0, 150.0, -120.0, -150.0):
            e, a = np.radians(elevation), np.radians(azimuth)
            directions.append(np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)]))
    return directions


def two_views(
    surface: Surface,
    importance: Floats,
    origin: Floats,
    normal: Floats,
    progress: Callable[[float], None] = lambda _: None,
) -> tuple[Camera, Camera]:
    """The most informative oblique view of a part, and the view that adds most to it.

    importance (m,) is what it is worth to see a face squarely, per mm²; origin (3,) mm and normal (3,) there.
    Judged on samples of the part with the part's own occlusion; a face seen from its back counts less. ``progress``
    is called with the share done, 0 to 1.
    """
    faces = sample_faces(surface.areas)
    worth = importance[faces]
    triangles = surface.triangles[faces]
    points = np.vstack([surface.points[triangles].mean(axis=1), origin[None]])
    worth = np.append(worth, 0.08 * worth.sum())  # the first view should show the origin
    normals = np.vstack([surface.normals[faces], normal[None]])
    oblique = [Camera.looking_from(direction) for direction in oblique_directions()]
    cameras = oblique + [Camera.looking_from(direction) for direction in AXES]
    seen = []
    for n, camera in enumerate(cameras, start=1):
        seen.append(squareness(surface, camera, points, normals))
        progress(n / len(cameras))
    preference = 1.0 - 0.002 * np.arange(len(oblique))
    first = int(np.argmax([worth @ s * p for s, p in zip(seen, preference, strict=False)]))
    gains = [worth @ np.maximum(s - seen[first], 0.0) for s in seen]
    return cameras[first], cameras[int(np.argmax(gains))]


def sample_faces(areas: Floats) -> NDArray[np.int64]:
    """Numbers of faces (k,), evenly spread over the area (m,): the same for the same part."""
    cumulative = np.cumsum(areas)
    count = min(SAMPLES, 4 * len(areas))
    targets = (np.arange(count) + 0.5) / count * cumulative[-1]
    return np.minimum(np.searchsorted(cumulative, targets), len(areas) - 1).astype(np.int64)


def squareness(surface: Surface, camera: Camera, points: Floats, normals: Floats, size: int = 240) -> Floats:
    """(k,) 0 hidden … 1 seen squarely from the front, for points (k, 3) on the part with normals (k, 3)."""
    from geomdrap.export.raster import fill_triangles, visible_points

    corner = camera.project(surface.bounds.mean(axis=0))[:2] + 0.5 * surface.diagonal * np.array([-1.0, 1.0])
    view = Viewport(camera, float(corner[0]), float(corner[1]), size / surface.diagonal, size, size)
    depth = np.full((size, size), -np.inf, dtype=np.float32)
    unused = np.zeros((2, size, size), dtype=np.float32)
    nothing = np.zeros((len(surface.triangles), 3), dtype=np.float32)
    fill_triangles(
        view.pixels(surface.points), surface.triangles, nothing, nothing, depth, unused[0], unused[1]
    )
    visible = visible_points(view.pixels(points), depth, 1e-3 * surface.diagonal)
    facing = normals @ camera.toward
    return np.where(visible, np.where(facing > 0.0, facing, -0.6 * facing), 0.0)
