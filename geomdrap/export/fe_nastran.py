"""fe.bdf: the ply for Nastran, as the material angle THETA of each shell."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from geomdrap.errors import GeomdrapError
from geomdrap.export.fe_mesh import Deck
from geomdrap.export.fe_read import number
from geomdrap.export.fe_read_nastran import SHELLS
from geomdrap.export.map_onto import ElementPly
from geomdrap.export.whole import write_whole

WIDTH = 8
LONGEST = 99_999_999
"""Greatest number that fits into a field."""
PLAIN_FROM = 1e-3
"""Size from which eight characters hold as many digits without an exponent as with one."""


def write(ply: ElementPly, path: Path, ply_thickness: float | None = None) -> None:
    """Write the deck: a Nastran deck that was read with THETA filled in, else one of nodes and shells in mm.

    The latter has shells of second order by their corners alone (`losses`).

    Angles count from the side 1-2 of the element (G1 to G2) to the warp, about its normal. ``ply_thickness``
    mm goes into comments. Raises GeomdrapError if numbers do not fit or the file cannot be written.
    """
    check_numbers(ply)
    body = filled_in(ply, ply.mesh.deck) if ply.mesh.deck is not None else fresh(ply)
    text = "\n".join([*head(ply, ply_thickness), *body]) + "\n"
    write_whole(path, text.encode("utf-8", errors="surrogateescape"))  # bytes of the user's comments as they were


def check_numbers(ply: ElementPly) -> None:
    """Raise GeomdrapError where a number is longer than a field."""
    mesh = ply.mesh
    most = max(int(numbers.max()) for numbers in (mesh.element_ids, mesh.node_ids, mesh.parts))
    if most > LONGEST:
        raise GeomdrapError(f"{mesh.source}: number {most} does not fit into the 8 columns of a field; renumber it")


def losses(ply: ElementPly) -> list[str]:
    """Sentences on what the deck lacks of a mesh of another format, of which it has nodes and shells only."""
    mesh = ply.mesh
    beside = len(mesh.node_ids) - len(np.unique(mesh.corners[mesh.corners >= 0]))
    if mesh.deck is not None or not mesh.is_given or not beside:
        return []
    return [
        f"fe.bdf has the shells of {mesh.source} by their corners alone: its other nodes, {beside:,} of them, as "
        "in the middle of sides, are there but belong to no element; map onto a Nastran deck to keep them"
    ]


def head(ply: ElementPly, ply_thickness: float | None) -> Iterator[str]:
    """Comments: what this is, and the mean shear and thickness, which the cards have no place for."""
    on = ply.is_draped
    factor = ply.thickness[on]
    yield f"$ Ply on {ply.mesh.source}: THETA runs from side G1-G2 to the warp, about the normal of the element"
    yield f"$ {int(on.sum())} elements with ply, {int((~on).sum())} without (left as they were)"
    yield f"$ thickness factor {factor.min():.4f} to {factor.max():.4f}; per element, with the weft, in acp.csv"
    if ply_thickness is not None:
        yield f"$ thickness {ply_thickness * factor.min():.4f} to {ply_thickness * factor.max():.4f} mm"


def filled_in(ply: ElementPly, deck: Deck) -> Iterator[str]:
    """The lines of the deck, its shells written anew with their angle; everything else as it was."""
    theta = ply.side_angle(ply.warp)
    new = {}
    for k in np.flatnonzero(ply.is_draped).tolist():
        first, last = deck.spans[k]
        fields = [fitted(word, ply.mesh.source, first + 1) for word in deck.fields[k]]
        place = SHELLS[deck.names[k]].theta
        fields += [""] * (place + 1 - len(fields))
        fields[place] = degrees(theta[k])
        new[first] = (last, [*comments(deck.lines[first : last + 1]), *card(deck.names[k], fields)])
    k = 0
    while k < len(deck.lines):
        last, text = new.get(k, (k, [deck.lines[k]]))
        yield from text
        k = last + 1


def comments(lines: Sequence[str]) -> Iterator[str]:
    """What stands behind a dollar sign in the lines of a card."""
    for line in lines:
        _, dollar, words = line.partition("$")
        if dollar:
            yield dollar + words


def fresh(ply: ElementPly) -> Iterator[str]:
    """Nodes and shells, by their corners, as small-field cards."""
    mesh = ply.mesh
    theta = ply.side_angle(ply.warp)
    yield from (f"$ {text}" for text in losses(ply))
    yield "BEGIN BULK"
    for node, (x, y, z) in zip(mesh.node_ids.tolist(), mesh.points.tolist(), strict=True):
        yield from card("GRID", [str(node), "", real(x), real(y), real(z)])
    for k, element in enumerate(mesh.element_ids.tolist()):
        corners = [str(n) for n in mesh.node_ids[mesh.corners[k][mesh.corners[k] >= 0]].tolist()]
        angle = degrees(theta[k]) if ply.is_draped[k] else ""
        name = "CQUAD4" if len(corners) == 4 else "CTRIA3"
        yield from card(name, [str(element), str(mesh.parts[k]), *corners, angle])
    yield "ENDDATA"


def card(name: str, fields: list[str]) -> list[str]:
    """A card in small fields, with continuations."""
    while fields and not fields[-1]:
        fields = fields[:-1]
    lines = []
    for start in range(0, len(fields), 8):
        first = f"{name:<8}" if start == 0 else f"{'+':<8}"
        lines.append((first + "".join(f"{word:>8}" for word in fields[start : start + 8])).rstrip())
    return lines


def degrees(angle: float) -> str:
    """An angle in the three decimals that a field holds of any, without a negative zero."""
    return f"{round(angle, 3) + 0.0:.3f}"


def fitted(word: str, name: str, line: int) -> str:
    """A field of the deck ``name`` in at most eight characters. Raises GeomdrapError where it is no number."""
    if len(word) <= WIDTH:
        return word
    return str(int(word)) if word.isdigit() else real(number(word, name, line))


def real(value: float) -> str:
    """A number with a point in at most eight characters, as exactly as they hold it, with an exponent or without."""
    text = plain(value)
    if text and (abs(value) >= PLAIN_FROM or value == 0.0):
        return text
    texts = [text for text in (text, with_exponent(value)) if text]
    if not texts:
        raise GeomdrapError(f"{value} does not fit into the 8 columns of a field; move the mesh nearer to the origin")
    return min(texts, key=lambda text: abs(number(text, "", 0) - value))


def plain(value: float) -> str:
    """A number with as many decimals as a field holds, as ``.0012346``, ``-474.892``, ``12.``; else nothing."""
    before_point = len(str(int(abs(value)))) if abs(value) >= 1.0 else 0
    for decimals in range(WIDTH - 1 - before_point - (value < 0.0), -1, -1):
        text = f"{value:#.{decimals}f}"
        text = text.replace("0.", ".", 1) if text.startswith(("0.", "-0.")) else text
        if len(text) <= WIDTH:  # else it was rounded up to one digit more
            return text.rstrip("0") if text.strip("-0") != "." else "0."
    return ""


def with_exponent(value: float) -> str:
    """A number with an exponent without its E, as ``1.2346-3``; nothing where a field does not hold it."""
    for decimals in range(WIDTH - 3, -1, -1):
        mantissa, exponent = f"{value:#.{decimals}e}".split("e")
        text = f"{mantissa.rstrip('0')}{int(exponent):+d}"
        if len(text) <= WIDTH:
            return text
    return ""
