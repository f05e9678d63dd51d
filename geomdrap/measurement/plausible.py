"""Mistakes of a whole table that make every number wrong: units, another frame, swapped or mirrored labels."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.errors import MeasurementError
from geomdrap.measurement.marks import mark_spacing
from geomdrap.measurement.plausible_frame import other_frame
from geomdrap.measurement.plausible_yarns import check_directions

if TYPE_CHECKING:
    from geomdrap.fishnet import Net
    from geomdrap.measurement.match import Matched
    from geomdrap.measurement.measurement import Measurement
    from geomdrap.surface import Surface

OFF = 0.1
"""Of the part's diagonal: when half of the points lie further off than this, they are in another frame or unit."""
FITS = 0.02
"""Of the diagonal: half of the points this near say that a change of unit explains it."""
SMALL, TINY = 0.12, 0.01
"""Of the part's diagonal: a measured area this small is a small area or another unit; this tiny, another unit."""
BETTER = 0.25
"""Other labels explain a measurement where they bring half of the points to this share of the distance."""

FACTORS = {"m": 1000.0, "in": 25.4, "cm": 10.0}

LOOKS_WRONG = "it looks as if"
"""Words of the warning of labels that are probably others than they say."""

OTHER_LABELS = (
    ("u and v are swapped", (0, 1, 1, 0)),
    ("u runs the other way (mirrored)", (-1, 0, 0, 1)),
    ("v runs the other way (mirrored)", (1, 0, 0, -1)),
    ("u and v both run the other way (turned by 180 degrees, or the heading is)", (-1, 0, 0, -1)),
    ("u and v are swapped and v runs the other way (turned by 90 degrees, or the heading is)", (0, 1, -1, 0)),
    ("u and v are swapped and u runs the other way (turned by 90 degrees, or the heading is)", (0, -1, 1, 0)),
    ("u and v are swapped and both run the other way", (0, -1, -1, 0)),
)
"""What else the labels may be: words, and the matrix that turns the labels read into the right ones."""


OTHER_UNITS = (
    ("u and v are in inches, and x, y, z are not", 25.4),
    ("u and v are in m, and x, y, z are not", 1000.0),
    ("x, y, z are in inches, and u and v are not", 1.0 / 25.4),
    ("x, y, z are in m, and u and v are not", 1e-3),
)
"""What else the unit of the labels may be: words, and the factor that turns those read into the right ones."""

ANTI, ALIKE = -0.5, 0.7
"""Correlations with the predicted shear: of angles with the other sign, and of such in another unit."""
UNSIGNED = 0.4
"""Share of the misfit that is left where shear of the other sign loses it: then it was measured without."""
FEWEST, CERTAIN = 10, 4.0
"""Angles from which on a correlation says something, and the standard deviations from chance that it is to be."""


def require_on_part(surface: Surface, measurement: Measurement) -> tuple[str, ...]:
    """Warnings about the unit of the measurement. Raises MeasurementError for points nowhere near the part."""
    points, size = measurement.points, surface.diagonal
    distance = float(np.median(surface.nearest(points).distance))
    extent = float(np.linalg.norm(np.ptp(points, axis=0)))
    unit = _other_unit(surface, points) if distance > OFF * size or extent < SMALL * size else None
    if unit is not None:
        sizes = f"the points span {extent:.4g} mm and the part {size:.4g} mm"
        if _labels_agree(measurement, 1.0) and (distance >= FITS * extent or extent < TINY * size):
            raise MeasurementError(
                f"{measurement.source}: {sizes}, while its labels and points agree: either all of it is in {unit} "
                f"(use --unit-measured {unit}), or {surface.source} is read in the wrong unit (check --unit)"
            )
        hint = f"{measurement.source}: {sizes}; in {unit} they would lie on the part: use --unit-measured {unit}"
        if distance > OFF * size or extent < TINY * size or _labels_agree(measurement, FACTORS[unit]):
            raise MeasurementError(hint)
        return (hint + " if so",)
    if distance > OFF * size:
        raise MeasurementError(
            f"{measurement.source}: half of the points lie {distance:.4g} mm or more off {surface.source}, which is "
            f"{size:.4g} mm across: measure in the part's coordinates, or check --unit and --unit-measured"
        )
    return ()


def _other_unit(surface: Surface, points: np.ndarray) -> str | None:
    """The unit in which half of the points would lie on the part and cover some of it, None where there is none."""
    best, name = FITS * surface.diagonal, None
    for unit, factor in FACTORS.items():
        extent = float(np.linalg.norm(np.ptp(points, axis=0))) * factor
        distance = float(np.median(surface.nearest(points * factor).distance))
        if distance < best and 0.1 * surface.diagonal < extent < 1.5 * surface.diagonal:
            best, name = distance, unit
    return name


def _labels_agree(measurement: Measurement, factor: float) -> bool:
    """Whether marks would be of a sensible distance from one another only with that factor (labels are in mm)."""
    if measurement.u is None or measurement.v is None:
        return False
    labels = float(np.hypot(np.ptp(measurement.u), np.ptp(measurement.v)))
    extent = float(np.linalg.norm(np.ptp(measurement.points, axis=0)))
    return bool(0.5 < extent * factor / max(labels, 1e-300) < 1.5)


