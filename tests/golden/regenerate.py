"""Drapes the golden cases again: ``python tests/golden/regenerate.py`` writes over the folders beside it."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

GOLDEN = Path(__file__).parent
PARTS = GOLDEN / "parts"
OUTPUTS = "json,csv,dxf,svg"
CASES = {
    "hemisphere": ["hemisphere.obj", "--origin", "3,-2,45", "--angle", "20", "--pitch", "5"],
    "l-with-hole": ["l-with-hole.obj", "--origin", "-30,-30,0", "--angle", "37.3", "--pitch", "6"],
    "blank-on-saddle": ["saddle.obj", "--origin", "7,-4.5,0", "--angle", "-12.5", "--pitch", "5", "--blank", "90x63"],
}


def command(case: str, folder: Path | str, *more: str) -> list[str]:
    """Arguments of ``geomdrap`` for a case whose result goes to a folder."""
    part, *options = CASES[case]
    return ["drape", str(PARTS / part), *options, *more, "-o", str(folder), "--outputs", OUTPUTS, "--quiet"]


def write_parts() -> None:
    """Write the meshes with eight digits, so that every machine reads the same numbers."""
    from geomdrap.surface import shapes

    line = np.linspace(-60.0, 60.0, 25)
    l_with_hole = shapes.grid_surface(
        lambda x, y: -(x * x + 0.5 * y * y) / 300.0,
        line,
        line,
        keep=lambda x, y: ((x < 0.0) | (y < 0.0)) & ~((abs(x + 35.0) < 10.0) & (abs(y - 5.0) < 15.0)),
    )
    PARTS.mkdir(exist_ok=True)
    write_obj(shapes.hemisphere(45.0, 4.0), PARTS / "hemisphere.obj")
    write_obj(l_with_hole, PARTS / "l-with-hole.obj")
    write_obj(shapes.saddle(150.0, 120.0, 6.0), PARTS / "saddle.obj")


def write_obj(surface, path: Path) -> None:
    """Write a surface as OBJ."""
    lines = ["v {:.8g} {:.8g} {:.8g}".format(*p) for p in np.round(surface.points, 6) + 0.0]
    lines += ["f {} {} {}".format(*t) for t in surface.triangles + 1]
    path.write_text("\n".join(lines) + "\n")


def main() -> None:
    """Drape all cases; with ``--parts`` write the meshes first."""
    from geomdrap.cli import cli

    if "--parts" in sys.argv:
        write_parts()
    for case in CASES:
        try:
            cli.main(command(case, GOLDEN / case), prog_name="geomdrap")
        except SystemExit as end:
            if end.code:
                raise


if __name__ == "__main__":
    main()
