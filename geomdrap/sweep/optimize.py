"""``optimize``: the seed and the heading with the best drape, by a sweep and a pattern search from its best cases."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from contextlib import closing
from dataclasses import dataclass, replace

import numpy as np

from geomdrap.errors import SweepError
from geomdrap.fishnet.seed import heading_frame, locate
from geomdrap.geodesic.trace import Stop, trace
from geomdrap.sweep.case import Case, Job
from geomdrap.sweep.objective import DEFAULT, Objective
from geomdrap.sweep.pool import Pool, ThroughExecutor
from geomdrap.sweep.ranking import best_of_origins, ranked
from geomdrap.sweep.row import Row
from geomdrap.sweep.run import Sweep, require_best, rows_of

STARTS = 3  # best cases, of different origins, from which the search goes on
HALF_TURN = 180.0  # a net turned by it is the same net
HEADING_STEP = 15.0  # degrees between the headings from which a search begins
FINEST = 0.25  # pitches by which a seed is moved at last: less changes nothing that could be laid
FINEST_ANGLE = 0.25  # degrees, likewise
BUDGET = 800
AXES = ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))
AROUND = tuple((p, q, r) for p in (1, 0, -1) for q in (1, 0, -1) for r in (1, 0, -1))
EDGES, CORNERS = (tuple(m for m in AROUND if m.count(0) == n) for n in (1, 0))  # the largest shear has sharp valleys
SCATTERED = 48  # seeds between those of the sweep: good ones may lie in a small place


@dataclass(frozen=True)
class Step:
    """How far a search looks around: seed mm, heading degrees."""

    seed: float
    heading: float

    def halved(self, least: Step) -> Step:
        """Half as far, but as far as ``least``."""
        return Step(max(0.5 * self.seed, least.seed), max(0.5 * self.heading, least.heading))


@dataclass(frozen=True, eq=False)
class Optimum:
    """The best drape that was found.

    ``sweep`` holds all rows, those of the search after the first ``swept``; ``of_sweep`` is the best row of the
    global sweep alone; ``path`` the rows by which the search that led to the best came there; ``converged`` is False
    where the budget ended the search.
    """

    sweep: Sweep
    swept: int
    of_sweep: Row
    path: tuple[Row, ...]
    converged: bool

    @property
    def best(self) -> Row:
        """The best row of all, never worse than that of the sweep."""
        return self.sweep.best

    @property
    def shown(self) -> Sweep:
        """The global sweep with the best row added: what a picture shows."""
        rows = self.sweep.rows[: self.swept]
        return replace(self.sweep, rows=rows if self.best in rows else (*rows, self.best))


class Rows:
    """Rows of cases, each draped once, on a pool; ``found`` are all that there are, by case."""

    def __init__(self, pool: Pool, done: Iterable[Row], on_row: Callable[[Row], None]):
        self.pool, self.on_row = pool, on_row
        self.earlier = {row.key: row for row in done}
        self.found: dict[Case, Row] = {}

    def __call__(self, cases: Sequence[Case]) -> list[Row]:
        """The rows of cases, in their order."""
        for case in cases:
            if case not in self.found and (case.origin, case.angle) in self.earlier:
                self.found[case] = self.earlier[case.origin, case.angle]
        for row in rows_of(self.pool, [case for case in dict.fromkeys(cases) if case not in self.found]):
            self.on_row(row)
            self.found[Case(*row.key)] = row
        return [self.found[case] for case in cases]


def optimize(
    job: Job,
    cases: Sequence[Case],
    objective: str = DEFAULT,
    *,
    budget: int = BUDGET,
    pool: Pool | None = None,
    done: Iterable[Row] = (),
    on_row: Callable[[Row], None] = lambda row: None,
) -> Optimum:
    """The seed and heading that make the objective smallest.

    First the ``cases`` are swept, and some more with seeds scattered between theirs; then the best of all, from
    different origins, are refined on the surface: the seed moves along geodesics in the directions of the yarns, the
    heading turns, both together; where nothing around is better, the steps are halved, down to a quarter of the pitch
    and of a degree, which are tried too (pattern search: R. Hooke and T. A. Jeeves, J. ACM 8, 1961). ``budget`` is
    the greatest number of drapes after the sweep. Every value is that of a real drape; the best of all is returned.
    ``pool``, ``done`` and ``on_row`` as for ``run``.
    Raises SweepError where there is no case, none can be draped, or the objective is unknown.
    """
    wanted = Objective.parse(objective)
    if not cases:
        raise SweepError("there is no case to begin with: give at least one origin and one angle")
    with closing(pool or ThroughExecutor(job)) as place:
        rows = Rows(place, done, on_row)
        first = ranked(rows(list(dict.fromkeys(cases))), wanted)
        require_best(first)
        swept = len(rows.found)
        more = rows(scattered(job, first, min(SCATTERED, budget // 6)))
        first_and_more = ranked([*first, *more], wanted)
        step = first_step(job, list(rows.found), first[0].pitch)
        paths, converged = [], True
        for start in best_of_origins(first_and_more)[:STARTS]:
            path, finished = _refine(job, rows, wanted, start, step, swept + budget)
            paths.append(path)
            converged = converged and finished
    best = min(paths, key=lambda path: wanted.score(path[-1]))
    everything = Sweep(job, tuple(rows.found.values()), wanted)
    return Optimum(everything, swept, first[0], tuple(best), converged)


def first_headings(job: Job) -> tuple[float, ...]:
    """Headings (degrees) from which a search begins if none are given.

    Over a quarter turn, after which warp and weft have changed places; over half a turn where these differ: with
    effects, and with a blank that is longer one way.
    """
    alike = not job.effects and (job.reach is None or job.reach[0] == job.reach[1])
    return tuple(float(a) for a in np.arange(0.0, 0.5 * HALF_TURN if alike else HALF_TURN, HEADING_STEP))


def scattered(job: Job, rows: Sequence[Row], count: int) -> list[Case]:
    """Cases at the centroid and at places as far as can be from all others, with two headings each.

    ``rows`` are those of the sweep, the best first: a place takes the heading of the best one at the nearest origin,
    and that turned by 45 degrees.
    """
    known = best_of_origins(rows)
    places = [locate(job.surface, row.asked)[1] for row in known]
    headings = [row.angle for row in known]
    middle = job.surface.points[job.surface.triangles].mean(axis=1)
    away = np.stack([np.linalg.norm(middle - place, axis=1) for place in places])
    cases = []
    for n in range(count):
        found = locate(job.surface, "centroid" if n == 0 else middle[away.min(axis=0).argmax()])[1]
        near = int(np.argmin([np.linalg.norm(place - found) for place in places]))
        x, y, z = (float(c) for c in found)
        cases += [Case((x, y, z), (headings[near] + turn) % HALF_TURN) for turn in (0.0, 45.0)]
        away = np.minimum(away, np.linalg.norm(middle - found, axis=1)).min(axis=0, keepdims=True)
    return cases


def first_step(job: Job, cases: Sequence[Case], pitch: float) -> Step:
    """Half the way between origins of the sweep, and between its headings; never below the finest."""
    origins, angles = {case.origin for case in cases}, sorted({case.angle for case in cases})
    between = math.sqrt(job.surface.area / (4.0 if len(origins) == 1 else len(origins)))
    gap = float(np.median(np.diff(angles))) if len(angles) > 1 else 30.0
    return Step(max(0.5 * between, pitch), max(0.5 * gap, 2.0 * FINEST_ANGLE))


def _refine(job: Job, rows: Rows, objective: Objective, start: Row, step: Step, most: int) -> tuple[list[Row], bool]:
    """The rows from ``start`` to where no step finds a better one, and whether the budget sufficed."""
    path, finest = [start], Step(FINEST * start.pitch, FINEST_ANGLE)
    while True:
        for moves in (AXES, EDGES, CORNERS):
            around = _around(job, path[-1], step, moves)
            if len(rows.found) + sum(case not in rows.found for case in around) > most:
                return path, False
            best = ranked([path[-1], *rows(around)], objective)[0]
            if objective.score(best) < objective.score(path[-1]):
                path.append(best)
                break
        else:
            if step == finest:
                return path, True
            step = step.halved(finest)


def _around(job: Job, row: Row, step: Step, moves: Sequence[tuple[int, int, int]]) -> list[Case]:
    """The cases that ``moves`` lead to, steps along the warp, along the weft, and of the heading, from a row's.

    They go from the origin that the row's case asks for: where effects displace the ply, they will displace that of
    the new case too. A move that leaves the part leads to no case.
    """
    face, asked, _ = locate(job.surface, row.asked)
    here = job.surface.only_component(face)
    face, point, _ = locate(here, asked)
    normal = here.normals[face]
    along = heading_frame(normal, job.reference)
    angle_rad = math.radians(row.angle)
    warp = math.cos(angle_rad) * along + math.sin(angle_rad) * np.cross(normal, along)
    cases = []
    for p, q, turn in moves:
        to = (row.angle + turn * step.heading) % HALF_TURN if turn else row.angle
        if p == q == 0:
            cases.append(Case(row.asked, to))
            continue
        moved = trace(here, point, p * warp + q * np.cross(normal, warp), step.seed, face=face)
        if moved.stopped is Stop.LENGTH:
            x, y, z = (float(c) for c in moved.point)
            cases.append(Case((x, y, z), to))
    return cases
