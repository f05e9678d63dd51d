"""Draw all that a blind set consists of from one seed: part, effect, placement, scatter, noise, losses."""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np

from geomdrap.blind.hidden import HIDDEN, LIBRARY, OUTSIDE
from geomdrap.blind.lines import generators
from geomdrap.blind.ply import lay, warp_direction
from geomdrap.blind.recipe import Recipe
from geomdrap.blind.scatter import KINDS
from geomdrap.blind.shear import node_shear
from geomdrap.blind.sheet import bare, normals
from geomdrap.blind.terms import Array
from geomdrap.blind.tools import TOOLS, Tool, draw_tool
from geomdrap.errors import GeomdrapError

SIGMA_XYZ, SIGMA_SHEAR = 0.2, 0.6
"""Instrument noise of the sets, mm and deg, where ``noise`` is 1."""
KINDS_OF_SET = ("none", "placement", "random", "unknown", *HIDDEN)
PLACEMENTS = ("right", "wrong")


@dataclass(frozen=True)
class Options:
    """What is asked of a set; None: drawn at random."""

    effect: str = "random"
    part: str | None = None
    size: float = 1.0
    amount: float = 1.0
    noise: float = 1.0
    scatter: float | None = None
    """Standard deviation of the lay-up scatter, mm."""
    placement: str | None = None
    outliers: float | None = None
    lost: float = 0.1
    points: int | None = None
    columns: str = "all"


@dataclass(frozen=True)
class Case:
    """What was drawn."""

    tool: Tool
    believed: Recipe
    """A ply without effects as the person who measured believes it lies."""
    recipe: Recipe
    answer: str
    effects: dict[str, dict[str, float]]
    placement: dict[str, float]
    scatter: dict[str, Any]
    outliers: float
    noise_rng: np.random.Generator = field(repr=False)


def draw(seed: int, options: Options, attempt: int = 0) -> Case:
    """Draw a case, another one for each ``attempt``; GeomdrapError for options that do not exist or fit."""
    wanted = zlib.crc32(options.effect.encode())  # so that sets of one seed do not share their draws
    streams = [np.random.default_rng([seed, wanted, attempt, n]) for n in range(6)]
    names = _effects(options.effect, streams[0])
    part = _part(names, options.part, streams[0])
    tool = draw_tool(part, streams[1], options.size)
    start = options.size * streams[1].uniform(-10.0, 10.0, 2)
    believed = Recipe(start=(float(start[0]), float(start[1])), angle=5.0 * float(streams[1].integers(0, 18)))
    moved, placement = _placed(tool, believed, names, options, streams[2])
    named, recipe = _affected(tool, moved, names, options, streams[3])
    answer = "+".join(named) or ("placement" if placement else "none")
    if set(named) & set(OUTSIDE):
        answer = "unknown"
    scatter = _scatter(options, streams[4])
    outliers = options.outliers
    if outliers is None:
        outliers = float(streams[4].choice([0.0, streams[4].uniform(0.01, 0.04)]))
    return Case(tool, believed, recipe, answer, named, placement, scatter, outliers, streams[5])


def _effects(wanted: str, rng: np.random.Generator) -> list[str]:
    """Names of what is hidden: effects, or ``placement``, or none."""
    if wanted == "random":
        wanted = str(rng.choice(["none", "placement", "unknown", *LIBRARY]))
    if wanted == "unknown":
        wanted = str(rng.choice(OUTSIDE))
    names = [] if wanted == "none" else wanted.split("+")
    for name in names:
        if name != "placement" and name not in HIDDEN:
            raise GeomdrapError(f"there is no blind effect '{name}'; choose one of {', '.join(KINDS_OF_SET)}")
        if names.count(name) > 1:
            raise GeomdrapError(f"blind effect '{wanted}' names {name} more than once; name it once")
    return names


def _part(names: Sequence[str], part: str | None, rng: np.random.Generator) -> str:
    if part is not None:
        return part
    fit = [p for p in TOOLS if all(p in HIDDEN[name].parts for name in names if name in HIDDEN)]
    if not fit:
        raise GeomdrapError(f"no blind part shows {' and '.join(names)} at once; name one with part, or one effect")
    return str(rng.choice(fit))


