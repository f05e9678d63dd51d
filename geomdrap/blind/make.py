"""Make a blind set: a folder with a part, measurements and a setup, and the truth about them under seal."""

from __future__ import annotations

import secrets
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geomdrap.blind.draw import SIGMA_SHEAR, SIGMA_XYZ, Case, Options, draw, shifted, start_point
from geomdrap.blind.files import COLUMNS, write_measured, write_part, write_setup
from geomdrap.blind.marks import SPACING, Marks, fabric_points, lost, measured, spoilt, true_marks
from geomdrap.blind.ply import lay
from geomdrap.blind.recipe import Recipe
from geomdrap.blind.relax import NoMinimumError
from geomdrap.blind.scatter import random_shift
from geomdrap.blind.seal import seal
from geomdrap.blind.terms import Array
from geomdrap.errors import GeomdrapError

SIDES_PER_MARK = 4
ATTEMPTS = 4
FEWEST = 20  # marks worth a set


def make(seed: int | None = None, *, folder: str | Path = ".", **wanted: Any) -> Path:
    """Make a set and give its folder.

    wanted: fields of ``draw.Options``: effect (a name, A+B, random, none, placement, unknown), part, size, amount,
    noise, scatter, placement, outliers, lost, points, columns. The same seed and options give the same
    measurements; only the salt of the seal differs. GeomdrapError for options that do not exist or do not fit.
    """
    options = Options(**wanted)
    _check(options)
    seed = secrets.randbelow(2**31) if seed is None else seed
    case, marks, size = _drawn(seed, options)
    sigmas = options.noise * SIGMA_XYZ, options.noise * SIGMA_SHEAR
    seen = lost(marks, case.noise_rng, options.lost, options.points)
    if len(seen.shear) < FEWEST:
        raise GeomdrapError(f"only {len(seen.shear)} marks are left of this blind set; it takes {FEWEST}")
    signal = _signal(case, seen, size, sigmas)
    recorded, bad = spoilt(measured(seen, case.noise_rng, *sigmas), case.noise_rng, case.outliers)
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    facets = write_part(folder / "part.stl", case.tool)
    write_measured(folder / "measured.csv", recorded, options.columns)
    write_setup(folder / "setup.toml", start_point(case.tool, case.believed), case.believed.angle, *sigmas)
    seal(folder, _truth(seed, case, options, marks=len(recorded.shear), bad=bad, signal=signal, facets=facets))
    return folder


def _drawn(seed: int, options: Options) -> tuple[Case, Marks, tuple[float, float]]:
    """The first case of this seed whose net comes to rest, its true marks, its sizes."""
    for attempt in range(ATTEMPTS):
        case = draw(seed, options, attempt)
        try:
            return case, *_marks(case, options)
        except NoMinimumError:
            if attempt == ATTEMPTS - 1:
                raise
    raise AssertionError  # the loop returns or raises


def _check(options: Options) -> None:
    if options.columns not in COLUMNS:
        raise GeomdrapError(f"columns '{options.columns}' is not one of {', '.join(COLUMNS)}")
    if not 0.0 < options.noise < np.inf or not 0.0 < options.amount < np.inf:
        raise GeomdrapError("noise and amount are factors above 0")
    for name in ("outliers", "lost"):
        if not 0.0 <= (getattr(options, name) or 0.0) < 0.5:
            raise GeomdrapError(f"{name} is a share of the marks, from 0 to below 0.5")
    if options.scatter is not None and not 0.0 <= options.scatter < np.inf:
        raise GeomdrapError("scatter is a standard deviation in mm, 0 or more")
    if options.points is not None and options.points < FEWEST:
        raise GeomdrapError(f"points is {options.points}; a blind set takes {FEWEST} or more")


def _marks(case: Case, options: Options) -> tuple[Marks, tuple[float, float]]:
    """The true marks with scatter, and the side of the cells and spacing of the marks that were used, mm."""
    spacing = SPACING * options.size
    coarse = case.recipe.share > 0.0  # whole yarns couple nodes far apart: half as fine
    side = spacing / (SIDES_PER_MARK / 2 if coarse else SIDES_PER_MARK)
    ply = lay(case.tool, case.recipe, side)
    uv = fabric_points(ply, spacing)
    if options.points is not None and (1.0 - options.lost) * len(uv) < options.points:
        spacing /= 2.0
        uv = fabric_points(ply, spacing)
    shift = random_shift(case.noise_rng, uv, **case.scatter) if case.scatter else None
    return true_marks(ply, case.recipe, shift, spacing), (side, spacing)


def _signal(case: Case, seen: Marks, size: tuple[float, float], sigmas: tuple[float, float]) -> float:
    """How strongly the effect shows: the norm, in standard deviations of the noise, of what it changes in the marks
    (without scatter) that no placement could change.
    """
    if not case.effects:
        return 0.0
    here = case.recipe.start, case.recipe.angle
    base = Recipe(start=here[0], angle=here[1])
    moves = [(0.5, 0.0, 0.0), (0.0, 0.5, 0.0), (0.0, 0.0, 0.5)]
    recipes = [case.recipe, base, *(shifted(case.tool, base, *move) for move in moves)]
    changed, plain, *nearby = (_vector(case, recipe, seen, size, sigmas) for recipe in recipes)
    change, slopes = changed - plain, np.stack([near - plain for near in nearby], axis=1)
    known = np.isfinite(change) & np.all(np.isfinite(slopes), axis=1)
    if np.count_nonzero(known) <= slopes.shape[1]:
        return float("nan")
    weights = np.linalg.lstsq(slopes[known], change[known], rcond=None)[0]
    return float(np.linalg.norm(change[known] - slopes[known] @ weights))


def _vector(
    case: Case, recipe: Recipe, seen: Marks, size: tuple[float, float], sigmas: tuple[float, float]
) -> Array:
    """Positions and shear of the seen marks (4 n,) in standard deviations; NaN where there is no such mark."""
    side = min(2.0 * size[0], size[1])  # coarser than the set itself: a measure of size, to a few per cent
    marks = true_marks(lay(case.tool, recipe, side), recipe, None, size[1])
    row = {tuple(uv): n for n, uv in enumerate(np.round(marks.uv, 6))}
    at = np.array([row.get(tuple(uv), -1) for uv in np.round(seen.uv, 6)])
    values = np.column_stack([marks.points / sigmas[0], marks.shear / sigmas[1]])
    found = np.where(at[:, None] >= 0, values[at], np.nan)
    return found.ravel()


def _truth(
    seed: int, case: Case, options: Options, *, marks: int, bad: NDArray[np.intp], signal: float, facets: int
) -> dict[str, Any]:
    return {
        "answer": case.answer,
        "effect": case.effects,
        "placement": case.placement,
        "scatter": case.scatter,
        "outliers": [int(n) for n in bad],
        "signal_to_noise": round(signal, 3),
        "seed": seed,
        "part": case.tool.name,
        "facets": facets,
        "marks": marks,
        "options": asdict(options),
    }
