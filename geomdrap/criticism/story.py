"""A diagnosis in sentences, for people: the verdict, what speaks for it, and what these data cannot show."""

from __future__ import annotations

import math

from geomdrap.criticism.diagnosis import AMBIGUOUS, NONE, PLACEMENT, UNKNOWN, Diagnosis, Tried, Value
from geomdrap.effects import make
from geomdrap.measurement.plausible import LOOKS_WRONG

LARGE = 100.0  # numbers from there on are whole, errors of three digits
MOST_LINES = 12  # of a table: named one by one
OPEN = 0.2  # confidence: below, the data leave the answer open


def verdict_sentence(d: Diagnosis) -> str:
    """The answer, in one or two sentences, with what speaks against it: labels that look wrong, too few data."""
    answer = _answer(d)
    if d.confidence < OPEN and d.verdict not in (AMBIGUOUS, UNKNOWN):
        answer += f" These data leave that open (confidence {100.0 * d.confidence:.0f} %): measure more points."
    if any(LOOKS_WRONG in warning for warning in d.warnings):
        return f"The table looks wrong: see the warning. If it is right: {answer}"
    return answer


def _answer(d: Diagnosis) -> str:
    if d.verdict == NONE:
        scatter = (
            f"; lay-up scatter of {d.scatter.size:.2g} mm over {d.scatter.length:.0f} mm accounts for the rest"
            if d.scatter.size > 0.0
            else ""
        )
        hidden = 2 * sum(not _sizes(t) for t in d.tried) > len(d.tried)
        nothing = "Nothing that can be seen in these data is missing" if hidden else "Nothing is missing"
        nearly = "nearly down" if d.leftover.doubtful else "down"
        return f"{nothing}: the model agrees with the measurement {nearly} to its noise{scatter}."
    if d.verdict == PLACEMENT:
        return (
            f"The ply was laid elsewhere: {_list(d.placement)} (95 %). "
            "Nothing else that can be seen in these data is missing."
        )
    if d.verdict == AMBIGUOUS:
        return f"These effects explain the measurement equally well: {_and(d.candidates)}."
    if d.verdict == UNKNOWN:
        found = (
            f" {_and(d.candidates)} explain{'s' if len(d.candidates) == 1 else ''} part of it."
            if d.candidates
            else ""
        )
        return f"Something is missing that no effect of the library explains.{found}"
    chosen = [t for t in d.tried if t.selected]
    values = "; ".join(f"{t.name} ({_list(t.values)}; 95 %)" for t in chosen)
    return f"The model lacks {values}."


def error_sentence(d: Diagnosis) -> str:
    """How the error falls."""
    first, last = d.steps[0], d.steps[-1]
    scatter = f" and lay-up scatter of {d.scatter.size:.2g} mm" if d.scatter.size > 0.0 else ""
    return (
        f"Error over the noise: {first.error:.2f} as meant, {d.steps[1].error:.2f} with the placement fitted"
        + (f", {last.error:.2f} with all effects" if len(d.steps) > 2 else "")
        + f" (held out {last.cv_error:.2f}); noise{scatter} alone would leave {d.noise_floor:.2f}."
    )


def placement_sentence(d: Diagnosis) -> str | None:
    """Where the ply lies by the final model, if that is not the answer already."""
    return None if d.verdict == PLACEMENT else f"Placement: {_list(d.placement)} (95 %)."


def rival_sentence(d: Diagnosis) -> str | None:
    """What the next best effect would have explained."""
    if d.verdict in (NONE, PLACEMENT, UNKNOWN):
        return None
    others = [t for t in d.tried if not t.selected and t.name not in d.candidates]
    if not others:
        return None
    others = [t for t in others if t.evidence.in_range]
    best = max((t for t in others if _sizes(t)), key=lambda t: t.evidence.share, default=None)
    if best is None or best.evidence.share < 0.01:
        return "No other effect that these data show explains more than 1 % of the misfit with a possible size."
    found = [t.name for t in d.tried if t.selected]
    of = f"what {found[0]} leaves" if len(found) > 1 else "the misfit"
    return f"The next best, {best.name}, explains {100 * best.evidence.share:.0f} % of {of} above the noise."


