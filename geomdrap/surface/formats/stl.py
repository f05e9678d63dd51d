"""STL, binary and ASCII.

Read here, not through trimesh: importing trimesh takes 0.6 s, of 1.5 s for a whole drape, and its reader
takes a broken ASCII file or random bytes for a smaller or an empty part without a word.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from geomdrap.errors import SurfaceError
from geomdrap.surface.formats.raw import RawMesh
from geomdrap.surface.types import Floats

HEADER = 84
RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
CHUNK = 4_000_000
LONGEST_WORD = 64
#: the words of one facet; _ stands for a number
FACET = b"facet normal _ _ _ outer loop vertex _ _ _ vertex _ _ _ vertex _ _ _ endloop endfacet".split()
NAME_LINE = re.compile(rb"^[ \t]*(?:end)?solid\b[^\n]*$", re.MULTILINE | re.IGNORECASE)


def read(path: Path, tolerance: float | None) -> RawMesh:
    """Read an STL file; three points of its own for each triangle.

    Raises SurfaceError for a file that ends early, has broken facets, or is no STL at all.
    """
    size = path.stat().st_size
    with path.open("rb") as file:
        head = file.read(HEADER + 512)
    declared = int.from_bytes(head[80:HEADER], "little") if len(head) >= HEADER else -1
    needed = HEADER + RECORD.itemsize * declared
    text = head.lstrip()[:5].lower() == b"solid"
    if declared >= 0 and size == needed:
        return _binary(path, declared)
    if text and (b"facet" in head.lower() or b"endsolid" in head.lower()):
        return _soup(_ascii(path))
    if declared > 0 and size > needed:
        extra = f"{size - needed:,} bytes after the last facet were ignored"
        return _binary(path, declared, (extra,))
    if text or declared <= 0 or (size - HEADER) / RECORD.itemsize < 0.001 * declared:
        raise SurfaceError(f"{path.name} is not an STL file, or is damaged; export the part again")
    raise SurfaceError(
        f"{path.name} is cut off: its header promises {declared:,} facets, "
        f"it holds {(size - HEADER) // RECORD.itemsize:,}; export or copy it again"
    )


def _binary(path: Path, number: int, notes: tuple[str, ...] = ()) -> RawMesh:
    records = np.fromfile(path, RECORD, count=number, offset=HEADER)
    return _soup(records["corners"].reshape(-1, 3).astype(np.float64), notes)


def _soup(points: Floats, notes: tuple[str, ...] = ()) -> RawMesh:
    return RawMesh(points, np.arange(len(points)).reshape(-1, 3), notes=notes)


def _ascii(path: Path) -> Floats:
    """Corners (3 m, 3) of an ASCII STL, a piece of the file at a time to bound the memory."""
    data = path.read_bytes().replace(b"\r", b"\n")
    if not re.search(rb"endsolid[^\n]*\s*\Z", data[-1000:], re.IGNORECASE):
        raise SurfaceError(f"{path.name} is cut off: it does not end with 'endsolid'; copy it again")
    data = NAME_LINE.sub(b"", data).lower()
    pieces, start, done = [], 0, 0
    while start < len(data):
        at = data.find(b"endfacet", start + CHUNK)
        end = len(data) if at < 0 else at + len(b"endfacet")
        pieces.append(_facets(data[start:end].split(), done, path.name))
        done += len(pieces[-1]) // 3
        start = end
    return np.concatenate(pieces) if pieces else np.empty((0, 3))


def _facets(words: list[bytes], done: int, name: str) -> Floats:
    """Corners of the facets written in these words; done facets came before them."""
    if not words:
        return np.empty((0, 3))
    whole = len(words) // len(FACET)
    if max(map(len, words)) > LONGEST_WORD:  # a table of words as wide as the longest would fill the memory
        whole = next(i for i, word in enumerate(words) if len(word) > LONGEST_WORD) // len(FACET)
    else:
        table = np.array(words[: whole * len(FACET)]).reshape(-1, len(FACET))
        fixed = [i for i, word in enumerate(FACET) if word != b"_"]
        wrong = (table[:, fixed] != np.array(FACET)[fixed]).any(axis=1)
        if whole * len(FACET) == len(words) and not wrong.any():
            return _numbers(table, done, name)
        whole = int(np.flatnonzero(wrong)[0]) if wrong.any() else whole
    raise SurfaceError(
        f"{name}: facet {done + whole + 1} is broken (each needs a normal and three vertices); "
        "export the part again"
    )


def _numbers(table: np.ndarray, done: int, name: str) -> Floats:
    columns = [i for i, word in enumerate(FACET) if word == b"_"][3:]
    try:
        return table[:, columns].astype(np.float64).reshape(-1, 3)
    except ValueError:
        pass
    for i, row in enumerate(table[:, columns]):
        for word in row:
            try:
                float(word)
            except ValueError:
                bad = word.decode("ascii", "replace")
                raise SurfaceError(
                    f"{name}: facet {done + i + 1} has {bad!r} where a number belongs; export the part again"
                ) from None
    raise AssertionError("numpy and Python disagree on what a number is")
