"""compare.json: a comparison with a measurement in one JSON object."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from geomdrap import __version__
from geomdrap.export.report_json import as_text, plain
from geomdrap.export.whole import write_whole

if TYPE_CHECKING:
    from geomdrap.criticism import Comparison
    from geomdrap.criticism.compare_scores import Score
    from geomdrap.criticism.compare_structure import Likeness
    from geomdrap.criticism.compare_trends import Trend

SCHEMA = "geomdrap.compare/1"


def as_dict(comparison: Comparison, files: Mapping[str, str | Path] | None = None) -> dict[str, Any]:
    """Give the JSON object of a comparison (schema ``geomdrap.compare/1``): mm and degrees.

    ``position.rms`` is the root mean square length of the residual vectors and ``position.noise`` what noise alone
    would give: sigma · √3 with fabric coordinates, sigma without, where the residual is the distance from the part.
    ``chi2_per_dof`` is that of all kinds together, without the outliers.
    """
    from geomdrap.criticism.compare_regions import unmeasured, worst_regions

    net, scores, measurement = comparison.net, comparison.scores, comparison.measurement
    share, gaps = unmeasured(comparison)
    return plain(
        {
            "schema": SCHEMA,
            "version": __version__,
            "part": Path(net.surface.source).name,
            "measured": measurement.source,
            "origin": net.origin,
            "angle": net.angle,
            "pitch": net.pitch,
            "points": len(measurement),
            "used": int(comparison.used.sum()),
            "unmatched": int((~comparison.used).sum()),
            "matched_by": "fabric coordinates" if measurement.labelled else "nearest point",
            "position": _position(comparison),
            "shear": _score(scores.shear),
            "directions": _directions(comparison),
            "chi2_per_dof": scores.chi2_per_dof,
            "worst": [asdict(region) for region in worst_regions(comparison)],
            "structure": {
                "position": _likeness(comparison.structure.position),
                "shear": _likeness(comparison.structure.shear),
            },
            "trends": [_trend(trend) for trend in comparison.trends],
            "outliers": [_outlier(outlier) for outlier in comparison.outliers],
            "unmatched_points": _unmatched(comparison),
            "unmatched_reasons": dict(sorted(Counter(r for r in comparison.matched.reason if r).items())),
            "unmeasured": {"share": share, "patches": [asdict(gap) for gap in gaps]},
            "warnings": list(comparison.warnings),
            "notes": list(comparison.notes),
            "files": {key: str(name) for key, name in (files or {}).items()},
        }
    )


def write(comparison: Comparison, path: Path, files: Mapping[str, str | Path] | None = None) -> None:
    """Write compare.json: no date, path or timing in it. Of ``files`` only the names are kept."""
    names = {key: Path(file).name for key, file in (files or {}).items()}
    write_whole(path, as_text(as_dict(comparison, names)))


def _score(score: Score | None) -> dict[str, Any] | None:
    if score is None:
        return None
    chi2 = score.chi2 / score.dof if score.chi2 is not None and score.dof else None
    return {
        "rms": score.rms,
        "noise": score.noise,
        "sigma": score.sigma,
        "noise_from": score.source,
        "robust_rms": score.robust_rms,
        "n": score.n,
        "chi2_per_dof": chi2,
        "bias": score.bias[0] if len(score.bias) == 1 else list(score.bias),
    }


def _position(comparison: Comparison) -> dict[str, Any] | None:
    """The score of the positions, with the root mean square of each component."""
    score = _score(comparison.scores.position)
    if score is None:
        return None
    parts = comparison.parts[comparison.used]
    rms = np.sqrt(np.mean(parts**2, axis=0))
    labelled, bias = comparison.measurement.labelled, score.pop("bias")
    kind = "vector" if labelled else "normal distance"
    return {
        **score,
        "kind": kind,
        "bias": _by_yarn(bias, labelled) if bias else None,
        "rms_along": _by_yarn(rms, labelled),
    }


def _by_yarn(values: Sequence[float], labelled: bool) -> dict[str, float | None]:
    """Components by name; those along the yarns are not measured without fabric coordinates."""
    named = zip(("warp", "weft", "normal"), values, strict=True)
    return {name: value if labelled or name == "normal" else None for name, value in named}


def _directions(comparison: Comparison) -> dict[str, Any] | None:
    scores = comparison.scores
    if scores.warp is None and scores.weft is None:
        return None
    return {"warp": _score(scores.warp), "weft": _score(scores.weft)}


def _likeness(likeness: Likeness | None) -> dict[str, Any] | None:
    return None if likeness is None else asdict(likeness)


def _trend(trend: Trend) -> dict[str, Any]:
    return {
        "kind": trend.kind,
        "against": trend.against,
        "rho": trend.rho,
        "p": trend.p,
        "independent": trend.independent,
        "bins": [
            {"from": a, "to": b, "n": n, "rms": rms, "mean": mean}
            for a, b, n, rms, mean in zip(
                trend.edges[:-1], trend.edges[1:], trend.n, trend.rms, trend.mean, strict=True
            )
        ],
    }


def _outlier(outlier: Any) -> dict[str, Any]:
    return {
        "line": outlier.line,
        "kind": outlier.kind,
        "size": outlier.size,
        "sigmas": outlier.sigmas,
        "label_off_by": list(outlier.shift) if outlier.shift else None,
    }


def _unmatched(comparison: Comparison) -> list[dict[str, Any]]:
    """Line, place and reason of each point without a prediction."""
    measurement, reasons = comparison.measurement, comparison.matched.reason
    return [
        {"line": int(measurement.row[k]), "position": measurement.points[k], "reason": reason}
        for k, reason in enumerate(reasons)
        if reason
    ]