def unseen_sentences(d: Diagnosis) -> list[str]:
    """Effects that were not found, with the smallest size that would have been, and those that cannot be seen."""
    seen, blind = [], []
    for t in d.tried:
        if t.selected or t.name in d.candidates:
            continue
        sizes = _sizes(t)
        if sizes:
            seen.append(f"{t.name} {', '.join(sizes)}")
        else:
            blind.append(t.name)
    out = []
    if seen:
        out.append("Would have been seen: " + "; ".join(seen) + ".")
    if blind:
        out.append("Cannot be seen in these data: " + ", ".join(blind) + ".")
    return out


def _sizes(t: Tried) -> list[str]:
    """From which sizes on each parameter of an effect would have been seen; empty where none would.

    What does nothing alone, as a threshold, is left out: it is not seen for what it is, whatever the data.
    """
    amounts = {name: amount for name, amount, _ in t.visible if amount is not None}
    out, last = [], ""
    for p in make(t.name).parameters:
        if p.name not in amounts or make(t.name, **{p.name: p.typical}).is_neutral:
            continue
        amount, side = _plain(amounts[p.name], 2), "above "
        if p.neutral == p.high:  # as an angle of locking: the lower the stronger
            amount, side = f"{p.neutral - amounts[p.name]:.3g}", "below "
        out.append(f"{'' if side == last else side}{p.name} {amount}{_unit(p.unit)}")
        last = side
    return out


def outlier_sentence(d: Diagnosis) -> str | None:
    """Which lines of the table are set apart."""
    lines = sorted({o.line for o in d.outliers})
    if not lines:
        return None
    more = f" and {len(lines) - MOST_LINES} more" if len(lines) > MOST_LINES else ""
    first = ", ".join(map(str, lines[:MOST_LINES]))
    which = "lines" if len(lines) > 1 else "line"
    return f"Set apart because they stand out from their neighbours: {which} {first}{more}."


def fitted_words(t: Tried) -> str:
    """The values found for an effect with their 95 % intervals, or that there are none and why."""
    if t.looked_at_only:
        return "looked at only"
    return "not seen" if not any(math.isfinite(v.sigma) for v in t.values) else _list(t.values)


def held_out(t: Tried) -> str:
    """The held-out error of an effect, over the noise."""
    return f"{t.cv_error:.2f}" if t.cv_error < LARGE else _plain(t.cv_error, 3)


def table_rows(d: Diagnosis) -> list[tuple[str, ...]]:
    """Header and a row per effect: name, values, share of the misfit, held-out error, chance, looks like."""
    rows = [("effect", "fitted (± 95 %)", "explains", "held out", "by chance", "looks like")]
    return rows + [_row(t) for t in d.tried]


def _row(t: Tried) -> tuple[str, ...]:
    return (
        ("* " if t.selected else "  ") + t.name,
        fitted_words(t),
        f"{100 * max(t.evidence.share, 0.0):.0f} %",
        held_out(t),
        f"{t.evidence.p_family:.1g}",
        ", ".join(t.confounded_with) or "-",
    )


def _list(values: tuple[Value, ...]) -> str:
    return ", ".join(_value(v) for v in values)


def _value(v: Value) -> str:
    # no-break spaces: a value stays on one line with its interval
    if not math.isfinite(v.sigma):
        return f"{v.name}\u00a0not\u00a0seen"
    return f"{v.name}\u00a0{_plain(v.value, 3)}\u00a0±\u00a0{_plain(1.96 * v.sigma, 1)}{_unit(v.unit)}"


def _plain(number: float, digits: int) -> str:
    """A number to so many digits, without an exponent if it is large."""
    short = float(f"{number:.{digits}g}")
    return f"{short:.0f}" if abs(short) >= LARGE else f"{short:g}"


def _unit(unit: str) -> str:
    return f"\u00a0{unit}" if unit else ""


def _and(names: tuple[str, ...]) -> str:
    return " and ".join([", ".join(names[:-1]), names[-1]]) if len(names) > 1 else "".join(names)
