"""Small meshes as decks of each solver, and readers of what is written, made from the manuals and not from the code."""

from __future__ import annotations

import re

import numpy as np

FIRST_NODE, FIRST_ELEMENT = 1001, 501


def grid(nx, ny, size, turn=0.0, height=lambda x, y: 0.0 * x):
    """Points (n, 3) and quads (m, 4) of a sheet nx × ny, ``size`` mm across; every third quad is turned over."""
    x, y = np.meshgrid(np.linspace(-0.5, 0.5, nx + 1) * size, np.linspace(-0.5, 0.5, ny + 1) * size, indexing="ij")
    c, s = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    x, y = c * x - s * y, s * x + c * y
    points = np.stack([x, y, height(x, y)], axis=-1).reshape(-1, 3)
    i, j = (k.ravel() for k in np.meshgrid(np.arange(nx), np.arange(ny), indexing="ij"))
    a = i * (ny + 1) + j
    quads = np.stack([a, a + ny + 1, a + ny + 2, a + 1], axis=1)
    quads[::3] = quads[::3, ::-1]
    return points, quads


def abaqus(points, quads, first_element=FIRST_ELEMENT):
    lines = ["*HEADING", "a test", "** comment", "*NODE, NSET=ALL"]
    lines += [f"{FIRST_NODE + k}, {x:.9g}, {y:.9g}, {z:.9g}" for k, (x, y, z) in enumerate(points)]
    lines += ["*ELEMENT, TYPE=S4R, ELSET=SHELLS"]
    lines += [f"{first_element + k}, " + ", ".join(str(FIRST_NODE + n) for n in q) for k, q in enumerate(quads)]
    return "\n".join([*lines, "*MATERIAL, NAME=M", "*ELASTIC", "1., 0.3"]) + "\n"


def nastran(points, quads, theta=""):
    lines = ["SOL 101", "CEND", "BEGIN BULK", "$ nodes", "MAT1,1,70000.,,0.33", "PSHELL         7       1      1."]
    for k, (x, y, z) in enumerate(points):
        lines += [f"{'GRID*':<8}{FIRST_NODE + k:>16}{'':>16}{x:>16.9g}{y:>16.9g}*", f"{'*':<8}{z:>16.9g}"]
    for k, q in enumerate(quads):
        corners = "".join(f"{FIRST_NODE + n:>8}" for n in q)
        lines.append(f"{'CQUAD4':<8}{FIRST_ELEMENT + k:>8}{7:>8}{corners}{theta:>8}{'0.25':>8}")
    return "\n".join([*lines, "ENDDATA"]) + "\n"


def radioss(points, quads):
    lines = ["#RADIOSS STARTER", "/BEGIN", "test", "/NODE"]
    lines += [f"{FIRST_NODE + k:>10}{x:>20.9g}{y:>20.9g}{z:>20.9g}" for k, (x, y, z) in enumerate(points)]
    lines += ["/SHELL/3", "# shell_ID   node_ID1"]
    lines += [
        f"{FIRST_ELEMENT + k:>10}" + "".join(f"{FIRST_NODE + n:>10}" for n in q) for k, q in enumerate(quads)
    ]
    return "\n".join([*lines, "/END"]) + "\n"


def abaqus_blocks(text):
    """(keyword line, data lines) of a file, comments left out."""
    out = []
    for line in text.splitlines():
        if line.startswith("**"):
            continue
        if line.startswith("*"):
            out.append((line, []))
        else:
            out[-1][1].append(line)
    return out


def abaqus_axes(text, orientation):
    """Default and {element: (a, b)} of the distribution that an orientation of the file uses, per the keyword manual."""
    blocks = abaqus_blocks(text)
    head, data = next(b for b in blocks if b[0].startswith("*ORIENTATION") and f"NAME={orientation}," in b[0])
    assert "SYSTEM=RECTANGULAR" in head
    assert data[1].replace(" ", "") == "3,0."  # additional turn about axis 3
    head, rows = next(b for b in blocks if b[0].startswith("*DISTRIBUTION,") and f"NAME={data[0]}," in b[0])
    assert "LOCATION=ELEMENT" in head
    table = re.search(r"TABLE=(\w+)", head)[1]
    _, columns = next(b for b in blocks if b[0].startswith("*DISTRIBUTION TABLE") and b[0].endswith(f"NAME={table}"))
    assert columns == ["COORD3D, COORD3D"]
    assert rows[0].startswith(",")  # the default comes first, without a label
    numbers = {int(r.split(",")[0]): np.array(r.split(",")[1:], float) for r in rows[1:]}
    return {n: (v[:3], v[3:]) for n, v in numbers.items()}


def fixed_fields(line):
    """The fields of a small-field Nastran card, eight columns each."""
    return [line[k : k + 8].strip() for k in range(0, len(line), 8)]


def nastran_theta(text):
    """{element: (name, fields)} of the shells in small fields."""
    cards = [fixed_fields(line) for line in text.splitlines() if line.startswith(("CQUAD4", "CTRIA3"))]
    return {int(card[1]): card for card in cards}


def turned(vectors, about, degrees):
    """Vectors (k, 3) turned about unit axes (k, 3) by angles (k,), after Rodrigues."""
    angle = np.radians(degrees)[:, None]
    along = (vectors * about).sum(axis=1, keepdims=True) * about
    return along + np.cos(angle) * (vectors - along) + np.sin(angle) * np.cross(about, vectors)


def corners_normal_side(points, quads):
    """Centres, unit normals and unit sides 1-2 of flat quads."""
    a, b, c, d = (points[quads[:, k]] for k in range(4))
    normal = np.cross(c - a, d - b)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    side = b - a
    return 0.25 * (a + b + c + d), normal, side / np.linalg.norm(side, axis=1, keepdims=True)
