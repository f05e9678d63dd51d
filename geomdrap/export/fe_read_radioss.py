"""Shells of a Radioss starter file: /NODE, /SHELL and /SH3N blocks, in columns of ten and twenty characters."""

from __future__ import annotations

from collections.abc import Sequence

from geomdrap.errors import GeomdrapError
from geomdrap.export.fe_mesh import Elements, FeMesh, Nodes, assemble
from geomdrap.export.fe_read import number, whole

CORNERS = {"SHELL": 4, "SH3N": 3}
SOLIDS = ("BRICK", "BRIC20", "TETRA4", "TETRA10", "PENTA6", "SHEL16", "QUAD", "TRIA")
"""Elements that could be taken for the laminate, and are not read."""


def read(name: str, lines: Sequence[str]) -> FeMesh:
    """The nodes and shells of the file. Raises GeomdrapError."""
    nodes: Nodes = {}
    elements: Elements = []
    keyword, part = "", 1
    others = set()
    for count, line in enumerate(lines, start=1):
        if line.lower().startswith("#include"):
            raise GeomdrapError(f"{name} includes another file; write the mesh of the part to one file")
        if line.startswith(("#", "$")) or not line.strip():
            continue
        if line.startswith("/"):
            words = [word.strip() for word in line[1:].split("/")]
            keyword = words[0].upper()
            others.update({keyword} & set(SOLIDS))
            part = whole(words[1], name, count) if keyword in CORNERS and len(words) > 1 else 1
        elif keyword == "NODE":
            x, y, z = (number(line[10 + 20 * k : 30 + 20 * k], name, count) for k in range(3))
            nodes[whole(line[:10], name, count)] = (x, y, z)
        elif keyword in CORNERS:
            columns = [line[10 * k : 10 * k + 10] for k in range(1 + CORNERS[keyword])]
            number_of, *corners = (whole(word, name, count) for word in columns)
            elements.append((number_of, part, tuple(corners)))
    return assemble(name, nodes, elements, others=others)
