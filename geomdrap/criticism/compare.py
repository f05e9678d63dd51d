"""``compare``: where a drape differs from what was measured."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from geomdrap.criticism.compare_places import places_of
from geomdrap.criticism.compare_residuals import in_yarns, turns
from geomdrap.criticism.comparison import Comparison
from geomdrap.criticism.smooth import SmoothTool, note_on
from geomdrap.errors import MeasurementError
from geomdrap.fishnet import drape
from geomdrap.fishnet.pitch import choose_pitch, coarse_facets
from geomdrap.measurement.lines import FEWEST
from geomdrap.measurement.marks import mark_spacing, pitch_for_marks
from geomdrap.measurement.match import Matched, match
from geomdrap.measurement.noise import Noise, noise_of, noise_of_directions, repeats_of
from geomdrap.measurement.outliers import Outlier, find_outliers
from geomdrap.measurement.plausible import looks_wrong, require_on_part
from geomdrap.measurement.upright import without_upright

if TYPE_CHECKING:
    from collections.abc import Sequence

    from geomdrap.fishnet import Effect, Net
    from geomdrap.fishnet.seed import Origin
    from geomdrap.measurement.measurement import Measurement
    from geomdrap.surface import Surface


FINER = 0.5
"""Of the pitch of a drape, where the facets allow: a finer net reaches closer to the rim, where marks lie too."""


def compare(
    surface: Surface,
    measurement: Measurement,
    *,
    origin: Origin,
    angle: float,
    pitch: float | None = None,
    sigma_xyz: float | None = None,
    sigma_shear: float | None = None,
    sigma_direction: float | None = None,
    effects: Sequence[Effect] = (),
    reference: Sequence[float] | None = None,
    project: bool = False,
    smooth: bool = True,
) -> Comparison:
    """Drape a part and compare the net with measured points.

    ``origin``, ``angle``, ``effects``, ``reference`` and ``project`` as for `drape`; ``pitch`` mm is chosen from the
    part, and so that drawn marks lie on nodes, where it is None. ``sigma_xyz`` (mm, per coordinate),
    ``sigma_shear`` and ``sigma_direction`` (degrees) are the noise of the measurement where it has no columns for
    it; where they are None too the noise comes from replicates, or from the differences of neighbours, and that of
    directions, where these do not say it, from that of the shear. A real ply lies on the ``smooth`` tool that the
    facets stand for; nodes of a drape by another tool lie on the facets themselves.
    Raises MeasurementError where the table cannot belong to the part, SurfaceError and DrapeError as `drape` does.
    """
    warnings = require_on_part(surface, measurement)
    pitch, notes = suited_pitch(surface, measurement, pitch)
    acting = (*effects, SmoothTool()) if smooth else effects
    net = drape(surface, origin, angle, pitch, effects=acting, reference=reference, project=project)
    notes = (*notes, *note_on(surface)) if smooth else notes
    result = compare_net(
        net, measurement, sigma_xyz=sigma_xyz, sigma_shear=sigma_shear, sigma_direction=sigma_direction
    )
    return with_messages(result, notes, warnings)


def suited_pitch(
    surface: Surface, measurement: Measurement, pitch: float | None = None
) -> tuple[float, tuple[str, ...]]:
    """The pitch for a comparison, mm, and the sentence on it: as asked, or from part and marks.

    Finer than that of a drape where the facets allow.
    """
    if pitch is not None:
        return pitch, ()
    wanted, _ = choose_pitch(surface)
    if not coarse_facets(surface, FINER * wanted):
        wanted *= FINER
    steps = [s for s in (mark_spacing(measurement.u), mark_spacing(measurement.v)) if s is not None]
    pitch = pitch_for_marks(min(steps) if steps else None, wanted)
    source = "the part and the marks" if steps else "the part"
    return pitch, (f"pitch {pitch:g} mm chosen from {source} (set another with --pitch)",)


def compare_net(
    net: Net,
    measurement: Measurement,
    *,
    sigma_xyz: float | None = None,
    sigma_shear: float | None = None,
    sigma_direction: float | None = None,
) -> Comparison:
    """Compare a net, from whatever model, with measured points; see `compare`."""
    measurement = without_upright(net.surface, measurement)
    matched = match(net, measurement)
    _require_matches(measurement, matched)
    away = measurement.points - matched.point
    if not measurement.labelled:
        away = np.einsum("ij,ij->i", away, matched.normal)[:, None] * matched.normal
    shear = None if measurement.shear is None else measurement.shear - matched.shear
    warp, weft = (
        None if measured is None else turns(predicted, measured, matched.normal)
        for predicted, measured in ((matched.warp, measurement.warp), (matched.weft, measurement.weft))
    )
    noises, said = _noises(measurement, matched, away, shear, (warp, weft), (sigma_xyz, sigma_shear, sigma_direction))
    outliers = find_outliers(net, measurement, matched, noises[0].sigma, noises[1].sigma)
    wrong = looks_wrong(net, measurement, matched)
    return Comparison(
        net=net,
        measurement=measurement,
        matched=matched,
        vector=away,
        parts=in_yarns(away, matched),
        shear=shear,
        warp_turn=warp,
        weft_turn=weft,
        noise_xyz=noises[0],
        noise_shear=noises[1],
        noise_warp=noises[2],
        noise_weft=noises[3],
        outliers=outliers,
        trusted=_trusted(matched, outliers),
        places=places_of(net, matched),
        notes=(*net.notes, *measurement.notes),
        warnings=(
            *net.warnings,
            *measurement.warnings,
            *said,
            *wrong,
            *_words(measurement, outliers, matched.used, bool(wrong)),
        ),
    )


def with_messages(result: Comparison, notes: Sequence[str], warnings: Sequence[str]) -> Comparison:
    """The same comparison with more notes and warnings, ahead of its own."""
    from dataclasses import replace

    return replace(result, notes=(*notes, *result.notes), warnings=(*warnings, *result.warnings))


def _require_matches(measurement: Measurement, matched: Matched) -> None:
    """Raise MeasurementError where no row has a prediction."""
    if matched.used.any():
        return
    reasons = sorted(set(matched.reason), key=matched.reason.count)
    raise MeasurementError(
        f"{measurement.source}: none of its {len(measurement)} points has a prediction ({reasons[-1]}): check "
        "origin, angle, labels and frame of the measurement"
    )


def _noises(
    measurement: Measurement,
    matched: Matched,
    away: np.ndarray,
    shear: np.ndarray | None,
    turned: tuple[np.ndarray | None, np.ndarray | None],
    given: tuple[float | None, float | None, float | None],
) -> tuple[tuple[Noise, Noise, Noise, Noise], tuple[str, ...]]:
    """Noise of coordinates, shear, warp and weft, and warnings; ``given`` of coordinates, shear and directions."""
    sigma_xyz, sigma_shear, sigma_direction = given
    group = repeats_of(measurement)
    places = np.column_stack([matched.u, matched.v])
    residual = away if measurement.labelled else np.einsum("ij,ij->i", away, matched.normal)[:, None]
    xyz, said = noise_of("sigma_xyz", measurement.sigma_xyz, sigma_xyz, measurement.points, group, residual, places)
    of_shear = Noise(None, None)
    more: tuple[str, ...] = ()
    if measurement.shear is not None and shear is not None:
        values = measurement.shear[:, None]
        of_shear, more = noise_of(
            "sigma_shear", measurement.sigma_shear, sigma_shear, values, group, shear[:, None], places
        )
    column, shear_told = measurement.sigma_direction, of_shear.typical or sigma_shear
    of_turn = {0: Noise(None, None), 1: Noise(None, None)}
    for k, turn in enumerate(turned):
        if turn is not None:
            of_turn[k], last = noise_of_directions(column, sigma_direction, shear_told, turn[:, None], group, places)
            more = (*more, *(words for words in last if words not in more))
    return (xyz, of_shear, of_turn[0], of_turn[1]), (*said, *more)


def _trusted(matched: Matched, outliers: tuple[Outlier, ...]) -> np.ndarray:
    trusted = matched.used.copy()
    trusted[[outlier.row for outlier in outliers]] = False
    return trusted


def _words(
    measurement: Measurement, outliers: tuple[Outlier, ...], used: np.ndarray, all_wrong: bool
) -> tuple[str, ...]:
    """Sentences on the outliers: how many, and which labels seem wrong, unless the table is ``all_wrong``.

    ``used`` (n,) bool have a prediction.
    """
    out = []
    if outliers:
        lines = ", ".join(str(line) for line in sorted({outlier.line for outlier in outliers})[:8])
        more = ", …" if len({outlier.line for outlier in outliers}) > 8 else ""
        out.append(f"{len(outliers)} values stand out from their neighbours (lines {lines}{more}) and are set apart")
    if all_wrong:
        return tuple(out)
    told, left = _words_on_lines(measurement, [one for one in outliers if one.shift is not None], used)
    for outlier in left[:8]:
        a, b = outlier.shift or (0, 0)
        where = f"{a:+d} along u and {b:+d} along v"
        told.append(f"line {outlier.line}: the label seems to be off; the mark fits {where} (in marks)")
    return (*out, *told)


def _words_on_lines(
    measurement: Measurement, shifted: list[Outlier], used: np.ndarray
) -> tuple[list[str], list[Outlier]]:
    """A sentence for each line of marks of which some are off alike, and the outliers of no such line."""
    told, left = [], shifted
    for name, labels, shifts in (("v", measurement.v, {(1, 0), (-1, 0)}), ("u", measurement.u, {(0, 1), (0, -1)})):
        if labels is None:
            continue
        for shift, level in sorted({(one.shift, float(labels[one.row])) for one in left if one.shift in shifts}):
            own = [one for one in left if one.shift == shift and labels[one.row] == level]
            if len(own) >= FEWEST and shift is not None:
                where = f"{shift[0]:+d} along u and {shift[1]:+d} along v"
                share = f"{len(own)} of {int((used & (labels == level)).sum())}"
                told.append(
                    f"the marks with {name} = {level:g} mm: {share} labels of this line seem to be off; they fit "
                    f"{where} (in marks)"
                )
                left = [one for one in left if one not in own]
    return told, left
