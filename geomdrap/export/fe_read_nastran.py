"""Shells of a Nastran or OptiStruct bulk data file, in free, small and large fields."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from geomdrap.errors import GeomdrapError
from geomdrap.export.fe_mesh import Deck, FeMesh, Nodes, assemble
from geomdrap.export.fe_read import number, whole

MOST = 8
"""Data fields that a line may have."""


class Kind(NamedTuple):
    """A shell's card: number of corners, and the place of THETA or MCID among the fields after the name."""

    corners: int
    theta: int


SHELLS = {
    "CTRIA3": Kind(3, 5),
    "CTRIAR": Kind(3, 5),
    "CTRIA6": Kind(3, 8),
    "CQUAD4": Kind(4, 6),
    "CQUADR": Kind(4, 6),
    "CQUAD8": Kind(4, 14),
}


SOLIDS = ("CTETRA", "CPYRAM", "CPYRA", "CPENTA", "CHEXA", "CTRIAX", "CTRIAX6", "CQUADX", "CSHEAR", "CTRIA2", "CQUAD")
"""Elements that could be taken for the laminate, and are not read."""


class Card(NamedTuple):
    """A card: name, fields after it without blanks around, first and last line (from 0)."""

    name: str
    fields: tuple[str, ...]
    first: int
    last: int

    def field(self, place: int) -> str:
        """A field, blank where the card is shorter."""
        return self.fields[place] if place < len(self.fields) else ""


def read(name: str, lines: Sequence[str]) -> FeMesh:
    """Nodes, shells, and the angle or the coordinate system that their material axes have. Raises GeomdrapError."""
    nodes: Nodes = {}
    shells: list[Card] = []
    systems: dict[int, Card] = {}
    others = set()
    for card in cards(name, lines):
        if card.name == "GRID":
            nodes.update([read_grid(name, card)])
        elif card.name in SHELLS:
            shells.append(card)
        elif card.name in SOLIDS:
            others.add(card.name)
        elif card.name == "CORD2R":
            systems[whole(card.field(0), name, card.first + 1)] = card
        elif card.name == "INCLUDE":
            raise GeomdrapError(f"{name} includes another file; write the mesh of the part to one file")
    angle, axis = material_axes(name, shells, systems)
    return assemble(
        name,
        nodes,
        [read_shell(name, card) for card in shells],
        material_angle=angle,
        material_axis=axis,
        others=others,
        deck=Deck(
            tuple(lines),
            tuple((card.first, card.last) for card in shells),
            tuple(card.name for card in shells),
            tuple(card.fields for card in shells),
        ),
    )


def cards(source: str, lines: Sequence[str]) -> Iterator[Card]:
    """The cards of the bulk data, with their continuations. Raises GeomdrapError for a line with too many fields."""
    name, fields, first, last = "", [], 0, 0
    begin = next((k + 1 for k, line in enumerate(lines) if line.upper().split()[:2] == ["BEGIN", "BULK"]), 0)
    for k in range(begin, len(lines)):
        text = lines[k].split("$")[0].rstrip()
        if not text:
            continue
        head, words, beyond = split(text)
        if beyond:
            raise GeomdrapError(f"{source}, line {k + 1} has more than {MOST} fields; continue on a line of its own")
        if (not head or head[0] in "+*") and name:
            fields += words
            last = k
            continue
        if name:
            yield Card(name, tuple(fields), first, last)
        if head.upper() == "ENDDATA":
            return
        name, fields, first, last = head.upper(), words, k, k
    if name:
        yield Card(name, tuple(fields), first, last)


def split(text: str) -> tuple[str, list[str], bool]:
    """The first field without its asterisk, 8 (large fields: 4) data fields, and whether a line has more."""
    if text.upper().startswith("INCLUDE"):
        return "INCLUDE", [], False
    beyond = False
    if "," in text:
        head, *words = (word.strip() for word in text.split(","))
        most = MOST // 2 if "*" in head else MOST
        beyond = any(words[most + 1 :])  # the one after the last names the continuation
        words = (words + [""] * most)[:most]
    else:
        text = text.expandtabs(8)
        head = text[:8].strip()
        width = 16 if "*" in head else 8
        words = [text[8 + k * width : 8 + (k + 1) * width].strip() for k in range(64 // width)]
    return head.rstrip("*") or head, words, beyond


def read_grid(name: str, card: Card) -> tuple[int, tuple[float, float, float]]:
    """A node; in the basic system only."""
    line = card.first + 1
    if card.field(1) not in ("", "0"):
        raise GeomdrapError(
            f"{name}, line {line}: a GRID in coordinate system {card.field(1)}; write nodes in the basic system"
        )
    x, y, z = (number(card.field(k), name, line) for k in (2, 3, 4))
    return whole(card.field(0), name, line), (x, y, z)


def read_shell(name: str, card: Card) -> tuple[int, int, tuple[int, ...]]:
    """Number, property and corners of a shell; a blank property is the element's number."""
    line = card.first + 1
    element = whole(card.field(0), name, line)
    part = whole(card.field(1), name, line) if card.field(1) else element
    return element, part, tuple(whole(card.field(2 + k), name, line) for k in range(SHELLS[card.name].corners))


def material_axes(name: str, shells: Sequence[Card], systems: dict[int, Card]) -> tuple[np.ndarray, np.ndarray]:
    """Angle (m,) from side 1-2 by THETA, and direction (m, 3) by MCID, NaN where it is THETA that counts."""
    angle, axis = np.zeros(len(shells)), np.full((len(shells), 3), np.nan)
    known: dict[int, np.ndarray] = {0: np.array([1.0, 0.0, 0.0])}
    for k, card in enumerate(shells):
        word = card.field(SHELLS[card.name].theta)
        if word.isdigit():
            system = int(word)
            if system not in known:
                known[system] = x_axis(name, system, systems, card)
            axis[k] = known[system]
        else:
            angle[k] = number(word, name, card.first + 1)
    return angle, axis


def x_axis(name: str, system: int, systems: dict[int, Card], shell: Card) -> np.ndarray:
    """The x direction (3,) of a CORD2R: from A towards C, across the z axis AB."""
    card = systems.get(system)
    if card is None or card.field(1) not in ("", "0"):
        raise GeomdrapError(
            f"{name}, line {shell.first + 1}: the material axis is in system {system}, which is no CORD2R in "
            "the basic system of this file; use THETA, or such a system"
        )
    values = [number(card.field(2 + k), name, card.first + 1) for k in range(9)]
    a, b, c = np.array(values).reshape(3, 3)
    x = (c - a) * ((b - a) @ (b - a)) - ((c - a) @ (b - a)) * (b - a)
    if not x.any():
        raise GeomdrapError(f"{name}, line {card.first + 1}: CORD2R {system} has no x axis; give three points apart")
    return np.asarray(x / np.linalg.norm(x))
