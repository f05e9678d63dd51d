"""The readable summary of a comparison."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from geomdrap.criticism import Comparison
    from geomdrap.criticism.compare_scores import Score


def summary(comparison: Comparison, files: Mapping[str, Path]) -> str:
    """Give the summary as text: a labelled line per fact, in mm and degrees."""
    return "\n".join(f"{label:<13}{text}".rstrip() for label, text in _lines(comparison, files))


def _lines(comparison: Comparison, files: Mapping[str, Path]) -> Iterator[tuple[str, str]]:
    net, measurement, scores = comparison.net, comparison.measurement, comparison.scores
    yield "part", f"{net.surface.source}, warp at {net.angle:g}°, pitch {net.pitch:.4g} mm"
    by = "marks with u, v" if measurement.labelled else "nearest points of the drape"
    used = int(comparison.used.sum())
    yield "measured", f"{measurement.source}: {used} of {len(measurement)} points compared, {by}"
    for reason, count in Counter(r for r in comparison.matched.reason if r).most_common():
        yield "", f"{count} without a prediction: {reason}"
    name = "position" if measurement.labelled else "off the part"
    for label, score, unit in (
        (name, scores.position, " mm"),
        ("shear", scores.shear, "°"),
        ("warp", scores.warp, "°"),
        ("weft", scores.weft, "°"),
    ):
        if score is not None:
            yield label, _score(score, unit)
    if scores.chi2_per_dof is not None:
        yield "chi²", f"{scores.chi2_per_dof:.3g} per value (1: nothing but noise)"
    yield from _structure(comparison)
    yield from _trends(comparison)
    yield from _worst(comparison)
    if files:
        yield "files", f"{next(iter(files.values())).parent}: {', '.join(f.name for f in files.values())}"


def _score(score: Score, unit: str) -> str:
    noise = "noise not known" if score.noise is None else f"noise alone {score.noise:.3g}{unit} ({score.source})"
    robust = f", {score.robust_rms:.3g}{unit} without outliers" if score.robust_rms < 0.98 * score.rms else ""
    return f"rms {score.rms:.3g}{unit}{robust}, {noise}"


def _structure(comparison: Comparison) -> Iterator[tuple[str, str]]:
    """Whether the residuals are alike at neighbours: what is not noise."""
    kinds = (("position", comparison.structure.position), ("shear", comparison.structure.shear))
    known = [(kind, found) for kind, found in kinds if found is not None]
    alike = [f"{kind} (Moran's I {found.moran:.2f})" for kind, found in known if found.alike]
    if alike:
        yield "structure", f"neighbours are alike, which noise is not: {', '.join(alike)}"


def _trends(comparison: Comparison) -> Iterator[tuple[str, str]]:
    """The trends that are beyond chance."""
    names = {
        "shear": "predicted shear",
        "distance": "distance from the origin",
        "curvature": "curvature",
        "rim": "distance from the rim",
    }
    clear = [t for t in comparison.trends if t.p is not None and t.rho is not None and t.p < 0.01]
    for k, trend in enumerate(sorted(clear, key=lambda t: t.p or 0.0)):
        verb = "grows" if (trend.rho or 0.0) > 0.0 else "falls"
        numbers = f"rho {trend.rho:+.2f}, p {trend.p:.1g}"
        yield ("goes with" if k == 0 else ""), f"{trend.kind} {verb} with {names[trend.against]} ({numbers})"


def _worst(comparison: Comparison) -> Iterator[tuple[str, str]]:
    from geomdrap.criticism.compare_regions import region_words, unmeasured, worst_regions

    for k, region in enumerate(worst_regions(comparison)):
        yield ("worst" if k == 0 else ""), region_words(region)
    share, _ = unmeasured(comparison)
    if share > 0.02:
        yield "unmeasured", f"{100 * share:.0f} % of the part's area has no measured point nearby"