def looks_wrong(net: Net, measurement: Measurement, found: Matched) -> tuple[str, ...]:
    """Warnings where labels, frame, directions or shear angles are probably others than the table says.

    Directions and shear are held against those predicted at the labels: where these are wrong they say nothing.
    """
    labels = check_labels(net, measurement)
    frame = None if labels else other_frame(net, measurement, found)
    if frame:
        return (f"{measurement.source}: {LOOKS_WRONG} {frame}",)
    return labels or (
        *check_directions(measurement, found),
        *check_shear(measurement.shear, found.shear, measurement.source),
    )


def check_labels(net: Net, measurement: Measurement) -> tuple[str, ...]:
    """A warning where other labels (swapped, mirrored, counted from another mark) fit the net far better."""
    if measurement.u is None or measurement.v is None:
        return ()
    labels = np.column_stack([measurement.u, measurement.v])
    present = _typical_distance(net, measurement.points, labels)
    step = mark_spacing(measurement.u), mark_spacing(measurement.v)
    lost = not math.isfinite(present)  # of most labels there is no prediction: others must do well, not just better
    best, words = BETTER * (OFF * net.surface.diagonal if lost else present), ""
    for text, matrix in OTHER_LABELS:
        distance = _typical_distance(net, measurement.points, labels @ np.reshape(matrix, (2, 2)).T)
        if distance < best:
            best, words = distance, text
    for text, factor in OTHER_UNITS:
        distance = _typical_distance(net, measurement.points, labels * factor)
        if distance < best:
            best, words = distance, text
    for text, shift in _other_counts(step):
        distance = _typical_distance(net, measurement.points, labels + shift)
        if distance < best:
            best, words = distance, text
    if not words:
        return ()
    now = "where most have none as they are" if lost else f"instead of {present:.3g} mm"
    return (
        f"{measurement.source}: {LOOKS_WRONG} {words}: half of the points would then lie within {best:.3g} mm of "
        f"the prediction, {now}",
    )


def check_shear(measured: np.ndarray | None, predicted: np.ndarray, source: str) -> tuple[str, ...]:
    """A warning where shear angles (n,), degrees, look as if they were others than they should be."""
    if measured is None:
        return ()
    known = np.isfinite(measured) & np.isfinite(predicted)
    a, b = measured[known], predicted[known]
    if known.sum() < FEWEST or min(a.std(), b.std()) <= 0.0:
        return ()
    words = _other_shear(a, b)
    return (f"{source}: {LOOKS_WRONG} the shear {words}",) if words else ()


def _other_shear(a: np.ndarray, b: np.ndarray) -> str | None:
    """What angles a (n,), degrees, are in place of those predicted, b: from yarn to yarn, of another sign or unit."""
    alike, ratio = float(np.corrcoef(a, b)[0, 1]), float(a.std() / b.std())
    signed = "positive is where the angle between warp and weft becomes less than 90 degrees"
    if a.min() > 0.0 and np.median(np.abs(90.0 - a - np.abs(b))) < BETTER * np.median(np.abs(a - b)):
        return f"is the angle between warp and weft: give 90 less it, with its sign ({signed})"
    if alike < ANTI and alike * np.sqrt(len(a)) < -CERTAIN:
        return f"has the other sign: it goes against what is predicted (correlation {alike:.2f}); {signed}"
    if _has_no_sign(a, b):
        never = "negative" if a.max() > 0.0 else "positive"
        goes = "goes with the size of what is predicted, not with its sign"
        return f"has no sign: it is never {never}, and {goes}; {signed}"
    if alike > ALIKE and 0.3 < ratio * 180.0 / np.pi < 3.0:
        return f"is in radians: it is {ratio:.3f} times what is predicted"
    return None


def _has_no_sign(measured: np.ndarray, predicted: np.ndarray) -> bool:
    """Whether shear angles are all of one sign, and those predicted (n,) of the other are as large without theirs.

    They must go with the size of what is predicted, and with that better than with what is predicted.
    """
    if measured.min() < 0.0 < measured.max():
        return False
    size = np.abs(predicted)
    if size.std() <= 0.0:
        return False
    with_size, with_sign = (
        float(np.corrcoef(a, b)[0, 1]) for a, b in ((np.abs(measured), size), (measured, predicted))
    )
    if not with_size > max(with_sign, 0.0):
        return False
    against = predicted * np.sign(measured.mean()) < 0.0
    a, b = np.abs(measured[against]), np.abs(predicted[against])
    return bool(against.sum() >= FEWEST and np.median(np.abs(a - b)) < UNSIGNED * np.median(a + b))


def _other_counts(step: tuple[float | None, float | None]) -> list[tuple[str, np.ndarray]]:
    """Shifts (2,) of all labels by one mark, with words."""
    if step[0] is None or step[1] is None:
        return []
    counts = [(a, b) for a in (-1, 0, 1) for b in (-1, 0, 1) if (a, b) != (0, 0)]
    return [
        (f"all labels are off by a mark (by {a:+d} along u, {b:+d} along v)", np.array([-a * step[0], -b * step[1]]))
        for a, b in counts
    ]


def _typical_distance(net: Net, points: np.ndarray, labels: np.ndarray) -> float:
    """Median distance in mm of points (n, 3) from where labels (n, 2) are predicted; infinite for too few of them."""
    predicted, _ = net.interpolate(labels[:, 0], labels[:, 1])
    away = np.linalg.norm(points - predicted, axis=1)
    known = np.isfinite(away)
    return float(np.median(away[known])) if known.sum() > 0.5 * len(points) else float("inf")
