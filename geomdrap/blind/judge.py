"""Was the verdict right? Compare what a diagnosis found with what a blind set hides."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

RIGHT, AMONG, UNEXPLAINED, MISSED, FALSE_ALARM, PARTLY, WRONG = (
    "right",
    "among the candidates",
    "unexplained",
    "missed",
    "false alarm",
    "partly",
    "wrong",
)
INTERVAL = 1.96
"""Standard deviations on either side of a value that make its 95 % interval."""
GOOD = (RIGHT, AMONG)
"""Grades that count as right."""


def grade(answer: str, verdict: str, candidates: list[str] | tuple[str, ...] = ()) -> str:
    """Grade a ``verdict`` (none, placement, ambiguous, unknown, an effect, A+B) where ``answer`` was hidden.

    ``ambiguous`` counts as right where the truth is among the candidates, or where the truth is outside the
    library; ``unknown`` for an effect of the library is honest, but not right.
    """
    hidden, found = set(answer.split("+")), set(verdict.split("+"))
    if hidden == found:
        return RIGHT
    quiet = {"none", "placement"}
    if verdict == "ambiguous":
        among = answer == "unknown" or answer in candidates or hidden <= set(candidates)
        return AMONG if among else FALSE_ALARM if hidden <= quiet else WRONG
    if hidden <= quiet:
        return WRONG if found <= quiet else FALSE_ALARM
    if found <= quiet:
        return MISSED
    if verdict == "unknown":
        return UNEXPLAINED
    return PARTLY if hidden & found else WRONG


def parameters(truth: Mapping[str, Any], diagnosis: Mapping[str, Any]) -> list[dict[str, Any]]:
    """True and found parameters, a row each: effect, parameter, unit, true, found, sigma, off (in sigmas).

    ``outside``: the true value is not in the 95 % interval of the one found; ``wrong_sign``: it is of the other sign.
    All that follows from found and sigma is None where the diagnosis does not give them.
    """
    fitted = {one["name"]: one.get("parameters", {}) for one in diagnosis.get("effects", ())}
    rows = []
    for effect, values in truth["effect"].items():
        for name, true in values.items():
            entry = fitted.get(effect, {}).get(name) or {}
            value, sigma = entry.get("value"), entry.get("sigma")
            off = (value - true) / sigma if value is not None and sigma else None
            row = {"effect": effect, "parameter": name, "unit": entry.get("unit", ""), "true": true}
            seen = {"found": value, "sigma": sigma, "off": off, "outside": None, "wrong_sign": None}
            if off is not None:
                seen.update({"outside": abs(off) > INTERVAL, "wrong_sign": value * true < 0.0})
            rows.append({**row, **seen})
    return rows
