"""Reads the finite element mesh that a ply is mapped onto, by the ending of its name."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import NamedTuple

from geomdrap.errors import GeomdrapError
from geomdrap.export.fe_mesh import FeMesh


class Format(NamedTuple):
    """A solver's files: module with ``read(name, lines) -> FeMesh``; the output that is written for such a mesh."""

    reader: str
    output: str


FORMATS = {
    ".inp": Format("fe_read_abaqus", "abaqus"),
    ".bdf": Format("fe_read_nastran", "nastran"),
    ".nas": Format("fe_read_nastran", "nastran"),
    ".dat": Format("fe_read_nastran", "nastran"),
    ".fem": Format("fe_read_nastran", "optistruct"),
    ".rad": Format("fe_read_radioss", "radioss"),
}
"""By the ending of the file's name."""


def read_fe_mesh(path: str | Path) -> FeMesh:
    """Shells of an Abaqus, Nastran, OptiStruct or Radioss deck, in mm, with the deck's own numbers.

    Raises GeomdrapError, in one sentence, for whatever keeps the file from being read.
    """
    path = Path(path)
    kind = FORMATS.get(path.suffix.lower())
    if kind is None:
        known = ", ".join(FORMATS)
        raise GeomdrapError(f"{path.name}: a ply is mapped onto meshes in {known} files, not '{path.suffix}'")
    try:
        text = path.read_text(encoding="utf-8", errors="surrogateescape")  # comments may be in any encoding
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise GeomdrapError(f"{path} cannot be read ({reason}); check the name of the mesh") from None
    lines = text.removesuffix("\n").split("\n")  # not splitlines, which splits at form feeds too
    mesh: FeMesh = import_module(f"geomdrap.export.{kind.reader}").read(path.name, lines)
    return mesh


def number(text: str, name: str, line: int) -> float:
    """A real number as solvers write it, also ``1.5-3`` and ``1.D5``; blank is 0. Raises GeomdrapError."""
    word = text.strip().upper().replace("D", "E")
    if not word:
        return 0.0
    sign = max(word.rfind("+"), word.rfind("-"))
    if sign > 0 and word[sign - 1] not in "E+-":
        word = f"{word[:sign]}E{word[sign:]}"
    try:
        return float(word)
    except ValueError:
        raise GeomdrapError(f"{name}, line {line}: '{text.strip()}' is not a number; export the mesh again") from None


def whole(text: str, name: str, line: int) -> int:
    """A whole number. Raises GeomdrapError."""
    try:
        return int(text)
    except ValueError:
        raise GeomdrapError(
            f"{name}, line {line}: '{text.strip()}' is not a whole number; export the mesh again"
        ) from None
