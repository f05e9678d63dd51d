"""The written parts of report.html: heading, numbers, notices, tables; plain HTML that needs no script."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from geomdrap import __version__
from geomdrap.export import palette
from geomdrap.export.report_histogram import histogram
from geomdrap.export.report_json import absent_counts, is_incomplete
from geomdrap.fields.evaluate import MOST_RESIDUAL
from geomdrap.fields.figures import least_blank

if TYPE_CHECKING:
    from geomdrap.fields import Drape
    from geomdrap.fields.strips import Roll

EDGE_ERROR = 1e-4
"""Share of the pitch by which a side may be too long, and still be called right."""
OFF_SURFACE = 0.01
"""Share of the pitch by which a node may lie off the part."""
STOPS = 24
"""Of the colour scales drawn by the style sheet."""


def escaped(text: object) -> str:
    """Text for HTML."""
    return escape(str(text), quote=True)


def header(result: Drape) -> str:
    """Part, seed and heading, and the two verdicts."""
    net = result.net
    name = escaped(Path(net.surface.source).name)
    where = f"draped from ({coordinates(net.origin)}), warp at {net.angle:g}°, pitch {net.pitch:.4g} mm"
    over = result.statistics.over_limit
    badges = (
        badge(is_incomplete(result), "not covered in full", "covered in full"),
        badge(over > 0.0, f"{percent(over)} over {result.limit_angle:g}°", f"all under {result.limit_angle:g}°"),
    )
    return f'<header><h1>{name}</h1><p>{where}</p><div class="badges">{"".join(badges)}</div></header>'


def badge(is_bad: bool, bad: str, good: str) -> str:
    """A verdict in a word or two."""
    return f'<span class="badge bad">{bad}</span>' if is_bad else f'<span class="badge good">{good}</span>'


def notices(result: Drape) -> str:
    """Warnings, if there are any: they come before everything else."""
    if not result.warnings:
        return ""
    items = "".join(f"<li>{escaped(text)}</li>" for text in result.warnings)
    return f'<section class="card notice" role="alert"><h2>Look at this first</h2><ul>{items}</ul></section>'


def tiles(result: Drape) -> str:
    """The numbers that are asked for first."""
    shear, areas = result.statistics, result.area
    facts = (
        (percent(areas.coverage), "of the part covered"),
        (f"{shear.max:.2f}°", f"largest shear, limit {result.limit_angle:g}°"),
        (f"{shear.p95:.2f}°", "on 95 % of the area at most"),
        (percent(shear.over_limit), "of the area over the limit"),
        (area(areas.fabric), "of fabric"),
        pattern_tile(result),
    )
    return '<section class="tiles">' + "".join(
        f'<div class="card tile"><b>{value}</b><span>{words}</span></div>' for value, words in facts
    ) + "</section>"


def pattern_tile(result: Drape) -> tuple[str, str]:
    """The rectangle that the pattern is cut from; that there is none."""
    if not result.flat.outer:
        return "none", "flat pattern: no fabric lies on the part"
    return pattern_size(result).removesuffix(" mm"), "mm, rectangle to cut it from"


def pattern_size(result: Drape) -> str:
    """Width and height of the flat pattern, along warp and weft."""
    if not result.flat.outer:
        return "no pattern"
    width, height = least_blank(result.net, result.trimmed)
    return f"{width:.4g} × {height:.4g} mm"


def legend(result: Drape) -> str:
    """Scales of the three ways of colouring; the style sheet shows the one that is chosen."""
    limit, top = result.limit_angle, palette.top_of_scale(result.statistics.max, result.limit_angle)
    plain = ramp(palette.continuous_table(), ticks(0.0, top, limit), [limit / top])
    both = ramp(palette.diverging_table(), ticks(-top, top, limit), [0.5 - limit / top / 2, 0.5 + limit / top / 2])
    names = ((f"under {limit / 2:g}°", "low"), (f"to {limit:g}°", "middle"), (f"over {limit:g}°", "high"))
    swatches = [f'<span><i style="background:var(--{key})"></i>{words}</span>' for words, key in names]
    return (
        '<div id="legend" data-mode="shear">'
        f'<div class="scale of-shear">shear, without its sign{plain}</div>'
        f'<div class="scale of-signed">shear with its sign{both}</div>'
        f'<div class="scale of-classes swatches">{"".join(swatches)}</div></div>'
    )


def ticks(low: float, high: float, limit: float) -> list[tuple[float, str]]:
    """Places 0 to 1 on a scale and their words: ends, middle and the limit, where they do not run into each other."""
    marks = [(0.0, f"{low:g}°"), (1.0, f"{high:g}°")]
    for value, words in ((limit, f"limit {limit:g}°"), (-limit, f"−{limit:g}°"), (0.5 * (low + high), "")):
        place = (value - low) / (high - low)
        if 0.0 < place < 1.0 and all(abs(place - other) > 0.17 for other, _ in marks):
            marks.append((place, words or f"{value:g}°"))
    return sorted(marks)


def ramp(table: np.ndarray, marks: Sequence[tuple[float, str]], limits: Iterable[float]) -> str:
    """A colour scale with the limit marked, and words under it."""
    rows = np.rint(255 * table[np.linspace(0, len(table) - 1, STOPS).astype(int)]).astype(int).tolist()
    colours = ",".join(f"rgb({r},{g},{b})" for r, g, b in rows)
    lines = "".join(f'<i style="left:{100 * x:.2f}%"></i>' for x in limits if 0.0 < x < 1.0)
    words = "".join(f'<span style="left:{100 * x:.2f}%">{text}</span>' for x, text in marks)
    back = f"background:linear-gradient(90deg,{colours})"
    return f'<div class="ramp" style="{back}">{lines}</div><div class="ticks">{words}</div>'


def cards(result: Drape, command: str) -> str:
    """The tables below the views."""
    parts = [
        card("Shear", table(shear_rows(result)) + histogram(result)),
        card("Areas", table(area_rows(result))),
        *([card("Roll", table(roll_rows(result.roll)))] if result.roll is not None else []),
        bare_card(result),
        card("Checks", table(check_rows(result))),
        card("Settings", table(setting_rows(result))),
    ]
    if command:
        copy = '<button type="button" id="copy">Copy</button>'
        words = f'<div class="command"><code id="command">{escaped(command)}</code>{copy}</div>'
        parts.append(card("The command that made it", words))
    return "\n".join(parts)


def card(title: str, body: str) -> str:
    """A titled box."""
    return f'<section class="card"><h2>{title}</h2>{body}</section>'


def table(rows: Iterable[tuple[str, str, str]]) -> str:
    """Rows of a label, a number and a remark in small letters (may be empty)."""
    lines = []
    for label, value, remark in rows:
        lines.append(f'<tr><td>{label}</td><td class="number">{value}</td></tr>')
        if remark:
            lines.append(f'<tr class="remark"><td colspan="2">{remark}</td></tr>')
    return f"<table>{''.join(lines)}</table>"


def shear_rows(result: Drape) -> Iterator[tuple[str, str, str]]:
    """Statistics of the shear."""
    shear, limit = result.statistics, result.limit_angle
    thicker = 1.0 / np.cos(np.radians(min(shear.max, 89.9)))
    yield "largest", f"{shear.max:.2f}°", f"the fabric is {thicker:.2f} times as thick there"
    yield "95 % of the area below", f"{shear.p95:.2f}°", ""
    yield "mean", f"{shear.mean:.2f}°", ""
    yield f"over half the limit, {limit / 2:g}°", percent(shear.over_half_limit), "of the draped area"
    yield f"over the limit, {limit:g}°", percent(shear.over_limit), "of the draped area"


def area_rows(result: Drape) -> Iterator[tuple[str, str, str]]:
    """Areas, and what is left of the rectangle that the pattern is cut from."""
    areas = result.area
    yield "part", area(areas.part), ""
    yield "draped", area(areas.draped), f"{percent(areas.coverage)} of the part"
    yield "fabric", area(areas.fabric), "the flat pattern"
    if result.flat.outer:
        width, height = least_blank(result.net, result.trimmed)
        blank = width * height
        yield "rectangle", area(blank), f"{pattern_size(result)}; {percent(1 - areas.fabric / blank)} of it is waste"


def roll_rows(roll: Roll) -> Iterator[tuple[str, str, str]]:
    """The strips that the pattern is laid from, and the seams between them (green in both views)."""
    yield "roll", f"{roll.width:g} mm wide", f"strips overlap by {roll.overlap:g} mm" if roll.overlap > 0.0 else ""
    yield "used", f"{roll.length:.1f} mm", f"{percent(roll.waste)} of it is waste"
    for number, strip in enumerate(roll.strips, start=1):
        yield f"strip {number}", f"{strip.length:.1f} mm", f"v from {strip.v[0]:.1f} to {strip.v[1]:.1f} mm"
    if not roll.seams:
        yield "seams", "none", ""
    for seam in roll.seams:
        words = f"{seam.length:.1f} mm long, crosses shear up to {seam.max_shear:.2f}°"
        yield "seam", f"v = {seam.v:.1f} mm", words


def bare_card(result: Drape) -> str:
    """Bare regions with their reasons, each with a button that shows it; and why nodes are absent."""
    if not result.bare:
        body = "<p>None: the ply covers the part.</p>"
    else:
        rows = [
            f'<tr><td>{area(r.area)} at ({coordinates(r.center)})</td>'
            f'<td class="number"><button type="button" data-bare="{n}">Show</button></td></tr>'
            f'<tr class="remark"><td colspan="2">{escaped(r.reason)}</td></tr>'
            for n, r in enumerate(result.bare)
        ]
        body = f"<table>{''.join(rows)}</table>"
    counts = absent_counts(result)
    if counts:
        words = ", ".join(f"{number:,} {escaped(reason)}" for reason, number in counts.items())
        body += f'<p class="keys">Nodes that were tried and are absent: {words}.</p>'
    return card("Bare regions", body)


def check_rows(result: Drape) -> Iterator[tuple[str, str, str]]:
    """How well the net keeps its promises, each with a verdict."""
    checks, pitch = result.checks, result.net.pitch
    yield (
        "sides of cells" + verdict(checks.edge_error <= EDGE_ERROR),
        f"{checks.edge_error:.1g}",
        "of the pitch, by which the worst is too long: yarns must not stretch",
    )
    yield (
        "nodes on the part" + verdict(checks.off_surface <= OFF_SURFACE * pitch),
        f"{checks.off_surface:.1g} mm",
        "by which the worst lies off it",
    )
    if checks.curvature_residual is None:
        yield "shear against curvature", "not made", "yarns that are no geodesics, or no node with a whole rectangle"
    else:
        yield (
            "shear against curvature" + verdict(checks.curvature_residual <= MOST_RESIDUAL),
            f"{checks.curvature_residual:.2g}°",
            "between shear and the curvature that the net encloses (Gauss-Bonnet), 95 % below",
        )


def verdict(is_good: bool) -> str:
    """Whether a check was passed, in a word."""
    return ' <span class="badge good">right</span>' if is_good else ' <span class="badge bad">look</span>'


def setting_rows(result: Drape) -> Iterator[tuple[str, str, str]]:
    """What was draped, and how."""
    net = result.net
    low, high = net.surface.bounds
    yield "part", escaped(Path(net.surface.source).name), f"{len(net.surface.triangles):,} facets"
    yield "size", " × ".join(f"{x:.4g}" for x in high - low) + " mm", ""
    yield "origin", coordinates(net.origin, 2), "where the ply touches first"
    yield "normal there", coordinates(net.normal0, 3), "the ply is seen from this side"
    yield "warp", f"{net.angle:g}°", f"runs along ({coordinates(net.warp0, 3)}) at the origin"
    yield "pitch", f"{net.pitch:.6g} mm", f"{int(np.isfinite(net.points[..., 0]).sum()):,} nodes"
    if net.reach is not None:
        yield "blank", f"{2 * net.reach[0]:.6g} × {2 * net.reach[1]:.6g} mm", "along warp × along weft"
    for effect in net.effects:
        values = ", ".join(f"{name} = {value:g}" for name, value in getattr(effect, "values", {}).items())
        yield "effect", escaped(effect.title()), escaped(values)
    for note in net.notes:
        yield "note", "", escaped(note)
    yield "made with", f"geomdrap {__version__}", ""


def coordinates(values: Iterable[float], places: int = 1) -> str:
    """Numbers with commas between, without negative zeros."""
    return ", ".join(f"{round(float(x), places) + 0.0:.{places}f}" for x in values)


def percent(share: float) -> str:
    """A share 0 to 1 in percent."""
    return f"{100 * share:.2f} %"


def area(square_mm: float) -> str:
    """An area in the unit that reads best."""
    return f"{square_mm / 1e6:.4f} m²" if square_mm >= 1e5 else f"{square_mm:,.0f} mm²"