def _placed(
    tool: Tool, believed: Recipe, names: Sequence[str], options: Options, rng: np.random.Generator
) -> tuple[Recipe, dict[str, float]]:
    """Where the ply really lies, and by how much that is off; {} where it lies right."""
    if options.placement not in (None, *PLACEMENTS):
        raise GeomdrapError(f"placement '{options.placement}' is not one of {', '.join(PLACEMENTS)}")
    wrong = "placement" in names or options.placement == "wrong"
    if options.placement is None and not wrong:
        wrong = bool(names) and bool(rng.integers(0, 2))
    if not wrong:
        return believed, {}
    low, high = (1.5, 4.0) if "placement" in names else (0.5, 3.0)
    du, dv = options.size * rng.uniform(low, high, 2) * rng.choice([-1.0, 1.0], 2)
    dangle = rng.uniform(0.4, 1.8) * rng.choice([-1.0, 1.0])
    off = {"du": float(du), "dv": float(dv), "dangle": float(dangle)}
    return shifted(tool, believed, **off), off


def shifted(tool: Tool, recipe: Recipe, du: float, dv: float, dangle: float) -> Recipe:
    """The recipe with its seed moved by a chord of (du, dv) mm along warp and weft, and its heading turned [deg]."""
    sheet, start = bare(tool.term), np.asarray(recipe.start)
    away = float(np.hypot(du, dv))
    if away > 0.0:
        normal = normals(sheet, start[None])[0]
        toward = recipe.angle + float(np.rad2deg(np.arctan2(dv, du)))
        heading = warp_direction(sheet(start[None])[1][0], normal, toward)
        one = np.array([[away]])
        start = generators(sheet, start, heading[None], one, 0.0 * one)[0, 1]
    return replace(recipe, start=(float(start[0]), float(start[1])), angle=recipe.angle + dangle)


def _affected(
    tool: Tool, recipe: Recipe, names: Sequence[str], options: Options, rng: np.random.Generator
) -> tuple[dict[str, dict[str, float]], Recipe]:
    """The recipe with the effects, and their parameters by name."""
    named: dict[str, dict[str, float]] = {}
    if not set(names) & set(HIDDEN):
        return named, recipe
    shear = _shear(tool, recipe, options.size)
    neutral = Recipe()
    for name in names:
        if name not in HIDDEN:
            continue
        named[name], change = HIDDEN[name].draw(rng, options.amount, shear)
        taken = [key for key in change if getattr(recipe, key) != getattr(neutral, key)]
        if taken:
            raise GeomdrapError(f"{name} does not go together with {' and '.join(n for n in names if n != name)}")
        recipe = replace(recipe, **change)
    if recipe.ball and recipe.offset:  # each makes a surface of the tool, and a ply lies on one
        raise GeomdrapError("thickness does not go together with bridging; hide one of them")
    return named, recipe


def _shear(tool: Tool, recipe: Recipe, size: float) -> float:
    """97th percentile of |γ| of the ply without effects, deg."""
    shear = np.abs(node_shear(lay(tool, recipe, 8.0 * size).points))
    return float(np.nanpercentile(shear, 97.0))


def _scatter(options: Options, rng: np.random.Generator) -> dict[str, Any]:
    """Standard deviation and length of the scatter, mm, and its kind; {} for none. Some two sets in five have it."""
    sd = options.scatter
    if sd is None:
        sd = float(rng.choice([0.0, 0.0, 0.0, rng.uniform(0.2, 0.6), rng.uniform(0.2, 0.6)]))
    if sd == 0.0:
        return {}
    return {"sd": sd, "length": float(rng.uniform(25.0, 45.0)), "kind": str(rng.choice(KINDS))}


def start_point(tool: Tool, recipe: Recipe) -> Array:
    """The seed (3,) mm on the tool itself."""
    start: Array = bare(tool.term)(np.asarray(recipe.start)[None])[0][0]
    return start


def option_names() -> tuple[str, ...]:
    """Names of what can be asked of a set."""
    return tuple(one.name for one in fields(Options))
