"""Shells of an Abaqus input file: *NODE and *ELEMENT of one part."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from geomdrap.errors import GeomdrapError
from geomdrap.export.fe_mesh import Elements, FeMesh, Nodes, assemble
from geomdrap.export.fe_read import number, whole

SHELL = re.compile(r"(S|STRI|M3D|SFM3D)(3|4|6|8|9|65)(R|RS|RT|T|R5|R5T|SW)?$")
"""Shells, membranes and surfaces, by their element types; the number is that of their nodes."""
TRIANGLES = {"3": 3, "6": 6, "65": 6}
"""Numbers in the types of triangles → nodes; others have four corners."""
REFUSED = {
    "INCLUDE": "includes another file",
    "NGEN": "generates nodes",
    "ELGEN": "generates elements",
    "NCOPY": "copies nodes",
    "ELCOPY": "copies elements",
    "SYSTEM": "has nodes in a system of their own",
}
SCOPES = ("PART", "END PART", "ASSEMBLY", "INSTANCE", "END INSTANCE")
"""Keywords after which numbers of nodes and elements begin anew."""


def read(name: str, lines: Sequence[str]) -> FeMesh:
    """The nodes and shells of the file. Raises GeomdrapError."""
    parts: list[tuple[Nodes, Elements]] = [({}, [])]
    others = set()
    for keyword, options, data in blocks(lines):
        refuse(name, keyword, options, data)
        kind = SHELL.match(options.get("TYPE", "").upper())
        if keyword in SCOPES:
            parts.append(({}, []))
        elif keyword == "NODE":
            parts[-1][0].update(read_nodes(name, data))
        elif keyword == "ELEMENT" and kind is not None:
            parts[-1][1].extend(read_elements(name, kind[2], data))
        elif keyword == "ELEMENT":
            others.add(options.get("TYPE", "no type").upper())
    with_shells = [part for part in parts if part[1]]
    if len(with_shells) > 1:
        raise GeomdrapError(f"{name} holds {len(with_shells)} parts with shells; write one part to a file of its own")
    return assemble(name, *(with_shells[0] if with_shells else parts[0]), others=others)


def blocks(lines: Sequence[str]) -> Iterator[tuple[str, dict[str, str], list[tuple[int, str]]]]:
    """Keyword, its options in capitals, and its numbered data lines."""
    keyword = ""
    options: dict[str, str] = {}
    data: list[tuple[int, str]] = []
    for count, line in enumerate(lines, start=1):
        if line.startswith("**") or not line.strip():
            continue
        if not line.startswith("*"):
            data.append((count, line))
            continue
        if keyword:
            yield keyword, options, data
        head, *rest = (word.strip() for word in line[1:].split(","))
        keyword, data = head.upper(), []
        options = {k.strip().upper(): v.strip() for k, _, v in (word.partition("=") for word in rest)}
    if keyword:
        yield keyword, options, data


def refuse(name: str, keyword: str, options: dict[str, str], data: list[tuple[int, str]]) -> None:
    """Raise GeomdrapError for what would give other coordinates or numbers than those that are read."""
    if keyword in REFUSED or ("INPUT" in options and keyword in ("NODE", "ELEMENT")):
        why = REFUSED.get(keyword, "reads nodes or elements from another file")
        raise GeomdrapError(f"{name} {why} (*{keyword}); write the mesh of the part to one flat file")
    if keyword == "NODE" and options.get("SYSTEM", "R").upper() != "R":
        raise GeomdrapError(f"{name}: *NODE with SYSTEM={options['SYSTEM']}; write rectangular coordinates")
    if keyword == "INSTANCE" and any(number(x, name, count) for count, text in data for x in text.split(",")):
        raise GeomdrapError(f"{name}: the instance {options.get('NAME', '')} is moved; write the part where it lies")


def read_nodes(name: str, data: list[tuple[int, str]]) -> Nodes:
    """Nodes by number; missing coordinates are 0, as the format has it."""
    out = {}
    for count, line in data:
        words = line.split(",")
        x, y, z = (number(word, name, count) for word in [*words[1:4], "", "", ""][:3])
        out[whole(words[0], name, count)] = (x, y, z)
    return out


def read_elements(name: str, size: str, data: list[tuple[int, str]]) -> Elements:
    """Elements with their corners; a line that ends with a comma goes on in the next."""
    corners = 3 if size in TRIANGLES else 4
    per_element = TRIANGLES.get(size, int(size))
    out: Elements = []
    words: list[int] = []
    for count, line in data:
        words += [whole(word, name, count) for word in line.split(",") if word.strip()]
        if len(words) > per_element:
            out.append((words[0], 1, tuple(words[1 : 1 + corners])))
            words = []
    return out
